// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/solid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/sort.h"
#include "base/vec3.h"
#include "mesh/surface.h"

enum { KIND_FACE = 1, KIND_EDGE, KIND_SPHERE, TURNS = 48 };
static const double EDGE = 0.9;  // half the width of an edge, pixels

typedef struct picture {
  const vsc_camera *camera;
  const vsc_solid *solid;
  double low[2], scale;
  vsc_raster *raster;
  vsc_vertex *nodes;  // node_count: as seen, without normals
  uint64_t *edges;    // of the elements, ascending
  size_t edge_count;
} picture;

static void see(const picture *p, const double at[3], double place[3])
{
  double d[3];
  vsc_subtract(at, p->camera->centre, d);
  place[0] = (vsc_dot(d, p->camera->right) - p->low[0]) * p->scale;
  place[1] = p->raster->height - (vsc_dot(d, p->camera->up) - p->low[1]) * p->scale;
  place[2] = vsc_dot(d, p->camera->into) * p->scale;
}

static void shade(const vsc_vertex *vertex, int kind, const void *context, float colour[3])
{
  static const double light[3] = {-0.42, -0.50, -0.76};  // rows count downwards
  static const double grey[3] = {0.72, 0.74, 0.78};
  const vsc_solid *solid = context;
  double base[3], normal[3] = {vertex->normal[0], vertex->normal[1], vertex->normal[2]};
  const double span = solid->high - solid->low;
  vsc_view_colour(span > 0 ? (vertex->value - solid->low) / span : 0, base);
  if (kind == KIND_SPHERE) memcpy(base, grey, sizeof base);
  vsc_normalize(normal);
  if (normal[2] > 0)
    for (int k = 0; k < 3; k++) normal[k] = -normal[k];
  const double lit = (1 + vsc_dot(normal, light)) / 2;
  const double bright = (0.45 + 0.58 * lit * lit) * (kind == KIND_EDGE ? 0.62 : 1);
  for (int k = 0; k < 3; k++) colour[k] = (float)fmin(1, base[k] * bright);
}

// ---- edges of elements

