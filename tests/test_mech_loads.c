// SPDX-License-Identifier: GPL-3.0-or-later
// Pressures that follow faces of three and six nodes, their tangent, springs and dashpots on surfaces.
#include "mech/loads.h"

#include "base/mem.h"
#include "base/vec3.h"
#include "model/robin.h"
#include "octahedron.h"

#define PRESSURE 3.0
enum { COUNT = 4 * OCTA_NODES };

// Triangles that count whole, with middles or without.
static vsc_facets facets_of(size_t count, uint32_t *corners, uint32_t *mid)
{
  return (vsc_facets){.count = count, .whole = count, .corners = corners, .mid = mid};
}

// A model that is nothing but loads on an octahedron.
typedef struct loaded {
  octahedron o;
  vsc_pressure pressure;
  vsc_robin robin;
  vsc_model model;
  double *x, *v, *rest, *pull, *force;  // aligned
} loaded;

static void open_loaded(loaded *l, double noise)
{
  memset(l, 0, sizeof *l);
  octahedron_make(&l->o, noise, 7);
  if (!VSC_NEW(l->x, COUNT) || !VSC_NEW(l->v, COUNT) || !VSC_NEW(l->rest, COUNT) ||
      !VSC_NEW(l->pull, COUNT) || !VSC_NEW(l->force, COUNT))
    fail_msg("no memory");
  memcpy(l->x, l->o.x, COUNT * sizeof *l->x);
  memcpy(l->rest, l->o.x, COUNT * sizeof *l->rest);
  l->model.rest = l->rest;
  l->model.node_count = OCTA_NODES;
}

static void push(loaded *l, int nodes)
{
  const vsc_curve_def constant = vsc_default_curve(VSC_CURVE_CONSTANT);
  l->pressure = (vsc_pressure){.facets = facets_of(OCTA_FACES, l->o.triangles, nodes == 6 ? l->o.mid : NULL),
                               .rule = vsc_face_rule_of(nodes, VSC_FACE_FLUX),
                               .peak = PRESSURE};
  if (vsc_curve_build(&constant, 1, &l->pressure.curve, NULL) != VSC_OK) fail_msg("no memory");
  l->model.pressure_count = 1;
  l->model.pressures = &l->pressure;
}

static void lay(loaded *l, int nodes, bool normal, double stiffness, double damping)
{
  l->robin = (vsc_robin){.normal = normal, .stiffness = stiffness, .damping = damping};
  const vsc_facets facets = facets_of(OCTA_FACES, l->o.triangles, nodes == 6 ? l->o.mid : NULL);
  if (vsc_robin_fill(l->rest, &facets, &l->robin, NULL) != VSC_OK) fail_msg("no memory");
  l->model.robin_count = 1;
  l->model.robins = &l->robin;
}

static void forces(loaded *l)
{
  memset(l->force, 0, COUNT * sizeof *l->force);
  vsc_loads_push(&l->model, l->x, 0, 1, l->force);
  vsc_loads_hold(&l->model, l->x, l->v, l->pull, l->force);
}

static void close_loaded(loaded *l)
{
  vsc_curve_free(&l->pressure.curve);
  vsc_robin_free(&l->robin);
  vsc_free(l->x);
  vsc_free(l->v);
  vsc_free(l->rest);
  vsc_free(l->pull);
  vsc_free(l->force);
}

// f = -p dV/dx. The volume is linear in each coordinate of one node, so differences are exact.
static void pressure_is_the_gradient_of_volume(void **state)
{
  (void)state;
  for (int nodes = 3; nodes <= 6; nodes += 3) {
    loaded l;
    open_loaded(&l, 0.2);
    push(&l, nodes);
    forces(&l);
    for (int i = 0; i < COUNT; i++) {
      const double kept = l.o.x[i], h = 0.1;
      if (i % 4 == 3) continue;
      l.o.x[i] = kept + h;
      const double more = octahedron_volume(&l.o, nodes);
      l.o.x[i] = kept - h;
      const double less = octahedron_volume(&l.o, nodes);
      l.o.x[i] = kept;
      assert_close(l.force[i], -PRESSURE * (more - less) / (2 * h), 0, 1e-13);  // rounding
    }
    close_loaded(&l);
  }
}

