// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/quadratic.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/edges.h"
#include "mesh/split.h"

static const double FAR = 0.1;  // part of an edge that a corner may be off the ellipsoid

// ---- raising the order

// Elements of other kinds than tets are cut into such.
static vsc_status make_tets(vsc_mesh **mesh, const char *name, vsc_error *error)
{
  if ((*mesh)->element_count == 0)
    return vsc_fail(error, VSC_INPUT, "%s: mesh.order: 2 needs elements, and the mesh is a surface: leave out mesh.order",
                    name);
  for (size_t e = 0; e < (*mesh)->element_count; e++)
    if ((*mesh)->kinds[e] != VSC_TET) return vsc_mesh_cut(mesh, name, error);
  return VSC_OK;
}

// Each tuple of an array on nodes, and behind them the means of the edges' ends.
static bool raise_array(const vsc_array *from, const vsc_edges *edges, vsc_arrays *to)
{
  vsc_array *array = vsc_arrays_add(to, from->name, from->components, from->tuples + edges->count);
  const size_t width = (size_t)from->components;
  if (array == NULL) return false;
  array->single = from->single;
  memcpy(array->values, from->values, from->tuples * width * sizeof *from->values);
  double *middle = array->values + from->tuples * width;
  for (size_t k = 0; k < edges->count; k++)
    for (size_t c = 0; c < width; c++)
      *middle++ = 0.5 * (from->values[edges->items[k].low * width + c] +
                         from->values[edges->items[k].high * width + c]);
  return true;
}

static bool copy_arrays(const vsc_arrays *from, vsc_arrays *to)
{
  for (size_t a = 0; a < from->count; a++) {
    const vsc_array *array = &from->items[a];
    vsc_array *copy = vsc_arrays_add(to, array->name, array->components, array->tuples);
    if (copy == NULL) return false;
    copy->single = array->single;
    memcpy(copy->values, array->values,
           array->tuples * (size_t)array->components * sizeof *array->values);
  }
  return true;
}

static void raise_nodes(const vsc_mesh *from, const vsc_edges *edges, vsc_mesh *to)
{
  memcpy(to->nodes, from->nodes, 3 * from->node_count * sizeof *to->nodes);
  memcpy(to->node_source, from->node_source, from->node_count * sizeof *to->node_source);
  double *middle = to->nodes + 3 * from->node_count;
  for (size_t k = 0; k < edges->count; k++) {
    const double *low = from->nodes + 3 * (size_t)edges->items[k].low;
    const double *high = from->nodes + 3 * (size_t)edges->items[k].high;
    for (int a = 0; a < 3; a++) *middle++ = 0.5 * (low[a] + high[a]);
    to->node_source[from->node_count + k] = (uint32_t)(from->report.file_nodes + k);
  }
}

static void raise_elements(const vsc_mesh *from, const vsc_edges *edges, vsc_mesh *to)
{
  memcpy(to->element_source, from->element_source,
         from->element_count * sizeof *to->element_source);
  memcpy(to->triangles, from->triangles, 3 * from->triangle_count * sizeof *to->triangles);
  for (size_t e = 0; e < from->element_count; e++) {
    uint32_t *corner = to->corners + to->start[e];
    memcpy(corner, vsc_mesh_corners(from, e), 4 * sizeof *corner);
    for (int k = 0; k < 6; k++) {
      const int *ends = vsc_cells[VSC_TET10].edges[k];
      const vsc_edge *edge = vsc_edges_find(edges, corner[ends[0]], corner[ends[1]]);
      corner[4 + k] = (uint32_t)(from->node_count + (size_t)(edge - edges->items));
    }
  }
}

