// SPDX-License-Identifier: GPL-3.0-or-later
#include <math.h>
#include <string.h>
#include <stdio.h>

#include "base/parallel.h"
#include "io/replace.h"
#include "mech/kernel.h"
#include "run/job.h"
#include "run/prestress.h"
#include "solve/implicit.h"

// A text as a JSON string.
static void write_string(FILE *file, const char *key, const char *text, const char *end)
{
  fprintf(file, "  \"%s\": \"", key);
  for (const char *c = text; *c != '\0'; c++) {
    if (*c == '"' || *c == '\\') fputc('\\', file);
    if ((unsigned char)*c >= ' ') fputc(*c, file);
  }
  fprintf(file, "\"%s\n", end);
}

// JSON knows no NaN and no infinity.
static void write_number(FILE *file, const char *key, double value, const char *end)
{
  if (isfinite(value))
    fprintf(file, "  \"%s\": %.10g%s\n", key, value, end);
  else
    fprintf(file, "  \"%s\": null%s\n", key, end);
}

// What the estimates of the stable step were worth: steps of a run that had known the shortest of them from the
// start and had kept to it, less those that were taken.
static void write_steps(const vsc_job *job, FILE *file)
{
  const vsc_limit *limit = &job->state->limit;
  if (job->problem->model->solve.kind != VSC_SOLVE_EXPLICIT) return;
  write_number(file, "step_estimates", limit->refreshes, ",");
  write_number(file, "shortest_allowed_step_ms", limit->least, ",");
  if (limit->span > 0) write_number(file, "steps_saved", limit->span / limit->least - job->state->steps, ",");
}

// What Newton's method has done since this run began, a resumed one too: checkpoints do not have it.
static void write_newton(const vsc_job *job, FILE *file)
{
  const vsc_model *model = job->problem->model;
  const vsc_newton *newton = vsc_solve_newton(model, job->state);
  if (newton == NULL) return;
  const vsc_linear_counts linear = vsc_linear_counted(newton->linear);
  write_number(file, "newton_solutions_this_run", newton->solutions, ",");
  write_number(file, "newton_iterations_this_run", newton->iterations, ",");
  write_number(file, "newton_failures_this_run", newton->failures, ",");
  write_number(file, "linear_iterations_this_run", linear.iterations, ",");
  write_number(file, "factorizations_this_run", linear.factorizations, ",");
  write_number(file, "factor_entries", linear.factor_entries, ",");
  write_number(file, "factor_flops", linear.factor_flops, ",");
  if (model->solve.kind != VSC_SOLVE_IMPLICIT) return;
  const vsc_implicit_counts counts = vsc_implicit_counted(job->state);
  write_number(file, "steps_rejected_this_run", counts.rejected, ",");
  write_number(file, "steps_failed_this_run", counts.failed, ",");
  write_number(file, "most_energy_made_part", vsc_watch_energy_made(job->watch), ",");
  write_number(file, "energy_taken_part", -job->watch->balance / job->watch->energy_scale, ",");
}

static void write_unloaded(const vsc_problem *problem, FILE *file)
{
  const vsc_unloaded *unloaded = problem->unloaded;
  if (unloaded == NULL) return;
  const vsc_prestress_row *last = &unloaded->rows[unloaded->row_count - 1];
  write_number(file, "prestress_iterations", last->iteration, ",");
  write_number(file, "prestress_largest_mm", last->largest, ",");
  write_number(file, "prestress_mean_mm", last->mean, ",");
  write_number(file, "prestress_rest_to_mesh_mm", unloaded->furthest, ",");
}

// What the run has cost.
static void write_seconds(const vsc_job *job, const vsc_run_result *result, FILE *file)
{
  write_number(file, "input_seconds", job->problem->input_seconds, ",");
  write_number(file, "build_seconds", job->problem->build_seconds, ",");
  write_number(file, "begin_seconds", job->begun_seconds, ",");
  write_number(file, "output_seconds", result->output_seconds, ",");
  write_number(file, "frame_cpu_seconds", result->frame_cpu_seconds, ",");
  write_number(file, "wall_seconds", result->wall_seconds, ",");
  write_number(file, "cpu_seconds", result->cpu_seconds, ",");
  write_number(file, "element_updates_per_cpu_second", result->updates_per_second, ",");
}