// A pressure all round neither pushes nor turns.
static void closed_surfaces_are_not_moved(void **state)
{
  (void)state;
  for (int nodes = 3; nodes <= 6; nodes += 3) {
    loaded l;
    double sum[3] = {0}, turn[3] = {0}, size = 0;
    open_loaded(&l, 0.2);
    push(&l, nodes);
    forces(&l);
    for (int n = 0; n < OCTA_NODES; n++) {
      double moment[3];
      vsc_cross(l.x + 4 * n, l.force + 4 * n, moment);
      for (int k = 0; k < 3; k++) {
        sum[k] += l.force[4 * n + k];
        turn[k] += moment[k];
        size += fabs(l.force[4 * n + k]);
      }
    }
    assert_true(size > 1);
    for (int k = 0; k < 3; k++) {
      assert_close(sum[k], 0, 0, 1e-15 * size);
      assert_close(turn[k], 0, 0, 1e-15 * size);
    }
    close_loaded(&l);
  }
}

// Both with three nodes: the flat formula -(x_1 - x_0) x (x_2 - x_0)/6.
static void three_nodes_share_the_face(void **state)
{
  (void)state;
  static const double x[3][3] = {{1, 2, 3}, {2, 5, 1}, {0, 1, 7}};
  const vsc_face_rule rule = vsc_face_rule_of(3, VSC_FACE_FLUX);
  double f[3][3], first[3], second[3], n[3];
  vsc_subtract(x[1], x[0], first);
  vsc_subtract(x[2], x[0], second);
  vsc_cross(first, second, n);
  vsc_face_push(&rule, x, f);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) assert_close(f[i][k], -n[k] / 6, 1e-15, 1e-15);
}

// K_ij = -df_i/dx_j, not symmetrised. Forces are linear in each coordinate of one node: exact.
static void tangent_is_the_difference_of_forces(void **state)
{
  (void)state;
  for (int nodes = 3; nodes <= 6; nodes += 3) {
    const vsc_face_rule rule = vsc_face_rule_of(nodes, VSC_FACE_FLUX);
    uint64_t seed = 11;
    double x[6][3], more[6][3], less[6][3], K[6][VSC_FACE_NODES][9], h = 0.1;
    random_fill(&seed, 1, x[0], 18);
    vsc_face_push_tangent(&rule, (const double(*)[3])x, K);
    for (int j = 0; j < nodes; j++)
      for (int c = 0; c < 3; c++) {
        const double kept = x[j][c];
        x[j][c] = kept + h;
        vsc_face_push(&rule, (const double(*)[3])x, more);
        x[j][c] = kept - h;
        vsc_face_push(&rule, (const double(*)[3])x, less);
        x[j][c] = kept;
        for (int i = 0; i < nodes; i++)
          for (int r = 0; r < 3; r++)
            assert_close(K[i][j][3 * r + c], -(more[i][r] - less[i][r]) / (2 * h), 0, 1e-13);
      }
  }
}

typedef double dense[COUNT][COUNT];

static void sink(void *context, uint32_t i, uint32_t j, const double K[9])
{
  dense *matrix = context;
  for (uint32_t r = 0; r < 3; r++)
    for (uint32_t c = 0; c < 3; c++) (*matrix)[4 * i + r][4 * j + c] += K[3 * r + c];
}

// D_ij = -(a df_i/dx_j + b df_i/dv_j): linear in h, so exact.
static void difference(loaded *l, double load, double a, double b, dense *D)
{
  const double h = 0.1;
  for (int j = 0; j < COUNT; j++) {
    double f[2][COUNT] = {{0}};
    for (int side = 0; side < 2 && j % 4 < 3; side++) {
      const double way = side == 0 ? h : -h;
      l->x[j] += a * way;
      l->v[j] += b * way;
      memset(l->force, 0, COUNT * sizeof *l->force);
      vsc_loads_push(&l->model, l->x, 0, load, l->force);
      vsc_loads_hold(&l->model, l->x, l->v, l->pull, l->force);
      memcpy(f[side], l->force, sizeof f[side]);
      l->x[j] -= a * way;
      l->v[j] -= b * way;
    }
    for (int i = 0; i < COUNT; i++) (*D)[i][j] = -(f[0][i] - f[1][i]) / (2 * h);
  }
}

