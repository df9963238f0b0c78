// SPDX-License-Identifier: GPL-3.0-or-later
// Coupled masses: passes over the nodes against the polynomial on the eigenvectors of L, which is found by eigenvalues of
// the dense matrix; what L is made of, by hand; symmetry, whole motions, held directions, threads.
#include "mech/coupled_mass.h"

#include <gsl/gsl_eigen.h>

#include "base/hash.h"
#include "base/mem.h"
#include "base/parallel.h"
#include "mech/step_limit.h"
#include "small_body.h"

static void couple(small_body *body, double rate, int degree)
{
  vsc_error error;
  vsc_state_free(body->state);
  if (vsc_coupled_mass_create(body->model, rate, &error) != VSC_OK ||
      vsc_coupled_mass_set_degree(body->model, degree, &error) != VSC_OK ||
      vsc_state_create(body->model, &body->state, &error) != VSC_OK)
    fail_msg("%s", error.text);
}

// A block of 48 tets with jitter, its face x = 0 held along x alone.
static void open(small_body *body)
{
  body_open(body, block_of(2, 2, 2, 1.5, 0.2), 80);
  body_hold(body, "x0", 1, 0, 0);
  body_build(body);
}

static double entry(const vsc_coupled_mass *mass, size_t row, size_t column)
{
  double sum = 0;
  for (uint32_t k = mass->start[row]; k < mass->start[row + 1]; k++)
    if (mass->columns[k] == column) sum += mass->entries[k];
  return sum;
}

// T_m beyond and within [-1, 1].
static double chebyshev(double m, double x)
{
  return x > 1 ? cosh(m * acosh(x)) : cos(m * acos(x));
}

static double polynomial(double m, double y)
{
  const double w0 = 1 + 1 / (2 * m * m), w1 = 1 + w0, t = acosh(w0);
  const double slope = m * sinh(m * t) / sinh(t);  // T_m'(w0)
  return y < 1e-12 ? 1 : (chebyshev(m, w0) - chebyshev(m, w0 - w1 * y)) / (y * w1 * slope);
}

// Eigenvectors of M^-1/2 L M^-1/2 of the directions of one axis that are free, as columns of `vectors`.
static void decompose(const vsc_model *model, size_t axis, gsl_vector *values, gsl_matrix *vectors)
{
  const size_t n = model->node_count;
  gsl_matrix *A = gsl_matrix_alloc(n, n);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      gsl_matrix_set(A, i, j, entry(&model->coupled, i, j) *
                                  sqrt(model->inverse_mass[4 * i + axis] * model->inverse_mass[4 * j + axis]));
  gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(n);
  gsl_eigen_symmv(A, values, vectors, work);
  gsl_eigen_symmv_free(work);
  gsl_matrix_free(A);
}

// One eigenvector after the other, for several numbers of passes.
static void passes_are_the_polynomial(void **state)
{
  (void)state;
  static const int degrees[] = {1, 2, 3, 8, 40};
  small_body body;
  open(&body);
  couple(&body, 0, 1);
  const size_t n = body.model->node_count;
  double *a = vsc_alloc(4 * n, sizeof *a);
  gsl_vector *values = gsl_vector_alloc(n);
  gsl_matrix *vectors = gsl_matrix_alloc(n, n);
  for (size_t axis = 0; axis < 2; axis++) {
    decompose(body.model, axis, values, vectors);
    const double largest = gsl_vector_max(values);
    // of 27 nodes Lanczos's method finds it to the last digits
    if (axis == 1) assert_close(body.model->coupled.largest, 1.02 * largest, 1e-9, 0);
    for (size_t d = 0; d < sizeof degrees / sizeof degrees[0]; d++) {
      vsc_error error;
      assert_int_equal(vsc_coupled_mass_set_degree(body.model, degrees[d], &error), VSC_OK);
      for (size_t k = 0; k < n; k++) {
        const double y = gsl_vector_get(values, k) / body.model->coupled.largest;
        memset(a, 0, 4 * n * sizeof *a);
        for (size_t i = 0; i < n; i++)
          if (body.model->inverse_mass[4 * i + axis] > 0)
            a[4 * i + axis] = gsl_matrix_get(vectors, i, k) / sqrt(body.model->mass[i]);
        const double *spread = vsc_coupled_mass_spread(body.model, &body.state->scratch, a);
        // rounding of each pass
        for (size_t i = 0; i < 4 * n; i++)
          assert_close(spread[i], polynomial(degrees[d] + 1, fmax(y, 0)) * a[i], 0, 1e-13 * (degrees[d] + 1));
      }
    }
  }
  gsl_matrix_free(vectors);
  gsl_vector_free(values);
  vsc_free(a);
  body_close(&body);
}

