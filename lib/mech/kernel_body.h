// SPDX-License-Identifier: GPL-3.0-or-later
// The text of the kernels, included by one source file per instruction set. KERNEL_SET names it.
// Here: linear tets under law SPRINGS. Other cells and other laws of strain are in kernel_law.h, the laws that are there to be compared with in kernel_paper.h, membranes in
// kernel_surface.h.
#include <string.h>

#include "mech/kernel_common.h"
#include "mech/kernel_sets.h"
#include "mech/kernel_tets.h"
// what the tets have is used by these
#include "mech/kernel_law.h"
#include "mech/kernel_paper.h"
#include "mech/kernel_solid.h"
#include "mech/kernel_surface.h"
#include "mech/kernel_tangent.h"
#include "mech/kernel_surface_tangent.h"
#include "mech/kernel_smoothed.h"

#define FORCE_KERNEL(composed, damping, active, nodal)                             \
  static void force_##composed##damping##active##nodal(const vsc_patch_work *work) \
  {                                                                                \
    force_kernel(work, composed, damping, active, nodal);                          \
  }
#define FORCE_KERNELS(composed, active)  \
  FORCE_KERNEL(composed, 0, active, 0)   \
  FORCE_KERNEL(composed, 0, active, 1)   \
  FORCE_KERNEL(composed, 1, active, 0)   \
  FORCE_KERNEL(composed, 1, active, 1)
#define TABLE(c)                                                                             \
  {                                                                                          \
    {{force_##c##000, force_##c##001}, {force_##c##010, force_##c##011},                     \
     {force_##c##020, force_##c##021}},                                                      \
        {{force_##c##100, force_##c##101}, {force_##c##110, force_##c##111},                 \
         {force_##c##120, force_##c##121}},                                                  \
  }

_Static_assert(VSC_ACTIVE_NONE == 0 && VSC_ACTIVE_SPRING == 1 && VSC_ACTIVE_TENSION == 2,
               "the tables below are indexed by these");
FORCE_KERNELS(0, 0)
FORCE_KERNELS(0, 1)
FORCE_KERNELS(0, 2)
FORCE_KERNELS(1, 0)
FORCE_KERNELS(1, 1)
FORCE_KERNELS(1, 2)

const vsc_kernels KERNEL_SET = {
    .name = KERNEL_NAME,
    .tets = {TABLE(0), TABLE(1)},
    .solids = {{springs_hexes, springs_wedges, springs_pyramids, springs_tets10},
               {damped_springs_hexes, damped_springs_wedges, damped_springs_pyramids,
                damped_springs_tets10}},
    .laws = {{law_tets, law_hexes, law_wedges, law_pyramids, law_tets10},
             {damped_law_tets, damped_law_hexes, damped_law_wedges, damped_law_pyramids,
              damped_law_tets10}},
    .paper_tets = {force_paper_tets, force_damped_paper_tets},
    .paper_hexes = {force_paper_hexes, force_damped_paper_hexes},
    .springs = {force_springs, force_damped_springs},
    .triangles = {force_triangles, force_damped_triangles},
    .bends = {force_bends, force_damped_bends},
    .volume = volume_kernel,
    .tangents = {tangent_tets, tangent_hexes, tangent_wedges, tangent_pyramids,
                 tangent_tets10, NULL, tangent_triangles, tangent_bends},
    .smoothed = {force_smoothed_0, force_smoothed_1},
    .gradient = gradient_kernel,
    .edge_force = edge_force_kernel,
    .edge_stress = edge_stress_kernel,
    .edge_tangent = edge_tangent_kernel,
    .edge_product = edge_product_kernel,
};