// What is handed out is the symmetric part of the derivative: all of it on a closed surface, less on one with
// a free rim.
static void all_blocks_are_the_derivative_of_the_force(void **state)
{
  (void)state;
  static dense K, D;
  for (int kind = 0; kind < 8; kind++) {
    const int nodes = kind & 1 ? 6 : 3;
    const bool normal = kind & 2, open = kind & 4;
    loaded l;
    double askew = 0;
    uint64_t seed = 13;
    open_loaded(&l, 0.2);
    push(&l, nodes);
    lay(&l, nodes, normal, 5, 7);
    l.pressure.facets.whole = l.pressure.facets.count -= open;
    for (int i = 0; i < COUNT; i++) l.x[i] += i % 4 < 3 ? random_between(&seed, -0.1, 0.1) : 0;
    memset(K, 0, sizeof K);
    vsc_loads_tangent(&l.model, l.x, 0, 0.5, 2, 3, sink, &K);
    difference(&l, 0.5, 2, 3, &D);
    for (int i = 0; i < COUNT; i++)
      for (int j = 0; j < COUNT; j++) {
        assert_close(K[i][j], (D[i][j] + D[j][i]) / 2, 0, 1e-12);
        assert_close(K[i][j], K[j][i], 0, 1e-14);  // order of sums
        askew = fmax(askew, fabs(D[i][j] - D[j][i]));
      }
    assert_true(open ? askew > 0.1 : askew < 1e-12);
    close_loaded(&l);
  }
}

// f = -grad E of the springs, and -v . f is what the dashpots dissipate.
static void beds_store_and_dissipate(void **state)
{
  (void)state;
  for (int nodes = 3; nodes <= 6; nodes += 3)
    for (int normal = 0; normal < 2; normal++) {
      loaded l;
      const double h = 0.1;
      uint64_t seed = 17;
      open_loaded(&l, 0.2);
      lay(&l, nodes, normal, 5, 0);
      for (int i = 0; i < COUNT; i++) l.x[i] += i % 4 < 3 ? random_between(&seed, -0.5, 0.5) : 0;
      forces(&l);
      for (int i = 0; i < COUNT; i++) {
        if (i % 4 == 3) continue;
        l.x[i] += h;
        const double more = vsc_loads_energy(&l.model, l.x);
        l.x[i] -= 2 * h;
        const double less = vsc_loads_energy(&l.model, l.x);
        l.x[i] += h;
        assert_close(l.force[i], -(more - less) / (2 * h), 0, 1e-13);  // quadratic: exact
      }
      assert_close(vsc_loads_dissipation(&l.model, l.v), 0, 0, 0);
      memcpy(l.x, l.rest, COUNT * sizeof *l.x);
      l.robin.damping = 7;
      for (int i = 0; i < COUNT; i++) l.v[i] = i % 4 < 3 ? random_between(&seed, -1, 1) : 0;
      forces(&l);
      double power = 0;
      for (int i = 0; i < COUNT; i++) power -= l.v[i] * l.force[i];
      assert_true(power > 1);
      assert_close(vsc_loads_dissipation(&l.model, l.v), power, 1e-14, 0);
      close_loaded(&l);
    }
}

