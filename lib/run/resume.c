// SPDX-License-Identifier: GPL-3.0-or-later
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "io/checkpoint.h"
#include "mech/prony.h"
#include "run/job.h"
#include "run/prestress.h"

// Scalars of a checkpoint, in the order of list_scalars.
enum { CLOCK = 0, LIMIT = 2, WORKS = 10, WATCH = 15, SCALARS = 30, BLOCKS = 28, UNLOADED = 3 };

static void list_scalars(vsc_job *job, double *places[SCALARS])
{
  vsc_state *state = job->state;
  vsc_limit *limit = &state->limit;
  vsc_watch *watch = job->watch;
  vsc_ledger *ledger = watch->ledger;
  double *const list[SCALARS] = {
      &state->time,       &state->steps,  // CLOCK
      &limit->eigenvalue, &limit->step,    &limit->time,         &limit->interval,
      &limit->refreshes,  // LIMIT
      &limit->first,      &limit->least,   &limit->span,
      &ledger->active,    &ledger->pressure, &ledger->dissipated, &ledger->start, &ledger->calls,  // WORKS
      &watch->rows,       &watch->balance, &watch->energy_scale, &job->most_inverted,  // WATCH
      &job->most_continued, &job->repeated, &job->cycle.stroke, &job->cycle.speed,
      &job->cycle.ended,  &job->cycle.difference, &limit->caution, &job->calm,
      &job->inverted_element, &job->inverted_time, &job->vain};
  memcpy(places, list, sizeof list);
}

static void take_scalars(vsc_job *job, double scalars[SCALARS])
{
  double *places[SCALARS];
  list_scalars(job, places);
  for (int k = 0; k < SCALARS; k++) scalars[k] = *places[k];
}

static void put_scalars(vsc_job *job, const double scalars[SCALARS])
{
  double *places[SCALARS];
  list_scalars(job, places);
  for (int k = 0; k < SCALARS; k++) *places[k] = scalars[k];
}

// Nodes with a memory of contact.
static size_t contact_nodes(const vsc_job *job)
{
  const vsc_model *model = job->problem->model;
  return model->obstacle_count > 0 ? model->node_count : 0;
}

// Nodes that remember the step before, or their velocities in it.
static size_t former_nodes(const vsc_job *job, bool velocities)
{
  const vsc_model *model = job->problem->model;
  return vsc_state_has_former(model, velocities) ? model->node_count : 0;
}

static size_t past_nodes(const vsc_job *job)
{
  const vsc_model *model = job->problem->model;
  return vsc_state_has_past(model) ? model->node_count : 0;
}

static size_t coupled_nodes(const vsc_job *job)
{
  const vsc_model *model = job->problem->model;
  return model->coupled.degree > 0 ? model->node_count : 0;
}

// `count` where equilibria have multipliers.
static size_t multipliers(const vsc_job *job, size_t count)
{
  return job->problem->model->solve.incompressible > 0 ? count : 0;
}

// What the linear solver of implicit steps goes on from; without these none, of no size.
static double *linear_past(const vsc_job *job, size_t *count)
{
  const vsc_model *model = job->problem->model;
  *count = 0;
  if (model->solve.kind != VSC_SOLVE_IMPLICIT) return NULL;
  *count = sizeof(vsc_linear_past) / sizeof(double);
  return (double *)vsc_linear_past_of(vsc_solve_newton(model, job->state)->linear);
}

static double *factorized_matrix(const vsc_job *job, size_t *count)
{
  const vsc_newton *newton = vsc_solve_newton(job->problem->model, job->state);
  *count = 0;
  return newton != NULL ? vsc_linear_factorized(newton->linear, count) : NULL;
}

