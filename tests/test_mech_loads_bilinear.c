// SPDX-License-Identifier: GPL-3.0-or-later
// Pressures, dead tractions, springs and dashpots on quadrilateral faces, and on both kinds together.
#include "base/vec3.h"
#include "kinds_body.h"
#include "mech/loads.h"
#include "mesh/surface.h"
#include "model/robin.h"

#define PRESSURE 3.0

// Nothing but loads on the boundary of a block of hexahedra or of all kinds.
typedef struct loaded {
  vsc_mesh *mesh;
  vsc_surface boundary;
  vsc_pressure pressure;
  vsc_robin robin;
  vsc_model model;
  size_t count;  // 4 x nodes
  double *x, *v, *rest, *pull, *force;
} loaded;

static void open_loaded(loaded *l, kinds_mesh kind, double noise)
{
  const vsc_curve_def constant = vsc_default_curve(VSC_CURVE_CONSTANT);
  uint64_t seed = 23;
  *l = (loaded){.mesh = mesh_of(kind, 2, 29)};
  const size_t nodes = l->mesh->node_count;
  l->count = 4 * nodes;
  l->x = numbers(l->count);
  l->v = numbers(l->count);
  l->rest = numbers(l->count);
  l->pull = numbers(l->count);
  l->force = numbers(l->count);
  for (size_t i = 0; i < l->count; i++)
    if (i % 4 < 3) l->x[i] = l->rest[i] = l->mesh->nodes[3 * (i / 4) + i % 4] += random_between(&seed, -noise, noise);
  assert_int_equal(vsc_boundary(l->mesh, &l->boundary, NULL), VSC_OK);
  assert_int_equal(vsc_facets_make(&l->boundary, &l->pressure.facets, NULL), VSC_OK);
  assert_int_equal(vsc_curve_build(&constant, 1, &l->pressure.curve, NULL), VSC_OK);
  l->pressure.rule = vsc_face_rule_of(3, VSC_FACE_FLUX);
  l->pressure.peak = PRESSURE;
  l->model.rest = l->rest;
  l->model.node_count = nodes;
  l->model.pressure_count = 1;
  l->model.pressures = &l->pressure;
}

static void lay(loaded *l, bool normal, double stiffness, double damping)
{
  l->robin = (vsc_robin){.normal = normal, .stiffness = stiffness, .damping = damping};
  assert_int_equal(vsc_robin_fill(l->rest, &l->pressure.facets, &l->robin, NULL), VSC_OK);
  l->model.robin_count = 1;
  l->model.robins = &l->robin;
}

static void forces(loaded *l)
{
  memset(l->force, 0, l->count * sizeof *l->force);
  vsc_loads_push(&l->model, l->x, 0, 1, l->force);
  vsc_loads_hold(&l->model, l->x, l->v, l->pull, l->force);
}

static void close_loaded(loaded *l)
{
  vsc_curve_free(&l->pressure.curve);
  vsc_facets_free(&l->pressure.facets);
  vsc_robin_free(&l->robin);
  vsc_surface_free(&l->boundary);
  vsc_mesh_free(l->mesh);
  vsc_free(l->x);
  vsc_free(l->v);
  vsc_free(l->rest);
  vsc_free(l->pull);
  vsc_free(l->force);
}

// Of the elements, which know nothing of surfaces.
static double volume_of(const loaded *l, const double *x)
{
  double volume = 0;
  for (size_t i = 0; i < l->count; i++)
    if (i % 4 < 3) l->mesh->nodes[3 * (i / 4) + i % 4] = x[i];
  for (size_t e = 0; e < l->mesh->element_count; e++) volume += vsc_mesh_element_volume(l->mesh, e);
  return volume;
}

// Outside the pressure is all round: f = p dV/dx of the body inwards. The volume is linear in each coordinate.
static void pressure_is_the_gradient_of_the_elements_volume(void **state)
{
  (void)state;
  for (int kind = ALL_HEXES; kind <= ALL_KINDS; kind++) {
    loaded l;
    open_loaded(&l, (kinds_mesh)kind, 0.1);
    forces(&l);
    double most = 0;
    for (size_t i = 0; i < l.count; i++) {
      const double kept = l.x[i], h = 0.05;
      if (i % 4 == 3) continue;
      l.x[i] = kept + h;
      const double more = volume_of(&l, l.x);
      l.x[i] = kept - h;
      const double less = volume_of(&l, l.x);
      l.x[i] = kept;
      assert_close(l.force[i], -PRESSURE * (more - less) / (2 * h), 0, 1e-12);  // rounding of a volume of 8
      most = fmax(most, fabs(l.force[i]));
    }
    assert_true(most > 1);
    close_loaded(&l);
  }
}

// From x to y in `steps` equal steps.
static double work_on_the_way(loaded *l, const double *y, int steps)
{
  double *push = numbers(vsc_loads_push_count(&l->model)), *at = numbers(l->count), work = 0;
  vsc_loads_pressure_work(&l->model, l->x, 0, push);
  for (int s = 1; s <= steps; s++) {
    for (size_t i = 0; i < l->count; i++) at[i] = l->x[i] + (y[i] - l->x[i]) * s / steps;
    work += vsc_loads_pressure_work(&l->model, at, 0, push);
  }
  vsc_free(push);
  vsc_free(at);
  return work;
}

