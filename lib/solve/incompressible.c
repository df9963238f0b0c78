// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/incompressible.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "mech/element.h"
#include "mech/force.h"
#include "model/law_volume.h"

enum { SECANTS = 20 };
// A difference of which no more than this part is new is rounding.
#define NEW_PART 1e-6

struct vsc_multipliers {
  const vsc_model *model;
  size_t count;  // numbers in each vector below: node_count, then pack_count x VSC_WIDTH; kPa
  int rounds;    // since vsc_multipliers_begin
  int secants;   // differences added since, of which the last SECANTS are kept
  double *kept;  // multipliers at vsc_multipliers_begin; owned, as all of these
  double *lambda, *former_lambda;  // now, a round ago
  double *f, *former_f;            // U'(J) there
  double *dlambda, *df;            // SECANTS x count
};

vsc_status vsc_multipliers_create(const vsc_model *model, vsc_multipliers **multipliers, vsc_error *error)
{
  vsc_multipliers *made;
  *multipliers = NULL;
  if (!(model->solve.incompressible > 0)) return VSC_OK;
  if (!VSC_NEW(made, 1)) return vsc_fail_memory(error, "multipliers");
  const size_t count = model->node_count + VSC_WIDTH * model->pack_count;
  made->model = model;
  made->count = count;
  if (!VSC_NEW(made->kept, count) || !VSC_NEW(made->lambda, count) || !VSC_NEW(made->former_lambda, count) ||
      !VSC_NEW(made->f, count) || !VSC_NEW(made->former_f, count) || !VSC_NEW(made->dlambda, SECANTS * count) ||
      !VSC_NEW(made->df, SECANTS * count)) {
    vsc_multipliers_free(made);
    return vsc_fail_memory(error, "multipliers");
  }
  *multipliers = made;
  return VSC_OK;
}

void vsc_multipliers_free(vsc_multipliers *m)
{
  if (m == NULL) return;
  vsc_free(m->kept);
  vsc_free(m->lambda);
  vsc_free(m->former_lambda);
  vsc_free(m->f);
  vsc_free(m->former_f);
  vsc_free(m->dlambda);
  vsc_free(m->df);
  vsc_free(m);
}

static void take(const vsc_multipliers *m, const vsc_scratch *scratch, double *lambda)
{
  const size_t nodes = m->model->node_count;
  memcpy(lambda, scratch->node_multiplier, nodes * sizeof *lambda);
  memcpy(lambda + nodes, scratch->pack_multiplier, (m->count - nodes) * sizeof *lambda);
}

static void give(const vsc_multipliers *m, const double *lambda, vsc_scratch *scratch)
{
  const size_t nodes = m->model->node_count;
  memcpy(scratch->node_multiplier, lambda, nodes * sizeof *lambda);
  memcpy(scratch->pack_multiplier, lambda + nodes, (m->count - nodes) * sizeof *lambda);
}

void vsc_multipliers_begin(vsc_multipliers *m, const vsc_scratch *scratch)
{
  if (m == NULL) return;
  m->rounds = m->secants = 0;
  take(m, scratch, m->kept);
}

void vsc_multipliers_restore(const vsc_multipliers *m, vsc_scratch *scratch)
{
  if (m != NULL) give(m, m->kept, scratch);
}

static double look_at_nodes(const vsc_model *model, const double *x, vsc_scratch *scratch, double *f)
{
  double *ratio = scratch->trial + 4 * model->node_count, most = 0;
  vsc_group_ratios(model, x, scratch, ratio);
  for (size_t n = 0; n < model->node_count; n++) {
    if (!(model->group_modulus[n] > 0)) continue;
    f[n] = vsc_volume_stress(vsc_splat(model->group_modulus[n]), vsc_splat(ratio[n]))[0];
    most = fmax(most, fabs(ratio[n] - 1));
  }
  return most;
}

static double look_at_pack(const vsc_model *model, const vsc_patch *patch, size_t k, const double *x, double *f)
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
    f[l] = vsc_volume_stress(law.volume_modulus, vsc_splat(J))[l];
    most = fmax(most, fabs(J - 1));
  }
  return most;
}

// f at x, and the largest |J - 1|.
static double look(vsc_multipliers *m, const double *x, vsc_scratch *scratch)
{
  const vsc_model *model = m->model;
  double *packs = m->f + model->node_count;
  double most = model->terms.nodal_volume ? look_at_nodes(model, x, scratch, m->f) : 0;
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!vsc_patch_is_solid(patch) || patch->family == VSC_TETS) continue;
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      most = fmax(most, look_at_pack(model, patch, k, x, packs + VSC_WIDTH * k));
  }
  return most;
}

static double dot(const double *a, const double *b, size_t count)
{
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += a[i] * b[i];
  return sum;
}

// The differences to the round before, the oldest ones gone, freed of what the others show and scaled to |df| = 1.
static void add_secant(vsc_multipliers *m)
{
  const size_t count = m->count;
  const int others = m->secants < SECANTS ? m->secants : SECANTS;
  const int slot = m->secants % SECANTS;
  double *df = m->df + (size_t)slot * count, *dlambda = m->dlambda + (size_t)slot * count;
  for (size_t i = 0; i < count; i++) {
    df[i] = m->f[i] - m->former_f[i];
    dlambda[i] = m->lambda[i] - m->former_lambda[i];
  }
  const double whole = sqrt(dot(df, df, count));
  for (int k = 0; k < others; k++) {
    const double *q = m->df + (size_t)k * count, *s = m->dlambda + (size_t)k * count;
    if (k == slot) continue;
    const double part = dot(q, df, count);
    for (size_t i = 0; i < count; i++) df[i] -= part * q[i];
    for (size_t i = 0; i < count; i++) dlambda[i] -= part * s[i];
  }
  const double left = sqrt(dot(df, df, count));
  const double scale = left > NEW_PART * whole ? 1 / left : 0;
  for (size_t i = 0; i < count; i++) df[i] *= scale;
  for (size_t i = 0; i < count; i++) dlambda[i] *= scale;
  m->secants++;
}

double vsc_multipliers_update(vsc_multipliers *m, const double *x, vsc_scratch *scratch)
{
  const size_t count = m->count, bytes = count * sizeof *m->f;
  const double most = look(m, x, scratch);
  if (most <= m->model->solve.incompressible) return most;
  take(m, scratch, m->lambda);
  if (m->rounds > 0) add_secant(m);
  memcpy(m->former_lambda, m->lambda, bytes);
  memcpy(m->former_f, m->f, bytes);
  for (size_t i = 0; i < count; i++) m->lambda[i] += m->f[i];
  for (int k = 0; k < m->secants && k < SECANTS; k++) {
    const double *df = m->df + (size_t)k * count, *dlambda = m->dlambda + (size_t)k * count;
    const double part = dot(df, m->f, count);
    for (size_t i = 0; i < count; i++) m->lambda[i] -= part * (dlambda[i] + df[i]);
  }
  give(m, m->lambda, scratch);
  m->rounds++;
  return most;
}
