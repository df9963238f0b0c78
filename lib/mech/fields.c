// SPDX-License-Identifier: GPL-3.0-or-later
#include <string.h>

#include "mech/element.h"
#include "mech/force.h"
#include "mech/observe.h"

bool vsc_field_on_nodes(vsc_field field)
{
  return field <= VSC_FIELD_GROUP_RATIO;
}

int vsc_field_components(vsc_field field)
{
  switch (field) {
    case VSC_FIELD_GROUP_RATIO:
    case VSC_FIELD_ACTIVE_TENSION:
    case VSC_FIELD_STRETCH:
    case VSC_FIELD_VOLUME_RATIO:
      return 1;
    default:
      return 3;
  }
}

static void read_nodes(const vsc_model *model, vsc_state *state, vsc_field field, double *values)
{
  double *ratio = state->scratch.trial;
  if (field == VSC_FIELD_GROUP_RATIO && model->terms.nodal_volume)
    vsc_group_ratios(model, state->x, &state->scratch, ratio);
  for (size_t n = 0; n < model->node_count; n++) {
    const size_t node = model->mesh_node[n];
    if (field == VSC_FIELD_GROUP_RATIO) {
      values[node] = model->terms.nodal_volume ? ratio[n] : 1;
      continue;
    }
    for (int i = 0; i < 3; i++)
      values[3 * node + i] = field == VSC_FIELD_VELOCITY
                                 ? state->v[4 * n + i]
                                 : state->x[4 * n + i] - model->rest[4 * n + i];
  }
}

static void read_slot(const vsc_model *model, const vsc_state *state, const vsc_material *material,
                      const vsc_frame_axes *frame, double J, vsc_field field, size_t slot,
                      double *value)
{
  const int l = (int)(slot % VSC_WIDTH);
  double nominal;
  switch (field) {
    case VSC_FIELD_ACTIVE_TENSION:
      *value =
          vsc_active_tension(model, material, slot, state->time, frame->length[0][l], &nominal);
      break;
    case VSC_FIELD_STRETCH:
      *value = frame->length[0][l];
      break;
    case VSC_FIELD_VOLUME_RATIO:
      *value = J;
      break;
    default: {
      const vsc_wide3 *u = &frame->u[field - VSC_FIELD_FIBER];
      const double known = model->known[slot];
      value[0] = known * u->x[l];
      value[1] = known * u->y[l];
      value[2] = known * u->z[l];
    }
  }
}

static void read_tets(const vsc_model *model, const vsc_state *state, vsc_field field,
                      double *values)
{
  const int components = vsc_field_components(field);
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++) {
      vsc_wide3 g[3];
      vsc_pack_axes(model, patch, &model->packs[k], state->x, g);
      const vsc_frame_axes frame = vsc_frame_of(g);
      const vsc_wide J = vsc_pack_ratio(g);
      for (int l = 0; l < VSC_WIDTH; l++) {
        const size_t slot = VSC_WIDTH * k + l, tet = model->mesh_element[slot];
        if (tet == VSC_NO_ELEMENT) continue;
        read_slot(model, state, &model->materials[patch->material], &frame, J[l], field, slot,
                  values + components * tet);
      }
    }
  }
}

void vsc_read_field(const vsc_model *model, vsc_state *state, vsc_field field, double *values)
{
  if (vsc_field_on_nodes(field))
    read_nodes(model, state, field, values);
  else
    read_tets(model, state, field, values);
}
