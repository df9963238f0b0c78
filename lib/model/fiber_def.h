// SPDX-License-Identifier: GPL-3.0-or-later
// Where the fibre axes of the elements come from, as the user said it.
#ifndef VSC_MODEL_FIBER_DEF_H
#define VSC_MODEL_FIBER_DEF_H

#include <stdbool.h>
#include <stddef.h>

#include "base/text.h"

enum { VSC_PATH = 512 };  // bytes of a file name with its terminating zero

typedef enum vsc_fiber_source {
  VSC_FIBER_NONE,          // no fibres: every element is passive, frames are the global axes
  VSC_FIBER_MAP,           // voxel map of azimuth and elevation
  VSC_FIBER_ARRAYS,        // cell arrays of the mesh: a vector `fiber`, perhaps `sheet`
  VSC_FIBER_CONSTANT,      // one direction everywhere
  VSC_FIBER_HELIX,         // transmural helix of a ventricle
  VSC_FIBER_HORIZONTAL,    // the set of Fig. 6 of Bourguignon & Cani 2000: along x,
  VSC_FIBER_DIAGONAL,      // at 45 degrees in the x-z plane,
  VSC_FIBER_HEMICIRCULAR,  // along half circles in the x-z plane, round the bottom middle of the
                           // box,
  VSC_FIBER_HELICOIDAL,    // along helices round the box's vertical (z) mid-line, `pitch` above the
                           // horizontal,
  VSC_FIBER_RANDOM,        // uniform on the sphere, per element, from `seed`
  VSC_FIBER_ELLIPSOID,     // transmural helix between two ellipsoids, exact (fibers/ellipsoid.h)
} vsc_fiber_source;

// What a scene calls a source; "unknown" for a number that is none.
const char *vsc_fiber_source_name(vsc_fiber_source source);

// A voxel map of two angles. f = (cos el cos az, cos el sin az, sin el) in the axes chosen by
// `image_axes`; az = azimuth_sense (value . scale - azimuth_zero), el = elevation_sense . value .
// scale.
typedef struct vsc_angle_map_def {
  char file[VSC_PATH];
  char azimuth[VSC_NAME];    // array; default "azimuth"
  char elevation[VSC_NAME];  // array; default "elevation"
  double scale;              // radians per unit of the arrays; default pi/180 (degrees)
  double azimuth_zero;       // radians, counted from +x; default 0
  int azimuth_sense;         // +1 from +x to +y (default), -1 from +x to -y (rows stored downwards)
  int elevation_sense;       // +1 towards +z (default), -1
  bool image_axes;      // true (default): angles are in the image's own axes i, j, k and turned by
                        // its direction matrix; false: in the world's x, y, z
  char mask[VSC_NAME];  // voxels with mask > 0 hold tissue; empty: every voxel
  char weight[VSC_NAME];  // weight of a voxel, >= 0; empty: 1
  double length_unit;     // mm per unit of origin and spacing; default 1
} vsc_angle_map_def;

// A wall between two half ellipsoids of revolution with one centre and long axis, mm.
typedef struct vsc_ellipsoid_def {
  double centre[3];    // default 0 0 0
  double endo_radius;  // of the inner one, across the long axis
  double endo_length;  // from the centre to its apex
  double epi_radius;   // the same of the outer one
  double epi_length;
} vsc_ellipsoid_def;

typedef struct vsc_fiber_def {
  vsc_fiber_source source;     // default NONE
  vsc_angle_map_def map;       // MAP
  bool fill;                   // MAP, ARRAYS: elements without data take the mean axis of their
                               // neighbours, spreading until none is left; default false
  char fiber_array[VSC_NAME];  // ARRAYS: default "fiber"
  char sheet_array[VSC_NAME];  // ARRAYS: "sheet"; empty: by rule
  int sense_kept;              // ARRAYS on nodes: 1: between them the vectors are interpolated as they are; 0 (default):
                               // as axes, whose two senses are the same
  double direction[3];         // CONSTANT: any length
  double sheet_direction[3];   // CONSTANT: 0 0 0: by rule
  char endo[VSC_NAME];         // HELIX, ELLIPSOID: surface where the depth is 0; empty: the
                               // ellipsoid's own depth
  char epi[VSC_NAME];          // HELIX, ELLIPSOID: surface where the depth is 1
  double endo_angle;    // HELIX, ELLIPSOID: helix angle at the endocardium, radians; default +60 degrees
  double epi_angle;     // HELIX, ELLIPSOID: at the epicardium, radians; default -60 degrees
  double long_axis[3];  // HELIX, ELLIPSOID: from apex to base; default 0 0 1
  vsc_ellipsoid_def ellipsoid;  // ELLIPSOID
  int sheets_across;            // ELLIPSOID: 1 (default): the sheet axis s goes across the wall, along its
                                // normal; 0: it lies in the wall, and n goes across
  double pitch;         // HELICOIDAL: radians above the horizontal; default 30 degrees
  unsigned long seed;   // RANDOM: default 1
} vsc_fiber_def;

vsc_fiber_def vsc_default_fiber(void);

// Whether these fibres hang on the depth between surfaces: HELIX, and ELLIPSOID where they are given.
bool vsc_fiber_needs_surfaces(const vsc_fiber_def *fiber);

// A vessel that the mesh does not resolve: a closed surface, or centre lines when a radius is given.
typedef struct vsc_vessel_def {
  char name[VSC_NAME];          // its volume fraction becomes the element array <name>_fraction
  char file[VSC_PATH];          // polydata
  double unit;                  // mm per unit of the file's coordinates and radii; default 1
  char material[VSC_NAME];      // what it is made of
  double radius;                // centre lines: of all of them, mm; 0: none given
  char radius_array[VSC_NAME];  // centre lines: point array of radii in the file's unit; empty: none
  double threshold;             // elements with at least this volume fraction take the vessel's
                                // direction as their fibre; default 0.05
} vsc_vessel_def;

vsc_vessel_def vsc_default_vessel(void);

#endif
