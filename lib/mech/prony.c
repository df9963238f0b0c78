// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/prony.h"

#include <math.h>

#include "base/parallel.h"
#include "mech/element.h"
#include "model/law.h"
#include "model/law_volume.h"

// Of each frame: E, S_0, h_1, h_2, ...; six numbers each.
enum { STRAIN = 0, STRESS = 6, BRANCHES = 12 };

static size_t frame_size(const vsc_model *model)
{
  return BRANCHES + 6 * model->branch_count;
}

static vsc_wide *memory_of(const vsc_model *model, const double *prony, size_t frame)
{
  return (vsc_wide *)prony + frame_size(model) * frame;
}

static size_t first_work(const vsc_model *model)
{
  return VSC_WIDTH * frame_size(model) * model->frame_count;
}

size_t vsc_prony_size(const vsc_model *model)
{
  return model->branch_count > 0 ? first_work(model) + model->patch_count : 0;
}

static size_t frame_of(const vsc_model *model, const vsc_patch *patch, size_t k, int q)
{
  const size_t points = (size_t)vsc_family_frames(model, patch->family);
  return patch->first_frame + (k - patch->first_pack) * points + (size_t)q;
}

static vsc_law_input law_of(const vsc_model *model, const vsc_material *material)
{
  return (vsc_law_input){.material = material,
                         .axes = model->axes + material->first_axis,
                         .pairs = model->pairs + material->first_pair,
                         .moduli = vsc_moduli_or(material, NULL)};
}

VSC_INLINE vsc_wide share_of(const vsc_model *model, const vsc_patch *patch, size_t k)
{
  return patch->mixed ? vsc_pack_mixture(model, patch, k)->share : vsc_splat(1);
}

// S_0 of the own material's share, with J p C^-1 of p = -m/J: (C^-1)_ab = cof_a . cof_b / J^2.
VSC_INLINE void passive_stress(const vsc_law_input *in, vsc_wide share, const vsc_wide3 g[3],
                               const vsc_wide e[6], vsc_wide S[6])
{
  vsc_law_answer answer;
  vsc_wide3 cofactor[3];
  vsc_law_evaluate(in, e, VSC_LAW_STRESS, &answer);
  for (int a = 0; a < 3; a++) cofactor[a] = vsc_wide_cross(g[(a + 1) % 3], g[(a + 2) % 3]);
  const vsc_wide J = vsc_wide_dot(g[0], cofactor[0]), J0 = vsc_splat(VSC_VOLUME_J0);
  const vsc_wide part =
      vsc_rest_stress(vsc_splat(in->material->rest_shear), J) / vsc_select(J > J0, J, J0);
  for (int a = 0; a < 3; a++) {
    S[a] = share * (answer.S[a] + part * vsc_wide_dot(cofactor[a], cofactor[a]));
    S[3 + a] = share * (answer.S[3 + a] + part * vsc_wide_dot(cofactor[a], cofactor[(a + 1) % 3]));
  }
}

// What a step of dt does to the branches of a material: e^(-dt/tau_i), g_i w_i and L.
typedef struct branch_step {
  double decay[VSC_MOST_BRANCHES], gain[VSC_MOST_BRANCHES], loss;
} branch_step;

static branch_step step_of(const vsc_material *material, double dt)
{
  branch_step step = {0};
  for (size_t i = 0; i < material->branch_count; i++) {
    const double x = dt / material->branches[i].time, g = material->branches[i].modulus;
    step.decay[i] = exp(-x);
    step.gain[i] = x > 0 ? -g * expm1(-x) / x : g;
    step.loss += g - step.gain[i];
  }
  return step;
}

// H = sum_i (e^(-dt/tau_i) h_i - g_i w_i S_0 before) of one frame.
VSC_INLINE void past_of(const vsc_material *material, const branch_step *step, const vsc_wide *memory, vsc_wide H[6])
{
  for (int k = 0; k < 6; k++) {
    H[k] = vsc_splat(0);
    for (size_t i = 0; i < material->branch_count; i++)
      H[k] += step->decay[i] * memory[BRANCHES + 6 * i + (size_t)k] - step->gain[i] * memory[STRESS + k];
  }
}

// Carries one frame on to strain e and stress S_0; returns (S - S_0) : dE of the step, by the
// trapezoidal rule.
VSC_INLINE vsc_wide carry_frame(const vsc_material *material, const branch_step *step,
                                const vsc_wide e[6], const vsc_wide S[6], vsc_wide *memory)
{
  vsc_wide work = vsc_splat(0);
  for (int k = 0; k < 6; k++) {
    const vsc_wide before = memory[STRESS + k], change = S[k] - before;
    vsc_wide both = vsc_splat(0);  // S - S_0 before and after
    for (size_t i = 0; i < material->branch_count; i++) {
      vsc_wide *h = &memory[BRANCHES + 6 * i + (size_t)k];
      both += *h - material->branches[i].modulus * before;
      *h = step->decay[i] * *h + step->gain[i] * change;
      both += *h - material->branches[i].modulus * S[k];
    }
    work += 0.5 * both * (e[k] - memory[STRAIN + k]);
    memory[STRESS + k] = S[k];
    memory[STRAIN + k] = e[k];
  }
  return work;
}

