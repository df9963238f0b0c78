// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/cycle.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"

// Root of the mean square of a - b over nodes; b NULL: of a.
static double rms(const vsc_model *model, const double *a, const double *b)
{
  double sum = 0;
  for (size_t i = 0; i < 4 * model->node_count; i++) {
    const double d = a[i] - (b != NULL ? b[i] : 0);
    sum += d * d;
  }
  return sqrt(sum / (double)model->node_count);
}

static void keep(const vsc_model *model, const vsc_state *state, vsc_cycle *cycle)
{
  const size_t count = 4 * model->node_count;
  memcpy(cycle->kept, state->x, count * sizeof(double));
  memcpy(cycle->kept + count, state->v, count * sizeof(double));
  cycle->stroke = cycle->speed = 0;
}

vsc_status vsc_cycle_begin(const vsc_model *model, const vsc_state *state, vsc_cycle *cycle, vsc_error *error)
{
  *cycle = (vsc_cycle){.difference = 1};
  if (!VSC_NEW(cycle->kept, 8 * model->node_count)) return vsc_fail_memory(error, "the last cycle");
  keep(model, state, cycle);
  return VSC_OK;
}

void vsc_cycle_look(const vsc_model *model, const vsc_state *state, vsc_cycle *cycle)
{
  cycle->stroke = fmax(cycle->stroke, rms(model, state->x, cycle->kept));
  cycle->speed = fmax(cycle->speed, rms(model, state->v, NULL));
}

void vsc_cycle_end(const vsc_model *model, const vsc_state *state, vsc_cycle *cycle)
{
  const double *v = cycle->kept + 4 * model->node_count;
  const double off = cycle->stroke > 0 ? rms(model, state->x, cycle->kept) / cycle->stroke : 1;
  const double faster = cycle->speed > 0 ? rms(model, state->v, v) / cycle->speed : 0;
  cycle->ended++;
  cycle->difference = cycle->ended > 1 ? fmax(off, faster) : 1;
  keep(model, state, cycle);
}
