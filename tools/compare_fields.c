// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compare_fields.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "io/vtk.h"

static vsc_norms *find_or_add(vsc_comparison *all, const char *name, const char *where)
{
  for (size_t k = 0; k < all->count; k++)
    if (strcmp(all->arrays[k].name, name) == 0 && strcmp(all->arrays[k].where, where) == 0)
      return &all->arrays[k];
  if (all->count == all->room) {
    const size_t more = 2 * all->room + 16;
    if (!vsc_grow((void **)&all->arrays, all->room, more, sizeof *all->arrays)) return NULL;
    all->room = more;
  }
  vsc_norms *added = &all->arrays[all->count++];
  *added = (vsc_norms){.where = where};
  vsc_copy_name(added->name, name);
  return added;
}

// A value that is not a number on one side only is an infinite difference.
static double difference(double a, double b)
{
  if (a == b || (isnan(a) && isnan(b))) return 0;
  const double d = fabs(a - b);
  return isnan(d) ? INFINITY : d;
}

// Where an array's values lie: what is the same for all arrays there.
typedef struct places {
  const char *name;       // "points", ...
  size_t count;
  const double *volumes;  // count, or NULL
  const vsc_place *in_b;  // count, or NULL: value by value
  const vsc_pair *pair;
} places;

static void add_value(vsc_norms *n, double a, double b, double volume)
{
  const double d = difference(a, b);
  n->largest = fmax(n->largest, d);
  n->squares += d * d;
  if (isfinite(b)) n->reference += b * b;
  n->values++;
  if (!(volume > 0)) return;
  n->volume += volume;
  n->volume_squares += volume * d * d;
  if (isfinite(b)) n->volume_reference += volume * b * b;
}

static bool is_axis(const vsc_array *array)
{
  return array->components == 3 && (strcmp(array->name, "fiber") == 0 ||
                                    strcmp(array->name, "sheet") == 0 || strcmp(array->name, "normal") == 0);
}

// The value of B's array at place `i`.
static void value_of_b(const places *at, const vsc_array *b, size_t i, double *value)
{
  const size_t width = (size_t)b->components;
  if (at->in_b != NULL && at->in_b == at->pair->nodes)
    vsc_place_value(at->pair->b, &at->in_b[i], b->components, b->values, value);
  else
    memcpy(value, b->values + width * (at->in_b != NULL ? at->in_b[i].element : i),
           width * sizeof *value);
}

static void turn_towards(const double a[3], double axis[3])
{
  const double along = vsc_dot(a, axis);
  for (size_t c = 0; c < 3 && along < 0; c++) axis[c] = -axis[c];
}

// The angle of an axis, degrees: 180 more is the same. Brought to within 90 of `a`.
static double turn_angle(double a, double angle)
{
  return isfinite(a) && isfinite(angle) ? a - remainder(a - angle, 180) : angle;
}

static vsc_status add_array(vsc_comparison *all, const places *at, const vsc_array *a,
                            const vsc_array *b, vsc_error *error)
{
  vsc_norms *n = find_or_add(all, a->name, at->name);
  double *value;
  const size_t width = (size_t)a->components;
  if (n == NULL || !VSC_NEW(value, width)) return vsc_fail_memory(error, "the comparison");
  const bool axes = is_axis(b) && strcmp(at->name, "elements") == 0;
  const bool angles = b->components == 1 && strcmp(b->name, "helix_angle") == 0;
  for (size_t i = 0; i < at->count; i++) {
    const double *first = a->values + width * i;
    if (at->in_b != NULL && at->in_b[i].distance > at->pair->limit) {
      n->left_out++;
      continue;
    }
    value_of_b(at, b, i, value);
    if (axes) turn_towards(first, value);
    if (angles) value[0] = turn_angle(first[0], value[0]);
    for (size_t c = 0; c < width; c++)
      add_value(n, first[c], value[c], at->volumes != NULL ? at->volumes[i] : 0);
  }
  vsc_free(value);
  return VSC_OK;
}

static void note(vsc_comparison *all, const char *name, const char *why)
{
  const size_t used = strlen(all->note);
  char text[2 * VSC_NAME];
  snprintf(text, sizeof text, "%s (%s)", name, why);
  if (strstr(all->note, text) != NULL) return;
  snprintf(all->note + used, sizeof all->note - used, "%s%s", used > 0 ? ", " : "", text);
}

