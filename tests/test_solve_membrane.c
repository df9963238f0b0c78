// SPDX-License-Identifier: GPL-3.0-or-later
// Membranes against closed forms and classical values: a strip that bends under its weight, little
// and much; a pinched cylinder; an inflated tube.
#include "close.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_odeiv2.h>

#include "base/mem.h"
#include "mech/force.h"
#include "sheet_body.h"
#include "tools/shapes_sheet.h"

// ---- small displacements: the stiffness matrix by differences of forces

// Degrees of freedom: to[i] (4 to a node) moves by sign[i] with the to[i]-th unknown; none:
// SIZE_MAX.
typedef struct freedom {
  size_t count;
  size_t *to;
  double *sign;
} freedom;

// Displacements (node_count x 4) under `load` (mN, likewise), by Cholesky's method.
static void solve_small(small_body *body, const freedom *free, const double *load, double *moved)
{
  const size_t places = 4 * body->model->node_count;
  const double h = 1e-6 * body->model->element_size;
  double *x = vsc_alloc(places, sizeof *x), *f[2];
  for (int s = 0; s < 2; s++) f[s] = vsc_alloc(places, sizeof *x);
  gsl_matrix *K = gsl_matrix_calloc(free->count, free->count);
  gsl_vector *u = gsl_vector_calloc(free->count);
  for (size_t j = 0; j < free->count; j++) {
    for (int s = 0; s < 2; s++) {
      for (size_t i = 0; i < places; i++)
        x[i] = body->state->x[i] + (free->to[i] == j ? free->sign[i] * (s ? h : -h) : 0);
      vsc_force(body->model, x, NULL, 0, &body->state->scratch, f[s]);
    }
    for (size_t i = 0; i < places; i++)
      if (free->to[i] != SIZE_MAX)
        *gsl_matrix_ptr(K, free->to[i], j) += free->sign[i] * (f[0][i] - f[1][i]) / (2 * h);
  }
  for (size_t i = 0; i < places; i++)
    if (free->to[i] != SIZE_MAX) *gsl_vector_ptr(u, free->to[i]) += free->sign[i] * load[i];
  assert_int_equal(gsl_linalg_cholesky_decomp1(K), GSL_SUCCESS);
  gsl_linalg_cholesky_svx(K, u);
  for (size_t i = 0; i < places; i++)
    moved[i] = free->to[i] == SIZE_MAX ? 0 : free->sign[i] * gsl_vector_get(u, free->to[i]);
  gsl_matrix_free(K);
  gsl_vector_free(u);
  vsc_free(x);
  for (int s = 0; s < 2; s++) vsc_free(f[s]);
}

static freedom start_freedom(const small_body *body)
{
  freedom free = {0};
  free.to = vsc_alloc(4 * body->model->node_count, sizeof *free.to);
  free.sign = vsc_alloc(4 * body->model->node_count, sizeof *free.sign);
  for (size_t i = 0; i < 4 * body->model->node_count; i++) {
    free.to[i] = SIZE_MAX;
    free.sign[i] = 1;
  }
  return free;
}

// A strip of length 10 and width 2 along x, clamped in the nodes of x <= edge, bent by its weight:
// the mean deflection of its end, over w = q l^4/(8 D) of a beam.
static double weight_ratio(size_t cells, double nu, double jitter, sheet_cut cut)
{
  small_body body;
  vsc_membrane_def membrane;
  const double edge = 10. / (double)cells, D = 2, weight = 1e-3;
  vsc_mesh *mesh = sheet_mesh(cells + 1, cells / 5, edge, edge, cut, jitter, 5);
  open_surface(&body, mesh, &membrane);
  membrane.thickness = 0.5;
  membrane.axial[0] = membrane.axial[1] = 1000;
  membrane.angular = 500;
  membrane.area_modulus = 1000 * nu / (1 - nu);
  membrane.bending = D;
  body_build(&body);
  freedom free = start_freedom(&body);
  double *load = vsc_alloc(4 * body.model->node_count, sizeof *load);
  double *moved = vsc_alloc(4 * body.model->node_count, sizeof *moved), sum = 0, count = 0;
  for (size_t n = 0; n < body.model->node_count; n++) {
    const uint32_t column = body.model->mesh_node[n] % (uint32_t)(cells + 2);
    load[4 * n + 2] = weight * body.model->mass[n] / (0.5 * membrane.density);
    // two columns of nodes hold position and slope
    if (column >= 2) free.to[4 * n + 2] = free.count++;
  }
  solve_small(&body, &free, load, moved);
  for (size_t n = 0; n < body.model->node_count; n++)
    if (body.model->mesh_node[n] % (uint32_t)(cells + 2) == cells + 1) {
      sum += moved[4 * n + 2];
      count++;
    }
  vsc_free(free.to);
  vsc_free(free.sign);
  vsc_free(load);
  vsc_free(moved);
  body_close(&body);
  return sum / count / (weight * 1e4 / (8 * D));
}