static void list_blocks(vsc_job *job, double scalars[SCALARS], vsc_block blocks[BLOCKS])
{
  vsc_state *state = job->state;
  const size_t nodes = job->problem->model->node_count;
  size_t past, factorized;
  double *const linear = linear_past(job, &past), *const matrix = factorized_matrix(job, &factorized);
  const vsc_block list[BLOCKS] = {
      {"position", "mm", nodes, 4, state->x},
      {"velocity", "mm/ms", nodes, 4, state->v},
      {"acceleration", "mm/ms^2", nodes, 4, state->a},
      {"past_acceleration", "mm/ms^2", past_nodes(job), 4, state->past_a},
      {"lone_velocity", "mm/ms", coupled_nodes(job), 4, state->lone_v},
      {"lone_acceleration", "mm/ms^2", coupled_nodes(job), 4, state->lone_a},
      {"stiffest_mode", "1", nodes, 4, state->limit.mode},
      {"contact", "mN ms, uJ, uJ, mN ms, ms, mN", job->problem->model->obstacle_count,
       sizeof *state->contact / sizeof(double), (double *)state->contact},
      {"middle_velocity", "mm/ms", contact_nodes(job), 4, state->former},
      {"contact_impulse", "mN ms", contact_nodes(job), 4, state->pending},
      {"contact_normal", "1", contact_nodes(job), 4, state->contact_normal},
      {"contact_multipliers", "mN", vsc_state_contacts(job->problem->model), 1, state->touch},
      {"node_multipliers", "kPa", multipliers(job, job->problem->model->node_count), 1,
       state->scratch.node_multiplier},
      {"element_multipliers", "kPa", multipliers(job, job->problem->model->pack_count), VSC_WIDTH,
       state->scratch.pack_multiplier},
      {"former_position", "mm", former_nodes(job, false), 4, state->former_x},
      {"former_velocity", "mm/ms", former_nodes(job, true), 4, state->former_v},
      {"former_step", "ms", former_nodes(job, false) > 0, 1, &state->former_step},
      {"moved_supports", "1, 1/ms, mN, uJ, mN ms, mN ms, ms", job->problem->model->moved_count,
       sizeof *state->moved / sizeof(double), (double *)state->moved},
      {"kept_pressure", "kPa", job->problem->model->kept.count, 1, state->kept_pressure},
      {"prony", "1, kPa, uJ", vsc_prony_size(job->problem->model), 1, state->prony},
      {"time_and_steps", "ms, 1", LIMIT - CLOCK, 1, scalars + CLOCK},
      {"step_limit", "1/ms^2, ms, ms, ms, 1, ms, ms, ms", WORKS - LIMIT, 1, scalars + LIMIT},
      {"works", "uJ, uJ, uJ, uJ, 1", WATCH - WORKS, 1, scalars + WORKS},
      {"watch", "1, uJ, uJ, 1, 1, 1, mm, mm/ms, 1, 1, 1, 1, 1, ms, 1", SCALARS - WATCH, 1, scalars + WATCH},
      {"last_cycle", "mm, mm/ms", job->cycle.kept != NULL ? 2 * nodes : 0, 4, job->cycle.kept},
      {"linear_solver", "1, mN/mm, 1, 1, 1, 1", past, 1, linear},
      {"factorized_matrix", "mN/mm", factorized, 1, matrix},
      {"signal_extrema", "as signals.csv", 2 * VSC_SIGNALS, 1, job->watch->low},
  };
  memcpy(blocks, list, sizeof list);
}

_Static_assert(offsetof(vsc_watch, high) == offsetof(vsc_watch, low) + VSC_SIGNALS * sizeof(double),
               "signal_extrema covers low and high in one block");

// The shape at rest, and the last row of how it was found.
static void list_unloaded(const vsc_job *job, double row[4], vsc_block blocks[UNLOADED])
{
  const vsc_unloaded *unloaded = job->problem->unloaded;
  const size_t nodes = job->problem->mesh->node_count;
  const vsc_block list[UNLOADED] = {{"shape_at_rest", "mm", nodes, 4, unloaded->rest},
                                    {"shape_loaded", "mm", nodes, 4, unloaded->start},
                                    {"prestress", "1, 1, mm, mm", 4, 1, row}};
  memcpy(blocks, list, sizeof list);
}

uint64_t vsc_job_hash(const vsc_job *job)
{
  return job->problem->unloaded != NULL ? job->problem->unloaded->hash : job->problem->model->hash;
}

