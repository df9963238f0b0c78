// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/solve.h"

#include "solve/equilibrium.h"
#include "solve/explicit.h"
#include "solve/implicit.h"
#include "solve/keep_volume.h"
#include "solve/relax.h"

static bool relaxes(const vsc_model *model)
{
  return model->solve.kind == VSC_SOLVE_EQUILIBRIUM && model->solve.method == VSC_STATICS_RELAXATION;
}

vsc_status vsc_solve_start(const vsc_model *model, vsc_state *state, vsc_error *error)
{
  if (relaxes(model)) return vsc_relax_start(model, state, error);
  if (model->solve.kind == VSC_SOLVE_EQUILIBRIUM) return vsc_equilibrium_start(model, state, error);
  if (model->solve.kind == VSC_SOLVE_IMPLICIT) return vsc_implicit_start(model, state, error);
  return vsc_start(model, state, error);
}

vsc_status vsc_solve_resume(const vsc_model *model, vsc_state *state, vsc_error *error)
{
  return model->solve.kind == VSC_SOLVE_EXPLICIT ? vsc_keep_volume_ready(model, error)
                                                 : vsc_solve_start(model, state, error);
}

vsc_status vsc_solve_to(const vsc_model *model, vsc_state *state, double until, vsc_error *error)
{
  if (model->solve.kind != VSC_SOLVE_EXPLICIT && state->solver == NULL)
    return vsc_fail(error, VSC_INPUT, "vsc_solve_to: the method has not started: call vsc_solve_start before");
  if (relaxes(model)) return vsc_relax_to(model, state, until, error);
  if (model->solve.kind == VSC_SOLVE_EQUILIBRIUM)
    return vsc_equilibrium_to(model, state, until, error);
  if (model->solve.kind == VSC_SOLVE_IMPLICIT) return vsc_implicit_to(model, state, until, error);
  return vsc_advance(model, state, until, error);
}

void vsc_solve_heed(const vsc_model *model, vsc_state *state, const volatile sig_atomic_t *interrupted)
{
  vsc_newton *newton = vsc_solve_newton(model, state);
  state->interrupted = interrupted;
  if (newton != NULL) newton->interrupted = interrupted;
}

vsc_newton *vsc_solve_newton(const vsc_model *model, vsc_state *state)
{
  if (state->solver == NULL) return NULL;
  if (model->solve.kind == VSC_SOLVE_IMPLICIT) return vsc_implicit_newton(state);
  return model->solve.kind == VSC_SOLVE_EQUILIBRIUM && !relaxes(model) ? state->solver : NULL;
}
