// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/shapes_cloud.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "io/vtk_delaunay.h"
#include "tools/shapes_bricks.h"

enum {
  CANDIDATES = 40,  // of which the farthest from all points becomes the next one
  SMOOTHINGS = 4,
  ROUNDS = 200,
};
static const double SOUND = 0.2;  // shape of the worst tet: 1 is regular, 0 flat

typedef struct cloud {
  const vsc_cloud_shape *shape;
  double spacing;   // mm
  size_t count;     // points so far
  double *points;   // shape->points x 3
  uint8_t *places;  // shape->points: bits 0 to 5 for the faces x0 x1 y0 y1 z0 z1 that hold it
  size_t tet_count;
  uint32_t *tets;
  gsl_rng *random;
} cloud;

vsc_cloud_shape vsc_cloud_default(void)
{
  return (vsc_cloud_shape){.size = {10, 10, 10}, .points = 400, .seed = 1};
}

// ---- Points

// Pieces of the edges along `axis`.
static size_t pieces(const cloud *c, int axis)
{
  return (size_t)fmax(1, round(c->shape->size[axis] / c->spacing));
}

static double face_area(const cloud *c, int axis)
{
  return c->shape->size[(axis + 1) % 3] * c->shape->size[(axis + 2) % 3];
}

// Points inside a face across `axis`: one for each triangle pair of edge `spacing`, less its rim.
static size_t on_face(const cloud *c, int axis)
{
  const double per_area = 2 / (sqrt(3) * c->spacing * c->spacing);
  const size_t rim = pieces(c, (axis + 1) % 3) + pieces(c, (axis + 2) % 3);
  return (size_t)fmax(0, round(face_area(c, axis) * per_area - (double)rim - 1));
}

static size_t on_surface(const cloud *c)
{
  size_t count = 8;
  for (int a = 0; a < 3; a++) count += 4 * (pieces(c, a) - 1) + 2 * on_face(c, a);
  return count;
}

// Points in all: 1.2 in a cube of the spacing (1.41 in the densest lattice), and half of those on
// the surface.
static double wanted(const cloud *c)
{
  const double *size = c->shape->size, h = c->spacing;
  return 1.2 * size[0] * size[1] * size[2] / (h * h * h) + 0.5 * (double)on_surface(c);
}

static void add_point(cloud *c, const double at[3])
{
  double *x = c->points + 3 * c->count;
  for (int a = 0; a < 3; a++) {
    x[a] = at[a];
    if (x[a] == 0) c->places[c->count] |= (uint8_t)(1 << 2 * a);
    if (x[a] == c->shape->size[a]) c->places[c->count] |= (uint8_t)(2 << 2 * a);
  }
  c->count++;
}

static double nearest(const cloud *c, const double at[3])
{
  double least = INFINITY;
  for (size_t i = 0; i < c->count; i++) {
    double apart[3];
    vsc_subtract(at, c->points + 3 * i, apart);
    least = fmin(least, vsc_dot(apart, apart));
  }
  return least;
}

// Adds the candidate that is farthest from all points; axis and side say on which face, -1: inside.
static void scatter_point(cloud *c, int axis, int side)
{
  double best[3], farthest = -1;
  for (int k = 0; k < CANDIDATES; k++) {
    double at[3];
    const double margin = 0.35 * c->spacing;
    for (int a = 0; a < 3; a++) {
      const double room = fmax(c->shape->size[a] - 2 * margin, 0);
      at[a] = (c->shape->size[a] - room) / 2 + room * gsl_rng_uniform(c->random);
      if (a == axis) at[a] = side == 0 ? 0 : c->shape->size[a];
    }
    const double distance = nearest(c, at);
    if (distance <= farthest) continue;
    farthest = distance;
    memcpy(best, at, sizeof best);
  }
  add_point(c, best);
}

static void place_edges(cloud *c)
{
  const double *size = c->shape->size;
  for (int corner = 0; corner < 8; corner++)
    add_point(c, (double[3]){corner & 1 ? size[0] : 0, corner & 2 ? size[1] : 0,
                             corner & 4 ? size[2] : 0});
  for (int a = 0; a < 3; a++) {
    const size_t steps = pieces(c, a);
    for (int edge = 0; edge < 4; edge++)
      for (size_t k = 1; k < steps; k++) {
        double at[3];
        at[a] = size[a] * (double)k / (double)steps;
        at[(a + 1) % 3] = edge & 1 ? size[(a + 1) % 3] : 0;
        at[(a + 2) % 3] = edge & 2 ? size[(a + 2) % 3] : 0;
        add_point(c, at);
      }
  }
}