typedef struct carrying {
  const vsc_model *model;
  vsc_state *state;
  double dt;
} carrying;

VSC_CLONED static void carry_patch(void *context, size_t p, int thread)
{
  (void)thread;
  const carrying *c = context;
  const vsc_model *model = c->model;
  const vsc_patch *patch = &model->patches[p];
  if (!vsc_patch_is_solid(patch)) return;
  const vsc_material *material = &model->materials[patch->material];
  if (material->branch_count == 0) return;
  const branch_step step = step_of(material, c->dt);
  const vsc_law_input in = law_of(model, material);
  double sum = 0;
  for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++) {
    const vsc_wide share = share_of(model, patch, k);
    for (int q = 0; q < vsc_family_frames(model, patch->family); q++) {
      vsc_wide3 g[3];
      vsc_wide e[6], S[6];
      vsc_pack_axes(model, patch, k, q, c->state->x, g);
      vsc_strain_of(g, e);
      passive_stress(&in, share, g, e, S);
      vsc_wide *memory = memory_of(model, c->state->prony, frame_of(model, patch, k, q));
      const vsc_wide work =
          vsc_pack_frames(model, patch, k)[q].V * carry_frame(material, &step, e, S, memory);
      for (int l = 0; l < VSC_WIDTH; l++) sum += work[l];
    }
  }
  c->state->prony[first_work(model) + p] += sum;
}

void vsc_prony_step(const vsc_model *model, vsc_state *state, double dt)
{
  carrying c = {model, state, dt};
  vsc_parallel_for(model->patch_count, carry_patch, &c);
}

void vsc_prony_stress(const vsc_model *model, const vsc_material *material, const double *prony,
                      size_t frame, vsc_wide S[6])
{
  const branch_step step = step_of(material, 0);
  past_of(material, &step, memory_of(model, prony, frame), S);
}

double vsc_prony_past(const vsc_model *model, const vsc_patch *patch, size_t k, const double *prony,
                      double dt, vsc_wide (*H)[6])
{
  const vsc_material *material = &model->materials[patch->material];
  const branch_step step = step_of(material, dt);
  for (int q = 0; q < vsc_family_frames(model, patch->family); q++)
    past_of(material, &step, memory_of(model, prony, frame_of(model, patch, k, q)), H[q]);
  return step.loss;
}

// f_i = -sum_k D_ki V sum_a P_a T_ak of stress S on frame q of four cells with axes g.
VSC_INLINE void add_force(const vsc_model *model, const vsc_patch *patch, size_t k, int q, const vsc_wide3 g[3],
                          const vsc_wide S[6], double *f)
{
  const uint16_t(*node)[VSC_WIDTH] = vsc_pack_nodes(model, patch, k);
  const vsc_frame *frame = vsc_pack_frames(model, patch, k) + q;
  vsc_wide3 P[3], flux[3];
  vsc_stress_on_axes(S, g, P);
  for (int i = 0; i < 3; i++)
    flux[i] = vsc_wide_scale(-frame->V, vsc_wide_combine(frame->T[0][i], P[0], frame->T[1][i],
                                                         P[1], frame->T[2][i], P[2]));
  for (int c = 0; c < vsc_family_corners(patch->family); c++)
    for (int i = 0; i < 3; i++) {
      const double D = model->rules[patch->family].D[q][i][c];
      for (int l = 0; l < VSC_WIDTH; l++) {
        double *to = f + 4 * (size_t)node[c][l];
        to[0] += D * flux[i].x[l];
        to[1] += D * flux[i].y[l];
        to[2] += D * flux[i].z[l];
      }
    }
}

VSC_CLONED void vsc_prony_force(const vsc_model *model, const vsc_patch *patch, const double *prony, double dt,
                                const double *x, double *f)
{
  const vsc_material *material = &model->materials[patch->material];
  if (!vsc_patch_is_solid(patch) || material->branch_count == 0) return;
  const branch_step step = step_of(material, dt);
  const vsc_law_input in = law_of(model, material);
  for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
    for (int q = 0; q < vsc_family_frames(model, patch->family); q++) {
      vsc_wide3 g[3];
      vsc_wide e[6], S[6], now[6];
      vsc_pack_axes(model, patch, k, q, x, g);
      past_of(material, &step, memory_of(model, prony, frame_of(model, patch, k, q)), S);
      if (step.loss > 0) {
        vsc_strain_of(g, e);
        passive_stress(&in, share_of(model, patch, k), g, e, now);
        for (int i = 0; i < 6; i++) S[i] -= step.loss * now[i];
      }
      add_force(model, patch, k, q, g, S, f);
    }
}

double vsc_prony_work(const vsc_model *model, const vsc_state *state)
{
  double work = 0;
  for (size_t p = 0; model->branch_count > 0 && p < model->patch_count; p++)
    work += state->prony[first_work(model) + p];
  return work;
}
