// SPDX-License-Identifier: GPL-3.0-or-later
// Vessels given by their wall.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/sample.h"
#include "fibers/vessel_parts.h"

// The triangles as rays along the axes see them.
typedef struct wall {
  int rays;              // axes along which rays are sent: 1, or all 3 of an open surface
  vsc_boxes columns[3];  // the triangles' boxes, flattened along x, y, z
  double size;           // diagonal of the box round them, mm
} wall;

static const double *corner_of(const vsc_polydata *polydata, size_t triangle, int i)
{
  return &polydata->points[3 * (size_t)polydata->triangles[3 * triangle + (size_t)i]];
}

// ---- inside or not

// Above 0 where c lies to the left of the way from a to b, in the plane of the coordinates u and v.
// The same number, but for its sign, for b to a: so that neighbours agree on their common edge.
static double side(const double *a, const double *b, const double *c, int u, int v)
{
  if (a[u] > b[u] || (a[u] == b[u] && a[v] > b[v])) return -side(b, a, c, u, v);
  return (b[u] - a[u]) * (c[v] - a[v]) - (c[u] - a[u]) * (b[v] - a[v]);
}

// How often the projection of a triangle winds round that of the point: -1, 0 or 1. Each point of a
// common edge counts for one of its triangles only.
static int flat_winding(const double *const x[3], const double *point, int u, int v)
{
  int winding = 0;
  for (int i = 0; i < 3; i++) {
    const double *a = x[i], *b = x[(i + 1) % 3];
    if (a[v] <= point[v] && b[v] > point[v] && side(a, b, point, u, v) > 0) winding++;
    if (b[v] <= point[v] && a[v] > point[v] && side(a, b, point, u, v) < 0) winding--;
  }
  return winding;
}

// Where the line through the point along `axis` meets the plane of a triangle.
static double height(const double *const x[3], const double *point, int axis, int u, int v)
{
  double ab[3], ac[3], n[3];
  vsc_subtract(x[1], x[0], ab);
  vsc_subtract(x[2], x[0], ac);
  vsc_cross(ab, ac, n);
  return x[0][axis] - (n[u] * (point[u] - x[0][u]) + n[v] * (point[v] - x[0][v])) / n[axis];
}

// The windings that a ray forwards along `axis` and one backwards count.
static void rays_along(const vsc_vessel_walk *walk, const vsc_boxes *column, int axis,
                       const double point[3], uint32_t *found, int windings[2])
{
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  double flat[3] = {point[0], point[1], point[2]};
  flat[axis] = 0;
  const size_t count = vsc_boxes_find(column, flat, flat, found);
  windings[0] = windings[1] = 0;
  for (size_t i = 0; i < count; i++) {
    const double *x[3];
    for (int c = 0; c < 3; c++) x[c] = corner_of(walk->polydata, found[i], c);
    const int winding = flat_winding(x, point, u, v);
    if (winding == 0) continue;
    if (height(x, point, axis, u, v) > point[axis])
      windings[0] += winding;
    else
      windings[1] -= winding;
  }
}

static bool is_inside(const vsc_vessel_walk *walk, const double point[3], uint32_t *found)
{
  const wall *wall = walk->own;
  int sum = 0, windings[2];
  for (int axis = 0; axis < wall->rays; axis++) {
    rays_along(walk, &wall->columns[axis], axis, point, found, windings);
    if (wall->rays == 1) return windings[0] != 0;
    sum += windings[0] + windings[1];
  }
  return abs(sum) > 3;
}

// ---- the direction

// The square of the distance of a point from a segment.
static double from_edge(const double *a, const double *b, const double point[3])
{
  double ab[3], ap[3];
  vsc_subtract(b, a, ab);
  vsc_subtract(point, a, ap);
  const double square = vsc_dot(ab, ab);
  const double t = square > 0 ? fmin(fmax(vsc_dot(ab, ap) / square, 0), 1) : 0;
  for (int k = 0; k < 3; k++) ap[k] -= t * ab[k];
  return vsc_dot(ap, ap);
}

// The same from a triangle with the normal n (its length twice the area).
static double from_triangle(const double *const x[3], const double n[3], const double point[3])
{
  bool above = true;
  double nearest = INFINITY, ap[3];
  for (int i = 0; i < 3; i++) {
    double ab[3], inwards[3];
    vsc_subtract(x[(i + 1) % 3], x[i], ab);
    vsc_subtract(point, x[i], ap);
    vsc_cross(n, ab, inwards);
    above = above && vsc_dot(inwards, ap) >= 0;
    nearest = fmin(nearest, from_edge(x[i], x[(i + 1) % 3], point));
  }
  const double distance = vsc_dot(n, ap), square = vsc_dot(n, n);
  return above && square > 0 ? distance * distance / square : nearest;
}

// sum A n n^T over the triangles within `radius`, each weighted by 1 - (distance / radius)^2; of a
// large one radius^2 counts.
static void add_normals(const vsc_vessel_walk *walk, const double point[3], double radius,
                        uint32_t *found, double matrix[6])
{
  double low[3], high[3];
  for (int k = 0; k < 3; k++) low[k] = point[k] - radius, high[k] = point[k] + radius;
  const size_t count = vsc_boxes_find(&walk->near, low, high, found);
  memset(matrix, 0, 6 * sizeof *matrix);
  for (size_t i = 0; i < count; i++) {
    const double *x[3];
    double ab[3], ac[3], n[3];
    for (int c = 0; c < 3; c++) x[c] = corner_of(walk->polydata, found[i], c);
    vsc_subtract(x[1], x[0], ab);
    vsc_subtract(x[2], x[0], ac);
    vsc_cross(ab, ac, n);
    const double near = 1 - from_triangle(x, n, point) / (radius * radius);
    const double area = fmin(vsc_normalize(n) / 2, radius * radius);
    if (near > 0) vsc_add_square(n, near * area, matrix);
  }
}

