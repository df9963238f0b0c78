// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes that are to be kept: which triangles enclose them.
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "model/terms.h"

// Counts, then fills: with triangles NULL nothing is stored.
typedef struct lister {
  vsc_kept_volumes *kept;
  size_t count;
} lister;

static void add_triangle(lister *list, double weight, const uint32_t *number, uint32_t a, uint32_t b,
                         uint32_t c)
{
  const size_t k = list->count++;
  if (list->kept->triangles == NULL) return;
  uint32_t *corner = list->kept->triangles + 3 * k;
  corner[0] = number[a];
  corner[1] = number[b];
  corner[2] = number[c];
  list->kept->weights[k] = weight;
}

// A face of an element: one triangle, or four of half weight, the mean of its two cuts.
static void add_face(lister *list, const vsc_mesh *mesh, size_t element, int face, double weight,
                     const uint32_t *number)
{
  const int *v = vsc_mesh_kind(mesh, element)->faces[face];
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  if (v[3] < 0) {
    add_triangle(list, weight, number, corner[v[0]], corner[v[1]], corner[v[2]]);
    return;
  }
  static const int cuts[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};
  for (int t = 0; t < 4; t++)
    add_triangle(list, 0.5 * weight, number, corner[v[cuts[t][0]]], corner[v[cuts[t][1]]],
                 corner[v[cuts[t][2]]]);
}

// Volume k of the body, of material k, of node k's share, or of element k; inner faces, which two
// elements of the same volume share, are left out.
static void list_volume(lister *list, const vsc_mesh *mesh, const vsc_topology *topology,
                        const uint32_t *material_of, vsc_kept_volume kind, size_t k,
                        const uint32_t *number)
{
  if (kind == VSC_KEEP_NODE) {
    for (size_t i = topology->node_start[k]; i < topology->node_start[k + 1]; i++) {
      const size_t e = topology->node_elements[i];
      const vsc_cell_kind *cell = vsc_mesh_kind(mesh, e);
      for (int f = 0; f < cell->face_count; f++)
        add_face(list, mesh, e, f, 1.0 / cell->corners, number);
    }
    return;
  }
  const size_t first = kind == VSC_KEEP_ELEMENT ? k : 0;
  const size_t end = kind == VSC_KEEP_ELEMENT ? k + 1 : mesh->element_count;
  for (size_t e = first; e < end; e++) {
    if (kind == VSC_KEEP_REGION && material_of[e] != k) continue;
    for (int f = 0; f < vsc_mesh_kind(mesh, e)->face_count; f++) {
      const int32_t other = topology->neighbours[e][f];
      const bool inner = other >= 0 && (kind == VSC_KEEP_TOTAL ||
                                        (kind == VSC_KEEP_REGION && material_of[other] == k));
      if (!inner) add_face(list, mesh, e, f, 1, number);
    }
  }
}

// Whether any node of the volume's triangles can move.
static bool can_change(const vsc_model *model, size_t first, size_t end)
{
  for (size_t i = 3 * first; i < 3 * end; i++) {
    const double *inverse = model->inverse_mass + 4 * (size_t)model->kept.triangles[i];
    if (inverse[0] > 0 || inverse[1] > 0 || inverse[2] > 0) return true;
  }
  return false;
}

static size_t list_all(const vsc_mesh *mesh, const vsc_topology *topology,
                       const uint32_t *material_of, vsc_kept_volume kind, size_t volumes,
                       const uint32_t *number, vsc_model *model)
{
  lister list = {&model->kept, 0};
  size_t kept = 0;
  for (size_t k = 0; k < volumes; k++) {
    const size_t first = list.count;
    list_volume(&list, mesh, topology, material_of, kind, k, number);
    if (list.count == first) continue;  // no element
    if (model->kept.triangles != NULL && !can_change(model, first, list.count)) {
      list.count = first;
      continue;
    }
    if (model->kept.start != NULL) {
      model->kept.start[kept + 1] = list.count;
      model->kept.source[kept] = (uint32_t)k;
    }
    kept++;
  }
  model->kept.count = kept;
  return list.count;
}