static uint64_t key(uint32_t a, uint32_t b)
{
  return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

static bool list_edges(picture *p)
{
  const vsc_mesh *mesh = p->solid->mesh;
  if (!VSC_NEW(p->edges, VSC_MOST_EDGES * mesh->element_count + 3 * mesh->triangle_count))
    return false;
  for (size_t e = 0; e < mesh->element_count; e++) {
    const uint32_t *corners = vsc_mesh_corners(mesh, e);
    const vsc_cell_kind *kind = vsc_mesh_kind(mesh, e);
    for (int k = 0; k < kind->edge_count; k++) {
      const int *ends = kind->edges[k], middle = vsc_cell_middle(kind, ends[0], ends[1]);
      // halves of edges with a middle: a quadratic tet's 12 are as many as any kind has
      p->edges[p->edge_count++] = key(corners[ends[0]], corners[middle < 0 ? ends[1] : middle]);
      if (middle >= 0) p->edges[p->edge_count++] = key(corners[middle], corners[ends[1]]);
    }
  }
  if (mesh->element_count == 0)
    for (size_t c = 0; c < 3 * mesh->triangle_count; c++)
      p->edges[p->edge_count++] =
          key(mesh->triangles[c], mesh->triangles[c % 3 == 2 ? c - 2 : c + 1]);
  qsort(p->edges, p->edge_count, sizeof *p->edges, vsc_compare_uint64);
  return true;
}

// ---- drawing

static void see_nodes(picture *p)
{
  const vsc_solid *solid = p->solid;
  for (size_t i = 0; i < solid->mesh->node_count; i++) {
    double at[3];
    for (size_t k = 0; k < 3; k++)
      at[k] = solid->mesh->nodes[3 * i + k] +
              (solid->displacement == NULL ? 0 : solid->displacement[3 * i + k]);
    see(p, at, p->nodes[i].place);
    p->nodes[i].value = solid->values == NULL ? solid->low : solid->values[i];
  }
}

// An edge as a thin strip just in front of the faces.
static void draw_edge(const picture *p, const vsc_vertex *from, const vsc_vertex *to)
{
  const double dx = to->place[0] - from->place[0], dy = to->place[1] - from->place[1];
  const double length = hypot(dx, dy);
  if (!(length > 0)) return;
  vsc_vertex corner[4] = {*from, *from, *to, *to};
  for (int i = 0; i < 4; i++) {
    const double side = i == 0 || i == 3 ? EDGE : -EDGE;
    corner[i].place[0] -= side * dy / length;
    corner[i].place[1] += side * dx / length;
    corner[i].place[2] -= 1.5;
  }
  const vsc_vertex halves[2][3] = {{corner[0], corner[1], corner[2]},
                                   {corner[0], corner[2], corner[3]}};
  for (int h = 0; h < 2; h++) vsc_raster_triangle(p->raster, halves[h], KIND_EDGE, shade, p->solid);
}

static void draw_triangle(const picture *p, const uint32_t nodes[3])
{
  vsc_vertex corner[3];
  double ab[3], ac[3], normal[3];
  for (int i = 0; i < 3; i++) corner[i] = p->nodes[nodes[i]];
  vsc_subtract(corner[1].place, corner[0].place, ab);
  vsc_subtract(corner[2].place, corner[0].place, ac);
  vsc_cross(ab, ac, normal);
  for (int i = 0; i < 3; i++) memcpy(corner[i].normal, normal, sizeof normal);
  vsc_raster_triangle(p->raster, corner, KIND_FACE, shade, p->solid);
  for (int i = 0; i < 3; i++) {
    const uint64_t edge = key(nodes[i], nodes[(i + 1) % 3]);
    if (bsearch(&edge, p->edges, p->edge_count, sizeof edge, vsc_compare_uint64) != NULL)
      draw_edge(p, &corner[i], &corner[(i + 1) % 3]);
  }
}

static void draw_sphere(const picture *p, const double sphere[4])
{
  vsc_vertex row[2][TURNS + 1];
  for (int j = 0; j <= TURNS / 2; j++) {
    memcpy(row[0], row[1], sizeof row[0]);
    for (int i = 0; i <= TURNS; i++) {
      const double u = 2 * M_PI * i / TURNS, v = 2 * M_PI * j / TURNS;
      const double n[3] = {sin(v) * cos(u), sin(v) * sin(u), cos(v)};
      double at[3];
      for (int k = 0; k < 3; k++) at[k] = sphere[k] + sphere[3] * n[k];
      row[1][i] = (vsc_vertex){.normal = {vsc_dot(n, p->camera->right), -vsc_dot(n, p->camera->up),
                                          vsc_dot(n, p->camera->into)}};
      see(p, at, row[1][i].place);
    }
    for (int i = 0; i < TURNS && j > 0; i++) {
      const vsc_vertex halves[2][3] = {{row[0][i], row[1][i], row[1][i + 1]},
                                       {row[0][i], row[1][i + 1], row[0][i + 1]}};
      for (int h = 0; h < 2; h++)
        vsc_raster_triangle(p->raster, halves[h], KIND_SPHERE, shade, p->solid);
    }
  }
}

static vsc_status draw_surface(const picture *p, vsc_error *error)
{
  const vsc_mesh *mesh = p->solid->mesh;
  if (mesh->element_count == 0) {
    for (size_t t = 0; t < mesh->triangle_count; t++) draw_triangle(p, mesh->triangles + 3 * t);
    return VSC_OK;
  }
  vsc_surface boundary = {0};
  vsc_status status = vsc_boundary(mesh, &boundary, error);
  if (status == VSC_OK) status = vsc_surface_flatten(&boundary, error);
  for (size_t t = 0; status == VSC_OK && t < boundary.count; t++)
    draw_triangle(p, boundary.triangles + 3 * t);
  vsc_surface_free(&boundary);
  return status;
}

vsc_status vsc_solid_draw(const vsc_camera *camera, const vsc_solid *solid, const double low[2],
                          double scale, vsc_raster *raster, vsc_error *error)
{
  picture p = {
      .camera = camera, .solid = solid, .low = {low[0], low[1]}, .scale = scale, .raster = raster};
  vsc_status status = VSC_OK;
  if (!VSC_NEW(p.nodes, solid->mesh->node_count) || !list_edges(&p))
    status = vsc_fail_memory(error, "a picture");
  if (status == VSC_OK) {
    see_nodes(&p);
    status = draw_surface(&p, error);
    for (size_t s = 0; s < solid->sphere_count; s++) draw_sphere(&p, solid->spheres[s]);
  }
  vsc_free(p.edges);
  vsc_free(p.nodes);
  return status;
}