static void write_signals(const vsc_watch *watch, FILE *file)
{
  fprintf(file, "  \"signals\": {\n");
  for (size_t k = 0; k < watch->signal_count; k++)
    if (isfinite(watch->low[k]) && isfinite(watch->high[k]))
      fprintf(file, "    \"%s\": {\"min\": %.10g, \"max\": %.10g},\n", watch->names[k],
              watch->low[k], watch->high[k]);
  fprintf(file, "    \"rows\": %.0f\n  }\n", watch->rows);
}

static void write_body(const vsc_job *job, const vsc_run_result *result, const char *failure,
                       FILE *file)
{
  const vsc_problem *problem = job->problem;
  const vsc_model *model = problem->model;
  write_string(file, "program", "viscera " VISCERA_VERSION, ",");
  write_string(file, "scene", problem->scene->file, ",");
  write_string(file, "mesh", problem->scene->mesh_file, ",");
  const bool ended = job->state->time >= model->end_time || result->repeats;
  write_string(file, "outcome", failure ? "failed" : ended ? "finished" : "stopped", ",");
  if (failure) write_string(file, "reason", failure, ",");
  if (result->warning[0] != '\0') write_string(file, "warning", result->warning, ",");
  write_string(file, "kernel", vsc_kernel_set(), ",");
  fprintf(file, "  \"model_hash\": \"%016llx\",\n", (unsigned long long)vsc_job_hash(job));
  fprintf(file, "  \"state_hash\": \"%016llx\",\n",
          (unsigned long long)vsc_state_hash(model, job->state));
  write_number(file, "threads", vsc_parallel_threads(), ",");
  write_number(file, "nodes", (double)model->node_count, ",");
  write_number(file, "elements", (double)model->element_count, ",");
  write_number(file, "elements_with_fiber",
               (double)(problem->fibers.with_data + problem->fibers.filled), ",");
  write_number(file, "held_nodes", (double)model->held_count, ",");
  write_number(file, "mass_g", 1e-3 * model->total_mass, ",");
  if (model->scaled.step > 0) {
    write_number(file, "added_mass_part", model->scaled.added / model->total_mass, ",");
    write_number(file, "most_added_mass_of_a_node", model->scaled.most, ",");
    write_number(file, "nodes_with_added_mass", (double)model->scaled.nodes, ",");
  }
  if (model->coupled.degree > 0) write_number(file, "passes_of_coupled_masses", model->coupled.degree, ",");
  write_unloaded(problem, file);
  write_number(file, "time_s", 1e-3 * job->state->time, ",");
  write_number(file, "steps", job->state->steps, ",");
  write_number(file, "steps_this_run", result->steps, ",");
  if (model->force_step && model->step > 0)
    write_string(file, "forced_step", model->step * model->safety > job->state->limit.least ? "above the stable step"
                 : "not above the stable step", ",");
  if (model->terms.paper)
    write_string(file, "conservative", "no: law paper keeps neither energy nor momenta", ",");
  write_steps(job, file);
  write_newton(job, file);
  if (model->cycle > 0) {
    write_number(file, "cycles", result->cycles, ",");
    write_number(file, "cycle_difference", result->cycle_difference, ",");
    write_string(file, "repeats", result->repeats ? "yes: stopped before time.end" : "no", ",");
  }
  if (model->solve.kind == VSC_SOLVE_EXPLICIT)
    write_number(file, "stretches_repeated_with_shorter_steps", job->repeated, ",");
  write_number(file, "inverted_elements", job->watch->totals.inverted, ",");
  write_number(file, "most_inverted_elements", job->most_inverted, ",");
  write_number(file, "folded_elements", (double)job->wound.folded, ",");
  write_number(file, "wound_edges", (double)job->wound.count, ",");
  write_number(file, "most_frames_beyond_exponent", job->most_continued, ",");
  write_number(file, "frames", (double)result->frames, ",");
  write_seconds(job, result, file);
  write_signals(job->watch, file);
}

vsc_status vsc_job_summarize(const vsc_job *job, const vsc_run_result *result, const char *failure,
                             vsc_error *error)
{
  char path[VSC_PATH];
  vsc_replacement summary;
  vsc_job_path(job, "summary.json", path);
  const vsc_status status = vsc_replace_begin(path, &summary, error);
  if (status != VSC_OK) return status;
  fputs("{\n", summary.stream);
  write_body(job, result, failure, summary.stream);
  fputs("}\n", summary.stream);
  return vsc_replace_end(&summary, false, error);
}