// A surface that is moved as a whole by u feels -stiffness u per area in all, or -stiffness int N N^T dA u.
static void rigid_motion_meets_the_area(void **state)
{
  (void)state;
  static const double u[3] = {0.3, -0.2, 0.5};
  for (int normal = 0; normal < 2; normal++) {
    loaded l;
    double sum[3] = {0};
    open_loaded(&l, 0);
    lay(&l, 3, normal, 5, 0);
    assert_close(l.robin.area, 4 * sqrt(3), 1e-14, 0);  // eight triangles of sides sqrt 2
    for (int n = 0; n < OCTA_CORNERS; n++)
      for (int k = 0; k < 3; k++) l.x[4 * n + k] += u[k];
    forces(&l);
    for (int n = 0; n < OCTA_NODES; n++)
      for (int k = 0; k < 3; k++) sum[k] += l.force[4 * n + k];
    // the octahedron's normals are (+-1, +-1, +-1)/sqrt 3: int N N^T dA is a third of the area
    for (int k = 0; k < 3; k++)
      assert_close(sum[k], -5 * 4 * sqrt(3) * u[k] / (normal ? 3 : 1), 1e-14, 0);
    close_loaded(&l);
  }
}

// A triangle's matrix is A/12 (1 + delta_ij).
static void three_nodes_have_the_known_matrix(void **state)
{
  (void)state;
  uint32_t triangle[3] = {0, 1, 2};
  const vsc_facets facets = facets_of(1, triangle, NULL);
  double *rest, area = 6;
  vsc_robin robin = {.normal = true};
  assert_true(VSC_NEW(rest, 12));
  rest[4] = 3;
  rest[9] = 4;
  assert_int_equal(vsc_robin_fill(rest, &facets, &robin, NULL), VSC_OK);
  assert_int_equal(robin.node_count, 3);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int c = 0; c < 3; c++)
        for (int r = 0; r < 4; r++)
          assert_close(robin.blocks[12 * (3 * i + j) + 4 * c + r],
                       c == 2 && r == 2 ? area / 12 * (i == j ? 2 : 1) : 0, 0, 1e-14);
  vsc_robin_free(&robin);
  vsc_free(rest);
}

// Along the normal at rest only: what slides on a flat face is free.
static void sliding_is_free(void **state)
{
  (void)state;
  uint32_t triangle[3] = {0, 1, 2}, mid[3] = {3, 4, 5};
  const vsc_facets facets = facets_of(1, triangle, mid);
  static const double corner[6][2] = {{0, 0}, {3, 0}, {0, 4}, {1.5, 0}, {1.5, 2}, {0, 2}};
  loaded l;
  open_loaded(&l, 0);
  for (int n = 0; n < 6; n++) {
    for (int k = 0; k < 2; k++) l.rest[4 * n + k] = corner[n][k];
    l.rest[4 * n + 2] = 1;
  }
  l.robin = (vsc_robin){.normal = true, .stiffness = 5, .damping = 7};
  assert_int_equal(vsc_robin_fill(l.rest, &facets, &l.robin, NULL), VSC_OK);
  l.model.robin_count = 1;
  l.model.robins = &l.robin;
  memcpy(l.x, l.rest, COUNT * sizeof *l.x);
  for (int n = 0; n < 6; n++)
    for (int k = 0; k < 2; k++) {
      l.x[4 * n + k] += 0.3 * n + k;
      l.v[4 * n + k] = 1 - 0.2 * n * k;
    }
  forces(&l);
  for (int i = 0; i < COUNT; i++) assert_close(l.force[i], 0, 0, 1e-13);  // rounding
  for (int n = 0; n < 6; n++) l.x[4 * n + 2] = 1.5;
  forces(&l);
  double sum = 0;
  for (int n = 0; n < 6; n++) sum += l.force[4 * n + 2];
  assert_close(sum, -5 * 6 * 0.5, 1e-14, 0);
  close_loaded(&l);
}

// The area of the round octahedron and int (X . N)^2 dA, by Gauss's points of its own.
static void measure_round(const octahedron *o, double *area, double *square)
{
  double x[3], t1[3], t2[3], n[3];
  *area = *square = 0;
  for (int face = 0; face < OCTA_FACES; face++)
    for (int p = 0; p < 25; p++) {
      double u, v, weight;
      octahedron_point(p, &u, &v, &weight);
      octahedron_place(o, face, 6, u, v, x, t1, t2);
      vsc_cross(t1, t2, n);
      *area += weight * vsc_norm(n);
      *square += weight * vsc_dot(x, n) * vsc_dot(x, n) / vsc_norm(n);
    }
}

