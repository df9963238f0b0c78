// SPDX-License-Identifier: GPL-3.0-or-later
#include <string.h>

#include "io/checkpoint.h"
#include "run/session.h"

enum { BLOCKS = 9, LIMIT_NUMBERS = 5, LEDGER_NUMBERS = 5, WATCH_NUMBERS = 4 };

// The scalars of a checkpoint, gathered to lists.
typedef struct scalars {
  double clock[2];
  double limit[LIMIT_NUMBERS];
  double ledger[LEDGER_NUMBERS];
  double watch[WATCH_NUMBERS];
} scalars;

// Copies the scalars out of the session (save) or into it.
static void exchange(vsc_session *session, scalars *s, bool save)
{
  vsc_state *state = session->state;
  vsc_limit *limit = &state->limit;
  vsc_ledger *ledger = session->watch->ledger;
  double *const inside[] = {&state->time, &state->steps, &limit->eigenvalue, &limit->step, &limit->time,
                            &limit->interval, &limit->refreshes, &ledger->active, &ledger->pressure,
                            &ledger->dissipated, &ledger->start, &ledger->calls, &session->watch->rows,
                            &session->watch->balance, &session->watch->energy_scale, &session->most_inverted};
  double *const outside[] = {s->clock, s->clock + 1, s->limit, s->limit + 1, s->limit + 2,
                             s->limit + 3, s->limit + 4, s->ledger, s->ledger + 1,
                             s->ledger + 2, s->ledger + 3, s->ledger + 4, s->watch,
                             s->watch + 1, s->watch + 2, s->watch + 3};
  for (size_t k = 0; k < sizeof inside / sizeof inside[0]; k++) {
    if (save) *outside[k] = *inside[k];
    else *inside[k] = *outside[k];
  }
}

static void list_blocks(vsc_session *session, scalars *s, vsc_block blocks[BLOCKS])
{
  vsc_state *state = session->state;
  vsc_watch *watch = session->watch;
  const size_t nodes = session->problem->model->node_count;
  const vsc_block list[BLOCKS] = {
      {"position", "mm", nodes, 4, state->x},
      {"velocity", "mm/ms", nodes, 4, state->v},
      {"acceleration", "mm/ms^2", nodes, 4, state->a},
      {"stiffest_mode", "1", nodes, 4, state->limit.mode},
      {"time_and_steps", "ms, 1", 2, 1, s->clock},
      {"step_limit", "1/ms^2, ms, ms, ms, 1", LIMIT_NUMBERS, 1, s->limit},
      {"works", "uJ, uJ, uJ, uJ, 1", LEDGER_NUMBERS, 1, s->ledger},
      {"watch", "1, uJ, uJ, 1", WATCH_NUMBERS, 1, s->watch},
      {"signal_extrema", "as signals.csv", 2 * VSC_SIGNALS, 1, watch->low},
  };
  memcpy(blocks, list, sizeof list);
}

_Static_assert(offsetof(vsc_watch, high) == offsetof(vsc_watch, low) + VSC_SIGNALS * sizeof(double),
               "signal_extrema covers low and high in one block");

vsc_status vsc_session_save(vsc_session *session, vsc_error *error)
{
  scalars s;
  vsc_block blocks[BLOCKS];
  char path[VSC_PATH];
  exchange(session, &s, true);
  list_blocks(session, &s, blocks);
  vsc_session_path(session, "checkpoint.h5", path);
  return vsc_checkpoint_write(path, session->problem->model->hash, BLOCKS, blocks, error);
}

vsc_status vsc_session_load(vsc_session *session, vsc_error *error)
{
  scalars s;
  vsc_block blocks[BLOCKS];
  char path[VSC_PATH];
  list_blocks(session, &s, blocks);
  vsc_session_path(session, "checkpoint.h5", path);
  const vsc_status status =
      vsc_checkpoint_read(path, session->problem->model->hash, BLOCKS, blocks, error);
  if (status == VSC_OK) exchange(session, &s, false);
  return status;
}
