// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/kernel.h"

#include "mech/kernel_sets.h"

static const vsc_kernels *kernels(void)
{
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return &vsc_kernels_avx2;
#endif
  return &vsc_kernels_baseline;
}

#ifdef __x86_64__
bool vsc_computes_eight(void)
{
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#endif

// Eight cells at once where the processor can.
static const vsc_cell_kernels *cells(void)
{
#ifdef __x86_64__
  if (vsc_computes_eight()) return &vsc_cells_avx512;
#endif
  return &kernels()->cells;
}

static vsc_patch_kernel *cell_kernel(const vsc_kernels *set, const vsc_kernel_choice *c)
{
  if (c->law == VSC_LAW_CLASSICAL) return NULL;
  if (c->law == VSC_LAW_PAPER)
    return c->family == VSC_TETS ? set->paper_tets[c->damping] : set->paper_hexes[c->damping];
  if (c->smoothed) return set->smoothed[c->nodal_volume];
  if (c->general) return cells()->laws[c->damping][c->family];
  if (c->family == VSC_TETS) return cells()->tets[c->springs][c->damping][c->active][c->nodal_volume];
  return cells()->solids[c->damping][c->family - VSC_HEXES];
}

vsc_patch_kernel *vsc_force_kernel(const vsc_kernel_choice *choice)
{
  const vsc_kernels *set = kernels();
  switch (choice->family) {
    case VSC_SPRINGS_ON_EDGES:
      return set->springs[choice->damping];
    case VSC_TRIANGLES:
      return set->triangles[choice->damping];
    case VSC_BENDS:
      return set->bends[choice->damping];
    default:
      return cell_kernel(set, choice);
  }
}

vsc_patch_kernel *vsc_volume_kernel(void)
{
  return cells()->volume;
}

vsc_patch_kernel *vsc_gradient_kernel(void)
{
  return kernels()->gradient;
}

vsc_patch_kernel *vsc_edge_force_kernel(void)
{
  return kernels()->edge_force;
}

vsc_edge_kernel *vsc_edge_stress_kernel(void)
{
  return kernels()->edge_stress;
}

vsc_edge_kernel *vsc_edge_tangent_kernel(void)
{
  return kernels()->edge_tangent;
}

vsc_edge_kernel *vsc_edge_product_kernel(void)
{
  return kernels()->edge_product;
}

vsc_tangent_kernel *vsc_family_tangent(uint32_t family)
{
  return kernels()->tangents[family];
}

const char *vsc_kernel_set(void)
{
#ifdef __x86_64__
  if (vsc_computes_eight()) return "AVX-512";
#endif
  return kernels()->name;
}
