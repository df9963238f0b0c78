// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/view.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/surface.h"
#include "mesh/split.h"

static const double RAISED = 0.31;      // the camera's elevation, radians
static const double CREASE = 0.64;      // cosine of the angle from which an edge is drawn sharp
static const double GRID_HEIGHT = 10;   // mm between the lines of the material grid
static const double GRID_ANGLE = 15;    // degrees between its meridians
static const double GRID_WIDTH = 0.35;  // mm, its lines

// ---- the camera

static void horizontal(const double axis[3], double first[3], double second[3])
{
  const double x[3] = {1, 0, 0}, y[3] = {0, 1, 0};
  vsc_cross(axis, fabs(axis[0]) < 0.9 ? x : y, second);
  vsc_normalize(second);
  vsc_cross(second, axis, first);
}

// The horizontal direction in which the nodes spread least: seen from there the mesh is widest.
static void narrow_direction(const vsc_mesh *mesh, const double axis[3], const double centre[3],
                             double direction[3])
{
  double first[3], second[3], xx = 0, xy = 0, yy = 0;
  horizontal(axis, first, second);
  for (size_t i = 0; i < mesh->node_count; i++) {
    double d[3];
    vsc_subtract(mesh->nodes + 3 * i, centre, d);
    const double x = vsc_dot(d, first), y = vsc_dot(d, second);
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  // A round one is seen from the second direction.
  const double major = hypot(2 * xy, xx - yy) < 0.02 * (xx + yy) ? 0 : 0.5 * atan2(2 * xy, xx - yy);
  for (int k = 0; k < 3; k++) direction[k] = -sin(major) * first[k] + cos(major) * second[k];
}

vsc_camera vsc_camera_make(const vsc_mesh *mesh, const double axis[3], const double *from,
                           bool whole)
{
  vsc_camera camera = {.whole = whole};
  double low[3], high[3], side[3];
  vsc_mesh_box(mesh, low, high);
  for (int k = 0; k < 3; k++) camera.centre[k] = 0.5 * (low[k] + high[k]);
  memcpy(camera.axis, axis, sizeof camera.axis);
  if (vsc_normalize(camera.axis) == 0) camera.axis[2] = 1;
  if (from != NULL) {
    const double along = vsc_dot(from, camera.axis);
    for (int k = 0; k < 3; k++) side[k] = from[k] - along * camera.axis[k];
  }
  if (from == NULL || vsc_normalize(side) < 1e-9)
    narrow_direction(mesh, camera.axis, camera.centre, side);
  memcpy(camera.cut, side, sizeof side);
  for (int k = 0; k < 3; k++)
    camera.into[k] = -(cos(RAISED) * side[k] + sin(RAISED) * camera.axis[k]);
  vsc_cross(camera.into, camera.axis, camera.right);
  vsc_normalize(camera.right);
  vsc_cross(camera.right, camera.into, camera.up);
  return camera;
}

// A position in the picture: to the right, upwards, and away, mm from the centre.
static void project(const vsc_camera *camera, const double position[3], double seen[3])
{
  double d[3];
  vsc_subtract(position, camera->centre, d);
  seen[0] = vsc_dot(d, camera->right);
  seen[1] = vsc_dot(d, camera->up);
  seen[2] = vsc_dot(d, camera->into);
}

static void moved(const vsc_mesh *mesh, const double *displacement, size_t node, double position[3])
{
  for (size_t k = 0; k < 3; k++)
    position[k] =
        mesh->nodes[3 * node + k] + (displacement == NULL ? 0 : displacement[3 * node + k]);
}

void vsc_camera_extend(const vsc_camera *camera, const vsc_mesh *mesh, const double *displacement,
                       double low[2], double high[2])
{
  for (size_t i = 0; i < mesh->node_count; i++) {
    double position[3], seen[3];
    moved(mesh, displacement, i, position);
    project(camera, position, seen);
    for (int k = 0; k < 2; k++) {
      low[k] = fmin(low[k], seen[k]);
      high[k] = fmax(high[k], seen[k]);
    }
  }
}

// ---- colours and light

void vsc_view_colour(double share, double colour[3])
{
  static const double stops[5][3] = {{0.94, 0.83, 0.74},
                                     {0.95, 0.68, 0.50},
                                     {0.90, 0.46, 0.36},
                                     {0.80, 0.25, 0.26},
                                     {0.62, 0.08, 0.22}};
  const double place = 4 * fmin(fmax(share, 0), 1);
  const int stop = place >= 4 ? 3 : (int)place;
  for (int k = 0; k < 3; k++)
    colour[k] = stops[stop][k] + (place - stop) * (stops[stop + 1][k] - stops[stop][k]);
}

typedef struct scene {
  const vsc_camera *camera;
  const vsc_mesh *mesh;
  double largest;
  double low[2], scale;
  vsc_vertex *nodes;  // node_count: as seen, without normals
  double *distances;  // node_count: in front of the cutting plane at rest, mm
  vsc_raster *raster;
} scene;

// 1 on a line of the grid that is drawn on the tissue at rest and moves with it.
static bool on_grid(const vsc_camera *camera, const double rest[3])
{
  double first[3], second[3], d[3];
  horizontal(camera->axis, first, second);
  vsc_subtract(rest, camera->centre, d);
  const double height = vsc_dot(d, camera->axis), x = vsc_dot(d, first), y = vsc_dot(d, second);
  const double radius = hypot(x, y), step = GRID_ANGLE * M_PI / 180;
  const double meridian = remainder(atan2(y, x), step) * radius;
  return fabs(remainder(height, GRID_HEIGHT)) < GRID_WIDTH / 2 ||
         (radius > 3 && fabs(meridian) < GRID_WIDTH / 2);
}

static void shade(const vsc_vertex *vertex, int kind, const void *context, float colour[3])
{
  static const double light[3] = {-0.42, 0.50, -0.76};       // from over the viewer's left shoulder
  static const double halfway[3] = {-0.224, 0.266, -0.938};  // between the light and the viewer
  const scene *s = context;
  double base[3], normal[3] = {vertex->normal[0], vertex->normal[1], vertex->normal[2]};
  vsc_view_colour(s->largest > 0 ? vertex->value / s->largest : 0, base);
  vsc_normalize(normal);
  if (normal[2] > 0)
    for (int k = 0; k < 3; k++) normal[k] = -normal[k];
  const double lit = (1 + vsc_dot(normal, light)) / 2;  // the shaded side is no plain black
  double bright = 0.40 + 0.66 * lit * lit,
         shine = 0.06 * pow(fmax(0, vsc_dot(normal, halfway)), 24);
  if (kind == VSC_KIND_CUT) {
    bright = 1.0;
    shine = 0;
  } else if (on_grid(s->camera, vertex->rest)) {
    bright *= 0.80;
  }
  for (int k = 0; k < 3; k++) colour[k] = (float)fmin(1, base[k] * bright + shine);
}

// ---- the mesh as seen

// Turns a direction in space into the picture's axes (right, up, into).
static void turn(const vsc_camera *camera, const double direction[3], double seen[3])
{
  seen[0] = vsc_dot(direction, camera->right);
  seen[1] = vsc_dot(direction, camera->up);
  seen[2] = vsc_dot(direction, camera->into);
}

vsc_status vsc_to_nodes(const vsc_mesh *mesh, const double *element_values, double *node_values,
                        vsc_error *error)
{
  double *count;
  if (!VSC_NEW(count, mesh->node_count)) return vsc_fail_memory(error, "a picture");
  memset(node_values, 0, mesh->node_count * sizeof *node_values);
  for (size_t e = 0; e < mesh->element_count; e++)
    for (size_t c = mesh->start[e]; c < mesh->start[e + 1]; c++) {
      node_values[mesh->corners[c]] += element_values[e];
      count[mesh->corners[c]]++;
    }
  for (size_t i = 0; i < mesh->node_count; i++) node_values[i] /= fmax(count[i], 1);
  vsc_free(count);
  return VSC_OK;
}

static vsc_status colour_nodes(const vsc_mesh *mesh, const double *values, vsc_vertex *nodes,
                               vsc_error *error)
{
  double *means;
  if (!VSC_NEW(means, mesh->node_count)) return vsc_fail_memory(error, "a picture");
  const vsc_status status = vsc_to_nodes(mesh, values, means, error);
  for (size_t i = 0; i < mesh->node_count && status == VSC_OK; i++) nodes[i].value = means[i];
  vsc_free(means);
  return status;
}

static void see_nodes(scene *s, const double *displacement)
{
  for (size_t i = 0; i < s->mesh->node_count; i++) {
    vsc_vertex *node = &s->nodes[i];
    double position[3], seen[3], d[3];
    moved(s->mesh, displacement, i, position);
    project(s->camera, position, seen);
    node->place[0] = (seen[0] - s->low[0]) * s->scale;
    node->place[1] = s->raster->height - (seen[1] - s->low[1]) * s->scale;
    node->place[2] = seen[2];
    memcpy(node->rest, s->mesh->nodes + 3 * i, sizeof node->rest);
    vsc_subtract(node->rest, s->camera->centre, d);
    s->distances[i] = s->camera->whole ? -1 : vsc_dot(d, s->camera->cut);
  }
}

// The vertex where the edge from node `a` behind the plane to node `b` before it is cut.
static vsc_vertex cut_edge(const scene *s, uint32_t a, uint32_t b)
{
  const double t = s->distances[a] / (s->distances[a] - s->distances[b]);
  return vsc_vertex_mix(&s->nodes[a], &s->nodes[b], t);
}

// The face that the plane cuts out of a tet: three or four corners.
static void draw_cut(const scene *s, const uint32_t tet[4])
{
  uint32_t behind[4], before[4];
  int m = 0, n = 0;
  for (int i = 0; i < 4; i++) {
    if (s->distances[tet[i]] <= 0)
      behind[m++] = tet[i];
    else
      before[n++] = tet[i];
  }
  if (m == 0 || n == 0) return;
  vsc_vertex face[4];
  int corners = 0;
  if (m == 2) {
    face[corners++] = cut_edge(s, behind[0], before[0]);
    face[corners++] = cut_edge(s, behind[0], before[1]);
    face[corners++] = cut_edge(s, behind[1], before[1]);
    face[corners++] = cut_edge(s, behind[1], before[0]);
  } else {
    for (int i = 0; i < 3; i++)
      face[corners++] =
          m == 1 ? cut_edge(s, behind[0], before[i]) : cut_edge(s, behind[i], before[0]);
  }
  vsc_raster_triangle(s->raster, face, VSC_KIND_CUT, shade, s);
  const vsc_vertex rest[3] = {face[0], face[2], face[3]};
  if (corners == 4) vsc_raster_triangle(s->raster, rest, VSC_KIND_CUT, shade, s);
}

// The part of a boundary triangle behind the plane.
static void draw_triangle(const scene *s, const uint32_t nodes[3], double normals[3][3])
{
  vsc_vertex corner[3], kept[4];
  int count = 0;
  for (int i = 0; i < 3; i++) {
    corner[i] = s->nodes[nodes[i]];
    memcpy(corner[i].normal, normals[i], sizeof corner[i].normal);
  }
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3;
    const double a = s->distances[nodes[i]], b = s->distances[nodes[j]];
    if (a <= 0) kept[count++] = corner[i];
    if ((a <= 0) != (b <= 0)) kept[count++] = vsc_vertex_mix(&corner[i], &corner[j], a / (a - b));
  }
  if (count < 3) return;
  vsc_raster_triangle(s->raster, kept, VSC_KIND_SURFACE, shade, s);
  const vsc_vertex rest[3] = {kept[0], kept[2], kept[3 % count]};
  if (count == 4) vsc_raster_triangle(s->raster, rest, VSC_KIND_SURFACE, shade, s);
}