static vsc_status place_points(cloud *c, vsc_error *error)
{
  const double *size = c->shape->size;
  const double longest = fmax(size[0], fmax(size[1], size[2]));
  c->spacing = longest;
  while (wanted(c) < (double)c->shape->points) c->spacing *= 0.99;
  while (on_surface(c) + 1 > c->shape->points && c->spacing < 4 * longest) c->spacing *= 1.01;
  if (on_surface(c) + 1 > c->shape->points)
    return vsc_fail(error, VSC_INPUT,
                    "unstructured block: %zu points are too few for a box of %g x %g x %g mm",
                    c->shape->points, size[0], size[1], size[2]);
  place_edges(c);
  for (int a = 0; a < 3; a++)
    for (int side = 0; side < 2; side++)
      for (size_t k = on_face(c, a); k > 0; k--) scatter_point(c, a, side);
  while (c->count < c->shape->points) scatter_point(c, -1, 0);
  return VSC_OK;
}

// ---- Tets

// 6 sqrt(2) V over the cube of the root mean square of the edges.
static double shape_of(const cloud *c, const uint32_t tet[4])
{
  static const int edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  double edge[6][3], across[3], square = 0;
  for (int i = 0; i < 6; i++) {
    vsc_subtract(c->points + 3 * (size_t)tet[edges[i][1]], c->points + 3 * (size_t)tet[edges[i][0]],
                 edge[i]);
    square += vsc_dot(edge[i], edge[i]) / 6;
  }
  vsc_cross(edge[0], edge[1], across);
  return sqrt(2) * vsc_dot(across, edge[2]) / (square * sqrt(square));
}

// The points of a box whose faces bulge a little: no five of them on a plane, which VTK wants. What
// was on a face stays outside.
static double *bulging(const cloud *c)
{
  const double bulge = 0.01;
  double *points;
  if (!VSC_NEW(points, 3 * c->count)) return NULL;
  for (size_t i = 0; i < c->count; i++) {
    double part[3];
    for (int a = 0; a < 3; a++) part[a] = 2 * c->points[3 * i + (size_t)a] / c->shape->size[a] - 1;
    const double square = vsc_dot(part, part);
    for (int a = 0; a < 3; a++)
      points[3 * i + (size_t)a] =
          c->shape->size[a] / 2 * part[a] * (1 + bulge * (2 - square + part[a] * part[a]));
  }
  return points;
}

// Tetrahedralises, without the flat tets on faces.
static vsc_status connect(cloud *c, vsc_error *error)
{
  vsc_free(c->tets);
  c->tets = NULL;
  double *points = bulging(c);
  if (points == NULL) return vsc_fail_memory(error, "an unstructured block");
  const vsc_status status = vsc_vtk_delaunay(c->count, points, &c->tet_count, &c->tets, error);
  vsc_free(points);
  if (status != VSC_OK) return status;
  size_t kept = 0;
  for (size_t t = 0; t < c->tet_count; t++) {
    const uint32_t *tet = c->tets + 4 * t;
    if (c->places[tet[0]] & c->places[tet[1]] & c->places[tet[2]] & c->places[tet[3]]) continue;
    memmove(c->tets + 4 * kept++, tet, 4 * sizeof *tet);
  }
  c->tet_count = kept;
  return VSC_OK;
}

// Moves a point along the axes across which it lies on no face.
static void move_point(cloud *c, size_t point, const double to[3])
{
  for (int a = 0; a < 3; a++)
    if ((c->places[point] >> 2 * a & 3) == 0) c->points[3 * point + (size_t)a] = to[a];
}

static bool on_an_edge(uint8_t places)
{
  int faces = 0;
  for (int bit = 0; bit < 6; bit++) faces += places >> bit & 1;
  return faces > 1;
}

// Moves points to the mean of those neighbours that lie on all of their faces.
static bool smooth(cloud *c)
{
  double *sums;
  if (!VSC_NEW(sums, 4 * c->count)) return false;
  for (size_t t = 0; t < c->tet_count; t++)
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) {
        const uint32_t own = c->tets[4 * t + (size_t)i], other = c->tets[4 * t + (size_t)j];
        if (i == j || (c->places[own] & ~c->places[other])) continue;
        for (int a = 0; a < 3; a++) sums[4 * own + (size_t)a] += c->points[3 * other + (size_t)a];
        sums[4 * own + 3]++;
      }
  for (size_t i = 0; i < c->count; i++) {
    if (on_an_edge(c->places[i]) || sums[4 * i + 3] == 0) continue;
    double to[3];
    for (int a = 0; a < 3; a++) to[a] = sums[4 * i + (size_t)a] / sums[4 * i + 3];
    move_point(c, i, to);
  }
  vsc_free(sums);
  return true;
}

