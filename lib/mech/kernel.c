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

vsc_patch_kernel *vsc_force_kernel(bool damping, vsc_active_kind active, bool nodal_volume)
{
  return kernels()->force[damping][active][nodal_volume];
}

vsc_patch_kernel *vsc_volume_kernel(void)
{
  return kernels()->volume;
}

const char *vsc_kernel_set(void)
{
  return kernels()->name;
}
