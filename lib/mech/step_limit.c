// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/step_limit.h"

#include <math.h>
#include <string.h>

#include "mech/element.h"
#include "mech/force.h"

// Numbers in [-1, 1) that are the same everywhere (a 64-bit linear congruential generator, Knuth's MMIX).
static double next_random(uint64_t *seed)
{
  *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(int64_t)*seed * 0x1p-63;
}

static void random_mode(const vsc_model *model, double *mode)
{
  uint64_t seed = 1;
  for (size_t n = 0; n < model->node_count; n++)
    for (int i = 0; i < 3; i++)
      if (model->inverse_mass[4 * n + i] > 0) mode[4 * n + i] = next_random(&seed);
}

// |d| in the mass norm.
static double mass_norm(const vsc_model *model, const double *d)
{
  double sum = 0;
  for (size_t n = 0; n < model->node_count; n++)
    sum += model->mass[n] * (d[4 * n] * d[4 * n] + d[4 * n + 1] * d[4 * n + 1] + d[4 * n + 2] * d[4 * n + 2]);
  return sqrt(sum);
}

static double largest(const vsc_model *model, const double *d)
{
  double most = 0;
  for (size_t i = 0; i < 4 * model->node_count; i++) most = fmax(most, fabs(d[i]));
  return most;
}

// A length far below an element and far above the rounding of positions.
static double probe_length(const vsc_model *model)
{
  return 1e-6 * cbrt(model->total_volume / (double)model->tet_count);
}

// mode <- M^-1 (K + 4/dt C) mode by a difference of forces; returns the growth of its norm.
static double apply_system(const vsc_model *model, vsc_state *state, double time, const double *base)
{
  const size_t count = 4 * model->node_count;
  double *mode = state->limit.mode, *x = state->scratch.trial, *w = x + count;
  const double norm = mass_norm(model, mode), most = largest(model, mode);
  if (!(most > 0)) return 0;
  const double size = probe_length(model) / most;
  const double rate = state->limit.step > 0 ? 4 / state->limit.step : 0;
  for (size_t i = 0; i < count; i++) {
    x[i] = state->x[i] + size * mode[i];
    w[i] = size * rate * mode[i];
  }
  vsc_force(model, x, w, time, &state->scratch, state->scratch.trial + 2 * count);
  const double *moved = state->scratch.trial + 2 * count;
  for (size_t i = 0; i < count; i++) mode[i] = model->inverse_mass[i] * (base[i] - moved[i]) / size;
  return mass_norm(model, mode) / norm;
}

static void scale_mode(const vsc_model *model, double *mode)
{
  const double most = largest(model, mode);
  if (most > 0)
    for (size_t i = 0; i < 4 * model->node_count; i++) mode[i] /= most;
}

void vsc_limit_refresh(const vsc_model *model, vsc_state *state, double time, int iterations)
{
  vsc_limit *limit = &state->limit;
  if (!(limit->eigenvalue > 0)) random_mode(model, limit->mode);
  // forces at the same place without velocity; state->force is free: the next step rewrites it
  vsc_force(model, state->x, NULL, time, &state->scratch, state->force);
  double eigenvalue = 0;
  for (int i = 0; i < iterations; i++) {
    eigenvalue = apply_system(model, state, time, state->force);
    scale_mode(model, limit->mode);
    if (eigenvalue > 0) limit->step = model->safety * 2 / sqrt(1.1 * eigenvalue);
  }
  limit->eigenvalue = eigenvalue;
  limit->refreshes++;
}

// K + A of a material; A bounds the tangent of the axial (E_a) and angular (2 G_ab) springs at rest.
static double stiffest(const vsc_material *material)
{
  double most = material->active == VSC_ACTIVE_SPRING ? material->active_stiffness : 0;
  for (int a = 0; a < 3; a++) most = fmax(most, fmax(material->axial[a], 2 * material->angular[a]));
  if (material->active == VSC_ACTIVE_TENSION) most += material->tension;
  return most + fmax(material->volume_modulus, 0) + material->element_modulus;
}

// |B_i|^2 of corner c of tet l
static double gradient_square(const vsc_pack *pack, int c, int l)
{
  double square = 0;
  for (int a = 0; a < 3; a++) {
    const double B = c > 0 ? pack->B[a][c - 1][l] : -(pack->B[a][0][l] + pack->B[a][1][l] + pack->B[a][2][l]);
    square += B * B;
  }
  return square;
}

static void add_node_stiffness(const vsc_model *model, double *stiffness)
{
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    const double modulus = stiffest(&model->materials[patch->material]);
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      for (int c = 0; c < 4; c++)
        for (int l = 0; l < VSC_WIDTH; l++) {
          const vsc_pack *pack = &model->packs[k];
          stiffness[vsc_node_of(model, patch, pack->node[c][l])] +=
              pack->V[l] * modulus * gradient_square(pack, c, l);
        }
  }
}

double vsc_limit_bound(const vsc_model *model, vsc_scratch *scratch, size_t *slot)
{
  double *stiffness = scratch->trial, most = 0;
  memset(stiffness, 0, model->node_count * sizeof *stiffness);
  add_node_stiffness(model, stiffness);
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    const size_t first = VSC_WIDTH * (size_t)patch->first_pack;
    for (size_t k = first; k < first + VSC_WIDTH * (size_t)patch->pack_count; k++) {
      if (model->mesh_tet[k] == VSC_NO_TET) continue;
      double sum = 0;
      for (int c = 0; c < 4; c++) {
        const uint32_t node = vsc_node_of(model, patch, model->packs[k / VSC_WIDTH].node[c][k % VSC_WIDTH]);
        sum += stiffness[node] / model->mass[node];
      }
      if (sum > most) *slot = k;
      most = fmax(most, sum);
    }
  }
  return most;
}
