// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that moves. Arrays are in the model's node order, four doubles a node (x, y, z, 0).
#ifndef VSC_MECH_STATE_H
#define VSC_MECH_STATE_H

#include <signal.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "model/model.h"

// What the estimate of the stable step remembers (step_limit.h).
typedef struct vsc_limit {
  double eigenvalue;  // largest of M^-1 (K + 2/dt C) at dt = 2 / sqrt(1.1 eigenvalue), 1/ms^2; 0: not estimated yet
  double step;        // the step that is allowed now: safety . 2 / sqrt(1.1 eigenvalue), ms
  double time;        // when it was estimated, ms
  double interval;    // how long the estimate is trusted, ms
  double refreshes;   // estimates so far
  double first;       // the step that was allowed at the start, ms
  double rest;        // that of the body at rest, where it starts elsewhere or loads leave it next to no step; else 0 (not
                      // kept by checkpoints), ms
  double least;       // the shortest that any estimate has allowed, ms
  double span;        // time gone through in steps that were allowed when they were taken, ms
  double caution;     // part of the allowed step that is taken: 1, but where energy did not balance with that
  double *mode;       // node_count x 4: the eigenvector so far, of length 1 in the mass norm; of coupled masses, what is
                      // spread to it; owned
} vsc_limit;

// Memory of the computation, rewritten at each use.
typedef struct vsc_scratch {
  double load;    // part of all loads and of all activity that counts: 1, but while they come up
                  // on the way to a first equilibrium
  double *local;  // vsc_parallel_threads() when it was made x local_size: the nodes and forces of one patch
  size_t local_size;
  double *partial;         // partial_count x 4: parts of the forces on shared nodes, mN
  double *outside;         // node_count x 4: forces of loads on surfaces, mN; NULL where there are none
  bool pushed;             // whether outside has what counts now: loads on surfaces are at work
  double *pull;            // 4 for each row of the largest of model.robins: what springs and dashpots there
                           // pull with, kPa; NULL likewise
  double *volume;          // node_count: deformed volume of the nodes' groups, mm^3
  double *pressure;        // node_count: of the nodes' groups, U'(J) and what a multiplier adds, kPa
  double *partial_volume;  // partial_count: parts of the same for shared nodes
  bool still_known;        // whether these have what patches that are still give to them
  // smoothed tets: F of each slot, [slot][column][4], dF/dt (with damping), and P_e of each edge likewise, kPa
  double *gradient, *rate, *edge_stress;
  double *predicted;       // node_count x 4: velocity at the end of the step, when there is damping; between steps
                           // the mode's image of the step estimate
  const double *prony;      // the state's: branches of Prony series
  double prony_step;        // length of the step in which forces and tangents carry branches on to where they
                            // are taken, ms: 0 but while an implicit step is solved; equilibria: infinite
  double *node_multiplier;  // node_count: added to the pressure of each node's group, kPa; NULL but with
                            // solve.incompressible
  double *pack_multiplier;  // pack_count x 4: the same of each element that shares its volume among its
                            // frames
  double *spread;  // node_count x 4 x 2: passes of coupled masses; NULL without
  double *lone;    // node_count x 4 x 4: x, A x and A d of the step estimate spread, and d that is not; likewise
  double *trial;  // node_count x 4 x 3: positions, forces and velocities (or the mode's image) of the step estimate
} vsc_scratch;

// How a node touches obstacles. One that leaves still lies on an obstacle, which no longer stops it.
typedef enum vsc_touching { VSC_APART, VSC_TOUCHES, VSC_TOUCHES_SEVERAL, VSC_LEAVES } vsc_touching;

// What an obstacle has done to the nodes since the start.
typedef struct vsc_contact_sums {
  double impulse[3];  // mN ms
  double work;        // done by the obstacle's own motion, uJ
  double lost;        // by impact and friction, uJ
  double row_impulse[3];  // impulse at the last row of signals.csv, mN ms
  double row_time;        // when that was, ms
  double force[3];        // on the nodes now; equilibria, mN
} vsc_contact_sums;

// What a support that moves has done since the start.
typedef struct vsc_moved_sums {
  double part;        // the curve's value where its nodes are now
  double rate;        // d part/dt of their velocities, 1/ms
  double force[3];    // sum of all other forces on its nodes (implicit: less mass times acceleration), mN
  double work;        // done by it, uJ
  double impulse[3];  // of its force on the nodes, in the directions that it holds, mN ms
  double row_impulse[3];  // impulse at the last row of signals.csv, mN ms
  double row_time;        // when that was, ms
} vsc_moved_sums;

