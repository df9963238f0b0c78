// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/problem.h"

#include <stdio.h>

#include "tools/bench/problems.h"

// Stabilisation of tets with shared volumes is the scenes' own, the shear modulus; bricks need none
// (0 would stand for the shear modulus, too). Of linear tets volumes are kept by their modulus alone: multipliers
// lock them one by one, and take five times the iterations and more where they share volumes.
const vsc_bench_kind vsc_bench_kinds[] = {
    {VSC_BENCH_PLAIN, "plain", "", {"mesh.order=1", "mesh.curved=[]", "volume=element", "solver.incompressible=0"}},
    {VSC_BENCH_NODAL, "nodal", "", {"mesh.order=1", "mesh.curved=[]", "volume=nodal", "solver.incompressible=0"}},
    {VSC_BENCH_SMOOTHED, "smoothed", "", {"mesh.order=1", "mesh.curved=[]", "volume=nodal", "tets=smoothed", "solver.incompressible=0"}},
    {VSC_BENCH_QUADRATIC, "quadratic", "", {"mesh.order=2"}},
    {VSC_BENCH_POINTS, "points", "",
     {"mesh.order=2", "materials[0].volume_modulus=1 kPa", "materials[0].stabilization=999 kPa"}},
    {VSC_BENCH_HEXES, "hexes", "--element=hex", {"mesh.order=1", "mesh.curved=[]", "materials[0].stabilization=1 mPa"}},
    {VSC_BENCH_WEDGES, "wedges", "--element=wedge", {"mesh.order=1", "mesh.curved=[]", "materials[0].stabilization=1 mPa"}},
};
const size_t vsc_bench_kind_count = sizeof vsc_bench_kinds / sizeof vsc_bench_kinds[0];

const vsc_bench_problem *const vsc_bench_problems[] = {
    &vsc_bench_land_p1,
    &vsc_bench_land_p2,
    &vsc_bench_land_p3,
    &vsc_bench_sagging_block,
    &vsc_bench_lame_sphere,
    &vsc_bench_lame_cylinder,
    &vsc_bench_rubber_sphere,
    &vsc_bench_rubber_cylinder,
    &vsc_bench_beam,
    &vsc_bench_cook,
    &vsc_bench_vibration,
    &vsc_bench_bending_column,
    &vsc_bench_twisting_column,
    &vsc_bench_beat,
    &vsc_bench_arostica_0a,
    &vsc_bench_arostica_0b,
    &vsc_bench_arostica_1,
    &vsc_bench_arostica_biventricle,
};
const size_t vsc_bench_problem_count = sizeof vsc_bench_problems / sizeof vsc_bench_problems[0];

// The first or, after *size, next size of the problem that this kind is tried on; NULL behind the last.
static const vsc_bench_size *next_size(const vsc_bench_problem *problem, const vsc_bench_kind *kind,
                                       const vsc_bench_size *size)
{
  for (size = size == NULL ? problem->sizes : size + 1; size < problem->sizes + problem->size_count;
       size++)
    if ((size->kinds & kind->bit) != 0) return size;
  return NULL;
}

// Moves on by one kind, variant or problem; false behind the last.
static bool next_series(vsc_bench_case *at, size_t *problem)
{
  if (at->problem == NULL) {
    *problem = 0;
  } else if (++at->kind < vsc_bench_kinds + vsc_bench_kind_count) {
    return true;
  } else if (++at->variant < at->problem->variants + at->problem->variant_count) {
    at->kind = vsc_bench_kinds;
    return true;
  } else {
    ++*problem;
  }
  if (*problem == vsc_bench_problem_count) return false;
  at->problem = vsc_bench_problems[*problem];
  at->variant = at->problem->variants;
  at->kind = vsc_bench_kinds;
  return true;
}

bool vsc_bench_next(vsc_bench_case *at)
{
  size_t problem = 0;
  while (at->problem != NULL && vsc_bench_problems[problem] != at->problem) problem++;
  const vsc_bench_size *size =
      at->problem != NULL ? next_size(at->problem, at->kind, at->size) : NULL;
  at->coarsest = size == NULL;
  while (size == NULL) {
    if (!next_series(at, &problem)) return false;
    size = next_size(at->problem, at->kind, NULL);
  }
  at->size = size;
  snprintf(at->name, sizeof at->name, "%s%s%s-%s-%zu", at->problem->name,
           at->variant->name[0] != '\0' ? "-" : "", at->variant->name, at->kind->name,
           (size_t)(size - at->problem->sizes) + 1);
  return true;
}
