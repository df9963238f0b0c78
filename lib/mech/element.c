// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/element.h"

#include <string.h>

static void paper_law(const vsc_model *model, const vsc_patch *patch, size_t k, vsc_pack_law *law)
{
  const vsc_paper_def *paper = &model->materials[patch->material].paper;
  const void *data = vsc_pack_law_data(model, patch, k);
  const bool tets = patch->family == VSC_TETS;
  const vsc_wide *r = tets ? ((const vsc_chords *)data)->r : ((const vsc_hex_axes *)data)->r;
  const vsc_wide V =
      tets ? vsc_pack_frames(model, patch, k)->V : ((const vsc_hex_axes *)data)->volume;
  const vsc_wide inverse = vsc_wide_inverse(V, 0);
  for (int a = 0; a < 3; a++) {
    law->springs.axial[a] = paper->axial[a] * r[a] * r[a] * inverse;
    law->springs.angular[a] = 0.5 * paper->angular[a] * (r[a] + r[(a + 1) % 3]) * inverse;
    law->damping[a] = paper->damping[a] * r[a] * r[a] * inverse;
  }
  law->active_axial = paper->active * r[0] * r[0] * inverse;
}

// Of the moduli of `mixture`, or without one of the material's own.
static vsc_pack_law law_of(const vsc_material *material, const vsc_mixture *mixture)
{
  const vsc_mixture moduli = vsc_moduli_or(material, mixture);
  vsc_pack_law law = {.springs.rest_stretch = vsc_splat(1),
                      .volume_modulus = moduli.volume_modulus,
                      .stabilization = moduli.stabilization,
                      .element_modulus = moduli.element_modulus,
                      .viscosity = moduli.viscosity,
                      .share = moduli.share};
  memcpy(law.springs.axial, moduli.axial, sizeof moduli.axial);
  memcpy(law.springs.angular, moduli.angular, sizeof moduli.angular);
  memcpy(law.damping, moduli.damping, sizeof moduli.damping);
  memcpy(law.coupling, moduli.coupling, sizeof moduli.coupling);
  law.active_axial =
      law.springs.axial[0] + law.share * (material->active_stiffness - material->axial[0]);
  law.others = law.springs.axial[0] - law.share * material->axial[0];
  return law;
}

vsc_pack_law vsc_material_law(const vsc_material *material)
{
  return law_of(material, NULL);
}

vsc_pack_law vsc_pack_law_of(const vsc_model *model, const vsc_patch *patch, size_t k)
{
  vsc_pack_law law = law_of(&model->materials[patch->material],
                            patch->mixed ? vsc_pack_mixture(model, patch, k) : NULL);
  if (patch->law_data) paper_law(model, patch, k, &law);
  return law;
}