// The quadratic mesh, or NULL when memory is short.
static vsc_mesh *raised_mesh(const vsc_mesh *from, const vsc_edges *edges)
{
  uint8_t *kinds;
  if (!VSC_NEW(kinds, from->element_count)) return NULL;
  memset(kinds, VSC_TET10, from->element_count);
  vsc_mesh *to = vsc_mesh_create_cells(from->node_count + edges->count, from->element_count, kinds,
                                       from->triangle_count);
  vsc_free(kinds);
  if (to == NULL) return NULL;
  raise_nodes(from, edges, to);
  raise_elements(from, edges, to);
  bool room = copy_arrays(&from->element_data, &to->element_data) &&
              copy_arrays(&from->triangle_data, &to->triangle_data);
  for (size_t a = 0; a < from->node_data.count && room; a++)
    room = raise_array(&from->node_data.items[a], edges, &to->node_data);
  if (room) return to;
  vsc_mesh_free(to);
  return NULL;
}

vsc_status vsc_mesh_raise(vsc_mesh **mesh, const char *name, vsc_error *error)
{
  vsc_edges edges;
  if (vsc_mesh_is_quadratic(*mesh)) return VSC_OK;
  const vsc_mesh *given = *mesh;
  vsc_status status = make_tets(mesh, name, error);
  const vsc_mesh *from = *mesh;
  const bool cut = from != given;
  if (status == VSC_OK) status = vsc_edges_list(from, &edges, error);
  if (status != VSC_OK) return status;
  vsc_mesh *to = raised_mesh(from, &edges);
  vsc_edges_free(&edges);
  if (to == NULL) return vsc_fail_memory(error, "the quadratic mesh");
  status = vsc_mesh_clean(to, name, error);
  const size_t loose = to->report.loose_triangles;
  if (status == VSC_OK && cut && loose > 0)
    status = vsc_fail(error, VSC_INPUT,
                      "%s: %zu of its triangles lie across the cuts of its elements into tetrahedra for mesh.order: 2: mesh "
                      "with tetrahedra, or leave out mesh.order", name, loose);
  if (status != VSC_OK) {
    vsc_mesh_free(to);
    return status;
  }
  to->report = from->report;
  to->report.loose_triangles += loose;
  vsc_mesh_free(*mesh);
  *mesh = to;
  return VSC_OK;
}

// ---- onto an ellipsoid

// sum_a ((x_a - centre_a)/radii_a)^2 - 1 and half its gradient, 1/mm
static double level_of(const vsc_curved_def *curved, const double x[3], double slope[3])
{
  double sum = 0;
  for (int a = 0; a < 3; a++) {
    const double part = (x[a] - curved->centre[a]) / curved->radii[a];
    sum += part * part;
    slope[a] = part / curved->radii[a];
  }
  return sum - 1;
}

static vsc_status check_corners(const vsc_mesh *mesh, const vsc_surface *surface,
                                const vsc_curved_def *curved, vsc_error *error)
{
  for (size_t t = 0; t < surface->count; t++) {
    const double *x[3];
    double longest = 0, edge[3], slope[3];
    for (int i = 0; i < 3; i++) x[i] = mesh->nodes + 3 * (size_t)surface->triangles[3 * t + i];
    for (int i = 0; i < 3; i++) {
      vsc_subtract(x[(i + 1) % 3], x[i], edge);
      longest = fmax(longest, vsc_norm(edge));
    }
    for (int i = 0; i < 3; i++) {
      // to first order; from the centre no direction leads off
      const double level = level_of(curved, x[i], slope), steep = 2 * vsc_norm(slope);
      const double off = steep > 0 ? fabs(level) / steep : INFINITY;
      if (off <= FAR * longest) continue;
      return vsc_fail(error, VSC_INPUT,
                      "mesh.curved: node %u of surface %s at (%g, %g, %g) mm lies %.2g mm off the "
                      "ellipsoid: correct its centre and radii, or the surface",
                      mesh->node_source[surface->triangles[3 * t + i]], curved->surface, x[i][0],
                      x[i][1], x[i][2], off);
    }
  }
  return VSC_OK;
}

static void unit_normal(const vsc_mesh *mesh, const uint32_t corner[3], double normal[3])
{
  double first[3], second[3];
  vsc_subtract(mesh->nodes + 3 * (size_t)corner[1], mesh->nodes + 3 * (size_t)corner[0], first);
  vsc_subtract(mesh->nodes + 3 * (size_t)corner[2], mesh->nodes + 3 * (size_t)corner[0], second);
  vsc_cross(first, second, normal);
  vsc_normalize(normal);
}

