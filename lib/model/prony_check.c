// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/prony_check.h"

#include <math.h>

// Branches as numbers go.
static vsc_status check_branches(const vsc_material_def *material, size_t m, vsc_error *error)
{
  double sum = 0;
  for (size_t k = 0; k < material->prony_count; k++) {
    const vsc_prony_def *branch = &material->prony[k];
    if (!(branch->modulus > 0))
      return vsc_fail(error, VSC_INPUT,
                      "materials[%zu].prony[%zu].modulus: %g: give a part of the stress above 0", m, k,
                      branch->modulus);
    if (!(isfinite(branch->time) && branch->time > 0))
      return vsc_fail(error, VSC_INPUT,
                      "materials[%zu].prony[%zu].time: %g ms: give a time above zero", m, k,
                      branch->time);
    sum += branch->modulus;
  }
  if (!(sum < 1))
    return vsc_fail(error, VSC_INPUT,
                    "materials[%zu].prony: moduli of sum %g: they are parts of the instantaneous "
                    "stress; let their sum stay below 1",
                    m, sum);
  return VSC_OK;
}

static vsc_status refuse(size_t m, const char *remedy, vsc_error *error)
{
  return vsc_fail(error, VSC_INPUT, "materials[%zu].prony: %s", m, remedy);
}

vsc_status vsc_prony_check(const vsc_definition *definition, vsc_error *error)
{
  for (size_t m = 0; m < definition->material_count; m++) {
    const vsc_material_def *material = &definition->materials[m];
    if (material->prony_count == 0) continue;
    if (material->prony_count > VSC_MOST_BRANCHES)
      return vsc_fail(error, VSC_INPUT, "materials[%zu].prony: %zu branches: %d are the most", m,
                      material->prony_count, VSC_MOST_BRANCHES);
    const vsc_status status = check_branches(material, m, error);
    if (status != VSC_OK) return status;
    if (!vsc_law_is_of_strain(material->law))
      return refuse(m, "law: paper and classical have none; leave it out", error);
    if (definition->tets == VSC_TETS_SMOOTHED)
      return refuse(m, "smoothed tets have none; use tets: plain, or leave it out", error);
  }
  return VSC_OK;
}
