// SPDX-License-Identifier: GPL-3.0-or-later
// Edges round which a body lies more than once: rings of elements of every kind, and a block of random places.
#include <string.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "base/vec3.h"
#include "close.h"
#include "mesh/edges.h"
#include "mesh/quadratic.h"
#include "mesh/wound.h"
#include "random.h"
#include "tools/shapes_block.h"

enum { SECTORS = 10 };  // round the axis of a ring, an even number

// A ring round the axis between nodes 0 and 1: node 2 + 4 i + 2 u + l is at the level l of its spoke i, at radius 1,
// or halfway to the next spoke, further out (u = 1).
static uint32_t spoke_node(size_t sector, uint32_t out, uint32_t level)
{
  return 2 + 4 * (uint32_t)(sector % SECTORS) + 2 * out + level;
}

static void place_ring(double *x)
{
  for (uint32_t level = 0; level < 2; level++) {
    x[3 * level + 2] = level;
    for (size_t i = 0; i < SECTORS; i++)
      for (uint32_t out = 0; out < 2; out++) {
        double *at = x + 3 * (size_t)spoke_node(i, out, level);
        const double angle = 2 * M_PI * ((double)i + 0.5 * out) / SECTORS, radius = out ? 1.3 : 1;
        at[0] = radius * cos(angle), at[1] = radius * sin(angle), at[2] = level;
      }
  }
}

// Where the nodes of a ring are when it lies so many times round the axis, below and above.
static void wind(const vsc_mesh *mesh, double below, double above, double *x)
{
  for (size_t n = 0; n < mesh->node_count; n++) {
    const double *at = mesh->nodes + 3 * n, radius = hypot(at[0], at[1]);
    double angle = atan2(at[1], at[0]);
    if (angle < -1e-9) angle += 2 * M_PI;
    angle *= below + at[2] * (above - below);
    x[3 * n] = radius * cos(angle), x[3 * n + 1] = radius * sin(angle), x[3 * n + 2] = at[2];
  }
}

// The nodes of a sector's element: of pyramids every second one is the other way round, so that they share faces.
static void ring_element(vsc_cell kind, size_t i, uint32_t *nodes)
{
  const uint32_t a = spoke_node(i, 0, 0), b = spoke_node(i + 1, 0, 0), m = spoke_node(i, 1, 0);
  const uint32_t tet[4] = {0, a, b, 1}, wedge[6] = {0, a, b, 1, a + 1, b + 1};
  const uint32_t hex[8] = {0, a, m, b, 1, a + 1, m + 1, b + 1};
  const uint32_t pyramids[2][5] = {{0, 1, a + 1, a, b}, {0, b, b + 1, 1, a}};
  memcpy(nodes, kind == VSC_TET ? tet : kind == VSC_WEDGE ? wedge : kind == VSC_HEX ? hex : pyramids[i % 2],
         (size_t)vsc_cells[kind].corners * sizeof *nodes);
}

// The ring of so many of its sectors, once round the axis; not clean but for quadratic tets.
static vsc_mesh *ring(vsc_cell kind, size_t sectors)
{
  const vsc_cell corners = kind == VSC_TET10 ? VSC_TET : kind;
  uint8_t kinds[SECTORS];
  vsc_error error;
  memset(kinds, corners, sizeof kinds);
  vsc_mesh *mesh = vsc_mesh_create_cells(2 + 4 * SECTORS, sectors, kinds, 0);
  assert_non_null(mesh);
  place_ring(mesh->nodes);
  for (size_t i = 0; i < sectors; i++) ring_element(corners, i, mesh->corners + mesh->start[i]);
  for (size_t i = 0; i < sectors; i++)
    if (!(vsc_mesh_element_volume(mesh, i) > 0)) fail_msg("%s %zu is inside out", vsc_cells[kind].name, i);
  if (kind == VSC_TET10 && vsc_mesh_raise(&mesh, "ring", &error) != VSC_OK) fail_msg("%s", error.text);
  return mesh;
}

static vsc_wound wound_of(const vsc_mesh *mesh, const double *x)
{
  vsc_wound wound;
  vsc_error error;
  if (vsc_wound_find(mesh, x, &wound, &error) != VSC_OK) fail_msg("%s", error.text);
  return wound;
}

// The middles of a quadratic mesh are those of straight edges.
static void straighten(const vsc_mesh *mesh, double *x)
{
  for (size_t e = 0; e < mesh->element_count && vsc_mesh_is_quadratic(mesh); e++)
    for (int k = 0; k < 6; k++) {
      const uint32_t *corner = vsc_mesh_corners(mesh, e);
      const int *ends = vsc_cells[VSC_TET10].edges[k];
      for (size_t i = 0; i < 3; i++)
        x[3 * corner[4 + k] + i] = (x[3 * corner[ends[0]] + i] + x[3 * corner[ends[1]] + i]) / 2;
    }
}