// Between clamped columns the wall lies in the middle, which (1 + 1/cells)^2 is to second order.
// Meshes in rows do just this at nu = 0; others come near. At nu > 0 a strip's free edges curl,
// which softens it by up to 1/(1 - nu^2).
static void a_strip_bends_under_its_weight(void **state)
{
  (void)state;
  for (int cut = 0; cut < 2; cut++) {
    for (size_t cells = 5; cells <= 20; cells *= 2) {
      const double offset = (1 + 1. / (double)cells) * (1 + 1. / (double)cells);
      // differences of forces are good to some 1e-7
      assert_close(weight_ratio(cells, 0, 0, (sheet_cut)cut), offset, 1e-5, 0);
      assert_close(weight_ratio(cells, 0, 0.3, (sheet_cut)cut), offset, 0.02, 0);
    }
    const double curled = weight_ratio(20, 0.3, 0, (sheet_cut)cut) / (1.05 * 1.05);
    assert_true(curled > 1.06 && curled < 1 / (1 - 0.3 * 0.3));
    assert_close(weight_ratio(20, 0.3, 0.3, (sheet_cut)cut) / (1.05 * 1.05), curled, 0.03, 0);
  }
}

// ---- a strip that hangs from its clamped end

typedef struct elastica {
  double length, weight;  // D = 1
} elastica;

// y = theta, theta', x, z: theta'' = -q (l - s) cos theta, theta from the horizontal downwards.
static int elastica_slope(double s, const double y[], double slope[], void *context)
{
  const elastica *e = context;
  slope[0] = y[1];
  slope[1] = -e->weight * (e->length - s) * cos(y[0]);
  slope[2] = cos(y[0]);
  slope[3] = sin(y[0]);
  return GSL_SUCCESS;
}

static void shoot(const elastica *e, double first, double end[4])
{
  gsl_odeiv2_system system = {elastica_slope, NULL, 4, (void *)(uintptr_t)e};
  gsl_odeiv2_driver *driver =
      gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-3, 1e-12, 1e-12);
  double s = 0;
  const double start[4] = {0, first, 0, 0};
  memcpy(end, start, sizeof start);
  assert_int_equal(gsl_odeiv2_driver_apply(driver, &s, e->length, end), GSL_SUCCESS);
  gsl_odeiv2_driver_free(driver);
}

// Where the free end hangs: no moment there.
static void hang(const elastica *e, double end[4])
{
  double low = 0, high = e->weight * e->length * e->length / 2;
  for (int k = 0; k < 60; k++) {
    const double middle = (low + high) / 2;
    shoot(e, middle, end);
    if (end[1] > 0)
      high = middle;
    else
      low = middle;
  }
}

// How far the end is from the elastica's, part of the length.
static double off_elastica(const small_body *body, size_t cells, double load)
{
  const double h = 10. / ((double)cells + 0.5);
  double worst = 0, end[4];
  const elastica e = {.length = 10, .weight = load / 1e3};
  hang(&e, end);
  assert_true(end[3] > 7);
  for (size_t n = 0; n < body->model->node_count; n++) {
    const double *x = body->state->x + 4 * n;
    if (body->model->mesh_node[n] % (uint32_t)(cells + 2) == cells + 1)
      worst = fmax(worst, hypot(x[0] - h / 2 - end[2], x[2] + end[3]));
  }
  return worst / 10;
}

