// SPDX-License-Identifier: GPL-3.0-or-later
// Membranes against closed forms and classical values: a strip that bends under its weight, little
// and much; a pinched cylinder; an inflated tube.
#include "close.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>


#include "base/mem.h"
#include "mech/force.h"
#include "sheet_mesh.h"
#include "small_body.h"
#include "tools/shapes_sheet.h"

static void open_surface(small_body *body, vsc_mesh *mesh, vsc_membrane_def *membrane)
{
  body_open(body, mesh, 0);
  body->definition.material_count = 0;
  *membrane = vsc_default_membrane();
  vsc_copy_name(membrane->name, "sheet");
  vsc_copy_name(membrane->surface, "triangles");
  body->definition.membranes = membrane;
  body->definition.membrane_count = 1;
}

// ---- small displacements: the stiffness matrix by differences of forces

// Degrees of freedom: to[i] (4 to a node) moves by sign[i] with the to[i]-th unknown; none: SIZE_MAX.
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

static void a_strip_bends_under_its_weight(void **state)
{
  (void)state;
  for (int c = 0; c < 3; c++)
    for (int j = 0; j < 2; j++)
      for (size_t cells = 5; cells <= 40; cells *= 2)
        printf("cut %d jitter %g cells %zu: nu 0 %.5f nu 0.3 %.5f\n", c, 0.3 * j, cells, weight_ratio(cells, 0, 0.3 * j, (sheet_cut)c), cells < 40 ? weight_ratio(cells, 0.3, 0.3 * j, (sheet_cut)c):0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_strip_bends_under_its_weight),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