vsc_status vsc_job_save(vsc_job *job, vsc_error *error)
{
  const vsc_unloaded *unloaded = job->problem->unloaded;
  double scalars[SCALARS], row[4];
  vsc_block blocks[BLOCKS + UNLOADED];
  char path[VSC_PATH];
  take_scalars(job, scalars);
  list_blocks(job, scalars, blocks);
  if (unloaded != NULL) {
    const vsc_prestress_row *last = &unloaded->rows[unloaded->row_count - 1];
    memcpy(row, (double[]){last->iteration, last->relaxation, last->largest, last->mean}, sizeof row);
    list_unloaded(job, row, blocks + BLOCKS);
  }
  vsc_job_path(job, "checkpoint.h5", path);
  const vsc_status shown = vsc_frame_writer_finish(job->writer, error);
  const vsc_status status = vsc_checkpoint_write(path, vsc_job_hash(job), BLOCKS + (unloaded != NULL ? UNLOADED : 0), blocks,
                                                 shown == VSC_OK ? error : NULL);
  return shown == VSC_OK ? status : shown;
}

static vsc_status read_checkpoint(const vsc_job *job, size_t count, const vsc_block *blocks, vsc_error *error)
{
  char path[VSC_PATH];
  vsc_job_path(job, "checkpoint.h5", path);
  if (access(path, F_OK) != 0)
    return vsc_fail(error, VSC_INPUT,
                    "%s: is not there: a run leaves it when it ends or is stopped, and on its way with output.checkpoint; "
                    "begin anew without --resume", path);
  return vsc_checkpoint_read(path, vsc_job_hash(job), count, blocks, error);
}

vsc_status vsc_job_load_unloaded(vsc_job *job, vsc_error *error)
{
  vsc_problem *problem = job->problem;
  double row[4];
  vsc_block blocks[UNLOADED];
  vsc_status status = vsc_unloaded_create(problem, error);
  if (status != VSC_OK) return status;
  list_unloaded(job, row, blocks);
  status = read_checkpoint(job, UNLOADED, blocks, error);
  if (status != VSC_OK) return status;
  problem->unloaded->rows[0] = (vsc_prestress_row){(int)row[0], row[1], row[2], row[3]};
  return vsc_unload_again(problem, error);
}

// The factor of implicit steps is to be made again of its matrix, which has changed.
static void forget_factor(vsc_job *job)
{
  if (job->problem->model->solve.kind == VSC_SOLVE_IMPLICIT)
    vsc_linear_resume(vsc_solve_newton(job->problem->model, job->state)->linear);
}

vsc_status vsc_job_load(vsc_job *job, vsc_error *error)
{
  double scalars[SCALARS];
  vsc_block blocks[BLOCKS];
  list_blocks(job, scalars, blocks);
  const vsc_status status = read_checkpoint(job, BLOCKS, blocks, error);
  if (status == VSC_OK) put_scalars(job, scalars);
  if (status == VSC_OK) forget_factor(job);
  return status;
}

// Copies all that a checkpoint holds to job->good, or back from there.
static void copy_good(vsc_job *job, bool back)
{
  double scalars[SCALARS], *memory = job->good;
  vsc_block blocks[BLOCKS];
  take_scalars(job, scalars);
  list_blocks(job, scalars, blocks);
  for (int k = 0; k < BLOCKS; k++) {
    const size_t count = blocks[k].rows * blocks[k].columns;
    if (count > 0) memcpy(back ? blocks[k].values : memory, back ? memory : blocks[k].values, count * sizeof *memory);
    memory += count;
  }
  if (!back) return;
  put_scalars(job, scalars);
  forget_factor(job);
}

vsc_status vsc_job_make_good(vsc_job *job, vsc_error *error)
{
  double scalars[SCALARS];
  vsc_block blocks[BLOCKS];
  size_t numbers = 0;
  list_blocks(job, scalars, blocks);
  for (int k = 0; k < BLOCKS; k++) numbers += blocks[k].rows * blocks[k].columns;
  if (!VSC_NEW(job->good, numbers)) return vsc_fail_memory(error, "the last good state");
  vsc_job_keep_good(job);
  return VSC_OK;
}

void vsc_job_keep_good(vsc_job *job)
{
  copy_good(job, false);
}

void vsc_job_go_back(vsc_job *job)
{
  copy_good(job, true);
}
