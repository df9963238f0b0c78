// SPDX-License-Identifier: GPL-3.0-or-later
// vsc_select_surface: which boundary triangles a selector describes; surfaces less others.
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "mesh/select.h"

// A triangle's nodes, ascending.
typedef struct corners {
  uint32_t node[3];
} corners;

static corners sorted_corners(const uint32_t triangle[3])
{
  corners key;
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

// Marks the triangles of a surface that are among `count` others, which get sorted.
static void mark_corners(const vsc_surface *surface, corners *others, size_t count, uint8_t *marked)
{
  qsort(others, count, sizeof *others, compare_corners);
  for (size_t t = 0; t < surface->count; t++) {
    const corners key = sorted_corners(surface->triangles + 3 * t);
    marked[t] = bsearch(&key, others, count, sizeof key, compare_corners) != NULL;
  }
}

// Marks the boundary triangles that the file lists with a value that the selector takes.
static vsc_status mark_listed(const vsc_mesh *mesh, const vsc_surface *boundary,
                              const vsc_selector *selector, uint8_t *marked, vsc_error *error)
{
  const vsc_array *array = vsc_arrays_find(&mesh->triangle_data, selector->array);
  corners *listed;
  if (!VSC_NEW(listed, mesh->triangle_count)) return vsc_fail_memory(error, "a surface");
  size_t count = 0;
  for (size_t t = 0; t < mesh->triangle_count; t++)
    if (array->values[t] >= selector->low && array->values[t] <= selector->high)
      listed[count++] = sorted_corners(mesh->triangles + 3 * t);
  mark_corners(boundary, listed, count, marked);
  vsc_free(listed);
  return VSC_OK;
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
  corners *taken = NULL;
  uint8_t *marked = NULL;
  vsc_status status = VSC_OK;
  *rest = (vsc_surface){0};
  vsc_copy_name(rest->name, surface->name);
  if (VSC_NEW(taken, other->count) && VSC_NEW(marked, surface->count)) {
    for (size_t t = 0; t < other->count; t++) taken[t] = sorted_corners(other->triangles + 3 * t);
    mark_corners(surface, taken, other->count, marked);
    for (size_t t = 0; t < surface->count; t++) marked[t] = !marked[t];
    status = copy_marked(surface, marked, rest, error);
  } else {
    status = vsc_fail_memory(error, "a surface");
  }
  vsc_free(taken);
  vsc_free(marked);
  return status;
}
