// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/calibration.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_multifit.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"

static const char axis_letter[] = "fsn";

// ---- moduli

static vsc_status check_positive(const char *what, const char *names, int width,
                                 const double value[3], vsc_error *error)
{
  for (int i = 0; i < 3; i++)
    if (!(isfinite(value[i]) && value[i] > 0))
      return vsc_fail(error, VSC_INPUT, "%s modulus %.*s, %g kPa: give a value above zero", what,
                      width, names + width * i, value[i]);
  return VSC_OK;
}

static vsc_status check_young_and_shear(const vsc_moduli *moduli, vsc_error *error)
{
  const vsc_status status = check_positive("Young's", "fsn", 1, moduli->young, error);
  if (status != VSC_OK) return status;
  return check_positive("shear", "fssnnf", 2, moduli->shear, error);
}

// Refuses what no elastic material can have, naming the number: a modulus that is not above zero,
// |nu_ab| >= sqrt(Y_a / Y_b), three ratios that together give energy away.
static vsc_status check_moduli(const vsc_moduli *moduli, vsc_error *error)
{
  const vsc_status status = check_young_and_shear(moduli, error);
  if (status != VSC_OK) return status;
  double determinant = 1, product = 2;
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3;
    const double nu = moduli->poisson[a], most = sqrt(moduli->young[a] / moduli->young[b]);
    if (!(fabs(nu) < most))
      return vsc_fail(error, VSC_INPUT,
                      "Poisson's ratio %c%c, %g: with Young's moduli of %g and %g kPa it must be "
                      "between -%g and %g",
                      axis_letter[a], axis_letter[b], nu, moduli->young[a], moduli->young[b], most,
                      most);
    determinant -= nu * nu / (most * most);
    product *= nu / most;
  }
  determinant -= product;
  if (determinant > 1e-12) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "Poisson's ratios fs %g, sn %g, nf %g: together they belong to no material, some "
                  "deformation would cost no energy (determinant %.3g); lower them, or say "
                  "incompressible",
                  moduli->poisson[0], moduli->poisson[1], moduli->poisson[2], determinant);
}

vsc_status vsc_moduli_isotropic(double E, double nu, vsc_moduli *moduli, vsc_error *error)
{
  if (!(nu > -1 && nu < 0.5))
    return vsc_fail(error, VSC_INPUT,
                    "Poisson's ratio %g: give one above -1 and below 0.5 (at 0.5: incompressible)",
                    nu);
  for (int a = 0; a < 3; a++) {
    moduli->young[a] = E;
    moduli->shear[a] = E / (2 * (1 + nu));
    moduli->poisson[a] = nu;
  }
  return check_moduli(moduli, error);
}

// 4/D of numerics' closed form; it is 4 times the compliance's determinant on strains of no volume.
static double triangle(const double a[3])
{
  double sum = 0;
  for (int i = 0; i < 3; i++) sum += 2 * a[i] * a[(i + 1) % 3] - a[i] * a[i];
  return sum;
}

static vsc_status check_triangle(const double young[3], const double a[3], vsc_error *error)
{
  int softest = 0;
  for (int i = 1; i < 3; i++)
    if (a[i] > a[softest]) softest = i;
  if (triangle(a) > 1e-12 * a[softest] * a[softest]) return VSC_OK;
  return vsc_fail(
      error, VSC_INPUT,
      "Young's modulus along %c, %g kPa: no incompressible material is so soft in one "
      "direction beside %g and %g kPa in the others: 1/sqrt(Y) must be below the sum of "
      "theirs",
      axis_letter[softest], young[softest], young[(softest + 1) % 3], young[(softest + 2) % 3]);
}

vsc_status vsc_moduli_incompressible(double K, vsc_moduli *moduli, vsc_error *error)
{
  double a[3];
  const vsc_status status = check_young_and_shear(moduli, error);
  if (status != VSC_OK) return status;
  for (int i = 0; i < 3; i++) {
    a[i] = 1 / moduli->young[i] - 1 / (9 * K);
    if (!(K > 0 && a[i] > 0))
      return vsc_fail(error, VSC_INPUT,
                      "volume modulus %g kPa: too small for a Young's modulus of %g kPa along %c; "
                      "give some 100 times that for what is nearly incompressible",
                      K, moduli->young[i], axis_letter[i]);
  }
  if (check_triangle(moduli->young, a, error) != VSC_OK) return VSC_INPUT;
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    moduli->poisson[i] = -moduli->young[i] * ((a[k] - a[i] - a[j]) / 2 + 1 / (9 * K));
  }
  return check_moduli(moduli, error);
}

