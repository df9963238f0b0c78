// SPDX-License-Identifier: GPL-3.0-or-later
// All kernels of an instruction set, which computes four at once: included by one source file for each.
// KERNEL_SET names it. Those of cells under laws of strain are listed in kernel_cells.h.
#include <string.h>

#include "mech/kernel_cells.h"
#include "mech/kernel_common.h"
#include "mech/kernel_sets.h"
// what the cells have is used by these
#include "mech/kernel_paper.h"
#include "mech/kernel_surface.h"
#include "mech/kernel_tangent.h"
#include "mech/kernel_surface_tangent.h"
#include "mech/kernel_smoothed.h"

const vsc_kernels KERNEL_SET = {
    .name = KERNEL_NAME,
    .cells = CELLS,
    .paper_tets = {force_paper_tets, force_damped_paper_tets},
    .paper_hexes = {force_paper_hexes, force_damped_paper_hexes},
    .springs = {force_springs, force_damped_springs},
    .triangles = {force_triangles, force_damped_triangles},
    .bends = {force_bends, force_damped_bends},
    .tangents = {tangent_tets, tangent_hexes, tangent_wedges, tangent_pyramids,
                 tangent_tets10, NULL, tangent_triangles, tangent_bends},
    .smoothed = {force_smoothed_0, force_smoothed_1},
    .gradient = gradient_kernel,
    .edge_force = edge_force_kernel,
    .edge_stress = edge_stress_kernel,
    .edge_tangent = edge_tangent_kernel,
    .edge_product = edge_product_kernel,
};