// The top eigenvector of tr(M) 1 - M is that of the smallest eigenvalue of M.
static void find_direction(const vsc_vessel_walk *walk, const double point[3], double radius,
                           uint32_t *found, double direction[3])
{
  const wall *wall = walk->own;
  double matrix[6], values[3], axis[3];
  for (;; radius *= 1.5) {
    add_normals(walk, point, radius, found, matrix);
    const int top = vsc_top_axis(matrix, axis, values);
    if (top && values[1] >= 0.3 * values[0]) break;
    if (radius > wall->size) return;
  }
  const double trace = matrix[0] + matrix[3] + matrix[5];
  for (int k = 0; k < 6; k++) matrix[k] = (k == 0 || k == 3 || k == 5 ? trace : 0) - matrix[k];
  vsc_top_axis(matrix, direction, NULL);
}

// ---- an element

// An element that no triangle comes near is inside or outside as a whole, as its middle is.
static void visit(const vsc_vessel_walk *walk, size_t element, vsc_vessel_scratch *scratch)
{
  double low[3], high[3], size[3], middle[3], all = 0, inside = 0, centre[3] = {0};
  vsc_vessel_element_box(walk->mesh, element, low, high);
  vsc_subtract(high, low, size);
  if (vsc_boxes_find(&walk->near, low, high, scratch->found) == 0) {
    vsc_mesh_element_centre(walk->mesh, element, middle);
    if (!is_inside(walk, middle, scratch->found)) return;
    walk->fraction[element] = 1;
    find_direction(walk, middle, vsc_norm(size) / 2, scratch->found, &walk->direction[3 * element]);
    return;
  }
  vsc_cell_points_place(walk->mesh, element, walk->points[walk->mesh->kinds[element]],
                        scratch->places, scratch->weights);
  for (int p = 0; p < VSC_CELL_POINTS; p++) {
    all += scratch->weights[p];
    if (!is_inside(walk, scratch->places[p], scratch->found)) continue;
    inside += scratch->weights[p];
    for (int k = 0; k < 3; k++) centre[k] += scratch->weights[p] * scratch->places[p][k];
  }
  if (inside == 0) return;
  for (int k = 0; k < 3; k++) centre[k] /= inside;
  walk->fraction[element] = fmin(inside / all, 1);
  find_direction(walk, centre, vsc_norm(size) / 2, scratch->found, &walk->direction[3 * element]);
}

// ---- the boxes of the triangles

static void fill_boxes(const vsc_polydata *polydata, int flattened, double *ends)
{
  for (size_t t = 0; t < polydata->triangle_count; t++)
    for (int k = 0; k < 3; k++) {
      const double a = corner_of(polydata, t, 0)[k], b = corner_of(polydata, t, 1)[k];
      const double c = corner_of(polydata, t, 2)[k];
      ends[6 * t + (size_t)k] = k == flattened ? 0 : fmin(a, fmin(b, c));
      ends[6 * t + 3 + (size_t)k] = k == flattened ? 0 : fmax(a, fmax(b, c));
    }
}

static vsc_status sort_triangles(vsc_vessel_walk *walk, wall *wall, vsc_error *error)
{
  const vsc_polydata *polydata = walk->polydata;
  const size_t count = polydata->triangle_count;
  double *ends, low[3], high[3], size[3];
  if (!VSC_NEW(ends, 6 * count)) return vsc_fail_memory(error, "a surface's boxes");
  fill_boxes(polydata, -1, ends);
  vsc_status status = vsc_boxes_make(count, ends, &walk->near, error);
  for (int axis = 0; axis < wall->rays && status == VSC_OK; axis++) {
    fill_boxes(polydata, axis, ends);
    status = vsc_boxes_make(count, ends, &wall->columns[axis], error);
  }
  vsc_polydata_box(polydata, low, high);
  vsc_subtract(high, low, size);
  wall->size = vsc_norm(size);
  vsc_free(ends);
  return status;
}

vsc_status vsc_vessel_surface(vsc_vessel_walk *walk, vsc_vessel_report *report, vsc_error *error)
{
  wall wall = {.rays = 1};
  vsc_closure closure;
  vsc_status status = vsc_polydata_closure(walk->polydata, &closure, error);
  if (status != VSC_OK) return status;
  report->own_volume = fabs(closure.volume);
  report->open_edges = closure.open_edges;
  report->turned_edges = closure.turned_edges;
  if (!(report->own_volume > 0))
    return vsc_fail(error, VSC_INPUT,
                    "the surface encloses nothing (%zu of its edges are open): close it, or give "
                    "centre lines with a radius",
                    closure.open_edges);
  if (closure.open_edges + closure.turned_edges > 0) wall.rays = 3;
  walk->own = &wall;
  walk->visit = visit;
  status = sort_triangles(walk, &wall, error);
  if (status == VSC_OK) status = vsc_vessel_walk_all(walk, error);
  for (int axis = 0; axis < 3; axis++) vsc_boxes_free(&wall.columns[axis]);
  return status;
}