static void expect_axis(const vsc_mesh *mesh, const double *x, size_t count)
{
  const vsc_wound wound = wound_of(mesh, x);
  if (wound.count != count) fail_msg("%s: %zu edges, not %zu", vsc_mesh_kind(mesh, 0)->name, wound.count, count);
  if (count > 0) assert_true(wound.ends[0] == 0 && wound.ends[1] == 1);
}

// Once round the axis, backwards, or where the ring has turned, nothing is told; twice, three and four times it is, of
// hexahedra, wedges and pyramids also where that is so at one end only.
static void rings_of_every_kind(void **state)
{
  (void)state;
  for (int kind = 0; kind < VSC_CELLS; kind++) {
    vsc_mesh *mesh = ring((vsc_cell)kind, SECTORS);
    double x[3 * 256] = {0};
    assert_true(mesh->node_count <= 256);
    expect_axis(mesh, mesh->nodes, 0);
    for (int turns = -2; turns <= 4; turns++) {
      wind(mesh, turns, turns, x);
      straighten(mesh, x);
      expect_axis(mesh, x, turns >= 2);
    }
    const bool levels = kind == VSC_HEX || kind == VSC_WEDGE;
    wind(mesh, 1, 2, x);
    if (levels) expect_axis(mesh, x, 1);
    wind(mesh, 2, 1, x);
    if (levels) expect_axis(mesh, x, 1);
    vsc_mesh_free(mesh);
  }
}

// The tangents of quadratic tets count, not the places of their corners.
static void curved_edges_count_by_their_tangents(void **state)
{
  (void)state;
  vsc_mesh *mesh = ring(VSC_TET10, SECTORS);
  double x[3 * 256] = {0};
  for (int turns = 1; turns <= 2; turns++) {
    wind(mesh, 3 - turns, 3 - turns, x);
    straighten(mesh, x);
    for (size_t e = 0; e < SECTORS; e++) {
      const uint32_t *corner = vsc_mesh_corners(mesh, e);
      for (uint32_t k = 0; k < 2; k++)
        for (int end = 0; end < 4; end += 3) {
          const int middle = vsc_cell_middle(&vsc_cells[VSC_TET10], end, 1);
          const double angle = 2 * M_PI * turns * (double)e / SECTORS;
          double *at = x + 3 * (size_t)corner[middle];
          at[0] = cos(angle), at[1] = sin(angle);
        }
    }
    expect_axis(mesh, x, turns == 2);
  }
  vsc_mesh_free(mesh);
}

// A fan that is open: the axis is on the surface.
static void edges_of_the_surface(void **state)
{
  (void)state;
  vsc_mesh *mesh = ring(VSC_TET, SECTORS - 1);
  double x[3 * 256] = {0};
  static const struct {
    double turns;
    size_t count;
  } cases[] = {{1, 0}, {1.4, 0}, {2.3, 1}, {3, 1}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    wind(mesh, cases[k].turns * SECTORS / (SECTORS - 1), cases[k].turns * SECTORS / (SECTORS - 1), x);
    expect_axis(mesh, x, cases[k].count);
  }
  vsc_mesh_free(mesh);
}

// ---- corners

// One corner of one element is pushed through its face: told of hexahedra, wedges and pyramids, whose frames do not see it; not
// of tets. At rest the same corner is no fault of the run.
static void corners_that_are_inside_out(void **state)
{
  (void)state;
  for (int kind = 0; kind < VSC_CELLS; kind++) {
    vsc_mesh *mesh = ring((vsc_cell)kind, SECTORS);
    double x[3 * 256];
    assert_int_equal(wound_of(mesh, mesh->nodes).folded, 0);
    memcpy(x, mesh->nodes, 3 * mesh->node_count * sizeof *x);
    const uint32_t *corners = vsc_mesh_corners(mesh, 4);
    double *pushed = x + 3 * (size_t)corners[2];  // a ring's outermost
    for (int i = 0; i < 3; i++) pushed[i] = kind == VSC_HEX ? 0.5 * pushed[i] : -0.05 * pushed[i];
    const vsc_wound wound = wound_of(mesh, x);
    const bool told = vsc_cells[kind].vertices != 4;
    assert_int_equal(wound.folded > 0, told);
    assert_true(!told || wound.element == 4 || wound.element == 3);
    memcpy(mesh->nodes, x, 3 * mesh->node_count * sizeof *x);
    assert_int_equal(wound_of(mesh, x).folded, 0);
    vsc_mesh_free(mesh);
  }
}

// ---- against sums of angles

