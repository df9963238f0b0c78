// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/small_strain.h"

#include <gsl/gsl_eigen.h>
#include <math.h>

#include "model/law.h"

void vsc_rest_tangent(const vsc_model *model, const vsc_material *material, double D[36])
{
  vsc_material pulled = *material;
  pulled.compression = VSC_FIBRES_ALWAYS;
  pulled.active = VSC_ACTIVE_NONE;
  const vsc_law_input in = {.material = &pulled,
                            .axes = model->axes + material->first_axis,
                            .pairs = model->pairs + material->first_pair,
                            .moduli = vsc_moduli_or(&pulled, NULL)};
  vsc_wide rest[6];
  for (int k = 0; k < 6; k++) rest[k] = vsc_splat(0);
  vsc_law_answer answer;
  vsc_law_evaluate(&in, rest, VSC_LAW_TANGENT, &answer);
  for (int k = 0; k < 36; k++) D[k] = answer.D[k / 6][k % 6][0];
}

double vsc_material_shear(const vsc_model *model, const vsc_material *material)
{
  double D[36], most = -INFINITY;  // what is left after m may be negative
  if (!vsc_law_is_of_strain(material->law)) return 0;
  vsc_rest_tangent(model, material, D);
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3;
    most = fmax(most, D[7 * (3 + a)]);
    most = fmax(most, (D[7 * a] + D[7 * b] - 2 * D[6 * a + b]) / 4);
  }
  return most + material->rest_shear;
}

double vsc_material_stiffest(const vsc_model *model, const vsc_material *material)
{
  double D[36], eigenvalues[6], most = -INFINITY;
  vsc_rest_tangent(model, material, D);
  // a shear of E_ab counts twice in |E|^2
  for (int k = 0; k < 6; k++)
    for (int l = 0; l < 6; l++) D[6 * k + l] *= (k < 3 ? 1 : M_SQRT2) * (l < 3 ? 1 : M_SQRT2);
  gsl_matrix_view matrix = gsl_matrix_view_array(D, 6, 6);
  gsl_vector_view values = gsl_vector_view_array(eigenvalues, 6);
  gsl_eigen_symm_workspace *workspace = gsl_eigen_symm_alloc(6);
  gsl_eigen_symm(&matrix.matrix, &values.vector, workspace);
  gsl_eigen_symm_free(workspace);
  for (int k = 0; k < 6; k++) most = fmax(most, eigenvalues[k]);
  return most + 2 * material->rest_shear;
}
