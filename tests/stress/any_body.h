// SPDX-License-Identifier: GPL-3.0-or-later
// A small block of any law and any kind of element with random frames, held at two ends or free: for tests under stress.
#ifndef VSC_TESTS_STRESS_ANY_BODY_H
#define VSC_TESTS_STRESS_ANY_BODY_H

#include "kinds_body.h"
#include "tissue_laws.h"
#include "tools/shapes_block.h"

typedef enum any_kind { PLAIN, NODAL, SMOOTHED, QUADRATIC, HEXES, MIXED, ANY_KINDS } any_kind;

static const char *const any_kind_names[ANY_KINDS] = {"plain tets", "tets of nodal volume", "smoothed tets",
                                                      "quadratic tets", "hexahedra", "all kinds"};

// Laws of tissue_laws.h, the last of which has springs with couplings, and one more: springs without, which have
// kernels of their own.
enum { COUPLED_SPRINGS = TISSUE_LAWS - 1, PLAIN_SPRINGS, ANY_LAWS };

typedef struct any_body {
  vsc_mesh *mesh;
  vsc_axes *axes;
  vsc_material_def material;
  vsc_selector sets[2];
  vsc_support_def supports[2];
  vsc_definition definition;
  vsc_model *model;
  vsc_state *state;
} any_body;

// A block of cells along x, y, z of 1 mm, with node arrays x0 and x1.
static inline vsc_mesh *any_mesh(any_kind kind, const size_t cells[3])
{
  const vsc_block_shape shape = {.cells = {cells[0], cells[1], cells[2]},
                                 .size = {(double)cells[0], (double)cells[1], (double)cells[2]},
                                 .tets_per_cell = 6,
                                 .jitter = 0.15,
                                 .seed = 3};
  vsc_mesh *mesh = NULL;
  vsc_error error;
  if (vsc_block_of(&shape, kind == HEXES ? VSC_BLOCK_HEXES : kind == MIXED ? VSC_BLOCK_MIXED : VSC_BLOCK_TETS, &mesh,
                   &error) != VSC_OK)
    fail_msg("%s", error.text);
  return mesh;
}

// Takes the mesh. The body's material and definition may be changed before any_build.
static inline void any_open(any_body *body, vsc_mesh *mesh, int law, any_kind kind)
{
  vsc_error error;
  *body = (any_body){.mesh = mesh, .material = tissue_law(law < TISSUE_LAWS ? law : COUPLED_SPRINGS)};
  body->definition = vsc_default_definition();
  if (law == PLAIN_SPRINGS) memset(body->material.coupling, 0, sizeof body->material.coupling);
  if (kind == QUADRATIC && vsc_mesh_raise(&body->mesh, "block", &error) != VSC_OK) fail_msg("%s", error.text);
  body->axes = random_axes_for(body->mesh, 11);
  body->definition.materials = &body->material;
  body->definition.material_count = 1;
  body->definition.volume = kind == PLAIN ? VSC_VOLUME_ELEMENT : VSC_VOLUME_NODAL;
  body->definition.tets = kind == SMOOTHED ? VSC_TETS_SMOOTHED : VSC_TETS_PLAIN;
  body->definition.end_time = 1e6;
}

// Holds the nodes where x0, then x1, is 1: the first `ends` of them.
static inline void any_hold(any_body *body, size_t ends)
{
  static const char *const arrays[2] = {"x0", "x1"};
  for (size_t k = 0; k < ends; k++) {
    body->sets[k] = (vsc_selector){.kind = VSC_SELECT_NODE_ARRAY, .low = 1, .high = 1};
    vsc_copy_name(body->sets[k].name, arrays[k]);
    vsc_copy_name(body->sets[k].array, arrays[k]);
    body->supports[k] = (vsc_support_def){.held = {1, 1, 1}};
    vsc_copy_name(body->supports[k].set, arrays[k]);
  }
  body->definition.sets = body->sets;
  body->definition.supports = body->supports;
  body->definition.set_count = body->definition.support_count = ends;
}

static inline void any_build(any_body *body)
{
  vsc_error error;
  if (vsc_model_build(body->mesh, body->axes, &body->definition, &body->model, &error) != VSC_OK ||
      vsc_state_create(body->model, &body->state, &error) != VSC_OK)
    fail_msg("%s", error.text);
}

static inline void any_close(any_body *body)
{
  vsc_state_free(body->state);
  vsc_model_free(body->model);
  vsc_axes_free(body->axes);
  vsc_mesh_free(body->mesh);
}

#endif
