// SPDX-License-Identifier: GPL-3.0-or-later
// vsc_select_surface: which boundary triangles a selector describes; surfaces less others.
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/sort.h"
#include "mesh/select.h"
#include "mesh/split.h"

// A triangle's nodes, ascending, and its number among its like.
typedef struct corners {
  uint32_t node[3];
  uint32_t number;
} corners;

static corners sorted_corners(const uint32_t triangle[3], size_t number)
{
  corners key = {.number = (uint32_t)number};
  memcpy(key.node, triangle, sizeof key.node);
  for (int last = 2; last > 0; last--)
    for (int i = 0; i < last; i++)
      if (key.node[i] > key.node[i + 1]) {
        const uint32_t larger = key.node[i];
        key.node[i] = key.node[i + 1];
        key.node[i + 1] = larger;
      }
  return key;
}

static int compare_corners(const void *a, const void *b)
{
  const corners *x = a, *y = b;
  for (int i = 0; i < 3; i++)
    if (x->node[i] != y->node[i]) return x->node[i] < y->node[i] ? -1 : 1;
  return 0;
}

// Triangles by their nodes.
typedef struct triangle_list {
  size_t count;
  corners *items;  // count, sorted
} triangle_list;

static bool sort_triangles(triangle_list *list)
{
  return vsc_sort(list->items, list->count, sizeof *list->items / sizeof(uint32_t), 3);
}

// One with these nodes, or NULL.
static const corners *find_triangle(const triangle_list *list, const uint32_t triangle[3])
{
  const corners key = sorted_corners(triangle, 0);
  return bsearch(&key, list->items, list->count, sizeof key, compare_corners);
}

// Lists the triangles of a surface.
static bool list_surface(const vsc_surface *surface, triangle_list *list)
{
  *list = (triangle_list){0};
  if (!VSC_NEW(list->items, surface->count)) return false;
  for (size_t t = 0; t < surface->count; t++) list->items[t] = sorted_corners(surface->triangles + 3 * t, t);
  list->count = surface->count;
  return sort_triangles(list);
}

// Lists the file's triangles with a value that the selector takes.
static bool list_file(const vsc_mesh *mesh, const vsc_selector *selector, triangle_list *list)
{
  const vsc_array *array = vsc_arrays_find(&mesh->triangle_data, selector->array);
  *list = (triangle_list){0};
  if (!VSC_NEW(list->items, mesh->triangle_count)) return false;
  for (size_t t = 0; t < mesh->triangle_count; t++)
    if (vsc_selector_takes(selector, array, array->values[t]))
      list->items[list->count++] = sorted_corners(mesh->triangles + 3 * t, t);
  return sort_triangles(list);
}

// Leaves out of `list` what `other` has.
static void leave_out(triangle_list *list, const triangle_list *other)
{
  size_t left = 0;
  for (size_t k = 0; k < list->count; k++)
    if (find_triangle(other, list->items[k].node) == NULL) list->items[left++] = list->items[k];
  list->count = left;
}

// Marks the two halves of each quadrilateral face of the boundary that `listed` has cut along the other diagonal, and
// adds the triangles that it has there to `taken`, which has room for all of the boundary.
static void mark_other_cuts(const vsc_mesh *mesh, const triangle_list *boundary, const triangle_list *listed,
                            triangle_list *taken, uint8_t *marked)
{
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int f = 0; f < vsc_mesh_kind(mesh, e)->face_count; f++) {
      uint32_t cut[2][3];
      const corners *half[2];
      if (vsc_face_cut(vsc_mesh_corners(mesh, e), vsc_mesh_kind(mesh, e)->faces[f], cut) < 2) continue;
      const uint32_t other[2][3] = {{cut[0][0], cut[0][1], cut[1][2]}, {cut[0][1], cut[0][2], cut[1][2]}};
      if (find_triangle(listed, other[0]) == NULL || find_triangle(listed, other[1]) == NULL) continue;
      for (int i = 0; i < 2; i++) half[i] = find_triangle(boundary, cut[i]);
      for (int i = 0; i < 2 && half[0] != NULL && half[1] != NULL; i++) {
        marked[half[i]->number] = 1;
        taken->items[taken->count++] = sorted_corners(other[i], 0);
      }
    }
}

static vsc_status refuse_listed(const vsc_mesh *mesh, const vsc_selector *selector, const triangle_list *left,
                                size_t all, vsc_error *error)
{
  uint32_t first = left->items[0].number;
  for (size_t k = 1; k < left->count; k++)
    if (left->items[k].number < first) first = left->items[k].number;
  const uint32_t *node = mesh->triangles + 3 * (size_t)first, *source = mesh->node_source;
  return vsc_fail(error, VSC_INPUT,
                  "%s: of the file's %zu triangles with %s from %.9g to %.9g, %zu are no faces of the mesh's boundary, as "
                  "that between points %u, %u, %u: they lie inside the body, or do not fit its elements; give that "
                  "value to faces of the boundary alone, or select by a node array, a box or a plane",
                  selector->name, all, selector->array, selector->low, selector->high, left->count, source[node[0]],
                  source[node[1]], source[node[2]]);
}

