// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels of cells under laws of strain, where explicit steps spend their time: linear tets under law
// SPRINGS (kernel_tets.h), other cells and other laws (kernel_law.h). Included by one source file per
// instruction set; CELLS lists them.
#ifndef VSC_MECH_KERNEL_CELLS_H
#define VSC_MECH_KERNEL_CELLS_H

#include "mech/kernel_law.h"
#include "mech/kernel_sets.h"
#include "mech/kernel_tets.h"

#define FORCE_KERNEL(springs, damping, active, nodal)                             \
  static void force_##springs##damping##active##nodal(const vsc_patch_work *work) \
  {                                                                               \
    force_kernel(work, false, springs, damping, active, nodal);                   \
  }
#define FORCE_KERNELS(springs, active)  \
  FORCE_KERNEL(springs, 0, active, 0)   \
  FORCE_KERNEL(springs, 0, active, 1)   \
  FORCE_KERNEL(springs, 1, active, 0)   \
  FORCE_KERNEL(springs, 1, active, 1)
#define TABLE(s)                                                                             \
  {                                                                                          \
    {{force_##s##000, force_##s##001}, {force_##s##010, force_##s##011},                     \
     {force_##s##020, force_##s##021}},                                                      \
        {{force_##s##100, force_##s##101}, {force_##s##110, force_##s##111},                 \
         {force_##s##120, force_##s##121}},                                                  \
  }

_Static_assert(VSC_ACTIVE_NONE == 0 && VSC_ACTIVE_SPRING == 1 && VSC_ACTIVE_TENSION == 2 && VSC_AXIAL == 0 &&
                   VSC_ANGULAR == 1 && VSC_COMPOSED == 2,
               "the tables below are indexed by these");
FORCE_KERNELS(0, 0)
FORCE_KERNELS(0, 1)
FORCE_KERNELS(0, 2)
FORCE_KERNELS(1, 0)
FORCE_KERNELS(1, 1)
FORCE_KERNELS(1, 2)
FORCE_KERNELS(2, 0)
FORCE_KERNELS(2, 1)
FORCE_KERNELS(2, 2)

#define CELLS                                                                                \
  {                                                                                          \
    .tets = {TABLE(0), TABLE(1), TABLE(2)},                                                  \
    .solids = {{springs_hexes, springs_wedges, springs_pyramids, springs_tets10},            \
               {damped_springs_hexes, damped_springs_wedges, damped_springs_pyramids,        \
                damped_springs_tets10}},                                                     \
    .laws = {{law_tets, law_hexes, law_wedges, law_pyramids, law_tets10},                    \
             {damped_law_tets, damped_law_hexes, damped_law_wedges, damped_law_pyramids,     \
              damped_law_tets10}},                                                           \
    .volume = volume_kernel,                                                                 \
  }

#endif
