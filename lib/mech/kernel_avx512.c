// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled with -mavx512f -mavx512dq -mavx512vl (see CMakeLists.txt). Eight cells at once, two packs side by
// side; what is stored is read as vsc_four. Their sums go to the nodes pack by pack, so that the bits are the
// baseline's.
#ifdef __AVX512F__
#define VSC_EIGHT_LANES
#include "mech/kernel_cells.h"

const vsc_cell_kernels vsc_cells_avx512 = CELLS;
#else
typedef int vsc_no_avx512;  // a source file must not be empty
#endif