// ---- normals of the boundary

// Triangles round each node: those of node i are list[start[i]] to list[start[i + 1] - 1].
typedef struct fans {
  size_t *start;
  uint32_t *list;
  double (*normals)[3];  // of the triangles, in the picture's axes, as long as twice their area
} fans;

static void free_fans(fans *f)
{
  vsc_free(f->start);
  vsc_free(f->list);
  vsc_free(f->normals);
}

static vsc_status make_fans(const vsc_mesh *mesh, const vsc_surface *boundary,
                            const vsc_camera *camera, const double *displacement, fans *f,
                            vsc_error *error)
{
  *f = (fans){0};
  if (!VSC_NEW(f->start, mesh->node_count + 2) || !VSC_NEW(f->list, 3 * boundary->count) ||
      !VSC_NEW(f->normals, boundary->count))
    return vsc_fail_memory(error, "a picture");
  for (size_t c = 0; c < 3 * boundary->count; c++) f->start[boundary->triangles[c] + 2]++;
  for (size_t i = 2; i < mesh->node_count + 2; i++) f->start[i] += f->start[i - 1];
  for (size_t c = 0; c < 3 * boundary->count; c++)
    f->list[f->start[boundary->triangles[c] + 1]++] = (uint32_t)(c / 3);
  for (size_t t = 0; t < boundary->count; t++) {
    double corner[3][3], ab[3], ac[3], normal[3];
    for (size_t k = 0; k < 3; k++)
      moved(mesh, displacement, boundary->triangles[3 * t + k], corner[k]);
    vsc_subtract(corner[1], corner[0], ab);
    vsc_subtract(corner[2], corner[0], ac);
    vsc_cross(ab, ac, normal);
    turn(camera, normal, f->normals[t]);
  }
  return VSC_OK;
}