// Shakes the corners of all tets that are too flat; returns how many there are.
static size_t shake(cloud *c)
{
  size_t flat = 0;
  for (size_t t = 0; t < c->tet_count; t++) {
    const uint32_t *tet = c->tets + 4 * t;
    if (shape_of(c, tet) >= SOUND) continue;
    flat++;
    for (int i = 0; i < 4; i++) {
      double to[3];
      if (on_an_edge(c->places[tet[i]])) continue;
      for (int a = 0; a < 3; a++) {
        const double room = c->shape->size[a], step = 0.15 * c->spacing;
        to[a] = c->points[3 * tet[i] + (size_t)a] + step * (2 * gsl_rng_uniform(c->random) - 1);
        to[a] = fmin(fmax(to[a], fmin(step, 0.5 * room)), fmax(room - step, 0.5 * room));
      }
      move_point(c, tet[i], to);
    }
  }
  return flat;
}

// The tets fill the box and hold all points; `used` (count) is for its own use.
static bool fills_box(const cloud *c, uint8_t *used)
{
  memset(used, 0, c->count);
  for (size_t k = 0; k < 4 * c->tet_count; k++) used[c->tets[k]] = 1;
  if (memchr(used, 0, c->count) != NULL) return false;
  const double *size = c->shape->size, box = size[0] * size[1] * size[2];
  double volume = 0;
  for (size_t t = 0; t < c->tet_count; t++) {
    const uint32_t *tet = c->tets + 4 * t;
    double edge[3][3], across[3];
    for (int i = 0; i < 3; i++)
      vsc_subtract(c->points + 3 * (size_t)tet[i + 1], c->points + 3 * (size_t)tet[0], edge[i]);
    vsc_cross(edge[0], edge[1], across);
    volume += vsc_dot(across, edge[2]) / 6;
  }
  return fabs(volume - box) < 1e-10 * box;
}

static vsc_status make_tets(cloud *c, vsc_error *error)
{
  uint8_t *used;
  if (!VSC_NEW(used, c->count)) return vsc_fail_memory(error, "an unstructured block");
  vsc_status status = VSC_OK;
  bool sound = false;
  for (int round = 0; round < ROUNDS && status == VSC_OK && !sound; round++) {
    status = connect(c, error);
    if (status != VSC_OK) break;
    if (round >= SMOOTHINGS)
      sound = shake(c) == 0 && fills_box(c, used);
    else if (!smooth(c))
      status = vsc_fail_memory(error, "smoothing a block");
  }
  vsc_free(used);
  if (status != VSC_OK || sound) return status;
  return vsc_fail(error, VSC_NUMERICAL,
                  "unstructured block: %zu points with seed %lu give no sound tets, try another "
                  "seed or number",
                  c->shape->points, c->shape->seed);
}

// ---- The mesh

static vsc_status build(const cloud *c, vsc_mesh **result, vsc_error *error)
{
  static const char *const names[6] = {"x0", "x1", "y0", "y1", "z0", "z1"};
  vsc_mesh *mesh = NULL;
  const vsc_status status =
      vsc_mesh_from_arrays(c->count, c->points, c->tet_count, c->tets, &mesh, error);
  if (status != VSC_OK) return status;
  bool complete = mesh->node_count == c->count;
  for (int a = 0; a < 6 && complete; a++) {
    vsc_array *array = vsc_arrays_add(&mesh->node_data, names[a], 1, c->count);
    complete = array != NULL;
    for (size_t i = 0; i < c->count && complete; i++) array->values[i] = c->places[i] >> a & 1;
  }
  if (!complete || !vsc_region_add(mesh)) {
    vsc_mesh_free(mesh);
    return vsc_fail_memory(error, "the block's arrays");
  }
  *result = mesh;
  return VSC_OK;
}

static vsc_status check(const vsc_cloud_shape *shape, vsc_error *error)
{
  for (int a = 0; a < 3; a++)
    if (!(shape->size[a] > 0 && isfinite(shape->size[a])))
      return vsc_fail(error, VSC_INPUT, "unstructured block: size %g mm along %c, must be above 0",
                      shape->size[a], 'x' + a);
  if (shape->points < 9 || shape->points > 100000)
    return vsc_fail(error, VSC_INPUT, "unstructured block: %zu points, must be 9 to 100000",
                    shape->points);
  return VSC_OK;
}

vsc_status vsc_cloud_mesh(const vsc_cloud_shape *shape, vsc_mesh **mesh, vsc_error *error)
{
  vsc_status status = check(shape, error);
  if (status != VSC_OK) return status;
  cloud c = {.shape = shape, .random = gsl_rng_alloc(gsl_rng_mt19937)};
  if (c.random == NULL || !VSC_NEW(c.points, 3 * shape->points) ||
      !VSC_NEW(c.places, shape->points))
    status = vsc_fail_memory(error, "an unstructured block");
  if (status == VSC_OK) {
    gsl_rng_set(c.random, shape->seed);
    status = place_points(&c, error);
  }
  if (status == VSC_OK) status = make_tets(&c, error);
  if (status == VSC_OK) status = build(&c, mesh, error);
  if (c.random != NULL) gsl_rng_free(c.random);
  vsc_free(c.points);
  vsc_free(c.places);
  vsc_free(c.tets);
  return status;
}
