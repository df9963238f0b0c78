// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of one material on meshes of any kind, with random frames: for tests of laws and kinds of
// elements.
#ifndef VSC_TESTS_KINDS_BODY_H
#define VSC_TESTS_KINDS_BODY_H

#include "hybrid_mesh.h"
#include "mesh/quadratic.h"
#include "random_body.h"

// A block of n^3 jittered hexahedra of 1 mm, or of as many bricks in all four linear kinds, or of tets, or
// of quadratic tets with straight edges.
typedef enum kinds_mesh { ALL_HEXES, ALL_KINDS, ALL_TETS, ALL_TETS10 } kinds_mesh;

static inline vsc_mesh *hex_block(size_t n, double jitter, uint64_t seed)
{
  const size_t nodes = (n + 1) * (n + 1) * (n + 1), bricks = n * n * n;
  uint8_t *kinds;
  if (!VSC_NEW(kinds, bricks)) fail_msg("no memory");
  memset(kinds, VSC_HEX, bricks);
  vsc_mesh *mesh = vsc_mesh_create_cells(nodes, bricks, kinds, 0);
  vsc_free(kinds);
  for (size_t i = 0; i < nodes; i++) hybrid_place(n, i, jitter, &seed, mesh->nodes + 3 * i);
  for (size_t b = 0; b < bricks; b++) {
    uint32_t brick[9];
    hybrid_brick(n, b, 0, brick);
    memcpy(mesh->corners + 8 * b, brick, 8 * sizeof *brick);
  }
  return mesh;
}

static inline vsc_mesh *mesh_of(kinds_mesh kind, size_t n, uint64_t seed)
{
  if (kind == ALL_HEXES) return hex_block(n, 0.15, seed);
  if (kind == ALL_KINDS) return hybrid_block(n, 0.15, seed);
  vsc_mesh *mesh = random_block(n, seed);
  vsc_error error;
  if (kind == ALL_TETS10 && vsc_mesh_raise(&mesh, "block", &error) != VSC_OK)
    fail_msg("%s", error.text);
  return mesh;
}

// Springs of all sorts: three axes and two more, pairs with right and other angles.
static inline vsc_material_def springs_material(vsc_axis_def axes[2], vsc_pair_def pairs[2])
{
  vsc_material_def material = vsc_default_material();
  static const double axial[3] = {9, 6, 4}, angular[3] = {3, 2, 5}, damping[3] = {0.3, 0.2, 0.1};
  for (int a = 0; a < 3; a++) {
    material.axial[a] = axial[a];
    material.angular[a] = angular[a];
    material.damping[a] = damping[a];
  }
  material.volume_modulus = 60;
  material.stabilization = 4;
  if (axes == NULL) return material;
  axes[0] = (vsc_axis_def){.direction = {1, 1, 0}, .modulus = 7, .damping = 0.2};
  axes[1] = (vsc_axis_def){.direction = {-1, 2, 1}, .modulus = 3};
  pairs[0] = (vsc_pair_def){.axes = {0, 3}, .modulus = 4};
  pairs[1] = (vsc_pair_def){.axes = {3, 4}, .modulus = 2};
  material.axes = axes;
  material.pairs = pairs;
  material.axis_count = material.pair_count = 2;
  return material;
}

static inline vsc_material_def paper_material(void)
{
  vsc_material_def material = vsc_default_material();
  material.law = VSC_LAW_PAPER;
  material.paper = (vsc_paper_def){.axial = {9, 6, 4},
                                   .damping = {0.3, 0.2, 0.1},
                                   .angular = {3, 2, 5},
                                   .volume = 8,
                                   .volume_damping = 0.2};
  return material;
}

static inline vsc_material_def classical_material(void)
{
  vsc_material_def material = vsc_default_material();
  material.law = VSC_LAW_CLASSICAL;
  material.classical = (vsc_classical_def){.stiffness = 5, .damping = 0.2};
  return material;
}

// The body of `material` on a mesh; body_close frees it. The material's arrays stay the caller's.
static inline void kinds_open_tets(random_body *body, vsc_mesh *mesh,
                                   const vsc_material_def *material, vsc_volume_kind volume,
                                   vsc_tets_kind tets, uint64_t seed)
{
  *body = (random_body){.mesh = mesh, .axes = random_axes_for(mesh, seed)};
  body->materials[0] = *material;
  body->definition = vsc_default_definition();
  body->definition.end_time = 1000;
  body->definition.volume = volume;
  body->definition.tets = tets;
  body->definition.material_count = 1;
  body->definition.materials = body->materials;
  body_build(body);
}

static inline void kinds_open(random_body *body, vsc_mesh *mesh, const vsc_material_def *material,
                              vsc_volume_kind volume, uint64_t seed)
{
  kinds_open_tets(body, mesh, material, volume, VSC_TETS_PLAIN, seed);
}

// Positions A X of the mesh's nodes into the state.
static inline void deform(random_body *body, const double A[9])
{
  double *x = numbers(3 * body->mesh->node_count);
  for (size_t n = 0; n < body->mesh->node_count; n++)
    rotate_vector(A, body->mesh->nodes + 3 * n, x + 3 * n);
  to_model(body->model, x, body->state->x);
  vsc_free(x);
}

// Stored energy at positions x (mesh's order).
static inline double kinds_energy(random_body *body, const double *x, vsc_totals *totals)
{
  to_model(body->model, x, body->state->x);
  vsc_observe(body->model, body->state, body->ledger, true, totals);
  return totals->axial + totals->angular + totals->volume_energy;
}

#endif