// Marks the boundary triangles that the file lists with a value that the selector takes, whichever way it cuts
// quadrilaterals. VSC_INPUT where it lists others.
static vsc_status mark_listed(const vsc_mesh *mesh, const vsc_surface *boundary,
                              const vsc_selector *selector, uint8_t *marked, vsc_error *error)
{
  triangle_list listed = {0}, faces = {0}, taken = {0};
  bool room = list_file(mesh, selector, &listed) && list_surface(boundary, &faces);
  const size_t all = listed.count;
  for (size_t t = 0; t < boundary->count && room; t++)
    marked[t] = find_triangle(&listed, boundary->triangles + 3 * t) != NULL;
  if (room) leave_out(&listed, &faces);
  if (room && listed.count > 0) {
    room = VSC_NEW(taken.items, boundary->count);
    if (room) mark_other_cuts(mesh, &faces, &listed, &taken, marked);
    room = room && sort_triangles(&taken);
    if (room) leave_out(&listed, &taken);
  }
  vsc_status status = room ? VSC_OK : vsc_fail_memory(error, "a surface");
  if (room && listed.count > 0) status = refuse_listed(mesh, selector, &listed, all, error);
  vsc_free(listed.items);
  vsc_free(faces.items);
  vsc_free(taken.items);
  return status;
}

// Marks the boundary triangles whose corners are all in the set.
static vsc_status mark_within(const vsc_mesh *mesh, const vsc_surface *boundary,
                              const vsc_node_set *set, uint8_t *marked, vsc_error *error)
{
  uint8_t *inside;
  if (!VSC_NEW(inside, mesh->node_count)) return vsc_fail_memory(error, "a surface");
  for (size_t i = 0; i < set->count; i++) inside[set->nodes[i]] = 1;
  for (size_t t = 0; t < boundary->count; t++) {
    const uint32_t *node = boundary->triangles + 3 * t;
    marked[t] = inside[node[0]] && inside[node[1]] && inside[node[2]];
  }
  vsc_free(inside);
  return VSC_OK;
}

static vsc_status mark_selected(const vsc_mesh *mesh, const vsc_surface *boundary,
                                const vsc_selector *selector, uint8_t *marked, vsc_error *error)
{
  if (selector->kind == VSC_SELECT_BOUNDARY) {
    memset(marked, 1, boundary->count);
    return VSC_OK;
  }
  if (selector->kind == VSC_SELECT_SURFACE)
    return vsc_fail(error, VSC_INPUT,
                    "%s: a surface cannot be given as another surface (%s): use that one's name",
                    selector->name, selector->array);
  vsc_node_set set;
  vsc_status status = vsc_select_nodes(mesh, selector, NULL, 0, &set, error);
  if (status != VSC_OK) return status;
  status = selector->kind == VSC_SELECT_TRIANGLE_ARRAY
               ? mark_listed(mesh, boundary, selector, marked, error)
               : mark_within(mesh, boundary, &set, marked, error);
  size_t found = 0;
  for (size_t t = 0; t < boundary->count; t++) found += marked[t];
  if (status == VSC_OK && found == 0)
    status = vsc_fail(error, VSC_INPUT,
                      "%s: selects %zu nodes, but no triangle of the mesh's boundary has all three "
                      "corners among them: widen the selection",
                      selector->name, set.count);
  vsc_node_set_free(&set);
  return status;
}

// Copies the marked triangles of a surface. Half a quadrilateral face without the other is a triangle.
static vsc_status copy_marked(const vsc_surface *from, const uint8_t *marked, vsc_surface *to, vsc_error *error)
{
  size_t count = 0;
  for (size_t t = 0; t < from->count; t++) count += marked[t];
  if (!VSC_NEW(to->triangles, 3 * count) || (from->mid != NULL && !VSC_NEW(to->mid, 3 * count)) ||
      (from->paired != NULL && !VSC_NEW(to->paired, count)))
    return vsc_fail_memory(error, "a surface");
  for (size_t t = 0; t < from->count; t++) {
    if (!marked[t]) continue;
    if (from->paired != NULL) to->paired[to->count] = from->paired[t] && marked[t + 1];
    const size_t at = 3 * to->count++;
    memcpy(to->triangles + at, from->triangles + 3 * t, 3 * sizeof *to->triangles);
    if (from->mid != NULL) memcpy(to->mid + at, from->mid + 3 * t, 3 * sizeof *to->mid);
  }
  return VSC_OK;
}

vsc_status vsc_select_surface(const vsc_mesh *mesh, const vsc_surface *boundary,
                              const vsc_selector *selector, vsc_surface *surface, vsc_error *error)
{
  *surface = (vsc_surface){0};
  vsc_copy_name(surface->name, selector->name);
  uint8_t *marked;
  if (!VSC_NEW(marked, boundary->count)) return vsc_fail_memory(error, "a surface");
  vsc_status status = mark_selected(mesh, boundary, selector, marked, error);
  if (status == VSC_OK) status = copy_marked(boundary, marked, surface, error);
  vsc_free(marked);
  return status;
}

vsc_status vsc_surface_without(const vsc_surface *surface, const vsc_surface *other, vsc_surface *rest,
                               vsc_error *error)
{
  triangle_list taken = {0};
  uint8_t *marked = NULL;
  vsc_status status = VSC_OK;
  *rest = (vsc_surface){0};
  vsc_copy_name(rest->name, surface->name);
  if (list_surface(other, &taken) && VSC_NEW(marked, surface->count)) {
    for (size_t t = 0; t < surface->count; t++)
      marked[t] = find_triangle(&taken, surface->triangles + 3 * t) == NULL;
    status = copy_marked(surface, marked, rest, error);
  } else {
    status = vsc_fail_memory(error, "a surface");
  }
  vsc_free(taken.items);
  vsc_free(marked);
  return status;
}
