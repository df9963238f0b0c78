// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/lost.h"

#include "run/job.h"

bool vsc_job_has_lost(const vsc_job *job)
{
  const vsc_model *model = job->problem->model;
  return model->solve.kind == VSC_SOLVE_EXPLICIT && vsc_state_find_bad(model, job->state) < model->node_count;
}

vsc_status vsc_job_find_lost(vsc_job *job, vsc_error *error)
{
  const vsc_model *model = job->problem->model;
  const double seen = job->state->time;
  const double repeated = job->repeated, caution = job->state->limit.caution;
  vsc_lost lost;
  vsc_job_go_back(job);
  job->repeated = repeated;
  job->state->limit.caution = caution;
  // steps that end elsewhere may lose it a little later
  const double until = seen + (seen - job->state->time);
  if (!vsc_find_lost(model, job->state, until, &lost)) return VSC_NUMERICAL;
  char node[VSC_NODE_TEXT], culprit[VSC_CULPRIT_TEXT];
  return vsc_fail(error, VSC_NUMERICAL,
                  "at %.6g ms (step %.0f) the position of %s, is no longer a finite number%s: the simulation has "
                  "blown up; take a smaller %s, more damping, or a smaller load",
                  lost.time, lost.steps, vsc_name_node(model, lost.node, node, sizeof node),
                  vsc_name_culprit(&lost.culprit, " a step before", culprit, sizeof culprit), model->step > 0 ? "time.step" : "time.safety");
}
