// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/shapes_liver.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "tools/shapes_bricks.h"

// A ball (a, b, c) drawn out into a liver of human size, 1.6 l: x runs from the left lobe (negative, thin)
// to the right one (thick), y from the front to the back, z from the bottom, which is hollow, to the
// top, which lies under the diaphragm:
//   t = (1 + a)/2, thick = 0.40 + 0.60 t (2 - t), wide = 0.66 + 0.34 t (2 - t)
//   x = 112 a,  y = 80 b wide,  z = 64 c thick (1 - 0.15 (1 - c)) - 14 (1 - t) + 10 b^2, mm
static void draw_out(const double ball[3], double point[3])
{
  const double a = ball[0], b = ball[1], c = ball[2], t = 0.5 * (1 + a);
  const double swell = t * (2 - t), thick = 0.40 + 0.60 * swell, wide = 0.66 + 0.34 * swell;
  point[0] = 112 * a;
  point[1] = 80 * b * wide;
  point[2] = 64 * c * thick * (1 - 0.15 * (1 - c)) - 14 * (1 - t) + 10 * b * b;
}

// ---- the organ

// A point of the cube [-1, 1]^3 drawn towards the ball, but for ROUGH of the way: at a ball's surface
// bricks would lie flat along the cube's edges.
static const double ROUGH = 0.5, CUBE = 0.82;

static void cube_to_ball(const double x[3], double ball[3])
{
  for (int i = 0; i < 3; i++) {
    const double y = x[(i + 1) % 3] * x[(i + 1) % 3], z = x[(i + 2) % 3] * x[(i + 2) % 3];
    ball[i] = x[i] * ((1 - ROUGH) * sqrt(1 - y / 2 - z / 2 + y * z / 3) + ROUGH * CUBE);
  }
}

static void place_nodes(size_t cells, vsc_mesh *mesh, vsc_array *sides[4])
{
  const size_t n = cells + 1;
  for (size_t i = 0; i < mesh->node_count; i++) {
    const size_t at[3] = {i % n, i / n % n, i / n / n};
    double cube[3], ball[3];
    for (int a = 0; a < 3; a++) cube[a] = 2 * (double)at[a] / (double)cells - 1;
    cube_to_ball(cube, ball);
    draw_out(ball, mesh->nodes + 3 * i);
    sides[0]->values[i] = at[2] == cells;
    sides[1]->values[i] = at[2] == 0;
    sides[2]->values[i] = at[1] == 0;
    sides[3]->values[i] = at[1] == cells && fabs(cube[0]) < 0.6 && fabs(cube[2]) < 0.75;
  }
}

static void cut_bricks(size_t cells, vsc_mesh *mesh)
{
  const size_t box[3] = {cells, cells, cells};
  for (size_t b = 0; b < cells * cells * cells; b++) {
    uint32_t corner[8];
    const bool mirrored = vsc_brick_corners(box, b, corner);
    vsc_brick_cut(corner, 5, mirrored, mesh->corners + 20 * b);
  }
}

vsc_status vsc_liver_mesh(size_t cells, vsc_mesh **mesh, vsc_error *error)
{
  static const char *const names[4] = {"top", "bottom", "front", "back"};
  if (cells < 2 || cells > 200)
    return vsc_fail(error, VSC_INPUT, "liver: %zu bricks a side; give 2 to 200", cells);
  const size_t nodes = (cells + 1) * (cells + 1) * (cells + 1);
  vsc_mesh *made = vsc_mesh_create(nodes, 5 * cells * cells * cells, 0);
  bool good = made != NULL;
  for (int s = 0; s < 4 && good; s++)
    good = vsc_arrays_add(&made->node_data, names[s], 1, nodes) != NULL;
  if (!good || !vsc_region_add(made)) {
    vsc_mesh_free(made);
    return vsc_fail_memory(error, "the liver");
  }
  vsc_array *sides[4];
  for (int s = 0; s < 4; s++) sides[s] = &made->node_data.items[s];
  place_nodes(cells, made, sides);
  cut_bricks(cells, made);
  *mesh = made;
  return VSC_OK;
}

// ---- the vessels

enum { GENERATIONS = 5, PIECES = 4, BRANCHES = (1 << GENERATIONS) - 1 };
static const double WITHIN = 0.86;    // of the ball's radius: no vessel leaves it
static const double SHORTER = 0.78;   // a branch and its parent
static const double SPREAD = 0.62;    // half the angle between two branches, radians

typedef struct grower {
  vsc_polydata *tree;
  double *radius;
  size_t points, segments;
} grower;

static void add_point(grower *g, const double ball[3], double radius, bool joined)
{
  draw_out(ball, g->tree->points + 3 * g->points);
  g->radius[g->points] = radius;
  if (joined) {
    g->tree->segments[2 * g->segments] = (uint32_t)g->points - 1;
    g->tree->segments[2 * g->segments + 1] = (uint32_t)g->points;
    g->segments++;
  }
  g->points++;
}

// A branch from `start` (in the ball) along `way`, of the plane with the normal `normal`, and all that
// come of it.
static void grow(grower *g, const double start[3], const double way[3], const double normal[3],
                 double length, double radius, int generation)
{
  double at[3], aside[3];
  memcpy(at, start, sizeof at);
  add_point(g, at, radius, false);
  for (int p = 0; p < PIECES; p++) {
    double next[3];
    for (int i = 0; i < 3; i++) next[i] = at[i] + length / PIECES * way[i];
    const double out = vsc_norm(next);
    for (int i = 0; i < 3; i++) at[i] = out > WITHIN ? next[i] * WITHIN / out : next[i];
    add_point(g, at, radius, true);
  }
  if (generation + 1 == GENERATIONS) return;
  vsc_cross(normal, way, aside);
  const double thin = radius * cbrt(0.5);
  for (int side = -1; side <= 1; side += 2) {
    double branch[3];
    for (int i = 0; i < 3; i++)
      branch[i] = cos(SPREAD) * way[i] + side * sin(SPREAD) * aside[i];
    // the next fork lies in the plane across this one
    grow(g, at, branch, aside, SHORTER * length, thin, generation + 1);
  }
}

vsc_status vsc_liver_vessels(vsc_liver_tree kind, vsc_polydata **tree, vsc_error *error)
{
  const size_t points = BRANCHES * (PIECES + 1), segments = BRANCHES * PIECES;
  vsc_polydata *made = vsc_polydata_create(points, 0, segments);
  vsc_array *radius = made ? vsc_arrays_add(&made->point_data, "radius", 1, points) : NULL;
  if (radius == NULL) {
    vsc_polydata_free(made);
    return vsc_fail_memory(error, "the vessels");
  }
  grower g = {.tree = made, .radius = radius->values};
  if (kind == VSC_PORTAL_TREE)
    grow(&g, (const double[3]){0.05, 0.1, -0.8}, (const double[3]){0, 0, 1},
         (const double[3]){0, 1, 0}, 0.55, 6.5, 0);
  else
    grow(&g, (const double[3]){0.1, 0.72, 0.4}, (const double[3]){0, -0.9578263, -0.2873479},
         (const double[3]){0, -0.2873479, 0.9578263}, 0.5, 8, 0);
  *tree = made;
  return VSC_OK;
}
