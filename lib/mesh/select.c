// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/select.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/split.h"
#include "mesh/topology.h"

void vsc_node_set_free(vsc_node_set *set)
{
  vsc_free(set->nodes);
  *set = (vsc_node_set){0};
}

void vsc_surface_free(vsc_surface *surface)
{
  vsc_free(surface->triangles);
  vsc_free(surface->mid);
  vsc_free(surface->paired);
  *surface = (vsc_surface){0};
}

static void add_face(vsc_surface *surface, const vsc_cell_kind *kind, const int face[4],
                     const uint32_t *corner)
{
  uint32_t cut[2][3];
  const int count = vsc_face_cut(corner, face, cut);
  for (int i = 0; i < 3 && surface->mid != NULL; i++)
    surface->mid[3 * surface->count + (size_t)i] =
        corner[vsc_cell_middle(kind, face[i], face[(i + 1) % 3])];
  if (count == 2) surface->paired[surface->count] = 1;
  memcpy(surface->triangles + 3 * surface->count, cut, (size_t)count * sizeof *cut);
  surface->count += (size_t)count;
}

// A surface's triangles as they are.
static vsc_status copy_triangles(const vsc_mesh *mesh, vsc_surface *boundary, vsc_error *error)
{
  if (!VSC_NEW(boundary->triangles, 3 * mesh->triangle_count))
    return vsc_fail_memory(error, "the mesh's boundary");
  boundary->count = mesh->triangle_count;
  memcpy(boundary->triangles, mesh->triangles,
         3 * mesh->triangle_count * sizeof *boundary->triangles);
  return VSC_OK;
}

// The triangles of all open faces, in the order of the elements.
static vsc_status list_open(const vsc_mesh *mesh, const uint8_t *open, vsc_surface *boundary, vsc_error *error)
{
  size_t count = 0, pairs = 0;
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int i = 0; open[e] >> i != 0; i++) {
      if (!(open[e] >> i & 1)) continue;
      const size_t paired = vsc_mesh_kind(mesh, e)->faces[i][3] >= 0;
      count += 1 + paired;
      pairs += paired;
    }
  if (!VSC_NEW(boundary->triangles, 3 * count) ||
      (vsc_mesh_is_quadratic(mesh) && !VSC_NEW(boundary->mid, 3 * count)) ||
      (pairs > 0 && !VSC_NEW(boundary->paired, count))) {
    vsc_surface_free(boundary);
    return vsc_fail_memory(error, "the mesh's boundary");
  }
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int i = 0; open[e] >> i != 0; i++)
      if (open[e] >> i & 1)
        add_face(boundary, vsc_mesh_kind(mesh, e), vsc_mesh_kind(mesh, e)->faces[i], vsc_mesh_corners(mesh, e));
  return VSC_OK;
}

vsc_status vsc_boundary(const vsc_mesh *mesh, vsc_surface *boundary, vsc_error *error)
{
  *boundary = (vsc_surface){.name = "boundary"};
  if (mesh->element_count == 0) return copy_triangles(mesh, boundary, error);
  uint8_t *open;
  if (!VSC_NEW(open, mesh->element_count)) return vsc_fail_memory(error, "the mesh's boundary");
  vsc_status status = vsc_open_faces(mesh, open, error);
  if (status == VSC_OK) status = list_open(mesh, open, boundary, error);
  vsc_free(open);
  return status;
}

static vsc_status find_array(const vsc_arrays *arrays, const char *kind,
                             const vsc_selector *selector, const vsc_array **array,
                             vsc_error *error)
{
  *array = vsc_arrays_find(arrays, selector->array);
  if (*array == NULL) {
    char hint[384];
    vsc_arrays_hint(arrays, selector->array, hint, sizeof hint);
    return vsc_fail(error, VSC_INPUT, "%s: %s_array: the mesh has no %s array '%s'%s", selector->name, kind,
                    kind, selector->array, hint);
  }
  if ((*array)->components != 1)
    return vsc_fail(error, VSC_INPUT,
                    "%s: %s array %s has %d components, a selection by value needs 1: name another "
                    "array",
                    selector->name, kind, selector->array, (*array)->components);
  return VSC_OK;
}

// A bound as the numbers of the array are.
static double rounded(const vsc_array *array, double bound)
{
  return array->single && fabs(bound) <= FLT_MAX ? (double)(float)bound : bound;
}

bool vsc_selector_takes(const vsc_selector *selector, const vsc_array *array, double value)
{
  return value >= rounded(array, selector->low) && value <= rounded(array, selector->high);
}