static vsc_status add_arrays(vsc_comparison *all, const places *at, const vsc_arrays *a,
                             const vsc_arrays *b, vsc_error *error)
{
  for (size_t k = 0; k < a->count; k++) {
    const vsc_array *first = &a->items[k];
    const vsc_array *second = vsc_arrays_find(b, first->name);
    if (second == NULL)
      note(all, first->name, "only in A");
    else if (second->components != first->components)
      note(all, first->name, "different numbers of components");
    else if (add_array(all, at, first, second, error) != VSC_OK)
      return error->status;
  }
  for (size_t k = 0; k < b->count; k++)
    if (vsc_arrays_find(a, b->items[k].name) == NULL) note(all, b->items[k].name, "only in B");
  return VSC_OK;
}

// Positions, of meshes compared value by value.
static vsc_status add_positions(vsc_comparison *all, const places *points, const vsc_mesh *a, const vsc_mesh *b, vsc_error *error)
{
  const vsc_array first = {.name = "(positions)", .components = 3, .tuples = a->node_count, .values = a->nodes};
  const vsc_array second = {.name = "(positions)", .components = 3, .tuples = b->node_count, .values = b->nodes};
  return add_array(all, points, &first, &second, error);
}

// Arrays on triangles, where both meshes have the same.
static vsc_status add_triangles(vsc_comparison *all, const vsc_pair *pair, const vsc_mesh *a,
                                const vsc_mesh *b, vsc_error *error)
{
  if (a->triangle_count != b->triangle_count ||
      memcmp(a->triangles, b->triangles, 3 * a->triangle_count * sizeof *a->triangles) != 0) {
    note(all, "triangles", "not the same");
    return VSC_OK;
  }
  const places triangles = {"triangles", a->triangle_count, NULL, NULL, pair};
  return add_arrays(all, &triangles, &a->triangle_data, &b->triangle_data, error);
}

static vsc_status add_meshes(vsc_comparison *all, const vsc_pair *pair, const vsc_mesh *a,
                             const vsc_mesh *b, vsc_error *error)
{
  const places points = {"points", a->node_count, pair->node_volumes, pair->nodes, pair};
  const places elements = {"elements", a->element_count, pair->element_volumes, pair->centres, pair};
  vsc_status status = pair->same ? add_positions(all, &points, a, b, error) : VSC_OK;
  if (status == VSC_OK)
    status = add_arrays(all, &points, &a->node_data, &b->node_data, error);
  if (status == VSC_OK && a->element_count > 0)
    status = add_arrays(all, &elements, &a->element_data, &b->element_data, error);
  if (status == VSC_OK && pair->same) status = add_triangles(all, pair, a, b, error);
  return status;
}

vsc_status vsc_compare_files(vsc_comparison *all, vsc_pair *pair, const char *file_a,
                             const char *file_b, vsc_error *error)
{
  vsc_mesh *a = NULL, *b = NULL;
  vsc_status status = vsc_vtk_read_mesh(file_a, 1, &a, error);
  if (status == VSC_OK) status = vsc_vtk_read_mesh(file_b, 1, &b, error);
  if (status == VSC_OK && !vsc_pair_holds(pair, a, b)) {
    status = vsc_pair_make(pair, a, file_a, b, file_b, error);
    return status == VSC_OK ? add_meshes(all, pair, a, b, error) : status;
  }
  if (status == VSC_OK) status = add_meshes(all, pair, a, b, error);
  vsc_mesh_free(a);
  vsc_mesh_free(b);
  return status;
}

vsc_status vsc_comparison_merge(vsc_comparison *all, const vsc_comparison *more, vsc_error *error)
{
  for (size_t k = 0; k < more->count; k++) {
    const vsc_norms *from = &more->arrays[k];
    vsc_norms *to = find_or_add(all, from->name, from->where);
    if (to == NULL) return vsc_fail_memory(error, "the comparison");
    to->largest = fmax(to->largest, from->largest);
    to->squares += from->squares;
    to->reference += from->reference;
    to->values += from->values;
    to->left_out += from->left_out;
    to->volume += from->volume;
    to->volume_squares += from->volume_squares;
    to->volume_reference += from->volume_reference;
  }
  if (all->note[0] == '\0') memcpy(all->note, more->note, sizeof all->note);
  return VSC_OK;
}

void vsc_comparison_free(vsc_comparison *all)
{
  vsc_free(all->arrays);
  *all = (vsc_comparison){0};
}

double vsc_norms_rms(const vsc_norms *n, bool by_volume)
{
  if (by_volume) return sqrt(n->volume_squares / n->volume);
  return n->values > 0 ? sqrt(n->squares / (double)n->values) : 0;
}

double vsc_norms_relative(const vsc_norms *n, bool by_volume)
{
  if (by_volume && n->volume == 0) return NAN;
  const double squares = by_volume ? n->volume_squares : n->squares;
  const double reference = by_volume ? n->volume_reference : n->reference;
  if (squares == 0) return 0;
  return reference > 0 ? sqrt(squares / reference) : INFINITY;
}
