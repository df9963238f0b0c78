// SPDX-License-Identifier: GPL-3.0-or-later
// A small body of one tissue with all that is needed to step it: for tests of stepping.
#ifndef VSC_TESTS_SMALL_BODY_H
#define VSC_TESTS_SMALL_BODY_H

#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "close.h"
#include "mech/observe.h"
#include "model/model.h"
#include "solve/explicit.h"
#include "tools/shapes.h"

// A modulus that counts for nothing beside the springs (none at all is refused).
#define NO_VOLUME 1e-12

typedef struct small_body {
  vsc_mesh *mesh;
  vsc_axes *axes;
  vsc_material_def material;
  vsc_selector sets[4];
  vsc_support_def supports[4];
  vsc_pressure_def pressure;
  vsc_definition definition;
  vsc_model *model;
  vsc_state *state;
} small_body;

// Isotropic springs of shear modulus 10 kPa, volume modulus K, element-wise; end at 100 ms.
static inline void body_open(small_body *body, vsc_mesh *mesh, double K)
{
  *body = (small_body){.mesh = mesh, .material = vsc_default_material()};
  for (int a = 0; a < 3; a++) {
    body->material.axial[a] = 20;
    body->material.angular[a] = 10;
  }
  body->material.volume_modulus = K;
  body->material.density = 1;
  vsc_copy_name(body->material.name, "tissue");
  body->definition = vsc_default_definition();
  body->definition.volume = VSC_VOLUME_ELEMENT;
  body->definition.material_count = 1;
  body->definition.materials = &body->material;
  body->definition.sets = body->sets;
  body->definition.supports = body->supports;
  body->definition.end_time = 100;
}

static inline vsc_mesh *block_of(size_t nx, size_t ny, size_t nz, double size, double jitter)
{
  const vsc_block_shape shape = {.cells = {nx, ny, nz},
                                 .size = {size * (double)nx, size * (double)ny, size * (double)nz},
                                 .tets_per_cell = 6,
                                 .jitter = jitter,
                                 .seed = 3};
  vsc_mesh *mesh = NULL;
  vsc_error error;
  if (vsc_block_mesh(&shape, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  return mesh;
}

// Holds the nodes of a node array's value 1 in the given directions.
static inline void body_hold(small_body *body, const char *array, int x, int y, int z)
{
  const size_t k = body->definition.set_count++;
  body->definition.support_count++;
  body->sets[k] = (vsc_selector){.kind = VSC_SELECT_NODE_ARRAY, .low = 1, .high = 1};
  vsc_copy_name(body->sets[k].name, array);
  vsc_copy_name(body->sets[k].array, array);
  body->supports[k] = (vsc_support_def){.held = {x, y, z}};
  vsc_copy_name(body->supports[k].set, array);
}

// Lets three faces slide in the planes of the axes, so that the body can only stretch.
static inline void body_hold_planes(small_body *body)
{
  body_hold(body, "x0", 1, 0, 0);
  body_hold(body, "y0", 0, 1, 0);
  body_hold(body, "z0", 0, 0, 1);
}

// Every tet's fibre along `fiber`.
static inline void body_fibers(small_body *body, const double fiber[3])
{
  body->axes = vsc_axes_create(body->mesh->element_count);
  if (body->axes == NULL) fail_msg("no memory");
  for (size_t t = 0; t < body->mesh->element_count; t++) {
    vsc_axes_complete(fiber, NULL, body->axes->frames + 9 * t);
    body->axes->known[t] = 1;
  }
}

// Builds the model and a state at rest, not started.
static inline void body_build(small_body *body)
{
  vsc_error error;
  if (vsc_model_build(body->mesh, body->axes, &body->definition, &body->model, &error) != VSC_OK ||
      vsc_state_create(body->model, &body->state, &error) != VSC_OK)
    fail_msg("%s", error.text);
}

static inline void body_start(small_body *body)
{
  vsc_error error;
  if (vsc_start(body->model, body->state, &error) != VSC_OK) fail_msg("%s", error.text);
}

static inline void body_steps(small_body *body, double dt, size_t count)
{
  vsc_error error;
  if (vsc_steps(body->model, body->state, dt, (double)count, &error) != VSC_OK)
    fail_msg("%s", error.text);
}

// The model's number of the mesh's node.
static inline size_t body_node(const small_body *body, size_t mesh_node)
{
  for (size_t n = 0; n < body->model->node_count; n++)
    if (body->model->mesh_node[n] == mesh_node) return n;
  fail_msg("no node %zu", mesh_node);
  return 0;
}

// Every node must be at `stretch` times its place at rest, to `off` mm.
static inline void body_must_be_stretched(const small_body *body, const double stretch[3], double off)
{
  for (size_t n = 0; n < body->model->node_count; n++)
    for (int i = 0; i < 3; i++)
      assert_close(body->state->x[4 * n + i], stretch[i] * body->model->rest[4 * n + i], 0, off);
}

static inline double any_number(uint64_t *seed)  // in [-1, 1)
{
  *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(int64_t)*seed * 0x1p-63;
}

// A random velocity on every node, up to `speed` along each axis; held directions have none.
static inline void body_shake(small_body *body, double speed)
{
  uint64_t seed = 5;
  for (size_t n = 0; n < body->model->node_count; n++)
    for (int i = 0; i < 3; i++)
      if (body->model->inverse_mass[4 * n + i] > 0)
        body->state->v[4 * n + i] += speed * any_number(&seed);
}

static inline void body_close(small_body *body)
{
  vsc_state_free(body->state);
  vsc_model_free(body->model);
  vsc_axes_free(body->axes);
  vsc_mesh_free(body->mesh);
}

#endif