// The normal of triangle `t` at `node`: the mean over the triangles there that meet it smoothly.
static void corner_normal(const fans *f, size_t t, uint32_t node, double normal[3])
{
  const double *own = f->normals[t];
  memcpy(normal, (double[3]){0}, 3 * sizeof *normal);
  for (size_t k = f->start[node]; k < f->start[node + 1]; k++) {
    const double *other = f->normals[f->list[k]];
    if (vsc_dot(own, other) < CREASE * vsc_norm(own) * vsc_norm(other)) continue;
    for (int c = 0; c < 3; c++) normal[c] += other[c];
  }
}

static vsc_status draw_boundary(const scene *s, const double *displacement, vsc_error *error)
{
  vsc_surface boundary = {0};
  vsc_status status = vsc_boundary(s->mesh, &boundary, error);
  if (status == VSC_OK) status = vsc_surface_flatten(&boundary, error);
  if (status != VSC_OK) {
    vsc_surface_free(&boundary);
    return status;
  }
  fans f;
  status = make_fans(s->mesh, &boundary, s->camera, displacement, &f, error);
  for (size_t t = 0; status == VSC_OK && t < boundary.count; t++) {
    double normals[3][3];
    const uint32_t *nodes = boundary.triangles + 3 * t;
    for (int k = 0; k < 3; k++) corner_normal(&f, t, nodes[k], normals[k]);
    draw_triangle(s, nodes, normals);
  }
  free_fans(&f);
  vsc_surface_free(&boundary);
  return status;
}

