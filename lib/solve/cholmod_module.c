// SPDX-License-Identifier: GPL-3.0-or-later
// The module `cholmod`: what is linked to CHOLMOD, so that the library need not be.
#include "solve/cholmod.h"

const vsc_cholmod vsc_cholmod_table = {
    .start = cholmod_start,
    .finish = cholmod_finish,
    .allocate_sparse = cholmod_allocate_sparse,
    .allocate_dense = cholmod_allocate_dense,
    .allocate_triplet = cholmod_allocate_triplet,
    .zeros = cholmod_zeros,
    .free_sparse = cholmod_free_sparse,
    .free_dense = cholmod_free_dense,
    .free_factor = cholmod_free_factor,
    .free_triplet = cholmod_free_triplet,
    .triplet_to_sparse = cholmod_triplet_to_sparse,
    .transpose = cholmod_transpose,
    .metis = cholmod_metis,
    .analyze = cholmod_analyze,
    .analyze_p = cholmod_analyze_p,
    .factorize = cholmod_factorize,
    .factorize_p = cholmod_factorize_p,
    .solve = cholmod_solve,
    .solve2 = cholmod_solve2,
};
