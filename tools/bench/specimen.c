// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/specimen.h"

#include <malloc.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "mesh/quadratic.h"
#include "run/problem.h"
#include "solve/explicit.h"
#include "tools/shapes_block.h"

enum { TIMINGS = 5 };
#define SHORTEST_TIMING 0.15  // seconds

// ---- meshes

static size_t random_below(size_t count)
{
  return (size_t)(((double)rand() / ((double)RAND_MAX + 1)) * (double)count);
}

static void exchange(void *a, void *b, size_t bytes)
{
  char kept[64];
  memcpy(kept, a, bytes);
  memcpy(a, b, bytes);
  memcpy(b, kept, bytes);
}

// Puts tets and nodes into random order, the same at each call.
static vsc_status shuffle(vsc_mesh *mesh, vsc_error *error)
{
  uint32_t *number, *former;
  const size_t nodes = mesh->node_count;
  if (!VSC_NEW(former, nodes)) return vsc_fail_memory(error, "shuffling");
  if (!VSC_NEW(number, nodes)) {
    vsc_free(former);
    return vsc_fail_memory(error, "shuffling");
  }
  srand(1);
  for (size_t n = 0; n < nodes; n++) former[n] = (uint32_t)n;
  for (size_t n = nodes - 1; n > 0; n--) {
    const size_t other = random_below(n + 1);
    exchange(former + n, former + other, sizeof *former);
    exchange(mesh->nodes + 3 * n, mesh->nodes + 3 * other, 3 * sizeof(double));
  }
  for (size_t n = 0; n < nodes; n++) number[former[n]] = (uint32_t)n;
  for (size_t i = 0; i < 4 * mesh->element_count; i++) mesh->corners[i] = number[mesh->corners[i]];
  for (size_t t = mesh->element_count - 1; t > 0; t--)
    exchange(mesh->corners + 4 * t, mesh->corners + 4 * random_below(t + 1), 4 * sizeof(uint32_t));
  vsc_free(former);
  vsc_free(number);
  return VSC_OK;
}

vsc_status vsc_specimen_mesh(vsc_specimen_kind kind, size_t elements, vsc_mesh **mesh, vsc_error *error)
{
  vsc_block_shape shape = vsc_block_default();
  const bool hexes = kind == VSC_SPECIMEN_HEXES;
  size_t cells = 1;
  while ((hexes ? 1 : 5) * cells * cells * cells < elements) cells++;
  for (int i = 0; i < 3; i++) {
    shape.cells[i] = cells;
    shape.size[i] = (double)cells;
  }
  vsc_status status = vsc_block_of(&shape, hexes ? VSC_BLOCK_HEXES : VSC_BLOCK_TETS, mesh, error);
  if (status == VSC_OK && kind == VSC_SPECIMEN_SHUFFLED) status = shuffle(*mesh, error);
  if (status == VSC_OK && kind == VSC_SPECIMEN_QUADRATIC) status = vsc_mesh_raise(mesh, "the block", error);
  return status;
}

// ---- tissues

static vsc_material_def tissue(const vsc_specimen *specimen)
{
  vsc_material_def material = vsc_default_material();
  material.law = specimen->law;
  for (int a = 0; a < 3; a++) {
    material.axial[a] = 10;
    material.angular[a] = 5;
    material.damping[a] = specimen->damping ? 0.1 : 0;
  }
  material.guccione = (vsc_guccione_def){.C = 2, .fibre = 8, .cross = 2, .shear = 4};
  material.holzapfel_ogden = (vsc_holzapfel_ogden_def){
      .a = 0.8, .b = 3, .a_f = 5, .b_f = 6, .a_s = 2, .b_s = 4, .a_fs = 0.6, .b_fs = 5};
  material.classical = (vsc_classical_def){20, specimen->damping ? 1 : 0};
  material.volume_modulus = 100;
  material.stabilization = 10;
  material.active.kind = specimen->active;
  material.active.tension = 1;
  if (specimen->resting) {
    material.active.curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
    material.active.curve.start = 1e6;
  }
  return material;
}