typedef struct vsc_state {
  double time;    // ms
  double steps;   // done so far (an integer)
  double part;    // of implicit steps of a given length the last one, ms: they are cut to end at frames and rows; 0 before
  bool loaded;    // the loads are borne at the start already: a first equilibrium does not let them come up
  double *x;      // node_count x 4: position, mm; owned
  double *v;      // node_count x 4: velocity, mm/ms; owned
  double *a;      // node_count x 4: acceleration at x, v, time, mm/ms^2; owned
  double *past_a; // node_count x 4: acceleration a step before a; explicit steps with damping, owned
  double *lone_v, *lone_a;  // node_count x 4: M^-1 times momenta and times forces, 0 in held directions: what v and a would
                            // be if the masses were not coupled (coupled_mass.h), mm/ms, mm/ms^2; only there, owned
  double *force;  // node_count x 4: total force behind a, or what vsc_force_parts leaves there, mN; owned
  vsc_contact_sums *contact;  // obstacle_count; owned
  uint8_t *contact_count;     // node_count: a vsc_touching of each node in the last step; only with obstacles, owned
  double *former;             // node_count x 4: velocities in the middle of the last step; likewise
  double *pending;            // node_count x 4: impulses of contact whose work is not counted yet,
                              // mN ms, and the work of the obstacles behind them, uJ; likewise
  double *contact_normal;     // node_count x 4: the free part of the last one's normal, and
                              // its number; likewise
  double *touch;          // vsc_state_contacts: multipliers, the force of each obstacle on each node that it
                          // stops, mN; owned
  vsc_moved_sums *moved;  // moved_count; owned
  double *kept_pressure;  // kept.count: multiplier of each kept volume in the last step, kPa; owned
  void *keeper;           // what keeps them (solve/keep_volume.c), made when first needed
  void (*release_keeper)(void *keeper);
  double former_step;         // scheme BDF2, equilibria: the step (increment) before, 0: none yet, ms
  double *former_x;           // node_count x 4: position before it, mm; likewise, owned
  double *former_v;           // node_count x 4: velocity before it, mm/ms; scheme BDF2, owned
  double *prony;          // vsc_prony_size: branches of Prony series (mech/prony.h); owned
  const volatile sig_atomic_t *interrupted;  // not 0: methods give up (vsc_solve_heed); NULL: never. Not owned
  void *solver;           // memory of the method (solve/solve.c), made when it starts
  void (*release_solver)(void *solver);
  vsc_limit limit;
  vsc_scratch scratch;
} vsc_state;

// Whether *flag is not 0; NULL is a flag that never is.
static inline bool vsc_is_set(const volatile sig_atomic_t *flag)
{
  return flag != NULL && *flag != 0;
}

// The state of `model` in its shape at rest at time 0, with its initial velocity, its acceleration still to be
// computed (vsc_start). What the method itself remembers comes when that starts (vsc_solve_start) or first needs it.
// It has room for as many threads as there are now: more must not be set while it is in use. The caller owns *state.
vsc_status vsc_state_create(const vsc_model *model, vsc_state **state, vsc_error *error);

void vsc_state_free(vsc_state *state);  // NULL is fine

// Whether the model's method remembers the acceleration of the step before.
static inline bool vsc_state_has_past(const vsc_model *model)
{
  return model->terms.damping && model->solve.kind == VSC_SOLVE_EXPLICIT;
}

// Whether the model's method remembers the step before, and its velocities too.
bool vsc_state_has_former(const vsc_model *model, bool velocities);

// The number of pairs of an obstacle and a node that it stops; 0 for explicit steps, which have no multipliers.
size_t vsc_state_contacts(const vsc_model *model);

// The first node whose position or velocity is not finite, or node_count. One that is held, to which that can only have
// come from others, where there is no other.
size_t vsc_state_find_bad(const vsc_model *model, const vsc_state *state);

enum { VSC_NODE_TEXT = 96 };  // room for a node's name and place

// "node 12, at rest at (1, 0.5, 2) mm", the node's number in the file: for messages. Writes at most `size` bytes
// with the terminating zero and returns `text`.
const char *vsc_name_node(const vsc_model *model, size_t node, char *text, size_t size);

// The node at which node_count x 4 numbers are largest (not a number: largest of all).
size_t vsc_largest_node(const vsc_model *model, const double *numbers);

// Hash of time, x, v and a: equal for equal bits.
uint64_t vsc_state_hash(const vsc_model *model, const vsc_state *state);

#endif
