// SPDX-License-Identifier: GPL-3.0-or-later
// A jittered block of two tissues with random fibres and everything switched on that a scene can
// have: for tests of the forces. Positions, velocities and forces of tests are in the mesh's order
// (nodes x 3).
#ifndef VSC_TESTS_RANDOM_BODY_H
#define VSC_TESTS_RANDOM_BODY_H

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "close.h"
#include "mech/force.h"
#include "mech/observe.h"
#include "model/model.h"
#include "random.h"
#include "tools/shapes.h"

#define RAMP_TIME 100.0  // ms: activation rises as a ramp, which the table of a curve holds exactly

typedef struct random_body {
  vsc_mesh *mesh;
  vsc_axes *axes;
  vsc_material_def
      materials[2];  // region 1: muscle, active and damped; region 2: passive and undamped
  vsc_pressure_def pressure;
  vsc_definition definition;
  vsc_model *model;
  vsc_state *state;
  vsc_ledger *ledger;
} random_body;

// A block of n x n x n bricks of 1 mm, 6 tets each; the half beyond the middle is region 2.
// Tet arrays `strength` (0.5 to 1) and `late` (0 to 20).
static inline vsc_mesh *random_block(size_t n, uint64_t seed)
{
  const double size = (double)n;
  const vsc_block_shape shape = {.cells = {n, n, n},
                                 .size = {size, size, size},
                                 .tets_per_cell = 6,
                                 .jitter = 0.2,
                                 .seed = (unsigned long)seed};
  vsc_mesh *mesh = NULL;
  vsc_error error;
  if (vsc_block_mesh(&shape, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_array *region = (vsc_array *)vsc_arrays_find(&mesh->element_data, "region");
  for (size_t t = 0; t < mesh->element_count; t++) {
    double centre[3];
    vsc_mesh_element_centre(mesh, t, centre);
    region->values[t] = centre[0] + 0.3 * centre[1] > 0.65 * size ? 2 : 1;
  }
  vsc_array *strength = vsc_arrays_add(&mesh->element_data, "strength", 1, mesh->element_count);
  for (size_t t = 0; t < mesh->element_count; t++) strength->values[t] = random_between(&seed, 0.5, 1);
  vsc_array *late = vsc_arrays_add(&mesh->element_data, "late", 1, mesh->element_count);
  for (size_t t = 0; t < mesh->element_count; t++) late->values[t] = random_between(&seed, 0, 20);
  return mesh;
}

// Random frames at all points of each element; one element in ten has no known fibre.
static inline vsc_axes *random_frames(vsc_axes *axes, uint64_t seed)
{
  for (size_t e = 0; e < axes->count; e++) {
    if (random_part(&seed) < 0.1) continue;
    for (int q = 0; q < axes->points; q++) random_rotation(&seed, vsc_axes_frame(axes, e, q));
    axes->known[e] = 1;
  }
  return axes;
}

static inline vsc_axes *random_axes(size_t count, uint64_t seed)
{
  return random_frames(vsc_axes_create(count), seed);
}

static inline vsc_axes *random_axes_for(const vsc_mesh *mesh, uint64_t seed)
{
  return random_frames(vsc_axes_create_for(mesh), seed);
}

static inline void define_materials(vsc_material_def materials[2], vsc_active_kind active)
{
  static const double axial[3] = {9, 6, 4}, angular[3] = {3, 2, 5}, damping[3] = {0.3, 0.2, 0.1};
  for (int m = 0; m < 2; m++) {
    materials[m] = vsc_default_material();
    materials[m].region_count = 1;
    materials[m].regions[0] = m + 1;
    for (int a = 0; a < 3; a++) {
      materials[m].axial[a] = axial[a] + 10 * m;
      materials[m].angular[a] = angular[a] + 2 * m;
      materials[m].damping[a] = m == 0 ? damping[a] : 0;
    }
    materials[m].volume_modulus = 50 + 100 * m;
    materials[m].stabilization = 4 + m;
    vsc_copy_name(materials[m].name, m == 0 ? "muscle" : "scar");
  }
  vsc_active_def *muscle = &materials[0].active;
  muscle->kind = active;
  muscle->stiffness = 60;
  muscle->rest_stretch = 0.85;
  muscle->tension = 25;
  muscle->delay = 5;
  muscle->delay_unit = 2;
  muscle->curve = vsc_default_curve(VSC_CURVE_RAMP);
  muscle->curve.duration = RAMP_TIME;
  vsc_copy_name(muscle->amplitude_array, "strength");
  vsc_copy_name(muscle->delay_array, "late");
}

// Fills the definition; the caller may change it before body_build.
static inline void body_define(random_body *body, vsc_mesh *mesh, vsc_axes *axes,
                               vsc_active_kind active, vsc_volume_kind volume)
{
  *body = (random_body){.mesh = mesh, .axes = axes};
  define_materials(body->materials, active);
  body->definition = vsc_default_definition();
  body->definition.end_time = 1000;
  body->definition.volume = volume;
  body->definition.material_count = 2;
  body->definition.materials = body->materials;
  vsc_copy_name(body->definition.region_array, "region");
  body->pressure = (vsc_pressure_def){.peak = 3, .curve = vsc_default_curve(VSC_CURVE_RAMP)};
  body->pressure.curve.duration = RAMP_TIME;
  vsc_copy_name(body->pressure.surface, "boundary");
  body->definition.pressures = &body->pressure;
  body->definition.pressure_count = 1;
  const double gravity[3] = {0.02, -0.01, 0.03};
  memcpy(body->definition.gravity, gravity, sizeof gravity);
}

static inline void body_build(random_body *body)
{
  vsc_error error;
  if (vsc_model_build(body->mesh, body->axes, &body->definition, &body->model, &error) != VSC_OK ||
      vsc_state_create(body->model, &body->state, &error) != VSC_OK ||
      vsc_ledger_create(body->model, &body->ledger, &error) != VSC_OK)
    fail_msg("%s", error.text);
}

static inline void random_body_open(random_body *body, size_t n, vsc_active_kind active,
                                    vsc_volume_kind volume, uint64_t seed)
{
  vsc_mesh *mesh = random_block(n, seed);
  body_define(body, mesh, random_axes(mesh->element_count, seed + 1), active, volume);
  body_build(body);
}

static inline void body_close(random_body *body)
{
  vsc_ledger_free(body->ledger);
  vsc_state_free(body->state);
  vsc_model_free(body->model);
  vsc_axes_free(body->axes);
  vsc_mesh_free(body->mesh);
}

// nodes x 3 in the mesh's order -> nodes x 4 in the model's.
static inline void to_model(const vsc_model *model, const double *of_mesh, double *of_model)
{
  for (size_t n = 0; n < model->node_count; n++) {
    memcpy(of_model + 4 * n, of_mesh + 3 * (size_t)model->mesh_node[n], 3 * sizeof(double));
    of_model[4 * n + 3] = 0;
  }
}

static inline void to_mesh(const vsc_model *model, const double *of_model, double *of_mesh)
{
  for (size_t n = 0; n < model->node_count; n++)
    memcpy(of_mesh + 3 * (size_t)model->mesh_node[n], of_model + 4 * n, 3 * sizeof(double));
}

static inline double *numbers(size_t count)
{
  double *array;
  if (!VSC_NEW(array, count)) fail_msg("no memory");
  return array;
}

// The force on each node at positions x and velocities w (NULL: without damping).
static inline void body_force(random_body *body, const double *x, const double *w, double time,
                              double *force)
{
  const size_t count = 4 * body->model->node_count;
  double *memory = numbers(3 * count);
  to_model(body->model, x, memory);
  if (w) to_model(body->model, w, memory + count);
  vsc_force(body->model, memory, w ? memory + count : NULL, time, &body->state->scratch,
            memory + 2 * count);
  to_mesh(body->model, memory + 2 * count, force);
  vsc_free(memory);
}

// An affine deformation within `strain` of the identity, and on top of it each node moved by up to
// `noise` (mm): new array.
static inline double *deformed(const vsc_mesh *mesh, double strain, double noise, uint64_t seed)
{
  double A[9], *x = numbers(3 * mesh->node_count);
  random_fill(&seed, strain, A, 9);
  for (int i = 0; i < 9; i += 4) A[i] += 1;
  for (size_t n = 0; n < mesh->node_count; n++) {
    double moved[3];
    random_fill(&seed, noise, moved, 3);
    rotate_vector(A, mesh->nodes + 3 * n, x + 3 * n);
    for (int i = 0; i < 3; i++) x[3 * n + i] += moved[i];
  }
  return x;
}

static inline double *random_array(size_t count, double size, uint64_t seed)
{
  double *array = numbers(count);
  random_fill(&seed, size, array, (int)count);
  return array;
}

static inline double largest_of(const double *array, size_t count)
{
  double most = 0;
  for (size_t i = 0; i < count; i++) most = fmax(most, fabs(array[i]));
  return most;
}

static inline double dot_of(const double *a, const double *b, size_t count)
{
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += a[i] * b[i];
  return sum;
}

#endif