// Place of G_fs, G_sn, G_nf among the six.
static const int shear_place[3] = {5, 3, 4};

void vsc_moduli_compliance(const vsc_moduli *moduli, double S[36])
{
  memset(S, 0, 36 * sizeof *S);
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3, g = shear_place[a];
    S[7 * a] = 1 / moduli->young[a];
    S[6 * a + b] = S[6 * b + a] = -moduli->poisson[a] / moduli->young[a];
    S[7 * g] = 1 / moduli->shear[a];
  }
}

vsc_status vsc_axial_incompressible(const double young[3], double axial[3], vsc_error *error)
{
  double a[3];
  for (int i = 0; i < 3; i++) a[i] = 1 / young[i];
  if (check_triangle(young, a, error) != VSC_OK) return VSC_INPUT;
  for (int i = 0; i < 3; i++) axial[i] = 2 * (a[(i + 1) % 3] + a[(i + 2) % 3] - a[i]) / triangle(a);
  return VSC_OK;
}

// ---- the unknown constants

enum { AXIAL = 0, ANGULAR = 3, VOLUME = 6, FACE = 7, SPACE = 10, UNKNOWNS = 11 };

// The stiffness that constant `u` has at 1 kPa.
static void unit_stiffness(int u, double C[36])
{
  static const double dilatation[6] = {1, 1, 1, 0, 0, 0};
  const int first = u < ANGULAR ? u : u < VOLUME ? u - ANGULAR : u < SPACE ? 3 + 2 * (u - FACE) : 9;
  const int count = u < FACE ? 1 : u < SPACE ? 2 : 4;
  double row[6];
  memset(C, 0, 36 * sizeof *C);
  for (int k = 0; k < count; k++) {
    const vsc_named_direction d = vsc_direction(u == VOLUME ? 0 : first + k);
    const vsc_named_direction e = vsc_direction((first + 1) % 3);
    vsc_axis_row(d.d, row);
    if (u >= ANGULAR && u < VOLUME) vsc_pair_row(d.d, e.d, row);
    vsc_stiffness_add(C, 1, u == VOLUME ? dilatation : row);
  }
}

static double *constant_of(vsc_spring_constants *springs, int u)
{
  if (u < ANGULAR) return &springs->axial[u];
  if (u < VOLUME) return &springs->angular[u - ANGULAR];
  if (u == VOLUME) return &springs->volume_modulus;
  return u < SPACE ? &springs->face[u - FACE] : &springs->space;
}

// C becomes L^-1 C L^-T, L L^T the wanted stiffness: 1 where it is as wanted.
static void make_relative(const gsl_matrix *L, double C[36])
{
  gsl_matrix_view view = gsl_matrix_view_array(C, 6, 6);
  gsl_blas_dtrsm(CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, 1, L, &view.matrix);
  gsl_blas_dtrsm(CblasRight, CblasLower, CblasTrans, CblasNonUnit, 1, L, &view.matrix);
}

// The Cholesky factor of the wanted stiffness.
static vsc_status factor_wanted(const vsc_moduli *moduli, double factor[36], vsc_error *error)
{
  double S[36];
  vsc_status status = check_moduli(moduli, error);
  if (status != VSC_OK) return status;
  vsc_moduli_compliance(moduli, S);
  status = vsc_invert_six(S, factor, error);
  if (status != VSC_OK) return status;
  gsl_matrix_view view = gsl_matrix_view_array(factor, 6, 6);
  gsl_linalg_cholesky_decomp1(&view.matrix);
  return VSC_OK;
}

static vsc_status compare(const vsc_moduli *moduli, vsc_spring_constants *springs, vsc_error *error)
{
  double factor[36], sum[36] = {0}, unit[36], values[6];
  const vsc_status status = factor_wanted(moduli, factor, error);
  if (status != VSC_OK) return status;
  for (int u = 0; u < UNKNOWNS; u++) {
    unit_stiffness(u, unit);
    for (int i = 0; i < 36; i++) sum[i] += *constant_of(springs, u) * unit[i];
  }
  gsl_matrix_view L = gsl_matrix_view_array(factor, 6, 6), M = gsl_matrix_view_array(sum, 6, 6);
  gsl_vector_view energies = gsl_vector_view_array(values, 6);
  gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(6);
  if (work == NULL) return vsc_fail_memory(error, "a calibration");
  make_relative(&L.matrix, sum);
  gsl_eigen_symm(&M.matrix, &energies.vector, work);
  gsl_eigen_symm_free(work);
  gsl_vector_minmax(&energies.vector, &springs->least_energy, &springs->most_energy);
  return VSC_OK;
}

