// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mesh.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/jacobian.h"

vsc_mesh *vsc_mesh_create_cells(size_t nodes, size_t elements, const uint8_t *kinds,
                                size_t triangles)
{
  vsc_mesh *mesh;
  if (nodes > UINT32_MAX || elements > INT32_MAX || !VSC_NEW(mesh, 1)) return NULL;
  mesh->node_count = nodes;
  mesh->element_count = elements;
  mesh->triangle_count = triangles;
  size_t corners = 0;
  for (size_t e = 0; e < elements; e++) corners += (size_t)vsc_cells[kinds ? kinds[e] : 0].corners;
  if (!VSC_NEW(mesh->nodes, 3 * nodes) || !VSC_NEW(mesh->kinds, elements) ||
      !VSC_NEW(mesh->start, elements + 1) || !VSC_NEW(mesh->corners, corners) ||
      !VSC_NEW(mesh->triangles, 3 * triangles) || !VSC_NEW(mesh->node_source, nodes) ||
      !VSC_NEW(mesh->element_source, elements)) {
    vsc_mesh_free(mesh);
    return NULL;
  }
  for (size_t i = 0; i < nodes; i++) mesh->node_source[i] = (uint32_t)i;
  for (size_t e = 0; e < elements; e++) {
    mesh->kinds[e] = kinds ? kinds[e] : VSC_TET;
    mesh->start[e + 1] = mesh->start[e] + (size_t)vsc_cells[mesh->kinds[e]].corners;
    mesh->element_source[e] = (uint32_t)e;
  }
  return mesh;
}

vsc_mesh *vsc_mesh_create(size_t nodes, size_t tets, size_t triangles)
{
  return vsc_mesh_create_cells(nodes, tets, NULL, triangles);
}

void vsc_mesh_free(vsc_mesh *mesh)
{
  if (mesh == NULL) return;
  vsc_free(mesh->nodes);
  vsc_free(mesh->kinds);
  vsc_free(mesh->start);
  vsc_free(mesh->corners);
  vsc_free(mesh->triangles);
  vsc_free(mesh->triangle_mid);
  vsc_free(mesh->node_source);
  vsc_free(mesh->element_source);
  vsc_arrays_free(&mesh->node_data);
  vsc_arrays_free(&mesh->element_data);
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
  for (size_t i = 0; i < arrays->count; i++) {
    const char *const two[2] = {nearest != NULL ? nearest : arrays->items[i].name, arrays->items[i].name};
    nearest = vsc_nearest(name, two, 2);
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

vsc_status vsc_mesh_from_arrays(size_t node_count, const double *nodes, size_t element_count,
                                const uint32_t *tets, vsc_mesh **mesh, vsc_error *error)
{
  vsc_mesh *made = vsc_mesh_create(node_count, element_count, 0);
  if (made == NULL) return vsc_fail_memory(error, "the mesh");
  if (node_count > 0) memcpy(made->nodes, nodes, 3 * node_count * sizeof *nodes);
  if (element_count > 0) memcpy(made->corners, tets, 4 * element_count * sizeof *tets);
  const vsc_status status = vsc_mesh_clean(made, "mesh arrays", error);
  if (status != VSC_OK) {
    vsc_mesh_free(made);
    return status;
  }
  *mesh = made;
  return VSC_OK;
}

const char *vsc_spell_kinds(const size_t counts[VSC_CELLS], char *text, size_t size)
{
  size_t used = 0;
  snprintf(text, size, "no elements");
  for (int k = 0; k < VSC_CELLS; k++) {
    if (counts[k] == 0 || used >= size) continue;
    used += (size_t)snprintf(text + used, size - used, "%s%zu %s", used == 0 ? "" : ", ", counts[k],
                             counts[k] == 1 ? vsc_cells[k].name : vsc_cells[k].plural);
  }
  return text;
}

const char *vsc_mesh_kinds_text(const vsc_mesh *mesh, char *text, size_t size)
{
  size_t counts[VSC_CELLS] = {0};
  for (size_t e = 0; e < mesh->element_count; e++) counts[mesh->kinds[e]]++;
  return vsc_spell_kinds(counts, text, size);
}

// (a x b) . c of three corners relative to the first node of the element
static double flux(const double *at[VSC_MOST_CORNERS], int i, int j, int k)
{
  return 6 * vsc_tet_volume(at[0], at[i], at[j], at[k]);
}

VSC_CLONED void vsc_mesh_jacobians(const vsc_mesh *mesh, size_t element, const vsc_cell_rule *rule,
                                   double det[VSC_MOST_POINTS])
{
  const int corners = vsc_mesh_kind(mesh, element)->corners;
  vsc_four x[VSC_MOST_CORNERS];
  double J[3][4], normal[3];
  vsc_cell_places(mesh->nodes, vsc_mesh_corners(mesh, element), corners, x);
  for (int q = 0; q < rule->points; q++) {
    vsc_cell_jacobian(rule, q, corners, x, J);
    vsc_cross(J[0], J[1], normal);
    det[q] = vsc_dot(normal, J[2]);
  }
}

static double sum_of_points(const vsc_mesh *mesh, size_t element, const vsc_cell_rule *rule)
{
  double volume = 0, det[VSC_MOST_POINTS];
  vsc_mesh_jacobians(mesh, element, rule, det);
  for (int q = 0; q < rule->points; q++) volume += rule->weight[q] * det[q];
  return volume;
}

double vsc_mesh_volume_by(const vsc_mesh *mesh, size_t element, const vsc_cell_rule *rule)
{
  if (mesh->kinds[element] == VSC_TET10) return sum_of_points(mesh, element, rule);
  const vsc_cell_kind *kind = vsc_mesh_kind(mesh, element);
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  const double *at[VSC_MOST_CORNERS];
  for (int i = 0; i < kind->corners; i++) at[i] = mesh->nodes + 3 * (size_t)corner[i];
  if (kind->corners == 4) return vsc_tet_volume(at[0], at[1], at[2], at[3]);
  double volume = 0;
  for (int f = 0; f < kind->face_count; f++) {
    const int *v = kind->faces[f];
    if (v[3] < 0)
      volume += flux(at, v[0], v[1], v[2]);
    else
      volume += 0.5 * (flux(at, v[0], v[1], v[2]) + flux(at, v[0], v[2], v[3]) +
                       flux(at, v[0], v[1], v[3]) + flux(at, v[1], v[2], v[3]));
  }
  return volume / 6;
}

double vsc_mesh_element_volume(const vsc_mesh *mesh, size_t element)
{
  if (mesh->kinds[element] != VSC_TET10) return vsc_mesh_volume_by(mesh, element, NULL);
  const vsc_cell_rule rule = vsc_cell_rule_of(VSC_TET10);
  return vsc_mesh_volume_by(mesh, element, &rule);
}

double vsc_mesh_element_size(const vsc_mesh *mesh)
{
  const vsc_cell_rule rule = vsc_cell_rule_of(VSC_TET10);
  double volume = 0;
  for (size_t e = 0; e < mesh->element_count; e++) volume += vsc_mesh_volume_by(mesh, e, &rule);
  return cbrt(volume / (double)mesh->element_count);
}

void vsc_mesh_element_centre(const vsc_mesh *mesh, size_t element, double centre[3])
{
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  const int corners = vsc_mesh_kind(mesh, element)->vertices;
  for (int axis = 0; axis < 3; axis++) {
    double sum = 0;
    for (int i = 0; i < corners; i++) sum += mesh->nodes[3 * (size_t)corner[i] + axis];
    centre[axis] = sum / corners;
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
