// SPDX-License-Identifier: GPL-3.0-or-later
// The tangent of all forces: the matrix that Newton's method needs.
//
//   A = a K + b C,  K = -df/dx,  C = -df/dw
//
// assembled from the elements, with a pattern that is computed once. Volumes shared by the tets round
// a node join nodes that no element joins: their part G^T W G, with the gradients G of the groups' volumes,
// is kept apart and applied as it stands (vsc_tangent_times); the preconditioner has a part of each
// group's stiffness on the group's own elements. So it is with the laws of smoothed tets, of which the
// preconditioner has for each tet the mean of its edges.
#ifndef VSC_MECH_TANGENT_H
#define VSC_MECH_TANGENT_H

#include "mech/block_matrix.h"
#include "mech/state.h"

typedef struct vsc_tangent {
  vsc_block_matrix matrix;   // of what elements join
  vsc_block_matrix preconditioner;  // the same matrix; with node-averaged volume or smoothed tets one
                                    // with the same pattern and numbers of its own
  uint32_t *places;          // where each pack's blocks go in the matrix, [pair][lane]; owned
  size_t *first_place;       // patch_count: of each patch's first pack; owned
  size_t color_count;
  uint32_t *color_start;     // color_count + 1; owned
  uint32_t *colored;         // patches by colour: those of one colour share no node; owned
  double *masses;            // int rho N_i N_j dV of each block of the matrix, mg; NULL: lumped; owned
  // node-averaged volume: group n's gradient d v_n/dx_i for the nodes i of its tets
  size_t *group_start;       // node_count + 1; NULL without; owned
  uint32_t *group_node;      // owned
  double *group_gradient;    // x 3, mm^2; owned
  double *group_weight;      // node_count: a U''(J_n)/V_n, kPa/mm^3; owned
  double *group_change;      // node_count: memory of vsc_tangent_times; owned
  // smoothed tets: dP_e/dF_e of all edges (mech/smoothed.h)
  const vsc_model *model;    // which must outlive the tangent
  vsc_wide *edges;           // NULL without; owned
  vsc_scratch *space;        // memory of vsc_tangent_times; owned
} vsc_tangent;

// Memory and pattern for `model`. VSC_INPUT, naming what and the remedy, for what has no tangent:
// law PAPER, classical springs. Of kept volumes solve/kept_balance.h adds what pressures do, of contact solve/touch.h.
vsc_status vsc_tangent_create(const vsc_model *model, vsc_tangent **tangent, vsc_error *error);

void vsc_tangent_free(vsc_tangent *tangent);  // NULL is fine

// The tangent at positions x, velocities w (NULL: no damping) and `time`, for a = stiffness_factor, b =
// damping_factor. Supports are not imposed: vsc_block_matrix_hold does that. With `before`, the
// positions of Newton's iterate before (NULL: none), stresses in the geometric part are those which that
// iterate foretold, S + D de, not those that the step's overshoot has made: with them a bending body
// takes steps many times as long, and the end is the same (Magisano, Leonetti & Garcea 2017).
void vsc_tangent_assemble(const vsc_model *model, vsc_tangent *tangent, const double *x,
                          const double *w, const double *before, double time, double stiffness_factor,
                          double damping_factor, vsc_scratch *scratch);

// Adds factor (1/ms^2) times the mass matrix to the tangent, and y += factor (any unit) times the mass
// matrix times a (node_count x 4).
void vsc_tangent_add_masses(const vsc_model *model, vsc_tangent *tangent, double factor);
void vsc_tangent_masses_times(const vsc_model *model, const vsc_tangent *tangent, double factor,
                              const double *a, double *y);

// Fills the preconditioner from the tangent that was assembled last, at x.
void vsc_tangent_precondition(const vsc_model *model, vsc_tangent *tangent, const double *x);

// y = A x, exactly, whatever shares volumes; node_count x 4. `free` (node_count x 4) is 0 for unknowns
// that supports hold, whose x must be 0 and whose y is set to 0.
void vsc_tangent_times(const vsc_tangent *tangent, const double *free, const double *x, double *y);

#endif