// The normal varies over curved faces: where a ball's surface grows by 0.1 X, the springs along its normals
// store stiffness/2 int (0.1 X . N)^2 dA.
static void curved_faces_have_curved_normals(void **state)
{
  (void)state;
  loaded l;
  double area, square;
  open_loaded(&l, 0);
  octahedron_round(&l.o);
  memcpy(l.rest, l.o.x, COUNT * sizeof *l.rest);
  lay(&l, 6, true, 5, 0);
  for (int i = 0; i < COUNT; i++) l.x[i] = 1.1 * l.rest[i];
  measure_round(&l.o, &area, &square);
  // no polynomials: both rules are near only; one normal for each face would be 30 % off
  assert_close(l.robin.area, area, 1e-3, 0);
  assert_close(vsc_loads_energy(&l.model, l.x), 5 * 0.01 * square / 2, 1e-3, 0);
  close_loaded(&l);
}

static double area_at_rest(const loaded *l)
{
  double area = 0;
  for (int face = 0; face < OCTA_FACES; face++) {
    double a[3], b[3], n[3];
    const double *corner[3];
    for (int i = 0; i < 3; i++) corner[i] = l->rest + 4 * l->o.triangles[3 * face + i];
    vsc_subtract(corner[1], corner[0], a);
    vsc_subtract(corner[2], corner[0], b);
    vsc_cross(a, b, n);
    area += 0.5 * vsc_norm(n);
  }
  return area;
}

static void no_block(void *context, uint32_t i, uint32_t j, const double K[9])
{
  (void)i, (void)j, (void)K;
  ++*(int *)context;
}

// A dead traction: the whole force is traction times area at rest, wherever the nodes have gone; it has no tangent;
// its work is that of its forces.
static void dead_tractions_stay(void **state)
{
  (void)state;
  for (int nodes = 3; nodes <= 6; nodes += 3) {
    loaded l;
    double kept[COUNT], sum[3] = {0}, bulk[VSC_FACE_NODES * OCTA_FACES * 6] = {0};
    int blocks = 0;
    open_loaded(&l, 0);
    push(&l, nodes);
    const double way[3] = {2.0 / 3, -2.0 / 3, 1.0 / 3};
    memcpy(l.pressure.direction, way, sizeof way);
    forces(&l);
    memcpy(kept, l.force, sizeof kept);
    for (size_t n = 0; n < OCTA_NODES; n++)
      for (size_t i = 0; i < 3; i++) sum[i] += l.force[4 * n + i];
    for (int i = 0; i < 3; i++) assert_close(sum[i], PRESSURE * area_at_rest(&l) * way[i], 1e-13, 0);
    vsc_loads_pressure_work(&l.model, l.x, 0, bulk);
    double expected = 0;
    for (size_t k = 0; k < COUNT; k++) {
      const double step = k % 4 < 3 ? 0.3 * sin(1.7 * (double)k) : 0;
      l.x[k] += step;
      expected += step * kept[k];
    }
    forces(&l);
    assert_memory_equal(l.force, kept, sizeof kept);
    assert_close(vsc_loads_pressure_work(&l.model, l.x, 0, bulk), expected, 1e-12, 0);
    vsc_loads_tangent(&l.model, l.x, 0, 1, 1, 0, no_block, &blocks);
    assert_int_equal(blocks, 0);
    close_loaded(&l);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pressure_is_the_gradient_of_volume),
      cmocka_unit_test(closed_surfaces_are_not_moved),
      cmocka_unit_test(dead_tractions_stay),
      cmocka_unit_test(three_nodes_share_the_face),
      cmocka_unit_test(tangent_is_the_difference_of_forces),
      cmocka_unit_test(all_blocks_are_the_derivative_of_the_force),
      cmocka_unit_test(beds_store_and_dissipate),
      cmocka_unit_test(rigid_motion_meets_the_area),
      cmocka_unit_test(three_nodes_have_the_known_matrix),
      cmocka_unit_test(sliding_is_free),
      cmocka_unit_test(curved_faces_have_curved_normals),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