vsc_status vsc_view_draw(const vsc_camera *camera, const vsc_mesh *mesh, const double *displacement,
                         const double *values, double largest, const double low[2], double scale,
                         vsc_raster *raster, vsc_error *error)
{
  vsc_error own;
  if (error == NULL) error = &own;
  scene s = {camera, mesh, largest, {low[0], low[1]}, scale, NULL, NULL, raster};
  vsc_status status = VSC_OK;
  if (!VSC_NEW(s.nodes, mesh->node_count) || !VSC_NEW(s.distances, mesh->node_count))
    status = vsc_fail_memory(error, "a picture");
  if (status == VSC_OK && values != NULL) status = colour_nodes(mesh, values, s.nodes, error);
  if (status == VSC_OK) {
    see_nodes(&s, displacement);
    status = draw_boundary(&s, displacement, error);
  }
  if (status == VSC_OK) {
    for (size_t e = 0; e < mesh->element_count; e++) {
      uint32_t tets[VSC_MOST_TETS][4];
      const int count = vsc_mesh_split(mesh, e, tets);
      for (int t = 0; t < count; t++) draw_cut(&s, tets[t]);
    }
    vsc_raster_outline(raster, 4);
  }
  vsc_free(s.nodes);
  vsc_free(s.distances);
  return status;
}