// Fibres along x.
static vsc_axes *axes_of(const vsc_mesh *mesh)
{
  vsc_axes *axes = vsc_axes_create_for(mesh);
  for (size_t e = 0; axes != NULL && e < mesh->element_count; e++)
    vsc_axes_set(axes, e, (double[3]){1, 0, 0}, NULL);
  return axes;
}

// The nodes of the half at smaller x.
static vsc_selector half_of(const vsc_mesh *mesh)
{
  vsc_selector half = {.name = "half", .kind = VSC_SELECT_BOX};
  double most = 0;
  for (size_t n = 0; n < mesh->node_count; n++) most = fmax(most, mesh->nodes[3 * n]);
  for (int i = 0; i < 3; i++) {
    half.box_low[i] = -1;
    half.box_high[i] = i == 0 ? 0.5 * most : most + 1;
  }
  return half;
}

static double allocated(void)
{
  const struct mallinfo2 info = mallinfo2();
  return (double)info.uordblks + (double)info.hblkhd;
}

static double now(int threads)
{
  return threads == 1 ? vsc_cpu_seconds() : vsc_wall_seconds();
}

static vsc_status time_steps(const vsc_model *model, vsc_state *state, int threads, double *seconds,
                             vsc_error *error)
{
  const double dt = state->limit.step;
  double count = 2;
  *seconds = INFINITY;
  for (int k = 0; k < TIMINGS;) {
    const double start = now(threads);
    const vsc_status status = vsc_steps(model, state, dt, count, error);
    if (status != VSC_OK) return status;
    const double passed = now(threads) - start;
    *seconds = fmin(*seconds, passed / count);
    if (passed < SHORTEST_TIMING && count < 1e6)
      count = ceil(count * fmin(1.5 * SHORTEST_TIMING / fmax(passed, 1e-4), 100));
    else
      k++;
  }
  return VSC_OK;
}

static vsc_status start_on(const vsc_model *model, int threads, vsc_state **state, vsc_error *error)
{
  vsc_parallel_set_threads(threads);
  const vsc_status status = vsc_state_create(model, state, error);
  return status == VSC_OK ? vsc_start(model, *state, error) : status;
}

vsc_status vsc_specimen_time(const vsc_specimen *specimen, const vsc_mesh *mesh, bool all,
                             vsc_specimen_cost *cost, vsc_error *error)
{
  vsc_material_def material = tissue(specimen);
  vsc_definition definition = vsc_default_definition();
  definition.materials = &material;
  definition.material_count = 1;
  definition.volume = specimen->nodal ? VSC_VOLUME_NODAL : VSC_VOLUME_ELEMENT;
  definition.tets = specimen->smoothed ? VSC_TETS_SMOOTHED : VSC_TETS_PLAIN;
  definition.end_time = 1e5;
  vsc_selector half = half_of(mesh);
  vsc_support_def support = {.set = "half", .held = {1, 1, 1}};
  definition.sets = &half;
  definition.supports = &support;
  definition.set_count = definition.support_count = specimen->held;
  vsc_parallel_set_threads(0);
  const int threads = vsc_parallel_threads();
  *cost = (vsc_specimen_cost){.elements = mesh->element_count, .nodes = mesh->node_count};
  vsc_axes *axes = axes_of(mesh);
  if (axes == NULL) return vsc_fail_memory(error, "the bench");
  vsc_model *model = NULL;
  vsc_state *state = NULL;
  vsc_parallel_set_threads(1);
  const double before = allocated(), start = vsc_cpu_seconds();
  vsc_status status = vsc_model_build(mesh, axes, &definition, &model, error);
  if (status == VSC_OK) status = start_on(model, 1, &state, error);
  cost->build = vsc_cpu_seconds() - start;
  cost->bytes = allocated() - before;
  if (status == VSC_OK) status = time_steps(model, state, 1, &cost->one, error);
  vsc_state_free(state);
  state = NULL;
  if (status == VSC_OK && all) status = start_on(model, threads, &state, error);
  if (status == VSC_OK && all) status = time_steps(model, state, threads, &cost->all, error);
  vsc_state_free(state);
  vsc_model_free(model);
  vsc_axes_free(axes);
  vsc_parallel_set_threads(0);
  return status;
}