// The power is of degree 2 along straight ways: trapezoids of one and of two steps give the integral exactly.
static void work_is_pressure_times_volume(void **state)
{
  (void)state;
  for (int kind = ALL_HEXES; kind <= ALL_KINDS; kind++) {
    loaded l;
    uint64_t seed = 31;
    open_loaded(&l, (kinds_mesh)kind, 0.1);
    double *y = numbers(l.count);
    for (size_t i = 0; i < l.count; i++) y[i] = l.x[i] + (i % 4 < 3 ? random_between(&seed, -0.2, 0.3) : 0);
    const double work = (4 * work_on_the_way(&l, y, 2) - work_on_the_way(&l, y, 1)) / 3;
    const double change = volume_of(&l, y) - volume_of(&l, l.x);
    assert_true(fabs(change) > 0.01);
    assert_close(work, -PRESSURE * change, 0, 1e-12);
    vsc_free(y);
    close_loaded(&l);
  }
}

typedef struct dense {
  size_t size;
  double *K;
} dense;

static void sink(void *context, uint32_t i, uint32_t j, const double K[9])
{
  const dense *matrix = context;
  for (size_t r = 0; r < 3; r++)
    for (size_t c = 0; c < 3; c++) matrix->K[(4 * i + r) * matrix->size + 4 * j + c] += K[3 * r + c];
}

// Column j of -df/dx; forces are linear in one coordinate.
static void difference(loaded *l, size_t j, double *column)
{
  const double h = 0.1;
  l->x[j] += h;
  forces(l);
  memcpy(column, l->force, l->count * sizeof *column);
  l->x[j] -= 2 * h;
  forces(l);
  for (size_t i = 0; i < l->count; i++) column[i] = (l->force[i] - column[i]) / (2 * h);
  l->x[j] += h;
}

static void the_tangent_is_the_derivative(void **state)
{
  (void)state;
  for (int kind = ALL_HEXES; kind <= ALL_KINDS; kind++)
    for (int open = 0; open < 2; open++) {
      loaded l;
      open_loaded(&l, (kinds_mesh)kind, 0.1);
      lay(&l, kind == ALL_KINDS, 5, 0);
      l.pressure.facets.count -= 4 * (size_t)open;
      dense K = {l.count, numbers(l.count * l.count)};
      double *D = numbers(l.count * l.count), askew = 0;
      vsc_loads_tangent(&l.model, l.x, 0, 1, 1, 0, sink, &K);
      for (size_t j = 0; j < l.count; j++)
        if (j % 4 < 3) difference(&l, j, D + j * l.count);
      for (size_t i = 0; i < l.count; i++)
        for (size_t j = 0; j < l.count; j++) {
          const double ij = D[j * l.count + i], ji = D[i * l.count + j];
          assert_close(K.K[i * l.count + j], (ij + ji) / 2, 0, 1e-12);
          askew = fmax(askew, fabs(ij - ji));
        }
      assert_true(open ? askew > 0.1 : askew < 1e-12);
      vsc_free(K.K);
      vsc_free(D);
      close_loaded(&l);
    }
}

// What each node of one flat side (x = 2, any quadrilaterals) gets of a traction, as part of the follower pressure
// there, which is exact. All node's sides but this one are left out.
static void keep_side(loaded *l)
{
  vsc_facets *facets = &l->pressure.facets;
  size_t kept = 0, whole = 0;
  for (size_t k = 0; k < facets->count; k++) {
    bool on = true;
    for (int i = 0; i < 3; i++) on = on && l->rest[4 * (size_t)facets->corners[3 * k + (size_t)i]] == 2;
    if (!on) continue;
    memmove(facets->corners + 3 * kept++, facets->corners + 3 * k, 3 * sizeof *facets->corners);
    whole += k < facets->whole;
  }
  facets->count = kept;
  facets->whole = whole;
}

// Dead tractions and beds moved as a whole share a flat side as the pressure does.
static void tractions_and_beds_share_alike(void **state)
{
  (void)state;
  static const double way[3] = {2.0 / 3, -2.0 / 3, 1.0 / 3};
  for (int kind = ALL_HEXES; kind <= ALL_KINDS; kind++) {
    loaded l;
    open_loaded(&l, (kinds_mesh)kind, 0);
    keep_side(&l);
    forces(&l);
    double *part = numbers(l.count / 4), sum = 0;
    for (size_t n = 0; n < l.count / 4; n++) sum += part[n] = -l.force[4 * n] / PRESSURE;
    assert_close(sum, 4, 1e-14, 0);
    memcpy(l.pressure.direction, way, sizeof way);
    for (size_t n = 0; n < l.count / 4; n++) l.x[4 * n] += 0.3 * sin(1.7 * (double)n);  // they stay
    forces(&l);
    for (size_t i = 0; i < l.count; i++)
      assert_close(l.force[i], i % 4 < 3 ? PRESSURE * part[i / 4] * way[i % 4] : 0, 0, 1e-14);
    l.model.pressure_count = 0;
    lay(&l, false, 5, 7);
    assert_close(l.robin.area, 4, 1e-13, 0);
    for (size_t i = 0; i < l.count; i++) {
      l.x[i] = l.rest[i] + (i % 4 < 3 ? 0.1 * way[i % 4] : 0);
      l.v[i] = i % 4 < 3 ? -0.2 * way[i % 4] : 0;
    }
    forces(&l);
    for (size_t i = 0; i < l.count; i++)
      assert_close(l.force[i], i % 4 < 3 ? -(5 * 0.1 - 7 * 0.2) * part[i / 4] * way[i % 4] : 0, 0, 1e-13);
    vsc_free(part);
    close_loaded(&l);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pressure_is_the_gradient_of_the_elements_volume),
      cmocka_unit_test(work_is_pressure_times_volume),
      cmocka_unit_test(the_tangent_is_the_derivative),
      cmocka_unit_test(tractions_and_beds_share_alike),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