// The heavy elastica of q l^3 = 20 D: the end hangs below seven tenths of the length. Measured, on meshes with
// jitter: 7.9 % and 1.7 % of the length. Explicit steps with every velocity damped come to the same: a speed of 1e-6
// of the length in the strip's slowest time, some ms, is left.
static void a_strip_hangs_as_the_elastica(void **state)
{
  (void)state;
  for (size_t cells = 8; cells <= 16; cells *= 2) {
    small_body body, slow;
    vsc_membrane_def membrane;
    open_strip(&body, &membrane, cells, 20);
    body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
    body.definition.solve.tolerance = 1e-9;
    body_build(&body);
    solve_to(&body, 1);
    assert_true(off_elastica(&body, cells, 20) < (cells == 8 ? 0.1 : 0.025));
    if (cells == 8) {
      double most = 0;
      open_strip(&slow, &membrane, cells, 20);
      body_build(&slow);
      body_start(&slow);
      settle(&slow, 0.07, 500);
      for (size_t i = 0; i < 4 * body.model->node_count; i++)
        most = fmax(most, fabs(body.state->x[i] - slow.state->x[i]));
      assert_true(most < 1e-4);
      body_close(&slow);
    }
    body_close(&body);
  }
}

// ---- the pinched cylinder

// Load point's displacement of a cylinder between two diaphragms, pinched by two opposite loads,
// over the classical 164.24 P/(E t) of R/t = 100, l/R = 2, nu = 0.3 (Lindberg, Olson, Cowper 1969).
// 4 n x 2 n cells; the symmetries leave an eighth.
static double pinched_ratio(size_t n)
{
  small_body body;
  vsc_membrane_def membrane;
  const vsc_tube_shape tube = {.radius = 300, .length = 600, .around = 4 * n, .along = 2 * n};
  const double E = 3e6, nu = 0.3, t = 3;
  vsc_mesh *mesh = NULL;
  assert_int_equal(vsc_tube_mesh(&tube, &mesh, NULL), VSC_OK);
  open_surface(&body, mesh, &membrane);
  membrane.thickness = t;
  membrane.axial[0] = membrane.axial[1] = E / (1 + nu);
  membrane.angular = E / (2 * (1 + nu));
  membrane.area_modulus = nu * E / (1 - nu * nu);
  membrane.bending = E * t * t * t / (12 * (1 - nu * nu));
  membrane.direction[0] = 0;
  membrane.direction[2] = 1;
  body_build(&body);
  freedom free = start_freedom(&body);
  const size_t places = 4 * body.model->node_count;
  double *load = vsc_alloc(places, sizeof *load), *moved = vsc_alloc(places, sizeof *moved);
  size_t *unknown = vsc_alloc(3 * (n + 1) * (n + 1), sizeof *unknown);
  for (size_t j = 0; j <= n; j++)
    for (size_t i = 0; i <= n; i++) {
      const bool held[3] = {j == 0 || i == n, j == 0 || i == 0, j == n};
      for (int d = 0; d < 3; d++)
        unknown[3 * (j * (n + 1) + i) + (size_t)d] = held[d] ? SIZE_MAX : free.count++;
    }
  size_t loaded = 0;
  for (size_t k = 0; k < body.model->node_count; k++) {
    size_t i = body.model->mesh_node[k] % (4 * n), j = body.model->mesh_node[k] / (4 * n);
    const bool point = j == n && (i == 0 || i == 2 * n);
    double sign[3] = {1, 1, 1};
    if (i > 2 * n) i = 4 * n - i, sign[1] = -1;
    if (i > n) i = 2 * n - i, sign[0] = -1;
    if (j > n) j = 2 * n - j, sign[2] = -1;
    for (int d = 0; d < 3; d++) {
      free.to[4 * k + (size_t)d] = unknown[3 * (j * (n + 1) + i) + (size_t)d];
      free.sign[4 * k + (size_t)d] = sign[d];
    }
    if (point) load[4 * k] = -sign[0];
    if (point) loaded = 4 * k;
  }
  solve_small(&body, &free, load, moved);
  const double ratio = fabs(moved[loaded]) * E * t / 164.24;
  vsc_free(free.to);
  vsc_free(free.sign);
  vsc_free(load);
  vsc_free(moved);
  vsc_free(unknown);
  body_close(&body);
  return ratio;
}

