// SPDX-License-Identifier: GPL-3.0-or-later
// Linear systems A d = b with the tangent's symmetric matrix: conjugate gradients, preconditioned by
// the diagonal blocks or by a Cholesky factor (CHOLMOD, supernodal) of the matrix as it was some time
// ago. With a factor of the present matrix one iteration is the direct solution.
#ifndef VSC_SOLVE_LINEAR_H
#define VSC_SOLVE_LINEAR_H

#include "mech/tangent.h"

typedef struct vsc_linear vsc_linear;

// What has been done so far.
typedef struct vsc_linear_counts {
  double iterations;      // of conjugate gradients
  double factorizations;
  double factor_entries;  // numbers in the factor; 0: none was made
  double factor_flops;    // operations of one factorisation
  double unfinished;      // solutions that ended above their tolerance
} vsc_linear_counts;

// What a solver remembers of the systems before, numbers only so that checkpoints can hold it.
typedef struct vsc_linear_past {
  double factorized;  // 1: there is a factor, of a matrix that may be an older one
  double shift;       // that was added to that matrix's diagonal
  double rate;        // iterations for each digit that a solution took right after that factorisation
  double spent;       // iterations beyond that rate since then
  double budget;      // iterations with diagonal blocks that may be spent before a factorisation,
  double plain_left;  // and what is left of them
} vsc_linear_past;

// For the tangents of `model` that have the pattern of `tangent`; both must outlive it. The caller owns *linear.
vsc_status vsc_linear_create(const vsc_model *model, const vsc_tangent *tangent, vsc_linear_kind kind,
                             vsc_linear **linear, vsc_error *error);

void vsc_linear_free(vsc_linear *linear);  // NULL is fine

// Forgets the factor and what was spent, so that what follows does not depend on what was before.
void vsc_linear_forget(vsc_linear *linear);

// All that what follows depends on: the past, and, with implicit steps, the numbers of the matrix that the factor was
// made of (their count; else NULL). Who writes others there goes on from there, with the same bits.
vsc_linear_past *vsc_linear_past_of(vsc_linear *linear);
double *vsc_linear_factorized(vsc_linear *linear, size_t *count);

// To be called when that was done.
void vsc_linear_resume(vsc_linear *linear);

// d with |b - A d| <= tolerance |b| for the tangent as assembled at x, unknowns with `free` 0 held at
// 0 (all node_count x 4). Where negative curvature is met or iterations run out d is as good as it has become, VSC_OK
// too, as Newton's next step mends it; counts.unfinished tells those. VSC_NUMERICAL when A is not positive definite, even
// with up to 10 % of its largest diagonal added; VSC_SYSTEM when the factor does not fit into memory (with AUTO diagonal blocks
// do the rest then) or no order is found for it. *indefinite tells whether a direction of negative curvature was met.
vsc_status vsc_linear_solve(vsc_linear *linear, vsc_tangent *tangent, const double *free,
                            const double *x, const double *b, double tolerance, double *d,
                            bool *indefinite, vsc_error *error);

// Whether the next system will be solved with diagonal blocks.
bool vsc_linear_is_plain(const vsc_linear *linear);

vsc_linear_counts vsc_linear_counted(const vsc_linear *linear);

#endif
