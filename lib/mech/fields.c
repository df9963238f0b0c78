// SPDX-License-Identifier: GPL-3.0-or-later
#include <math.h>
#include <string.h>

#include "base/vec3.h"
#include "mech/element.h"
#include "mech/force.h"
#include "mech/observe.h"
#include "mech/tensors.h"

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
    case VSC_FIELD_VON_MISES:
    case VSC_FIELD_HELIX_ANGLE:
      return 1;
    case VSC_FIELD_STRAIN_FIBER:
    case VSC_FIELD_STRAIN:
    case VSC_FIELD_STRESS_FIBER:
    case VSC_FIELD_STRESS:
      return 6;
    default:
      return 3;
  }
}

vsc_status vsc_field_check(const vsc_model *model, vsc_field field, vsc_error *error)
{
  for (size_t p = 0; vsc_field_is_stress(field) && p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!vsc_patch_is_solid(patch) || vsc_patch_has_stress(model, patch)) continue;
    const vsc_material *material = &model->materials[patch->material];
    return vsc_fail(error, VSC_INPUT,
                    "stress of material \"%s\": law %s is not a function of strain; leave "
                    "stress out, or use law: springs",
                    material->name, material->law == VSC_LAW_PAPER ? "paper" : "classical");
  }
  return VSC_OK;
}

static void read_nodes(const vsc_model *model, vsc_state *state, vsc_field field, double *values)
{
  double *ratio = state->scratch.trial;
  if (field == VSC_FIELD_GROUP_RATIO && model->terms.nodal_volume)
    vsc_group_ratios(model, state->x, &state->scratch, ratio);
  for (size_t n = 0; n < model->node_count; n++) {
    const size_t node = model->mesh_node[n];
    if (field == VSC_FIELD_GROUP_RATIO) {
      values[node] = model->terms.nodal_volume && model->group_modulus[n] > 0 ? ratio[n] : 1;
      continue;
    }
    for (int i = 0; i < 3; i++)
      values[3 * node + i] = field == VSC_FIELD_VELOCITY
                                 ? state->v[4 * n + i]
                                 : state->x[4 * n + i] - model->rest[4 * n + i];
  }
}

// What the frames of an element show, as their mean by volume.
typedef struct element_means {
  vsc_wide3 u[3];  // not of unit length
  vsc_wide J, stretch, tension, volume;
} element_means;

static element_means mean_of_frames(const vsc_model *model, const vsc_state *state,
                                    const vsc_patch *patch, size_t k)
{
  const vsc_material *material = &model->materials[patch->material];
  const bool active = material->active != VSC_ACTIVE_NONE;
  vsc_pack_law law;
  vsc_wide activation = vsc_splat(0);
  if (active) {
    law = vsc_pack_law_of(model, patch, k);
    activation = vsc_pack_activation(model, material, k, state->time);
  }
  element_means mean = {0};
  for (int q = 0; q < vsc_family_frames(model, patch->family); q++) {
    const vsc_wide V = vsc_pack_frames(model, patch, k)[q].V;
    vsc_wide3 g[3];
    vsc_pack_axes(model, patch, k, q, state->x, g);
    const vsc_frame_axes frame = vsc_frame_of(g);
    for (int a = 0; a < 3; a++) mean.u[a] = vsc_wide_add(mean.u[a], vsc_wide_scale(V, frame.u[a]));
    mean.J += V * vsc_pack_ratio(g);
    mean.stretch += V * frame.length[0];
    mean.volume += V;
    vsc_wide way;
    if (active) mean.tension += V * vsc_active_tension(material, &law, activation, g, &way);
  }
  return mean;
}

static void read_slot(const vsc_model *model, const element_means *mean, vsc_field field,
                      size_t slot, double *value)
{
  const int l = (int)(slot % VSC_WIDTH);
  switch (field) {
    case VSC_FIELD_ACTIVE_TENSION:
      *value = mean->tension[l] / mean->volume[l];
      break;
    case VSC_FIELD_STRETCH:
      *value = mean->stretch[l] / mean->volume[l];
      break;
    case VSC_FIELD_VOLUME_RATIO:
      *value = mean->J[l] / mean->volume[l];
      break;
    default: {
      const vsc_wide3 *u = &mean->u[field - VSC_FIELD_FIBER];
      value[0] = u->x[l];
      value[1] = u->y[l];
      value[2] = u->z[l];
      vsc_normalize(value);
      for (int i = 0; i < 3; i++) value[i] *= model->known[slot];
    }
  }
}

static void read_elements(const vsc_model *model, const vsc_state *state, vsc_field field,
                          double *values)
{
  const int components = vsc_field_components(field);
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!vsc_patch_is_solid(patch)) continue;
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++) {
      const element_means mean = mean_of_frames(model, state, patch, k);
      for (int l = 0; l < VSC_WIDTH; l++) {
        const size_t slot = VSC_WIDTH * k + (size_t)l, element = model->mesh_element[slot];
        if (element == VSC_NO_ELEMENT) continue;
        read_slot(model, &mean, field, slot, values + (size_t)components * element);
      }
    }
  }
}

void vsc_read_field(const vsc_model *model, vsc_state *state, vsc_field field, double *values)
{
  if (vsc_field_on_nodes(field))
    read_nodes(model, state, field, values);
  else if (vsc_field_is_tensor(field))
    vsc_read_tensors(model, state, field, values);
  else
    read_elements(model, state, field, values);
}

// The mean place of an element's corners.
static void place_of(const vsc_model *model, const vsc_state *state, const vsc_patch *patch,
                     size_t slot, double place[3])
{
  const uint16_t(*node)[VSC_WIDTH] = vsc_pack_nodes(model, patch, slot / VSC_WIDTH);
  const int corners = vsc_family_corners(patch->family);
  for (int i = 0; i < 3; i++) place[i] = 0;
  for (int c = 0; c < corners; c++) {
    const uint32_t n = vsc_node_of(model, patch, node[c][slot % VSC_WIDTH]);
    for (int i = 0; i < 3; i++) place[i] += state->x[4 * (size_t)n + (size_t)i] / corners;
  }
}

void vsc_read_helix_angle(const vsc_model *model, const vsc_state *state, const double centre[3],
                          const double axis[3], double *values)
{
  double up[3] = {axis[0], axis[1], axis[2]};
  vsc_normalize(up);
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!vsc_patch_is_solid(patch)) continue;
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++) {
      const element_means mean = mean_of_frames(model, state, patch, k);
      for (int l = 0; l < VSC_WIDTH; l++) {
        const size_t slot = VSC_WIDTH * k + (size_t)l, element = model->mesh_element[slot];
        double f[3], place[3], away[3], round[3];
        if (element == VSC_NO_ELEMENT) continue;
        read_slot(model, &mean, VSC_FIELD_FIBER, slot, f);
        place_of(model, state, patch, slot, place);
        vsc_subtract(place, centre, away);
        vsc_cross(up, away, round);
        vsc_normalize(round);
        // fibres are axes: of the two ends the one that goes round with e_c counts
        const double along = vsc_dot(f, round), rise = vsc_dot(f, up);
        values[element] = 180 / M_PI * atan2(along < 0 ? -rise : rise, fabs(along));
      }
    }
  }
}