// Symmetric in the mass norm, positive; a body moves as a whole as it would without; what is held stays.
static void whole_motions_are_free(void **state)
{
  (void)state;
  small_body body;
  uint64_t seed = 9;
  open(&body);
  couple(&body, 0, 6);
  const size_t n = body.model->node_count, all = 4 * n;
  double *a = vsc_alloc(all, sizeof *a), *b = vsc_alloc(all, sizeof *b), *Pa = vsc_alloc(all, sizeof *a);
  for (size_t i = 0; i < all; i++) {
    a[i] = body.model->inverse_mass[i] > 0 ? any_number(&seed) : 0;
    b[i] = body.model->inverse_mass[i] > 0 ? any_number(&seed) : 0;
  }
  memcpy(Pa, vsc_coupled_mass_spread(body.model, &body.state->scratch, a), all * sizeof *Pa);
  const double *Pb = vsc_coupled_mass_spread(body.model, &body.state->scratch, b);
  double ab = 0, ba = 0, aa = 0;
  for (size_t i = 0; i < all; i++) {
    ab += a[i] * body.model->mass[i / 4] * Pb[i];
    ba += b[i] * body.model->mass[i / 4] * Pa[i];
    aa += a[i] * body.model->mass[i / 4] * Pa[i];
    if (body.model->inverse_mass[i] == 0) assert_true(Pa[i] == 0);
  }
  assert_close(ab, ba, 1e-12, 0);
  assert_true(aa > 0);
  for (size_t i = 0; i < all; i++) a[i] = i % 4 == 1 ? 3 : 0;  // free along y
  Pb = vsc_coupled_mass_spread(body.model, &body.state->scratch, a);
  for (size_t i = 0; i < all; i++) assert_close(Pb[i], a[i], 0, 1e-12);
  vsc_free(a);
  vsc_free(b);
  vsc_free(Pa);
  body_close(&body);
}

// Of one tet (0, x, y, z) of unit edges: V = 1/6, B of the corners (-1, -1, -1), x, y, z; E = 20, K = 80, a viscosity of
// 3 kPa ms at a rate of 2: 106 V B_i . B_j.
static void entries_by_hand(void **state)
{
  (void)state;
  static const double nodes[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  static const uint32_t tet[4] = {0, 1, 2, 3};
  vsc_mesh *mesh;
  vsc_error error;
  small_body body;
  if (vsc_mesh_from_arrays(4, nodes, 1, tet, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  body_open(&body, mesh, 80);
  body.material.viscosity = 3;
  body_build(&body);
  couple(&body, 2, 1);
  const size_t corner = body_node(&body, 0);
  for (size_t i = 0; i < 4; i++)
    for (size_t j = 0; j < 4; j++) {
      const double product = i == corner && j == corner ? 3 : i == corner || j == corner ? -1 : i == j ? 1 : 0;
      assert_close(entry(&body.model->coupled, i, j), 106.0 / 6 * product, 1e-13, 1e-13);
    }
  body_close(&body);
}

// The same bits whoever does the pieces; more nodes than one piece has.
static void threads_do_not_matter(void **state)
{
  (void)state;
  uint64_t first = 0;
  for (int threads = 1; threads <= 3; threads++) {
    small_body body;
    uint64_t seed = 11;
    vsc_parallel_set_threads(threads);
    body_open(&body, block_of(9, 8, 8, 1, 0.2), 50);
    body_build(&body);
    couple(&body, 0, 5);
    assert_true(body.model->node_count > 2 * 256);
    for (size_t i = 0; i < 4 * body.model->node_count; i++) body.state->v[i] = i % 4 < 3 ? any_number(&seed) : 0;
    const double *spread = vsc_coupled_mass_spread(body.model, &body.state->scratch, body.state->v);
    const uint64_t hash = vsc_hash(VSC_HASH_START, spread, 4 * body.model->node_count * sizeof *spread);
    if (threads == 1) first = hash;
    assert_true(hash == first);
    body_close(&body);
  }
}

static void memory_runs_out_with_a_message(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  open(&body);
  for (long k = 0;; k++) {
    vsc_alloc_fail_after(k);
    vsc_status status = vsc_coupled_mass_create(body.model, 0, &error);
    if (status == VSC_OK) status = vsc_coupled_mass_set_degree(body.model, 3, &error);
    vsc_alloc_fail_after(-1);
    if (status == VSC_OK) break;
    assert_int_equal(status, VSC_SYSTEM);
    assert_non_null(strstr(error.text, "selective mass scaling"));
    assert_true(k < 50);
  }
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(passes_are_the_polynomial), cmocka_unit_test(whole_motions_are_free),
      cmocka_unit_test(entries_by_hand),           cmocka_unit_test(threads_do_not_matter),
      cmocka_unit_test(memory_runs_out_with_a_message),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
