// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mesh.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"

vsc_mesh *vsc_mesh_create(size_t nodes, size_t tets, size_t triangles)
{
  vsc_mesh *mesh;
  if (!VSC_NEW(mesh, 1)) return NULL;
  mesh->node_count = nodes;
  mesh->tet_count = tets;
  mesh->triangle_count = triangles;
  if (nodes > UINT32_MAX || tets > INT32_MAX || !VSC_NEW(mesh->nodes, 3 * nodes) ||
      !VSC_NEW(mesh->tets, 4 * tets) || !VSC_NEW(mesh->triangles, 3 * triangles) ||
      !VSC_NEW(mesh->node_source, nodes) || !VSC_NEW(mesh->tet_source, tets)) {
    vsc_mesh_free(mesh);
    return NULL;
  }
  for (size_t i = 0; i < nodes; i++) mesh->node_source[i] = (uint32_t)i;
  for (size_t i = 0; i < tets; i++) mesh->tet_source[i] = (uint32_t)i;
  return mesh;
}

void vsc_mesh_free(vsc_mesh *mesh)
{
  if (mesh == NULL) return;
  vsc_free(mesh->nodes);
  vsc_free(mesh->tets);
  vsc_free(mesh->triangles);
  vsc_free(mesh->node_source);
  vsc_free(mesh->tet_source);
  vsc_arrays_free(&mesh->node_data);
  vsc_arrays_free(&mesh->tet_data);
  vsc_arrays_free(&mesh->triangle_data);
  vsc_free(mesh);
}

void vsc_arrays_free(vsc_arrays *arrays)
{
  for (size_t i = 0; i < arrays->count; i++) vsc_free(arrays->items[i].values);
  vsc_free(arrays->items);
  *arrays = (vsc_arrays){0};
}

vsc_array *vsc_arrays_add(vsc_arrays *arrays, const char *name, int components, size_t tuples)
{
  vsc_array array = {.components = components, .tuples = tuples};
  if (components < 1 || tuples > SIZE_MAX / (size_t)components) return NULL;
  vsc_copy_name(array.name, name);
  if (!VSC_NEW(array.values, tuples * (size_t)components)) return NULL;
  void *items = arrays->items;
  if (!vsc_grow(&items, arrays->count, arrays->count + 1, sizeof array)) {
    vsc_free(array.values);
    return NULL;
  }
  arrays->items = items;
  arrays->items[arrays->count] = array;
  return &arrays->items[arrays->count++];
}

const vsc_array *vsc_arrays_find(const vsc_arrays *arrays, const char *name)
{
  for (size_t i = 0; i < arrays->count; i++)
    if (strcmp(arrays->items[i].name, name) == 0) return &arrays->items[i];
  return NULL;
}

static const char *nearest_array(const vsc_arrays *arrays, const char *name)
{
  const char *nearest = NULL;
  size_t least = 0;
  for (size_t i = 0; i < arrays->count; i++) {
    const char *candidate = arrays->items[i].name;
    if (vsc_nearest(name, &candidate, 1) == NULL) continue;
    const size_t distance = vsc_edit_distance(name, candidate);
    if (nearest != NULL && distance >= least) continue;
    nearest = candidate;
    least = distance;
  }
  return nearest;
}

void vsc_arrays_hint(const vsc_arrays *arrays, const char *name, char *text, size_t size)
{
  if (size == 0) return;
  if (arrays->count == 0) {
    snprintf(text, size, ", there are no arrays of that kind");
    return;
  }
  char ending[VSC_NAME + 24] = "";
  const char *nearest = nearest_array(arrays, name);
  if (nearest != NULL) snprintf(ending, sizeof ending, "; did you mean %s?", nearest);

  size_t used = (size_t)snprintf(text, size, ", known arrays");
  for (size_t i = 0; i < arrays->count && used < size; i++) {
    const char *known = arrays->items[i].name;
    const bool room = used + strlen(known) + strlen(", , ...") + strlen(ending) < size;
    used += (size_t)snprintf(text + used, size - used, "%s%s", i == 0 ? ": " : ", ",
                             room ? known : "...");
    if (!room) break;
  }
  if (used < size) snprintf(text + used, size - used, "%s", ending);
}

vsc_status vsc_mesh_from_arrays(size_t node_count, const double *nodes, size_t tet_count,
                                const uint32_t *tets, vsc_mesh **mesh, vsc_error *error)
{
  vsc_mesh *made = vsc_mesh_create(node_count, tet_count, 0);
  if (made == NULL) return vsc_fail_memory(error, "the mesh");
  if (node_count > 0) memcpy(made->nodes, nodes, 3 * node_count * sizeof *nodes);
  if (tet_count > 0) memcpy(made->tets, tets, 4 * tet_count * sizeof *tets);
  const vsc_status status = vsc_mesh_clean(made, "mesh arrays", error);
  if (status != VSC_OK) {
    vsc_mesh_free(made);
    return status;
  }
  *mesh = made;
  return VSC_OK;
}

double vsc_mesh_tet_volume(const vsc_mesh *mesh, size_t tet)
{
  const uint32_t *corner = mesh->tets + 4 * tet;
  return vsc_tet_volume(mesh->nodes + 3 * (size_t)corner[0], mesh->nodes + 3 * (size_t)corner[1],
                        mesh->nodes + 3 * (size_t)corner[2], mesh->nodes + 3 * (size_t)corner[3]);
}

void vsc_mesh_tet_centre(const vsc_mesh *mesh, size_t tet, double centre[3])
{
  const uint32_t *corner = mesh->tets + 4 * tet;
  for (int axis = 0; axis < 3; axis++) {
    double sum = 0;
    for (int i = 0; i < 4; i++) sum += mesh->nodes[3 * (size_t)corner[i] + axis];
    centre[axis] = sum / 4;
  }
}

void vsc_mesh_box(const vsc_mesh *mesh, double low[3], double high[3])
{
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = mesh->node_count > 0 ? mesh->nodes[axis] : 0;
    high[axis] = low[axis];
  }
  for (size_t i = 0; i < mesh->node_count; i++)
    for (int axis = 0; axis < 3; axis++) {
      low[axis] = fmin(low[axis], mesh->nodes[3 * i + axis]);
      high[axis] = fmax(high[axis], mesh->nodes[3 * i + axis]);
    }
}
