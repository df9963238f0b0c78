// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compare_pair.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "io/vtk_probe.h"
#include "model/masses.h"

#define SAME_PLACE 1e-6  // part of a body's size

// Elements of the same kinds on the same points.
static bool same_corners(const vsc_mesh *a, const vsc_mesh *b)
{
  const size_t elements = a->element_count;
  return a->node_count == b->node_count && elements == b->element_count &&
         memcmp(a->kinds, b->kinds, elements * sizeof *a->kinds) == 0 &&
         memcmp(a->corners, b->corners, a->start[elements] * sizeof *a->corners) == 0;
}

static double body_size(const vsc_mesh *mesh)
{
  double low[3], high[3], size[3];
  vsc_mesh_box(mesh, low, high);
  vsc_subtract(high, low, size);
  return vsc_norm(size);
}

static bool same_nodes(const vsc_mesh *a, const vsc_mesh *b, double apart)
{
  if (a->node_count != b->node_count) return false;
  for (size_t i = 0; i < 3 * a->node_count; i++)
    if (fabs(a->nodes[i] - b->nodes[i]) > apart) return false;
  return true;
}

bool vsc_pair_holds(const vsc_pair *pair, const vsc_mesh *a, const vsc_mesh *b)
{
  return pair->a != NULL && same_corners(pair->a, a) && same_nodes(pair->a, a, 0) &&
         same_corners(pair->b, b) && same_nodes(pair->b, b, 0);
}

static vsc_status measure_volumes(vsc_pair *pair, vsc_error *error)
{
  const vsc_mesh *a = pair->a;
  if (!VSC_NEW(pair->node_volumes, a->node_count) ||
      !VSC_NEW(pair->element_volumes, a->element_count))
    return vsc_fail_memory(error, "volumes");
  vsc_cell_rule rules[VSC_CELLS];
  for (int kind = 0; kind < VSC_CELLS; kind++) rules[kind] = vsc_cell_rule_of((vsc_cell)kind);
  for (size_t e = 0; e < a->element_count; e++) {
    double parts[VSC_MOST_CORNERS];
    vsc_lumped_volumes(a, &rules[a->kinds[e]], e, parts);
    pair->element_volumes[e] = vsc_mesh_element_volume(a, e);
    for (int i = 0; i < vsc_mesh_kind(a, e)->corners; i++)
      pair->node_volumes[vsc_mesh_corners(a, e)[i]] += parts[i];
  }
  return VSC_OK;
}

static void count_outside(vsc_pair *pair)
{
  const double inside = SAME_PLACE * body_size(pair->b);
  for (size_t n = 0; n < pair->a->node_count; n++) {
    const double distance = pair->nodes[n].distance;
    if (distance > pair->limit) pair->left_out++;
    else if (distance > inside) pair->outside++;
    if (distance <= pair->furthest) continue;
    pair->furthest = distance;
    memcpy(pair->furthest_at, pair->a->nodes + 3 * n, sizeof pair->furthest_at);
  }
}

static vsc_status find_nodes(vsc_pair *pair, vsc_error *error)
{
  const vsc_mesh *a = pair->a;
  if (!VSC_NEW(pair->nodes, a->node_count)) return vsc_fail_memory(error, "an interpolation");
  const vsc_status status = vsc_vtk_probe(pair->b, a->node_count, a->nodes, pair->nodes, error);
  if (status == VSC_OK) count_outside(pair);
  return status;
}

static vsc_status find_centres(vsc_pair *pair, vsc_error *error)
{
  const vsc_mesh *a = pair->a;
  double *centres;
  if (!VSC_NEW(pair->centres, a->element_count)) return vsc_fail_memory(error, "an interpolation");
  if (!VSC_NEW(centres, 3 * a->element_count)) return vsc_fail_memory(error, "an interpolation");
  for (size_t e = 0; e < a->element_count; e++) vsc_mesh_element_centre(a, e, centres + 3 * e);
  const vsc_status status =
      vsc_vtk_probe(pair->b, a->element_count, centres, pair->centres, error);
  vsc_free(centres);
  return status;
}

// The same connectivity is the same mesh, moved perhaps; the same nodes are compared whatever joins them.
static bool are_same(const vsc_pair *pair)
{
  const vsc_mesh *a = pair->a, *b = pair->b;
  if (pair->interpolate && b->element_count > 0) return false;
  if (a->node_count != b->node_count || a->element_count != b->element_count) return false;
  if (a->element_count == 0 || same_corners(a, b)) return true;
  return same_nodes(a, b, SAME_PLACE * body_size(b));
}

vsc_status vsc_pair_make(vsc_pair *pair, vsc_mesh *a, const char *file_a, vsc_mesh *b,
                         const char *file_b, vsc_error *error)
{
  vsc_pair_free(pair);
  pair->a = a;
  pair->b = b;
  pair->same = are_same(pair);
  if (!pair->same && (a->element_count == 0 || b->element_count == 0))
    return vsc_fail(error, VSC_INPUT,
                    "%s has %zu points and %zu elements, %s has %zu and %zu: results on different "
                    "meshes can be compared where both have elements",
                    file_a, a->node_count, a->element_count, file_b, b->node_count, b->element_count);
  vsc_status status = measure_volumes(pair, error);
  pair->limit = pair->reach > 0 ? pair->reach : 0.5 * vsc_mesh_element_size(b);
  if (status == VSC_OK && !pair->same) status = find_nodes(pair, error);
  if (status == VSC_OK && !(pair->same && same_corners(a, b))) status = find_centres(pair, error);
  return status;
}

void vsc_pair_free(vsc_pair *pair)
{
  vsc_mesh_free(pair->a);
  vsc_mesh_free(pair->b);
  vsc_free(pair->node_volumes);
  vsc_free(pair->element_volumes);
  vsc_free(pair->nodes);
  vsc_free(pair->centres);
  *pair = (vsc_pair){.reach = pair->reach, .interpolate = pair->interpolate};
}
