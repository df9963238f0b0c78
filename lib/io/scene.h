// SPDX-License-Identifier: GPL-3.0-or-later
// The scene: one YAML file, values with units, read by libcyaml and udunits2.
#ifndef VSC_IO_SCENE_H
#define VSC_IO_SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "mesh/quadratic.h"
#include "model/definition.h"
#include "model/fiber_def.h"

enum { VSC_OUTPUT_ARRAYS = 32, VSC_MOST_PRESSURES = 52, VSC_OUTPUT_POINTS = 64 };  // of a scene

// A material point whose way is a signal.
typedef struct vsc_point_def {
  char name[VSC_NAME];
  double at[3];  // mm, where it is at rest
  double reach;  // mm: how far outside the body `at` may lie; the nearest place of the body is watched
                 // then. Default 0: a tenth of the elements' size
} vsc_point_def;

// What is written, and how often.
typedef struct vsc_output_def {
  double frame_interval;   // ms between VTU frames; default 10; of equilibria the end
  bool double_precision;   // 64-bit floats in the frames; default false: 32
  size_t array_count;      // arrays of the frames; 0: the default set
  char arrays[VSC_OUTPUT_ARRAYS][VSC_NAME];
  double centre[3];        // a point of the line that helix angles are seen from, mm; default 0 0 0
  double axis[3];          // its direction from apex to base, of any length; 0 0 0 (default): that
                           // of fibers.helix
  double signal_interval;  // ms between rows of signals.csv; default 1; of solve
                           // implicit and equilibrium as the frames
  size_t cavity_count;     // surfaces whose enclosed (capped) volume is a signal
  char cavities[VSC_OUTPUT_ARRAYS][VSC_NAME];
  size_t point_count;      // observed points
  vsc_point_def *points;   // owned
  double checkpoint_interval;  // ms between checkpoints; 0: only at the end; default 0
} vsc_output_def;

// What shape the mesh is (run/prestress.h).
typedef struct vsc_prestress_def {
  bool loaded;       // it is in equilibrium under the loads; default false: it is at rest
  double time;       // under those of this time, at which the simulation begins, ms; default 0
  double tolerance;  // by which nodes may be off it then, mm; default 0.01
  int iterations;    // at most; default 20
} vsc_prestress_def;

vsc_prestress_def vsc_default_prestress(void);

typedef struct vsc_scene {
  char file[VSC_PATH];      // the scene file
  char mesh_file[VSC_PATH]; // resolved against the scene file's folder
  size_t input_count;         // files that the scene names: mesh, map, vessels, curves
  char (*inputs)[VSC_PATH];   // resolved likewise; owned
  double mesh_unit;         // mm per unit of the mesh's coordinates
  int mesh_order;           // 1: elements as the file has them (default), 2: tets made quadratic
  size_t curved_count;      // surfaces whose edges are bent
  vsc_curved_def *curved;   // owned
  vsc_prestress_def prestress;
  vsc_fiber_def fibers;     // its map file resolved likewise
  vsc_definition definition;
  vsc_output_def output;
} vsc_scene;

// Reads a scene file. `settings` (setting_count of them) are `key=value` texts that replace or add
// values after the file is read: "time.end=0.4 s", "materials[0].axial.f=12 kPa"; a list grows at
// its end ("output.cavities[0]=endo"), and whole parts are written in YAML's short form
// ("gravity=[0 m/s2, 0 m/s2, -9.81 m/s2]"). Fails with
// VSC_INPUT and "file:line: key: what was expected, the nearest known key". On success the caller
// owns *scene.
vsc_status vsc_scene_read(const char *file, const char *const *settings, size_t setting_count,
                          vsc_scene **scene, vsc_error *error);

void vsc_scene_free(vsc_scene *scene);  // NULL is fine

// How a scene as understood begins.
#define VSC_SCENE_UNDERSTOOD "# The scene as viscera understood it"

// Writes the scene as understood, every default filled in, as YAML that vsc_scene_read reads back
// to the same scene, in one step (temporary name, then renamed). File names are written absolute.
vsc_status vsc_scene_write(const vsc_scene *scene, const char *file, vsc_error *error);

// Prints a commented template of every key with its default, unit and meaning to `stream`. It is
// itself a valid scene once the mesh file exists.
void vsc_scene_schema(FILE *stream);

#endif
