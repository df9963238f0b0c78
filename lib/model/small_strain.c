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

static bool are_alike(const double three[3])
{
  return three[0] == three[1] && three[1] == three[2];
}

bool vsc_depends_on_direction(const vsc_model *model, const vsc_material *material)
{
  const vsc_paper_def *paper = &material->paper;
  double D[36], lambda = 0, mu = 0, largest = 0, off = 0;
  if (material->law == VSC_LAW_CLASSICAL) return false;
  if (material->law == VSC_LAW_PAPER)
    return !are_alike(paper->axial) || !are_alike(paper->angular) || !are_alike(paper->damping);
  vsc_rest_tangent(model, material, D);
  for (int a = 0; a < 3; a++) {
    lambda += D[6 * a + (a + 1) % 3] / 3;
    mu += D[7 * (3 + a)] / 3;
  }
  for (int k = 0; k < 6; k++)
    for (int l = 0; l < 6; l++) {
      const double normal = k < 3 && l < 3 ? lambda : 0, own = k != l ? 0 : k < 3 ? 2 * mu : mu;
      largest = fmax(largest, fabs(D[6 * k + l]));
      off = fmax(off, fabs(D[6 * k + l] - normal - own));
    }
  return off > 0.01 * largest || !are_alike(material->damping);
}

size_t vsc_undirected_elements(const vsc_model *model)
{
  size_t count = 0;
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!vsc_patch_is_solid(patch) || !vsc_depends_on_direction(model, &model->materials[patch->material])) continue;
    const size_t first = VSC_WIDTH * (size_t)patch->first_pack;
    for (size_t slot = first; slot < first + VSC_WIDTH * (size_t)patch->pack_count; slot++)
      count += model->mesh_element[slot] != VSC_NO_ELEMENT && !model->known[slot];
  }
  return count;
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
