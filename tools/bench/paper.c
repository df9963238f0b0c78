// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/paper.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "base/sort.h"
#include "run/problem.h"
#include "solve/explicit.h"
#include "tools/shapes_block.h"
#include "tools/shapes_cloud.h"

enum { TIMINGS = 60, STEPS = 200 };

typedef struct row {
  const char *name;
  vsc_law law;
  bool averaged;  // node-averaged volume
} row;

static const row rows[] = {{"classical springs", VSC_LAW_CLASSICAL, false},
                           {"the paper's law", VSC_LAW_PAPER, false},
                           {"ours, volume of each element", VSC_LAW_SPRINGS, false},
                           {"ours, volume averaged at nodes", VSC_LAW_SPRINGS, true}};
enum { ROWS = sizeof rows / sizeof rows[0] };

static vsc_material_def tissue(vsc_law law)
{
  vsc_material_def material = vsc_default_material();
  material.law = law;
  if (law == VSC_LAW_CLASSICAL) material.classical = (vsc_classical_def){20, 1};
  for (int a = 0; a < 3 && law == VSC_LAW_PAPER; a++) {
    material.paper.axial[a] = 20;
    material.paper.angular[a] = 20;
    material.paper.damping[a] = 1;
    material.paper.volume = 20;
  }
  for (int a = 0; a < 3 && law == VSC_LAW_SPRINGS; a++) {
    material.axial[a] = 10;
    material.angular[a] = 5;
    material.damping[a] = 1;
    material.volume_modulus = 20;
    material.stabilization = 5;
  }
  return material;
}

// Edges of the mesh, and the four main diagonals of each hexahedron.
static size_t classical_springs(const vsc_mesh *mesh)
{
  uint64_t *edges;
  size_t count = 0, different = 0, diagonals = 0;
  if (!VSC_NEW(edges, VSC_MOST_EDGES * mesh->element_count)) return 0;
  for (size_t e = 0; e < mesh->element_count; e++) {
    const vsc_cell_kind *kind = vsc_mesh_kind(mesh, e);
    const uint32_t *corners = vsc_mesh_corners(mesh, e);
    for (int k = 0; k < kind->edge_count; k++) {
      const uint64_t a = corners[kind->edges[k][0]], b = corners[kind->edges[k][1]];
      edges[count++] = a < b ? a << 32 | b : b << 32 | a;
    }
    if (mesh->kinds[e] == VSC_HEX) diagonals += 4;
  }
  qsort(edges, count, sizeof *edges, vsc_compare_uint64);
  for (size_t k = 0; k < count; k++) different += k == 0 || edges[k] != edges[k - 1];
  vsc_free(edges);
  return different + diagonals;
}

// Three axial springs and three angular ones in each frame; the paper's elements have one frame, its
// hexahedra eight springs more to their barycentre.
static size_t springs_of(const vsc_mesh *mesh, vsc_law law)
{
  if (law == VSC_LAW_CLASSICAL) return classical_springs(mesh);
  size_t count = 0;
  for (size_t e = 0; e < mesh->element_count; e++) {
    const vsc_cell kind = (vsc_cell)mesh->kinds[e];
    if (law == VSC_LAW_PAPER)
      count += kind == VSC_HEX ? 6 + 8 : 6;
    else
      count += 6 * (size_t)vsc_cell_rule_of(kind).points;
  }
  return count;
}

// Processor seconds of a step on one thread: the least of many timings.
static vsc_status time_step(const vsc_mesh *mesh, const vsc_axes *axes, const row *row,
                            double *seconds, vsc_error *error)
{
  vsc_material_def material = tissue(row->law);
  vsc_definition definition = vsc_default_definition();
  definition.materials = &material;
  definition.material_count = 1;
  definition.volume = row->averaged ? VSC_VOLUME_NODAL : VSC_VOLUME_ELEMENT;
  definition.end_time = 1000;
  vsc_model *model = NULL;
  vsc_state *state = NULL;
  vsc_parallel_set_threads(1);
  vsc_status status = vsc_model_build(mesh, axes, &definition, &model, error);
  if (status == VSC_OK) status = vsc_state_create(model, &state, error);
  if (status == VSC_OK) status = vsc_start(model, state, error);
  *seconds = 1e9;
  for (int k = 0; k < TIMINGS && status == VSC_OK; k++) {
    const double start = vsc_cpu_seconds();
    status = vsc_steps(model, state, state->limit.step, STEPS, error);
    const double passed = (vsc_cpu_seconds() - start) / STEPS;
    if (passed < *seconds) *seconds = passed;
  }
  vsc_state_free(state);
  vsc_model_free(model);
  return status;
}

static vsc_status bench_mesh(const vsc_mesh *mesh, const char *what, vsc_error *error)
{
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  if (axes == NULL) return vsc_fail_memory(error, "the bench");
  for (size_t e = 0; e < mesh->element_count; e++)
    axes->known[e] = vsc_axes_complete((double[3]){0, 0, 1}, NULL, &axes->frames[9 * e]) != 0;
  vsc_status status = VSC_OK;
  double seconds[ROWS] = {0};
  for (int k = 0; k < ROWS && status == VSC_OK; k++) {
    if (rows[k].averaged && mesh->kinds[0] != VSC_TET) continue;
    status = time_step(mesh, axes, &rows[k], &seconds[k], error);
    if (status != VSC_OK) break;
    printf("\"%zu masses, %zu %s\",\"%s\",%zu,%.4f,%.2f\n", mesh->node_count, mesh->element_count, what,
           rows[k].name, springs_of(mesh, rows[k].law), 1e5 * seconds[k], seconds[k] / seconds[0]);
  }
  vsc_axes_free(axes);
  return status;
}

vsc_status vsc_bench_paper(vsc_error *error)
{
  const vsc_cloud_shape cloud = {.size = {10, 10, 10}, .points = 222, .seed = 29};
  vsc_block_shape block = vsc_block_default();
  vsc_mesh *tets = NULL, *hexes = NULL;
  for (int a = 0; a < 3; a++) block.cells[a] = 5;
  vsc_status status = vsc_cloud_mesh(&cloud, &tets, error);
  if (status == VSC_OK) status = vsc_block_of(&block, VSC_BLOCK_HEXES, &hexes, error);
  puts("mesh,springs,number,milliseconds of processor time for 100 steps,over classical");
  if (status == VSC_OK) status = bench_mesh(tets, "tetrahedra", error);
  if (status == VSC_OK) status = bench_mesh(hexes, "hexahedra", error);
  vsc_mesh_free(tets);
  vsc_mesh_free(hexes);
  return status;
}