// ---- least squares with non-negative unknowns

// 36 rows for M - 1, and one for each further axis, so small that it only settles a draw.
enum { ROWS = 36 + UNKNOWNS };

typedef struct least_squares {
  int count;      // of unknowns
  gsl_matrix *A;  // ROWS x count, columns of unit length
  gsl_vector *b, *residual;
  gsl_vector *x, *trial;  // count: the answer so far, the next one
  bool free[UNKNOWNS];    // the others are held at zero
} least_squares;

// The unknowns that are free, by GSL; the others 0.
static vsc_status solve_free(least_squares *problem, vsc_error *error)
{
  int column[UNKNOWNS], count = 0;
  for (int u = 0; u < problem->count; u++)
    if (problem->free[u]) column[count++] = u;
  gsl_vector_set_zero(problem->trial);
  if (count == 0) return VSC_OK;
  gsl_matrix *A = gsl_matrix_alloc(ROWS, count), *covariance = gsl_matrix_alloc(count, count);
  gsl_vector *x = gsl_vector_alloc(count);
  gsl_multifit_linear_workspace *work = gsl_multifit_linear_alloc(ROWS, count);
  const bool fine = A != NULL && covariance != NULL && x != NULL && work != NULL;
  int failed = GSL_SUCCESS;
  if (fine) {
    double square;
    for (int c = 0; c < count; c++) {
      gsl_vector_view from = gsl_matrix_column(problem->A, column[c]);
      gsl_matrix_set_col(A, c, &from.vector);
    }
    failed = gsl_multifit_linear(A, problem->b, x, covariance, &square, work);
    for (int c = 0; c < count; c++) gsl_vector_set(problem->trial, column[c], gsl_vector_get(x, c));
  }
  gsl_matrix_free(A);
  gsl_matrix_free(covariance);
  gsl_vector_free(x);
  gsl_multifit_linear_free(work);
  if (!fine) return vsc_fail_memory(error, "a calibration");
  return failed ? vsc_fail(error, VSC_NUMERICAL, "a calibration: %s", gsl_strerror(failed)) : VSC_OK;
}

// The unknown held at zero by whose growth the misfit falls fastest, or -1.
static int most_wanted(least_squares *problem)
{
  int best = -1;
  double steepest = 1e-13;  // rounding: |b| is about 2, columns have length 1
  gsl_vector_memcpy(problem->residual, problem->b);
  gsl_blas_dgemv(CblasNoTrans, -1, problem->A, problem->x, 1, problem->residual);
  for (int u = 0; u < problem->count; u++) {
    double slope;
    gsl_vector_view column = gsl_matrix_column(problem->A, u);
    gsl_blas_ddot(&column.vector, problem->residual, &slope);
    if (problem->free[u] || slope <= steepest) continue;
    steepest = slope;
    best = u;
  }
  return best;
}

// Goes from x towards the trial until the first unknown reaches zero, which is then held there.
// Returns true when none did: x is the trial.
static bool go_towards_trial(least_squares *problem)
{
  double part = 1;
  int hit = -1;
  for (int u = 0; u < problem->count; u++) {
    const double from = gsl_vector_get(problem->x, u), to = gsl_vector_get(problem->trial, u);
    if (!problem->free[u] || to > 0) continue;
    const double reach = from > 0 ? from / (from - to) : 0;
    if (hit >= 0 && reach >= part) continue;
    part = reach;
    hit = u;
  }
  if (hit < 0) {
    gsl_vector_memcpy(problem->x, problem->trial);
    return true;
  }
  for (int u = 0; u < problem->count; u++) {
    double *x = gsl_vector_ptr(problem->x, u);
    *x = fmax(0, *x + part * (gsl_vector_get(problem->trial, u) - *x));
  }
  problem->free[hit] = false;
  gsl_vector_set(problem->x, hit, 0);
  return false;
}

static vsc_status solve_not_negative(least_squares *problem, vsc_error *error)
{
  // Each round ends at a better answer, so that no set of free unknowns comes twice; the limit is
  // for rounding.
  for (int round = 0, next; round < 10 * UNKNOWNS && (next = most_wanted(problem)) >= 0; round++) {
    problem->free[next] = true;
    do {
      if (solve_free(problem, error) != VSC_OK) return VSC_SYSTEM;
    } while (!go_towards_trial(problem));
  }
  return VSC_OK;
}