double vsc_kept_volume_of(const vsc_model *model, size_t k, const double *x)
{
  const vsc_kept_volumes *kept = &model->kept;
  const double *origin = x + 4 * (size_t)kept->triangles[3 * kept->start[k]];
  double volume = 0;
  for (size_t t = kept->start[k]; t < kept->start[k + 1]; t++) {
    const uint32_t *node = kept->triangles + 3 * t;
    volume += kept->weights[t] * vsc_tet_volume(origin, x + 4 * (size_t)node[0],
                                                x + 4 * (size_t)node[1], x + 4 * (size_t)node[2]);
  }
  return volume;
}

void vsc_kept_triangle(const vsc_model *model, size_t k, size_t t, const double *x, double at[3][3], double gradient[3][3])
{
  const vsc_kept_volumes *kept = &model->kept;
  const double *origin = x + 4 * (size_t)kept->triangles[3 * kept->start[k]];
  for (size_t c = 0; c < 3; c++) vsc_subtract(x + 4 * (size_t)kept->triangles[3 * t + c], origin, at[c]);
  for (size_t c = 0; c < 3 && gradient != NULL; c++) {
    double across[3];
    vsc_cross(at[(c + 1) % 3], at[(c + 2) % 3], across);
    for (int i = 0; i < 3; i++) gradient[c][i] = kept->weights[t] * across[i] / 6;
  }
}

static vsc_status check_freedom(const vsc_model *model, vsc_error *error)
{
  size_t freedom = 0;
  for (size_t i = 0; i < 4 * model->node_count; i++) freedom += model->inverse_mass[i] > 0;
  if (model->kept.count == 0 || model->kept.count < freedom) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "keep_volume: %zu volumes cannot be kept by nodes that have %zu ways to move; use "
                  "keep_volume: node, region or total",
                  model->kept.count, freedom);
}

static vsc_status fill(const vsc_mesh *mesh, const vsc_topology *topology, vsc_kept_volume kind,
                       const uint32_t *material_of, const uint32_t *number, vsc_model *model,
                       vsc_error *error)
{
  const size_t volumes = kind == VSC_KEEP_TOTAL    ? 1
                         : kind == VSC_KEEP_REGION ? model->material_count
                         : kind == VSC_KEEP_NODE   ? mesh->node_count
                                                   : mesh->element_count;
  vsc_kept_volumes *kept = &model->kept;
  const size_t triangles = list_all(mesh, topology, material_of, kind, volumes, number, model);
  if (!VSC_NEW(kept->start, kept->count + 1) || !VSC_NEW(kept->source, kept->count) || !VSC_NEW(kept->weights, triangles) ||
      !VSC_NEW(kept->triangles, 3 * triangles))
    return vsc_fail_memory(error, "kept volumes");
  list_all(mesh, topology, material_of, kind, volumes, number, model);
  if (!VSC_NEW(kept->rest, kept->count)) return vsc_fail_memory(error, "kept volumes");
  for (size_t k = 0; k < kept->count; k++) kept->rest[k] = vsc_kept_volume_of(model, k, model->rest);
  return check_freedom(model, error);
}

vsc_status vsc_terms_kept_volumes(const vsc_mesh *mesh, const vsc_definition *definition,
                                  const uint32_t *material_of, vsc_model *model, vsc_error *error)
{
  vsc_topology topology;
  model->kept.kind = definition->kept_volume;
  if (definition->kept_volume == VSC_KEEP_NONE) return VSC_OK;
  if (mesh->element_count == 0)
    return vsc_fail(error, VSC_INPUT,
                    "keep_volume: volumes of elements are kept, and the mesh has none, but triangles: leave it out");
  vsc_status status = vsc_topology_make(mesh, &topology, error);
  if (status != VSC_OK) return status;
  uint32_t *number = vsc_model_node_numbers(model);
  if (number == NULL)
    status = vsc_fail_memory(error, "node numbers");
  else
    status = fill(mesh, &topology, definition->kept_volume, material_of, number, model, error);
  vsc_free(number);
  vsc_topology_free(&topology);
  return status;
}