// For each node: how many triangles of the surface have it in the middle of an edge, and the sum of the
// normals of the other boundary triangles that have.
typedef struct rims {
  uint8_t *inside;
  double *normals;  // node_count x 3
} rims;

static void add_normals(const vsc_mesh *mesh, const vsc_surface *surface, double sign, rims *rims)
{
  for (size_t t = 0; t < surface->count; t++) {
    double normal[3];
    unit_normal(mesh, surface->triangles + 3 * t, normal);
    for (int i = 0; i < 3; i++)
      for (int a = 0; a < 3; a++)
        rims->normals[3 * (size_t)surface->mid[3 * t + i] + a] += sign * normal[a];
  }
}

// x + s d with the least |s| on the ellipsoid: A s^2 + 2 B s + C = 0.
static bool move_onto(const vsc_curved_def *curved, const double d[3], double x[3])
{
  double slope[3], A = 0;
  const double C = level_of(curved, x, slope), B = vsc_dot(slope, d);
  for (int a = 0; a < 3; a++) A += d[a] * d[a] / (curved->radii[a] * curved->radii[a]);
  const double inner = B * B - A * C;
  if (!(B > 0 && inner >= 0)) return false;
  const double s = -C / (B + sqrt(inner));
  for (int a = 0; a < 3; a++) x[a] += s * d[a];
  return true;
}

static vsc_status move_middles(vsc_mesh *mesh, const vsc_surface *surface,
                               const vsc_curved_def *curved, const rims *rims, vsc_error *error)
{
  for (size_t k = 0; k < 3 * surface->count; k++) {
    const uint32_t node = surface->mid[k];
    const size_t place = 3 * (size_t)node;
    double d[3], normal[3];
    level_of(curved, mesh->nodes + place, d);
    memcpy(normal, rims->normals + place, sizeof normal);
    if (rims->inside[node] == 1 && vsc_normalize(normal) > 0) {
      const double along = vsc_dot(d, normal);
      for (int a = 0; a < 3; a++) d[a] -= along * normal[a];
    }
    vsc_normalize(d);
    if (!move_onto(curved, d, mesh->nodes + place))
      return vsc_fail(error, VSC_INPUT,
                      "mesh.curved: the edge of surface %s at (%g, %g, %g) mm meets the ellipsoid nowhere: "
                      "correct its centre and radii, or mesh finer",
                      curved->surface, mesh->nodes[place], mesh->nodes[place + 1],
                      mesh->nodes[place + 2]);
  }
  return VSC_OK;
}

vsc_status vsc_mesh_bend(vsc_mesh *mesh, const vsc_surface *boundary, const vsc_surface *surface,
                         const vsc_curved_def *curved, vsc_error *error)
{
  rims rims = {0};
  if (surface->mid == NULL)
    return vsc_fail(error, VSC_INPUT,
                    "mesh.curved: surface %s has straight edges without nodes in their middle: use "
                    "mesh.order: 2",
                    curved->surface);
  vsc_status status = check_corners(mesh, surface, curved, error);
  if (status != VSC_OK) return status;
  if (VSC_NEW(rims.inside, mesh->node_count) && VSC_NEW(rims.normals, 3 * mesh->node_count)) {
    for (size_t k = 0; k < 3 * surface->count; k++) rims.inside[surface->mid[k]]++;
    add_normals(mesh, boundary, 1, &rims);
    add_normals(mesh, surface, -1, &rims);
    status = move_middles(mesh, surface, curved, &rims, error);
  } else {
    status = vsc_fail_memory(error, "a curved surface");
  }
  vsc_free(rims.inside);
  vsc_free(rims.normals);
  if (status != VSC_OK) return status;
  char name[VSC_NAME + 16];
  snprintf(name, sizeof name, "mesh.curved: %s", curved->surface);
  return vsc_mesh_check_folds(mesh, name, error);
}