// The angle of a tet at the edge between its nodes low and high, below 0 where it is inside out.
static double angle_at(const double *x, const uint32_t *tet, const vsc_edge *edge)
{
  double along[3], aside[2][3], product[3], volume[3][3];
  int found = 0;
  vsc_subtract(x + 3 * (size_t)edge->high, x + 3 * (size_t)edge->low, along);
  vsc_normalize(along);
  for (int i = 0; i < 4; i++) {
    if (i > 0) vsc_subtract(x + 3 * (size_t)tet[i], x + 3 * (size_t)tet[0], volume[i - 1]);
    if (tet[i] == edge->low || tet[i] == edge->high) continue;
    vsc_subtract(x + 3 * (size_t)tet[i], x + 3 * (size_t)edge->low, aside[found]);
    const double part = vsc_dot(aside[found], along);
    for (int k = 0; k < 3; k++) aside[found][k] -= part * along[k];
    found++;
  }
  vsc_cross(aside[0], aside[1], product);
  const double angle = atan2(vsc_norm(product), vsc_dot(aside[0], aside[1]));
  vsc_cross(volume[0], volume[1], product);
  return vsc_dot(product, volume[2]) > 0 ? angle : -angle;
}

static double sum_at(const vsc_mesh *mesh, const double *x, const vsc_edge *edge)
{
  double sum = 0;
  for (size_t e = 0; e < mesh->element_count; e++) {
    const uint32_t *tet = vsc_mesh_corners(mesh, e);
    int shared = 0;
    for (int i = 0; i < 4; i++) shared += tet[i] == edge->low || tet[i] == edge->high;
    if (shared == 2) sum += angle_at(x, tet, edge);
  }
  return sum;
}

static vsc_mesh *block(size_t cells)
{
  const vsc_block_shape shape = {.cells = {cells, cells, cells}, .size = {1, 1, 1}, .tets_per_cell = 6};
  vsc_mesh *mesh;
  vsc_error error;
  if (vsc_block_of(&shape, VSC_BLOCK_TETS, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  return mesh;
}

static void shake(const vsc_mesh *mesh, double by, uint64_t seed, double *x)
{
  for (size_t i = 0; i < 3 * mesh->node_count; i++) x[i] = mesh->nodes[i] + random_between(&seed, -by, by);
}

// Of a shaken block the edges that are told are those with a sum above 3 pi, and the first is among them.
static void the_sum_decides(void **state)
{
  (void)state;
  vsc_mesh *mesh = block(6);
  vsc_edges edges;
  static double x[3 * 343];
  size_t all = 0;
  assert_int_equal(vsc_edges_list(mesh, &edges, NULL), VSC_OK);
  for (uint64_t seed = 1; seed <= 6; seed++) {
    size_t most = 0, least = 0;
    bool first = false;
    shake(mesh, 1, seed, x);
    const vsc_wound wound = wound_of(mesh, x);
    for (size_t k = 0; k < edges.count; k++) {
      const double sum = sum_at(mesh, x, &edges.items[k]);
      if (sum <= 3 * M_PI) continue;
      most++, least += sum > 4 * M_PI || sum_at(mesh, mesh->nodes, &edges.items[k]) > 1.99 * M_PI;
      first |= edges.items[k].low == wound.ends[0] && edges.items[k].high == wound.ends[1];
    }
    assert_true(least <= wound.count && wound.count <= most && (wound.count == 0 || first));
    all += least;
  }
  assert_true(all >= 5);
  vsc_edges_free(&edges);
  vsc_mesh_free(mesh);
}

static void threads_change_nothing(void **state)
{
  (void)state;
  vsc_mesh *mesh = block(20);
  static double x[3 * 9261];
  shake(mesh, 0.1, 5, x);
  vsc_parallel_set_threads(1);
  const vsc_wound one = wound_of(mesh, x);
  vsc_parallel_set_threads(3);
  const vsc_wound three = wound_of(mesh, x);
  vsc_parallel_set_threads(0);
  assert_true(one.count > 20 && one.count == three.count);
  assert_true(one.ends[0] == three.ends[0] && one.ends[1] == three.ends[1]);
  vsc_mesh_free(mesh);
}

static void memory_may_be_short(void **state)
{
  (void)state;
  vsc_mesh *mesh = ring(VSC_TET, SECTORS);
  double x[3 * 256] = {0};
  vsc_wound wound;
  vsc_error error;
  wind(mesh, 2, 2, x);
  for (long k = 0; k < 6; k++) {
    vsc_alloc_fail_after(k);
    assert_int_equal(vsc_wound_find(mesh, x, &wound, &error), VSC_SYSTEM);
  }
  vsc_alloc_fail_after(-1);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rings_of_every_kind),
      cmocka_unit_test(curved_edges_count_by_their_tangents),
      cmocka_unit_test(edges_of_the_surface),
      cmocka_unit_test(corners_that_are_inside_out),
      cmocka_unit_test(the_sum_decides),
      cmocka_unit_test(threads_change_nothing),
      cmocka_unit_test(memory_may_be_short),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