// Fills in the rows; `lengths` of the columns before they were made 1.
static void fill_rows(least_squares *problem, const gsl_matrix *L, double least_volume,
                      double lengths[UNKNOWNS])
{
  double unit[36];
  for (int i = 0; i < 36; i += 7) gsl_vector_set(problem->b, i, 1);
  for (int u = 0; u < problem->count; u++) {
    unit_stiffness(u, unit);
    make_relative(L, unit);
    gsl_vector_const_view rows = gsl_vector_const_view_array(unit, 36);
    lengths[u] = gsl_blas_dnrm2(&rows.vector);
    for (int i = 0; i < 36; i++) {
      gsl_matrix_set(problem->A, i, u, unit[i] / lengths[u]);
      if (u == VOLUME) *gsl_vector_ptr(problem->b, i) -= least_volume * unit[i];
    }
    if (u >= FACE) gsl_matrix_set(problem->A, 36 + u, u, 1e-5);
  }
}

static vsc_status calibrate(const vsc_moduli *moduli, int axes, vsc_spring_constants *springs,
                            vsc_error *error)
{
  double factor[36], lengths[UNKNOWNS];
  vsc_status status = factor_wanted(moduli, factor, error);
  if (status != VSC_OK) return status;
  const gsl_matrix_view L = gsl_matrix_view_array(factor, 6, 6);
  const double *Y = moduli->young, least = 1e-3 * fmax(Y[0], fmax(Y[1], Y[2]));
  const int count = axes == 3 ? FACE : axes == 9 ? SPACE : UNKNOWNS;
  least_squares problem = {.count = count,
                           .A = gsl_matrix_calloc(ROWS, count),
                           .b = gsl_vector_calloc(ROWS),
                           .residual = gsl_vector_calloc(ROWS),
                           .x = gsl_vector_calloc(count),
                           .trial = gsl_vector_calloc(count)};
  if (problem.A == NULL || problem.b == NULL || problem.residual == NULL || problem.x == NULL ||
      problem.trial == NULL)
    status = vsc_fail_memory(error, "a calibration");
  if (status == VSC_OK) {
    fill_rows(&problem, &L.matrix, least, lengths);
    status = solve_not_negative(&problem, error);
  }
  *springs = (vsc_spring_constants){0};
  for (int u = 0; status == VSC_OK && u < count; u++) {
    const double share = gsl_vector_get(problem.x, u);  // of the energy; less than that is rounding
    *constant_of(springs, u) = share < 1e-12 ? 0 : share / lengths[u];
  }
  springs->volume_modulus += least;
  gsl_matrix_free(problem.A);
  gsl_vector_free(problem.b);
  gsl_vector_free(problem.residual);
  gsl_vector_free(problem.x);
  gsl_vector_free(problem.trial);
  return status == VSC_OK ? compare(moduli, springs, error) : status;
}

// GSL shall return its failures: by default it ends the process.
vsc_status vsc_compare_springs(const vsc_moduli *moduli, vsc_spring_constants *springs,
                               vsc_error *error)
{
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  const vsc_status status = compare(moduli, springs, error);
  gsl_set_error_handler(handler);
  return status;
}

vsc_status vsc_calibrate(const vsc_moduli *moduli, int axes, vsc_spring_constants *springs,
                         vsc_error *error)
{
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  const vsc_status status = calibrate(moduli, axes, springs, error);
  gsl_set_error_handler(handler);
  return status;
}

// ---- as a material

vsc_status vsc_material_of_springs(const vsc_spring_constants *springs, vsc_material_def *material,
                                   vsc_error *error)
{
  *material = vsc_default_material();
  memcpy(material->axial, springs->axial, sizeof material->axial);
  memcpy(material->angular, springs->angular, sizeof material->angular);
  material->volume_modulus = springs->volume_modulus;
  if (!VSC_NEW(material->axes, VSC_DIRECTIONS - 3)) return vsc_fail_memory(error, "a material");
  for (int k = 3; k < VSC_DIRECTIONS; k++) {
    const double modulus = k < 9 ? springs->face[(k - 3) / 2] : springs->space;
    if (modulus == 0) continue;
    vsc_axis_def *axis = &material->axes[material->axis_count++];
    axis->modulus = modulus;
    // 1, -1, 0 read better than unit vectors
    for (int i = 0; i < 3; i++) axis->direction[i] = round(vsc_direction(k).d[i]);
  }
  return VSC_OK;
}
