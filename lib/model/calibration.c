// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/calibration.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"

// Springs a fit may use: E_f, E_s, E_n, G_fs, G_sn, G_nf, K, then further axes.
enum { BASIC = 7, MOST = BASIC + VSC_DIRECTIONS - 3, EQUATIONS = 36 };

vsc_orthotropic vsc_isotropic(double young, double poisson)
{
  const double shear = young / (2 * (1 + poisson));
  return (vsc_orthotropic){.young = {young, young, young},
                           .shear = {shear, shear, shear},
                           .poisson = {poisson, poisson, poisson}};
}

static vsc_status check_moduli(const vsc_orthotropic *wanted, vsc_error *error)
{
  static const char *const young[] = {"Young's modulus Y_f", "Young's modulus Y_s",
                                      "Young's modulus Y_n"};
  static const char *const shear[] = {"shear modulus G_fs", "shear modulus G_sn",
                                      "shear modulus G_nf"};
  for (int a = 0; a < 3; a++) {
    if (!(wanted->young[a] > 0 && isfinite(wanted->young[a])))
      return vsc_fail(error, VSC_INPUT, "%s is %g kPa: give a value above zero", young[a],
                      wanted->young[a]);
    if (!(wanted->shear[a] > 0 && isfinite(wanted->shear[a])))
      return vsc_fail(error, VSC_INPUT, "%s is %g kPa: give a value above zero", shear[a],
                      wanted->shear[a]);
  }
  return VSC_OK;
}

vsc_status vsc_compliance_of(const vsc_orthotropic *wanted, double S[36], vsc_error *error)
{
  const vsc_status status = check_moduli(wanted, error);
  if (status != VSC_OK) return status;
  memset(S, 0, 36 * sizeof *S);
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3;
    S[7 * a] = 1 / wanted->young[a];
    S[6 * a + b] = S[6 * b + a] = -wanted->poisson[a] / wanted->young[a];
    // pair a is (a, a + 1), whose shear has the number of the axis left over
    S[7 * (3 + (a + 2) % 3)] = 1 / wanted->shear[a];
  }
  double C[36];
  if (vsc_invert_six(S, C, NULL) == VSC_OK) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "Poisson's ratios nu_fs %g, nu_sn %g, nu_nf %g with Young's moduli %g, %g, %g kPa "
                  "are no elastic material's: some deformation would release energy; give smaller "
                  "ratios (isotropic: below 0.5), or --incompressible",
                  wanted->poisson[0], wanted->poisson[1], wanted->poisson[2], wanted->young[0],
                  wanted->young[1], wanted->young[2]);
}

vsc_orthotropic vsc_constants_of(const double S[36])
{
  vsc_orthotropic o;
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3;
    o.young[a] = 1 / S[7 * a];
    o.shear[a] = 1 / S[7 * (3 + (a + 2) % 3)];
    o.poisson[a] = -S[6 * a + b] * o.young[a];
  }
  return o;
}

// ---- the fit

// Symmetric square root of S.
static void root_of(const double S[36], double root[36])
{
  double copy[36];
  memcpy(copy, S, sizeof copy);
  gsl_matrix_view view = gsl_matrix_view_array(copy, 6, 6);
  double values[6], vectors[36];
  gsl_vector_view value = gsl_vector_view_array(values, 6);
  gsl_matrix_view vector = gsl_matrix_view_array(vectors, 6, 6);
  gsl_eigen_symmv_workspace *workspace = gsl_eigen_symmv_alloc(6);
  gsl_eigen_symmv(&view.matrix, &value.vector, &vector.matrix, workspace);
  gsl_eigen_symmv_free(workspace);
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 6; j++) {
      root[6 * i + j] = 0;
      for (int k = 0; k < 6; k++)
        root[6 * i + j] += sqrt(values[k]) * vectors[6 * i + k] * vectors[6 * j + k];
    }
}

static void row_of(int spring, double row[6])
{
  static const double axis[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  static const double dilatation[6] = {1, 1, 1, 0, 0, 0};
  if (spring < 3)
    vsc_axis_row(axis[spring], row);
  else if (spring < 6)
    vsc_pair_row(axis[spring - 3], axis[(spring - 2) % 3], row);
  else if (spring == 6)
    memcpy(row, dilatation, sizeof dilatation);
  else
    vsc_axis_row(vsc_direction(spring - BASIC + 3).d, row);
}

// Column of the design matrix: (S^1/2 r)(S^1/2 r)^T.
static void column_of(const double root[36], int spring, double column[EQUATIONS])
{
  double row[6], scaled[6] = {0};
  row_of(spring, row);
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 6; j++) scaled[i] += root[6 * i + j] * row[j];
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 6; j++) column[6 * i + j] = scaled[i] * scaled[j];
}

typedef struct fit {
  int count;
  double column[MOST][EQUATIONS], target[EQUATIONS];
  double m[MOST];
  bool active[MOST];  // may differ from 0
} fit;

// Least squares within the active springs, into `trial` (0 elsewhere).
static void solve_active(const fit *f, double trial[MOST])
{
  int list[MOST], count = 0;
  for (int k = 0; k < f->count; k++) {
    trial[k] = 0;
    if (f->active[k]) list[count++] = k;
  }
  if (count == 0) return;
  gsl_matrix *A = gsl_matrix_alloc(EQUATIONS, (size_t)count);
  gsl_vector_const_view b = gsl_vector_const_view_array(f->target, EQUATIONS);
  gsl_vector *x = gsl_vector_alloc((size_t)count);
  gsl_matrix *covariance = gsl_matrix_alloc((size_t)count, (size_t)count);
  gsl_multifit_linear_workspace *workspace = gsl_multifit_linear_alloc(EQUATIONS, (size_t)count);
  double square;
  for (int c = 0; c < count; c++)
    for (int e = 0; e < EQUATIONS; e++)
      gsl_matrix_set(A, (size_t)e, (size_t)c, f->column[list[c]][e]);
  gsl_multifit_linear(A, &b.vector, x, covariance, &square, workspace);
  for (int c = 0; c < count; c++) trial[list[c]] = gsl_vector_get(x, (size_t)c);
  gsl_multifit_linear_free(workspace);
  gsl_matrix_free(covariance);
  gsl_vector_free(x);
  gsl_matrix_free(A);
}

