// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method for a balance of forces r(x) = 0 with a symmetric tangent A = -dr/dx:
//   A d = r,  x <- x + d,
// in full steps, which are halved only when a number is no longer finite or an element turns inside
// out: looking at the residual's norm ruins bending. It is looked at before the first step alone: where steep laws
// make a start far worse than the place that the body comes from, that is the start. The linear systems are solved as
// exactly as the residual deserves (Eisenstat & Walker 1996, choice 2), so convergence is quadratic.
#ifndef VSC_SOLVE_NEWTON_H
#define VSC_SOLVE_NEWTON_H

#include "mech/culprit.h"
#include "mech/state.h"
#include "mech/tangent.h"
#include "solve/incompressible.h"
#include "solve/kept_balance.h"
#include "solve/linear.h"
#include "solve/touch.h"

enum { VSC_MOST_NEWTON = 40 };  // iterations of one solution

// What has to vanish. `residual` fills r (node_count x 4, mN) at x; `assemble` the tangent at the x of
// the last residual; `before` is the iterate before, or NULL. Both with the pressures of kept volumes
// (solve/kept_balance.h), which are unknowns beside x. `blame` finds what pulls most at a node where no solution was
// found, at the x of the last residual, for the message.
typedef struct vsc_balance {
  void *context;
  void (*residual)(void *context, const double *x, double *r);
  void (*assemble)(void *context, const double *x, const double *before, vsc_tangent *tangent);
  void (*stay)(void *context, double *x);  // where else to start from, if forces are far off where it is; or NULL
  vsc_culprit (*blame)(void *context, const double *x, size_t node);  // or NULL
} vsc_balance;

// One iteration of one solution, for those who want to see how it went.
typedef struct vsc_newton_row {
  double time;        // ms
  double load;        // part of the loads, 1: all
  double iteration;   // from 0; 0 is before the first step
  double residual;    // |r| over the scale of forces so far
  double linear;      // iterations of conjugate gradients that this step took
  double factorized;  // factorisations
} vsc_newton_row;

typedef struct vsc_newton {
  const vsc_model *model;
  vsc_tangent *tangent;
  vsc_linear *linear;
  vsc_kept_balance *kept;  // NULL where no volumes are kept; owned
  vsc_touch *touch;  // contact with obstacles; NULL without
  vsc_multipliers *multipliers;  // of solve.incompressible; NULL without; owned
  double *r, *d, *trial, *before;  // node_count x 4
  double size;            // of the body, mm
  double scale;           // of the forces at work, mN
  double floor;           // |r| below which there is rounding only, mN
  size_t row_count, row_room;
  vsc_newton_row *rows;   // since they were last taken; owned
  double iterations, solutions, failures;  // since the start
  const volatile sig_atomic_t *interrupted;  // not 0: solutions are given up, with VSC_SYSTEM; NULL: never. Not owned
  bool indefinite;        // a direction of negative curvature was met in the last solution
} vsc_newton;

// Memory for `model`; VSC_INPUT where it has no tangent (mech/tangent.h). The caller owns *newton.
vsc_status vsc_newton_create(const vsc_model *model, vsc_newton **newton, vsc_error *error);

void vsc_newton_free(vsc_newton *newton);  // NULL is fine

// To be called before the first solution of a row: takes the norm of `force` (node_count x 4), the forces where the
// row starts under the loads of its end, for the scale of forces; reactions of solutions raise it. Forgets where
// solutions for kept volumes start.
void vsc_newton_begin(vsc_newton *newton, const double *force);

// The same where a body lies on surfaces' springs, which are no reactions of supports: the scale is no smaller than what
// these and the loads on surfaces push with at positions x (node_count x 4, mm) and `time` (ms), and the weight.
void vsc_newton_scale_by_loads(vsc_newton *newton, const double *x, double time);

// Solves from x (node_count x 4), which becomes the solution, to |r| <= tolerance x the scale of
// forces and kept volumes to VSC_KEPT_BALANCE; newton->kept has their pressures, before and after. `time` and
// `load` go into the rows. VSC_NUMERICAL, with plain words why, when it does not converge or numbers are
// no longer finite; x is then undefined.
// With obstacles, for which vsc_touch_begin was called, it is solved with their forces again and again, until
// multipliers have settled; iterations are those of the first time.
vsc_status vsc_newton_solve(vsc_newton *newton, const vsc_balance *balance, double time, double load,
                            double *x, int *iterations, vsc_error *error);

// The diagonal of the box round the body at rest, mm.
double vsc_body_size(const vsc_model *model);

// The smallest volume ratio J of any frame at x, and the mesh's element that has it.
double vsc_smallest_ratio(const vsc_model *model, const double *x, uint32_t *element);

#endif
