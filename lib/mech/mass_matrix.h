// SPDX-License-Identifier: GPL-3.0-or-later
// The consistent mass matrix. Internal to mech.
#ifndef VSC_MECH_MASS_MATRIX_H
#define VSC_MECH_MASS_MATRIX_H

#include "mech/block_matrix.h"
#include "model/model.h"

// entries[k] = int rho N_i N_j dV, mg, of each block (i, j) of `pattern`, which stands for that number
// times the unit matrix; owned by the caller. Exact for straight tets, quadratic ones too; other kinds are integrated at
// the points of their frames. Triangles of membranes give thickness times int rho N_i N_j dA. False when memory is short.
bool vsc_mass_matrix(const vsc_model *model, const vsc_block_matrix *pattern, double **entries);

// y = M v of the same matrix, without it (node_count x 4; mg mm/ms of velocities).
void vsc_consistent_masses_times(const vsc_model *model, const double *v, double *y);

#endif