// Nodes that vsc_mesh_raise put in the middle of edges have no value of their own, but a mean: they are taken
// where both ends of their edge are.
static void mark_middles(const vsc_mesh *mesh, uint8_t *marked)
{
  for (size_t e = 0; e < mesh->element_count; e++) {
    const vsc_cell_kind *kind = vsc_mesh_kind(mesh, e);
    const uint32_t *corner = vsc_mesh_corners(mesh, e);
    for (int k = 0; k < kind->edge_count; k++) {
      const uint32_t middle = corner[kind->vertices + k];
      if (mesh->node_source[middle] < mesh->report.file_nodes) continue;
      marked[middle] = marked[corner[kind->edges[k][0]]] && marked[corner[kind->edges[k][1]]];
    }
  }
}

static vsc_status mark_node_array(const vsc_mesh *mesh, const vsc_selector *selector,
                                  uint8_t *marked, vsc_error *error)
{
  const vsc_array *array;
  const vsc_status status = find_array(&mesh->node_data, "node", selector, &array, error);
  if (status != VSC_OK) return status;
  for (size_t i = 0; i < mesh->node_count; i++) marked[i] = vsc_selector_takes(selector, array, array->values[i]);
  if (vsc_mesh_is_quadratic(mesh)) mark_middles(mesh, marked);
  return VSC_OK;
}

static vsc_status mark_triangle_array(const vsc_mesh *mesh, const vsc_selector *selector,
                                      uint8_t *marked, vsc_error *error)
{
  if (mesh->triangle_count == 0)
    return vsc_fail(error, VSC_INPUT,
                    "%s: the mesh file holds no triangles on its elements: select by a node "
                    "array, a box or a plane",
                    selector->name);
  const vsc_array *array;
  const vsc_status status = find_array(&mesh->triangle_data, "triangle", selector, &array, error);
  if (status != VSC_OK) return status;
  for (size_t t = 0; t < mesh->triangle_count; t++)
    if (vsc_selector_takes(selector, array, array->values[t]))
      for (int i = 0; i < 3; i++) {
        marked[mesh->triangles[3 * t + i]] = 1;
        if (mesh->triangle_mid != NULL) marked[mesh->triangle_mid[3 * t + i]] = 1;
      }
  return VSC_OK;
}

static vsc_status mark_box(const vsc_mesh *mesh, const vsc_selector *selector, uint8_t *marked)
{
  for (size_t i = 0; i < mesh->node_count; i++) {
    marked[i] = 1;
    for (int axis = 0; axis < 3; axis++) {
      const double x = mesh->nodes[3 * i + axis];
      if (!(x >= selector->box_low[axis] && x <= selector->box_high[axis])) marked[i] = 0;
    }
  }
  return VSC_OK;
}

// Distance of a node from the selector's plane, mm.
static double plane_distance(const vsc_mesh *mesh, const vsc_selector *selector, size_t node)
{
  double normal[3], from[3];
  memcpy(normal, selector->normal, sizeof normal);
  vsc_normalize(normal);
  vsc_subtract(mesh->nodes + 3 * node, selector->point, from);
  return fabs(vsc_dot(from, normal));
}

static vsc_status mark_plane(const vsc_mesh *mesh, const vsc_selector *selector, uint8_t *marked,
                             vsc_error *error)
{
  const double length = vsc_norm(selector->normal);
  if (!(length > 0) || !isfinite(length))
    return vsc_fail(error, VSC_INPUT,
                    "%s: normal (%g %g %g) gives the plane no direction: use for example (0 0 1)",
                    selector->name, selector->normal[0], selector->normal[1], selector->normal[2]);
  for (size_t i = 0; i < mesh->node_count; i++)
    marked[i] = plane_distance(mesh, selector, i) <= selector->tolerance;
  return VSC_OK;
}

static void mark_triangles(const vsc_surface *surface, uint8_t *marked)
{
  for (size_t i = 0; i < 3 * surface->count; i++) marked[surface->triangles[i]] = 1;
  for (size_t i = 0; i < 3 * surface->count && surface->mid != NULL; i++)
    marked[surface->mid[i]] = 1;
}

static vsc_status mark_surface(const vsc_selector *selector, const vsc_surface *surfaces,
                               size_t surface_count, uint8_t *marked, vsc_error *error)
{
  const char *near = NULL;
  for (size_t i = 0; i < surface_count; i++) {
    if (strcmp(surfaces[i].name, selector->array) == 0) {
      mark_triangles(&surfaces[i], marked);
      return VSC_OK;
    }
    const char *both[2] = {surfaces[i].name, near};
    near = vsc_nearest(selector->array, both, near == NULL ? 1 : 2);
  }
  return vsc_fail(error, VSC_INPUT, "%s: there is no surface %s among the %zu surfaces%s%s%s",
                  selector->name, selector->array, surface_count,
                  near != NULL ? ": did you mean " : "", near != NULL ? near : "",
                  near != NULL ? "?" : ": define it under surfaces");
}