// Measured: 0.698, 1.238, 1.280, 1.229, 1.089 for 4, 8, 12, 16, 32 cells on a quarter of the circumference:
// flat triangles first are too stiff in their planes, then a little too soft in bending. The three that
// are quick are held here to what was measured.
static void a_pinched_cylinder(void **state)
{
  (void)state;
  assert_close(pinched_ratio(4), 0.698, 0.01, 0);
  assert_close(pinched_ratio(8), 1.238, 0.01, 0);
  assert_close(pinched_ratio(12), 1.280, 0.01, 0);
}

// ---- the inflated tube

// A tube of `around` flat sides between ends that keep their z, all triangles cut alike so that all
// nodes are alike.
static vsc_mesh *even_tube(size_t around, size_t along, double radius)
{
  vsc_mesh *mesh = vsc_mesh_create(around * (along + 1), 0, 2 * around * along);
  for (size_t n = 0; n < mesh->node_count; n++) {
    const double angle = 2 * M_PI * (double)(n % around) / (double)around;
    const double x[3] = {radius * cos(angle), radius * sin(angle), (double)(n / around)};
    memcpy(mesh->nodes + 3 * n, x, sizeof x);
  }
  for (size_t k = 0; k < around * along; k++) {
    const uint32_t a = (uint32_t)k,
                   b = (uint32_t)(k % around == around - 1 ? k + 1 - around : k + 1);
    const uint32_t c = b + (uint32_t)around, d = a + (uint32_t)around,
                   corners[6] = {a, b, c, a, c, d};
    memcpy(mesh->triangles + 6 * k, corners, sizeof corners);
  }
  return mesh;
}

// Laplace's law in the polygon: T = p r cos(pi/N), T = t (E_b + K)(r/R - 1) per length, at a
// stretch of more than a third. In the end rows a triangle's three equal forces load a node more
// from one side than from the other: 6e-5 of the radius.
static void an_inflated_tube_obeys_laplace(void **state)
{
  (void)state;
  small_body body;
  vsc_membrane_def membrane;
  const double R = 3, p = 1, t = 0.2, E = 40, K = 15;
  open_surface(&body, even_tube(12, 4, R), &membrane);
  membrane.thickness = t;
  membrane.density = 1;
  membrane.axial[0] = 30;
  membrane.axial[1] = E;
  membrane.angular = 20;
  membrane.area_modulus = K;
  membrane.direction[0] = 0;
  membrane.direction[2] = 1;
  body.pressure = (vsc_pressure_def){
      .surface = "boundary", .peak = -p, .curve = vsc_default_curve(VSC_CURVE_CONSTANT)};
  body.definition.pressures = &body.pressure;
  body.definition.pressure_count = 1;
  body.sets[0] = (vsc_selector){.kind = VSC_SELECT_BOUNDARY};
  vsc_copy_name(body.sets[0].name, "all");
  body.supports[0] = (vsc_support_def){.held = {0, 0, 1}};
  vsc_copy_name(body.supports[0].set, "all");
  body.definition.set_count = body.definition.support_count = 1;
  body_build(&body);
  body_start(&body);
  settle(&body, 2, 200);
  // t (E + K)(lambda - 1) = p R lambda cos(pi/N)
  const double stiff = t * (E + K), lambda = stiff / (stiff - p * R * cos(M_PI / 12));
  assert_true(lambda > 1.35);
  for (size_t n = 0; n < body.model->node_count; n++)
    assert_close(hypot(body.state->x[4 * n], body.state->x[4 * n + 1]), lambda * R, 1e-4, 0);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_strip_bends_under_its_weight),
      cmocka_unit_test(a_strip_hangs_as_the_elastica),
      cmocka_unit_test(a_pinched_cylinder),
      cmocka_unit_test(an_inflated_tube_obeys_laplace),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
