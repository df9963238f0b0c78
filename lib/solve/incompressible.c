// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/incompressible.h"

#include <math.h>

#include "mech/element.h"
#include "mech/force.h"
#include "model/law_volume.h"

static double update_nodes(const vsc_model *model, const double *x, vsc_scratch *scratch)
{
  double *ratio = scratch->trial + 4 * model->node_count, most = 0;
  vsc_group_ratios(model, x, scratch, ratio);
  for (size_t n = 0; n < model->node_count; n++) {
    if (!(model->group_modulus[n] > 0)) continue;
    const vsc_wide p = vsc_volume_stress(vsc_splat(model->group_modulus[n]), vsc_splat(ratio[n]));
    scratch->node_multiplier[n] += p[0];
    most = fmax(most, fabs(ratio[n] - 1));
  }
  return most;
}

static double update_pack(const vsc_model *model, const vsc_patch *patch, size_t k, const double *x,
                          vsc_wide *multiplier)
{
  const vsc_frame *frames = vsc_pack_frames(model, patch, k);
  const vsc_pack_law law = vsc_pack_law_of(model, patch, k);
  vsc_wide rest = vsc_splat(0), now = vsc_splat(0);
  for (int q = 0; q < vsc_family_frames(model, patch->family); q++) {
    vsc_wide3 g[3];
    vsc_pack_axes(model, patch, k, q, x, g);
    rest += frames[q].V;
    now += frames[q].V * vsc_pack_ratio(g);
  }
  double most = 0;
  for (int l = 0; l < VSC_WIDTH; l++) {
    if (model->mesh_element[VSC_WIDTH * k + (size_t)l] == VSC_NO_ELEMENT) continue;
    const double J = now[l] / rest[l];
    (*multiplier)[l] += vsc_volume_stress(law.volume_modulus, vsc_splat(J))[l];
    most = fmax(most, fabs(J - 1));
  }
  return most;
}

double vsc_multipliers_update(const vsc_model *model, const double *x, vsc_scratch *scratch)
{
  double most = model->terms.nodal_volume ? update_nodes(model, x, scratch) : 0;
  vsc_wide *multiplier = (vsc_wide *)scratch->pack_multiplier;
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!vsc_patch_is_solid(patch) || patch->family == VSC_TETS) continue;
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      most = fmax(most, update_pack(model, patch, k, x, &multiplier[k]));
  }
  return most;
}