static vsc_status mark_boundary(const vsc_mesh *mesh, uint8_t *marked, vsc_error *error)
{
  vsc_surface boundary;
  const vsc_status status = vsc_boundary(mesh, &boundary, error);
  if (status != VSC_OK) return status;
  mark_triangles(&boundary, marked);
  vsc_surface_free(&boundary);
  return VSC_OK;
}

static vsc_status mark_nodes(const vsc_mesh *mesh, const vsc_selector *selector,
                             const vsc_surface *surfaces, size_t surface_count, uint8_t *marked,
                             vsc_error *error)
{
  switch (selector->kind) {
  case VSC_SELECT_BOUNDARY: return mark_boundary(mesh, marked, error);
  case VSC_SELECT_NODE_ARRAY: return mark_node_array(mesh, selector, marked, error);
  case VSC_SELECT_TRIANGLE_ARRAY: return mark_triangle_array(mesh, selector, marked, error);
  case VSC_SELECT_BOX: return mark_box(mesh, selector, marked);
  case VSC_SELECT_PLANE: return mark_plane(mesh, selector, marked, error);
  case VSC_SELECT_SURFACE:
    return mark_surface(selector, surfaces, surface_count, marked, error);
  }
  return vsc_fail(error, VSC_INPUT, "%s: kind of selection %d is unknown; take one of vsc_select_kind",
                  selector->name, (int)selector->kind);
}

static vsc_status fail_no_value(const vsc_arrays *arrays, const vsc_selector *selector,
                                vsc_error *error)
{
  const vsc_array *array = vsc_arrays_find(arrays, selector->array);
  double low = INFINITY, high = -INFINITY;
  for (size_t i = 0; i < array->tuples; i++) {
    low = fmin(low, array->values[i]);
    high = fmax(high, array->values[i]);
  }
  return vsc_fail(error, VSC_INPUT,
                  "%s: no value of array %s lies in [%.9g, %.9g]: the array runs from %.9g to %.9g",
                  selector->name, selector->array, selector->low, selector->high, low, high);
}

// An empty set: says what was near.
static vsc_status fail_empty(const vsc_mesh *mesh, const vsc_selector *selector, vsc_error *error)
{
  double low[3], high[3], nearest = INFINITY;
  switch (selector->kind) {
  case VSC_SELECT_NODE_ARRAY: return fail_no_value(&mesh->node_data, selector, error);
  case VSC_SELECT_TRIANGLE_ARRAY: return fail_no_value(&mesh->triangle_data, selector, error);
  case VSC_SELECT_BOX:
    vsc_mesh_box(mesh, low, high);
    return vsc_fail(error, VSC_INPUT,
                    "%s: no node lies in the box (%g %g %g) to (%g %g %g) mm: the mesh reaches "
                    "from (%g %g %g) to (%g %g %g) mm",
                    selector->name, selector->box_low[0], selector->box_low[1],
                    selector->box_low[2], selector->box_high[0], selector->box_high[1],
                    selector->box_high[2], low[0], low[1], low[2], high[0], high[1], high[2]);
  case VSC_SELECT_PLANE:
    for (size_t i = 0; i < mesh->node_count; i++)
      nearest = fmin(nearest, plane_distance(mesh, selector, i));
    return vsc_fail(error, VSC_INPUT,
                    "%s: no node lies within %g mm of the plane: the nearest one is %g mm away",
                    selector->name, selector->tolerance, nearest);
  default:
    return vsc_fail(error, VSC_INPUT, "%s: holds no nodes: define it otherwise", selector->name);
  }
}

vsc_status vsc_select_nodes(const vsc_mesh *mesh, const vsc_selector *selector,
                            const vsc_surface *surfaces, size_t surface_count, vsc_node_set *set,
                            vsc_error *error)
{
  *set = (vsc_node_set){0};
  vsc_copy_name(set->name, selector->name);
  uint8_t *marked;
  if (!VSC_NEW(marked, mesh->node_count)) return vsc_fail_memory(error, "a node set");
  vsc_status status = mark_nodes(mesh, selector, surfaces, surface_count, marked, error);
  size_t count = 0;
  for (size_t i = 0; i < mesh->node_count; i++) count += marked[i];
  if (status == VSC_OK && count == 0) status = fail_empty(mesh, selector, error);
  if (status == VSC_OK && !VSC_NEW(set->nodes, count))
    status = vsc_fail_memory(error, "a node set");
  if (status == VSC_OK)
    for (size_t i = 0; i < mesh->node_count; i++)
      if (marked[i]) set->nodes[set->count++] = (uint32_t)i;
  vsc_free(marked);
  return status;
}
