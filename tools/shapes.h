// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes and maps made from formulas: a left ventricle, a block, and the ventricle's angle map.
// They return what a file would have held; `viscera generate` writes it, tests use it directly.
#ifndef VSC_TOOLS_SHAPES_H
#define VSC_TOOLS_SHAPES_H

#include "mesh/image.h"
#include "mesh/mesh.h"
#include "tools/shapes_bricks.h"

// A left ventricle between two half ellipsoids of revolution about z, apex at -z, cut by the plane
// z = base, or by a cone. A point at depth t (0 endocardium, 1 epicardium) lies on the ellipsoid with the radius
// (1-t) endo_radius + t epi_radius and the half length (1-t) endo_length + t epi_length.
typedef struct vsc_lv_shape {
  double endo_radius;  // mm, at the equator z = 0
  double endo_length;  // mm, from the equator to the apex
  double epi_radius;   // mm
  double epi_length;   // mm
  double base;         // z of the base plane, mm
  size_t around;       // bricks round the circumference, a multiple of 4
  size_t along;        // bricks from the apical patch to the base
  size_t layers;       // bricks through the wall
  double base_rise;    // mm; by how much the base lies higher at the epicardium: 0 (a plane), or a cone
                       // of straight lines from the endocardial ring to the epicardial one
  bool along_x;        // x, y, z take the places of z, x, y: the long axis is x, the apex at -x
  bool surfaces;       // the mesh has the boundary's triangles, too: array `surface`, 1 endocardium,
                       // 2 epicardium, 3 base
  vsc_block_kind element;  // TETS (5 of a brick), HEXES or WEDGES
} vsc_lv_shape;

// An adult human ventricle: cavity 134 ml, wall 9.5 mm thick at the equator and 7 mm at the apex,
// 135 ml of tissue, 86 mm from the endocardial apex to the base; 32 x 14 x 3 bricks.
vsc_lv_shape vsc_lv_default(void);

// The ventricle of Land et al. 2015, problems 2 and 3: cavity 7 by 17 mm, outside 10 by 20 mm, base plane
// z = 5; 16 x 12 x 2 bricks (2080 tets).
vsc_lv_shape vsc_lv_land(void);

// The one ventricle of Arostica et al. 2025: cavity 25 by 90 mm, outside 35 by 97 mm, axis x, base rings
// where cos u = 5/17 inside and 5/20 outside, with surfaces; 32 x 20 x 2 bricks (7040 tets).
vsc_lv_shape vsc_lv_arostica(void);

// Depth of a point: the t whose ellipsoid holds it, between -1 and 3 (limited to these):
// vsc_ellipsoid_depth.
double vsc_lv_depth(const vsc_lv_shape *shape, const double point[3]);

// The frame (rows f, s, n) of the transmural helix at a point, by the convention of fibers/helix.h:
// e_t is the normal of the ellipsoid through the point, the angle (radians) linear in vsc_lv_depth.
void vsc_lv_frame(const vsc_lv_shape *shape, const double point[3], double endo_angle,
                  double epi_angle, double frame[9]);

// The mesh of the ventricle: a square patch at the apex and four side patches (a cubed sphere), so
// that no element is degenerate; bricks become `element`s, tets mirrored from brick to brick so that
// faces match. Node arrays `endo`, `epi`, `base` and `rim` (the epicardial edge of the base), 0 or 1;
// cell array `region`, 1. The caller owns *mesh. VSC_INPUT for dimensions that make no ventricle.
vsc_status vsc_lv_mesh(const vsc_lv_shape *shape, vsc_mesh **mesh, vsc_error *error);

// The angle map of the helix on a grid of cubic voxels round the wall, with a margin of one voxel:
// point arrays `azimuth` (degrees in [0, 180)), `elevation` (degrees in [-90, 90]) and `tissue` (1
// for voxel centres in the wall; elsewhere all three are 0). Angles in radians, spacing in mm. Of
// ventricles about z with a flat base only. The caller owns *image.
vsc_status vsc_lv_map(const vsc_lv_shape *shape, double endo_angle, double epi_angle,
                      double spacing, vsc_image **image, vsc_error *error);

// A box from the origin to `size`, cut into bricks.
typedef struct vsc_block_shape {
  size_t cells[3];    // bricks along x, y, z
  double size[3];     // mm
  int tets_per_cell;  // 5 (neighbours mirrored) or 6 (round the brick's main diagonal)
  double jitter;  // inner nodes are moved by up to this part of a brick along each axis, 0 to 0.3
  unsigned long seed;  // of the jitter
  size_t slivers;      // so many inner nodes are moved along x to a hundredth of a brick from the next one
} vsc_block_shape;

// 4 x 4 x 4 bricks of 5 tets in a cube of 10 mm, no jitter.
vsc_block_shape vsc_block_default(void);

// The mesh of the box: node arrays x0, x1, y0, y1, z0, z1, 0 or 1, for its six faces; tet array
// `region`, 1. VSC_INPUT for an empty box, a jitter that turns a tet over, or more slivers than there are places, every third
// node along each axis. The caller owns *mesh.
vsc_status vsc_block_mesh(const vsc_block_shape *shape, vsc_mesh **mesh, vsc_error *error);

// Number `number` in [-1, 1) of the series `seed` (the mixing function of SplitMix64, Steele et al.
// 2014).
double vsc_scatter(unsigned long seed, size_t number);

#endif
