// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/step_limit.h"

#include <math.h>
#include <string.h>

#include "mech/element.h"
#include "mech/force.h"

// Noise in each estimate's first vector, as a part of its length. The estimate's error from it is
// below NOISE^2/20 after four iterations.
#define NOISE 0.5
// Iterations go on while one raises the eigenvalue by more than this factor, up to MOST_ITERATIONS.
#define RISING 1.001
enum { MOST_ITERATIONS = 40 };

// Numbers in [-1, 1) that are the same everywhere (a 64-bit linear congruential generator, Knuth's
// MMIX).
static double next_random(uint64_t *seed)
{
  *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(int64_t)*seed * 0x1p-63;
}

// |d| in the mass norm.
static double mass_norm(const vsc_model *model, const double *d)
{
  double sum = 0;
  for (size_t n = 0; n < model->node_count; n++)
    sum += model->mass[n] *
           (d[4 * n] * d[4 * n] + d[4 * n + 1] * d[4 * n + 1] + d[4 * n + 2] * d[4 * n + 2]);
  return sqrt(sum);
}

// mode <- mode + a random one of NOISE times its length (any length when there is none yet): what
// becomes the stiffest elsewhere must not have to grow from nothing.
static void stir_mode(const vsc_model *model, uint64_t seed, double *mode, double *noise)
{
  memset(noise, 0, 4 * model->node_count * sizeof *noise);
  for (size_t i = 0; i < 4 * model->node_count; i++)
    if (model->inverse_mass[i] > 0) noise[i] = next_random(&seed);
  const double length = mass_norm(model, mode);
  const double scale = length > 0 ? NOISE * length / mass_norm(model, noise) : 1;
  for (size_t i = 0; i < 4 * model->node_count; i++) mode[i] += scale * noise[i];
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
  return 1e-6 * cbrt(model->total_volume / (double)model->element_count);
}

// mode <- M^-1 (K + 4/dt C) mode by a difference of forces; returns the growth of its norm.
static double apply_system(const vsc_model *model, vsc_state *state, double time,
                           const double *base)
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
  stir_mode(model, 1 + (uint64_t)limit->refreshes, limit->mode, state->scratch.trial);
  // forces at the same place without velocity; state->force is free: the next step rewrites it
  vsc_force(model, state->x, NULL, time, &state->scratch, state->force);
  double eigenvalue = 0, before = 0;
  for (int i = 0; i < iterations || (i < MOST_ITERATIONS && eigenvalue > RISING * before); i++) {
    before = eigenvalue;
    eigenvalue = apply_system(model, state, time, state->force);
    scale_mode(model, limit->mode);
    if (eigenvalue > 0) limit->step = model->safety * 2 / sqrt(1.1 * eigenvalue);
  }
  limit->eigenvalue = eigenvalue;
  limit->refreshes++;
}

// A bound of the springs' tangent at rest: E_a along an axis, 2 G_ab across; a fibre that pulls
// with a tension T adds T across, T = E_f (1 - r) in an active spring.
static double stiffest_springs(const vsc_material *material)
{
  double along = 0, across = 0, tension = 0;
  for (int a = 0; a < 3; a++) {
    along = fmax(along, material->axial[a]);
    across = fmax(across, 2 * material->angular[a]);
  }
  if (material->active == VSC_ACTIVE_SPRING) {
    along = fmax(along, material->active_stiffness);
    tension = along * (1 - material->rest_stretch);
  }
  if (material->active != VSC_ACTIVE_TENSION) return fmax(along, across + tension);
  return fmax(along, across) + material->tension;
}

// K of tet l: its own, and the mean of its nodes' groups': V_n J_n'^2 <= sum_e V_e/4 J_e'^2.
static double volume_modulus(const vsc_model *model, const vsc_patch *patch, const vsc_pack *pack,
                             int l)
{
  double modulus = model->materials[patch->material].element_modulus;
  for (int c = 0; model->terms.nodal_volume && c < 4; c++)
    modulus += model->group_modulus[vsc_node_of(model, patch, pack->node[c][l])] / 4;
  return modulus;
}

// |B_i|^2 of corner c of tet l
static double gradient_square(const vsc_pack *pack, int c, int l)
{
  double square = 0;
  for (int a = 0; a < 3; a++) {
    const double B =
        c > 0 ? pack->B[a][c - 1][l] : -(pack->B[a][0][l] + pack->B[a][1][l] + pack->B[a][2][l]);
    square += B * B;
  }
  return square;
}

static void add_node_stiffness(const vsc_model *model, double *stiffness)
{
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    const double springs = stiffest_springs(&model->materials[patch->material]);
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      for (int l = 0; l < VSC_WIDTH; l++) {
        const vsc_pack *pack = &model->packs[k];
        const double modulus = springs + volume_modulus(model, patch, pack, l);
        for (int c = 0; c < 4; c++)
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
      if (model->mesh_element[k] == VSC_NO_ELEMENT) continue;
      double sum = 0;
      for (int c = 0; c < 4; c++) {
        const uint32_t node =
            vsc_node_of(model, patch, model->packs[k / VSC_WIDTH].node[c][k % VSC_WIDTH]);
        sum += stiffness[node] / model->mass[node];
      }
      if (sum > most) *slot = k;
      most = fmax(most, sum);
    }
  }
  return most;
}