// Residual target - sum m column; returns its norm.
static double residual_of(const fit *f, double residual[EQUATIONS])
{
  double square = 0;
  for (int e = 0; e < EQUATIONS; e++) {
    residual[e] = f->target[e];
    for (int k = 0; k < f->count; k++) residual[e] -= f->m[k] * f->column[k][e];
    square += residual[e] * residual[e];
  }
  return sqrt(square);
}

// The inactive spring that would lower the residual fastest, or -1.
static int most_wanted(const fit *f)
{
  double residual[EQUATIONS], best = 1e-10;
  int spring = -1;
  residual_of(f, residual);
  for (int k = 0; k < f->count; k++) {
    double slope = 0, size = 0;
    for (int e = 0; e < EQUATIONS; e++) {
      slope += f->column[k][e] * residual[e];
      size += f->column[k][e] * f->column[k][e];
    }
    if (f->active[k] || slope / sqrt(size) <= best) continue;
    best = slope / sqrt(size);
    spring = k;
  }
  return spring;
}

static void fit_moduli(fit *f)
{
  for (int round = 0; round < 10 * MOST; round++) {
    const int spring = most_wanted(f);
    if (spring < 0) return;
    f->active[spring] = true;
    for (int inner = 0; inner < MOST; inner++) {
      double trial[MOST], part = 1;
      int blocked = -1;
      solve_active(f, trial);
      // towards the trial as far as all stay above zero
      for (int k = 0; k < f->count; k++)
        if (f->active[k] && trial[k] <= 0 && f->m[k] / (f->m[k] - trial[k]) < part) {
          part = f->m[k] / (f->m[k] - trial[k]);
          blocked = k;
        }
      for (int k = 0; k < f->count; k++) f->m[k] += part * (trial[k] - f->m[k]);
      if (blocked < 0) break;
      f->active[blocked] = false;
      f->m[blocked] = 0;
    }
  }
}

static vsc_status keep_axes(const fit *f, vsc_material_def *material, vsc_error *error)
{
  if (!VSC_NEW(material->axes, (size_t)f->count)) return vsc_fail_memory(error, "further axes");
  for (int k = BASIC; k < f->count; k++) {
    if (f->m[k] == 0) continue;
    vsc_axis_def *axis = &material->axes[material->axis_count++];
    *axis = (vsc_axis_def){.modulus = f->m[k]};
    const vsc_named_direction direction = vsc_direction(k - BASIC + 3);
    for (int i = 0; i < 3; i++)  // -1, 0 or 1 along f, s, n
      axis->direction[i] = (direction.d[i] > 0.1) - (direction.d[i] < -0.1);
  }
  return VSC_OK;
}

vsc_status vsc_calibrate(const vsc_orthotropic *wanted, vsc_calibration_axes axes,
                         vsc_material_def *material, double *residual, vsc_error *error)
{
  double S[36], root[36], left[EQUATIONS];
  fit f = {.count = BASIC + (int)axes - 3};
  const vsc_status status = vsc_compliance_of(wanted, S, error);
  if (status != VSC_OK) return status;
  root_of(S, root);
  for (int k = 0; k < f.count; k++) column_of(root, k, f.column[k]);
  for (int i = 0; i < 6; i++) f.target[7 * i] = 1;
  fit_moduli(&f);
  *residual = residual_of(&f, left);
  for (int a = 0; a < 3; a++) {
    material->axial[a] = f.m[a];
    material->angular[a] = f.m[3 + a];
  }
  material->volume_modulus = f.m[6];
  return axes > VSC_THREE_AXES ? keep_axes(&f, material, error) : VSC_OK;
}

vsc_status vsc_calibrate_incompressible(const vsc_orthotropic *wanted, double volume_modulus,
                                        vsc_material_def *material, vsc_error *error)
{
  static const char *const names[] = {"f", "s", "n"};
  const vsc_status status = check_moduli(wanted, error);
  if (status != VSC_OK) return status;
  const double *Y = wanted->young, a = 1 / Y[0], b = 1 / Y[1], c = 1 / Y[2];
  const double D = 4 / (2 * a * b + 2 * b * c + 2 * c * a - a * a - b * b - c * c);
  if (!(D > 0))
    return vsc_fail(error, VSC_INPUT,
                    "Young's moduli %g, %g, %g kPa are no incompressible material's: their inverses "
                    "must be such that the roots of two exceed the third's",
                    Y[0], Y[1], Y[2]);
  const double sums[3] = {b + c - a, c + a - b, a + b - c};
  for (int i = 0; i < 3; i++) {
    if (sums[i] < 0)
      return vsc_fail(error, VSC_INPUT,
                      "Young's modulus Y_%s = %g kPa is so far below the others (%g, %g, %g kPa) that "
                      "its spring would have the modulus %g kPa; a spring cannot pull apart: raise it "
                      "to %g kPa",
                      names[i], Y[i], Y[0], Y[1], Y[2], D * sums[i] / 2,
                      1 / (a + b + c - 1 / Y[i]));
    material->axial[i] = D * sums[i] / 2;
    material->angular[i] = wanted->shear[i];
  }
  material->volume_modulus = volume_modulus;
  return VSC_OK;
}
