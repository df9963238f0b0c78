// SPDX-License-Identifier: GPL-3.0-or-later
// Forces that do not come from elements: pressures that follow their surface, springs and dashpots on
// surfaces, weight; and their derivatives.
#ifndef VSC_MECH_LOADS_H
#define VSC_MECH_LOADS_H

#include "mesh/face.h"
#include "model/model.h"

// Takes a 3 x 3 block (row-major) of the derivative of the force on node i by what node j does.
typedef void vsc_block_sink(void *context, uint32_t i, uint32_t j, const double K[9]);

// Whether anything at all acts on surfaces: springs or dashpots, or at `time` (ms) the part `load` of a pressure that is not
// 0 then. Where nothing does, vsc_loads_push and vsc_loads_hold add nothing.
bool vsc_loads_work(const vsc_model *model, double time, double load);

// Adds to `force` (mN, node_count x 4) the part `load` (1: all) of the pressures at positions x (node_count x 4) and
// `time` (ms).
void vsc_loads_push(const vsc_model *model, const double *x, double time, double load, double *force);

// Adds to `force` what springs and dashpots on surfaces do at positions x and velocities w (node_count x 4; w may be
// NULL when nothing is damped). Sums run in an order that does not depend on the number of threads. `pull` is room for
// 4 numbers of each row of the largest surface.
void vsc_loads_hold(const vsc_model *model, const double *x, const double *w, double *pull, double *force);

// stiffness_factor d(-f)/dx + damping_factor d(-f)/dv of pressures, springs and dashpots at positions x
// (node_count x 4) and `time` (ms), with the part `load` of the pressures, handed to `sink` in blocks of two nodes of one face; both orders i, j
// and j, i are delivered, and a block may come several times: they are to be added. Of a pressure's
// derivative only the symmetric part, (K + K^T)/2: all of it where the surface is closed or its rim held.
// With a damping factor in 1/ms the blocks are in mN/mm.
void vsc_loads_tangent(const vsc_model *model, const double *x, double time, double load,
                       double stiffness_factor, double damping_factor, vsc_block_sink *sink,
                       void *context);

// Forces of the pressure 1 kPa on the nodes of a face at x (mm), mN:
//   f_i = - int N_i t_1 x t_2 dxi deta,
// for three nodes - (x_1 - x_0) x (x_2 - x_0) / 6 each.
void vsc_face_push(const vsc_face_rule *rule, const double x[][3], double f[][3]);

// d(-f_i)/dx_j of that, row-major 3 x 3 blocks, mN/mm:
//   K_ij = int N_i (dN_j/deta [t_1]x - dN_j/dxi [t_2]x) dxi deta,   [a]x b = a x b.
void vsc_face_push_tangent(const vsc_face_rule *rule, const double x[][3],
                           double K[][VSC_FACE_NODES][9]);

// Stored in the springs on surfaces at x, sum stiffness u . W u / 2 with u = x - rest, uJ.
double vsc_loads_energy(const vsc_model *model, const double *x);

// Power of the dashpots on surfaces at velocities v, sum damping v . W v, uJ/ms.
double vsc_loads_dissipation(const vsc_model *model, const double *v);

// Work of the pressures between two calls, the mean force on a node times its way (the trapezoidal rule),
// uJ. `push` keeps forces and places of the last call: vsc_loads_push_count numbers.
double vsc_loads_pressure_work(const vsc_model *model, const double *x, double time, double *push);
size_t vsc_loads_push_count(const vsc_model *model);

#endif
