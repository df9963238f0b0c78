// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/events.h"

#include <math.h>

#define USUAL_LOOK 1.0    // ms between two looks of the energy ledger,
#define STEPS_OF_LOOK 32  // or as many steps, whichever is longer
#define LOOKS_PER_PERIOD 16
#define MOST_EVENTS 100000  // that are counted one by one

// A period must not slip through between two looks.
static void resolve(const vsc_curve *curve, double *look)
{
  if (curve->period > 0) *look = fmin(*look, curve->period / LOOKS_PER_PERIOD);
}

// The longest way between two looks of the ledger, ms.
static double longest_look(const vsc_model *model)
{
  double look = HUGE_VAL;
  for (size_t m = 0; m < model->material_count; m++)
    if (model->materials[m].active != VSC_ACTIVE_NONE) resolve(&model->materials[m].curve, &look);
  for (size_t p = 0; p < model->pressure_count; p++) resolve(&model->pressures[p].curve, &look);
  for (size_t s = 0; s < model->moved_count; s++) resolve(&model->moved[s].curve, &look);
  return look;
}

double vsc_events_look(const vsc_model *model, const vsc_state *state, double rows)
{
  if (model->solve.kind != VSC_SOLVE_EXPLICIT) return rows;
  const double step = model->step > 0 ? model->step : state->limit.first;
  const double usual = fmax(USUAL_LOOK, STEPS_OF_LOOK * step);
  return rows / fmax(fmax(round(rows / usual), ceil(rows / longest_look(model))), 1);
}

// The next multiple of `interval` after `time`, or `end` if that comes first or the interval is 0.
static double next_multiple(double time, double interval, double end)
{
  if (!(interval > 0)) return end;
  const double next = interval * (floor(time / interval * (1 + VSC_SAME_TIME)) + 1);
  return next < end * (1 - VSC_SAME_TIME) ? next : end;
}

double vsc_events_next(const vsc_problem *problem, double look, double time)
{
  const vsc_output_def *output = &problem->scene->output;
  const double end = problem->model->end_time;
  double next = next_multiple(time, look, end);
  next = fmin(next, next_multiple(time, output->frame_interval, end));
  next = fmin(next, next_multiple(time, output->checkpoint_interval, end));
  return fmin(next, next_multiple(time, problem->model->cycle, end));
}

bool vsc_events_between(double before, double now, double interval, double end)
{
  if (now >= end * (1 - VSC_SAME_TIME)) return true;
  return interval > 0 && next_multiple(before, interval, end) <= now * (1 + VSC_SAME_TIME);
}

double vsc_events_steps(const vsc_problem *problem, double look, double start, double dt)
{
  const double end = problem->model->end_time;
  if (problem->model->step > 0) return ceil((end - start) / dt * (1 - VSC_SAME_TIME));
  double time = start, steps = 0;
  for (size_t k = 0; k < MOST_EVENTS && time < end * (1 - VSC_SAME_TIME); k++) {
    const double next = vsc_events_next(problem, look, time);
    steps += fmax(ceil((next - time) / dt * (1 - VSC_SAME_TIME)), 1);
    time = next;
  }
  return time > start ? steps * (end - start) / (time - start) : 0;
}

double vsc_events_frames(const vsc_problem *problem, double start)
{
  const double interval = problem->scene->output.frame_interval, end = problem->model->end_time;
  return 1 + ceil(end / interval * (1 - VSC_SAME_TIME)) - floor(start / interval * (1 + VSC_SAME_TIME));
}
