// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels of all instruction sets give the same bits: of every kind of cell, under every law, with
// odd and even numbers of packs, with inclusions, at positions that turn some cells inside out.
#include "kinds_body.h"
#include "mech/kernel_sets.h"
#include "tissue_laws.h"

enum { MODULI = sizeof(vsc_mixture) / sizeof(double) };

#ifdef __x86_64__
// A patch's work with all inputs at random, and the memory that they lie in.
typedef struct random_work {
  vsc_patch_work work;
  size_t nodes;
  double *memory;
} random_work;

static double *fill(double **next, size_t count, double low, double high, uint64_t *seed)
{
  double *numbers = *next;
  for (size_t i = 0; i < count; i++) numbers[i] = random_between(seed, low, high);
  *next += (count + 3) / 4 * 4;
  return numbers;
}

static random_work work_of(const vsc_model *model, const vsc_patch *patch, bool mixed, uint64_t *seed)
{
  random_work r = {.nodes = patch->own_count + patch->shared_count};
  const size_t packs = patch->pack_count, lanes = VSC_WIDTH * packs;
  r.memory = numbers(9 * r.nodes + 4 + (MODULI + 2 * VSC_WIDTH) * packs);
  double *next = r.memory, *x = fill(&next, 4 * r.nodes, -0.4, 0.4, seed);
  double *w = fill(&next, 4 * r.nodes, -1, 1, seed);
  for (size_t n = 0; n < r.nodes; n++) {
    const uint32_t node = vsc_node_of(model, patch, (uint32_t)n);
    for (int i = 0; i < 3; i++) x[4 * n + (size_t)i] += model->rest[4 * (size_t)node + (size_t)i];
    x[4 * n + 3] = w[4 * n + 3] = 0;
  }
  r.work = (vsc_patch_work){.packs = model->store + patch->packs,
                            .pack_count = packs,
                            .material = &model->materials[patch->material],
                            .rule = &model->rules[patch->family],
                            .axes = model->axes,
                            .pairs = model->pairs,
                            .x = x,
                            .w = w,
                            .pressure = fill(&next, r.nodes, -50, 50, seed),
                            .activation = (const vsc_four *)fill(&next, lanes, 0, 1, seed),
                            .activation_stride = 1,
                            .multipliers = (const vsc_four *)fill(&next, lanes, -5, 5, seed),
                            .shares_volume = patch->family == VSC_TETS,
                            .angular = true};
  const double *mixtures = fill(&next, MODULI * packs, 0.1, 9, seed);
  if (mixed) r.work.mixtures = (const vsc_four *)mixtures;
  return r;
}

static void compare(const random_work *r, vsc_patch_kernel *kernel, vsc_patch_kernel *oracle)
{
  vsc_patch_work work = r->work;
  double *forces[2];
  for (int s = 0; s < 2; s++) {
    forces[s] = numbers(4 * r->nodes);
    work.f = work.volume = forces[s];
    (s ? oracle : kernel)(&work);
  }
  assert_true(largest_of(forces[0], 4 * r->nodes) > 0);
  assert_int_equal(memcmp(forces[0], forces[1], 4 * r->nodes * sizeof(double)), 0);
  vsc_free(forces[0]);
  vsc_free(forces[1]);
}

// Kernel `variant` of a family under law SPRINGS: there are 36 of tets, of others 2.
static vsc_patch_kernel *springs_kernel(const vsc_cell_kernels *set, uint32_t family, int variant)
{
  const int damping = variant & 1, nodal = variant >> 1 & 1, active = variant >> 2, springs = active / 3;
  return family == VSC_TETS ? set->tets[springs][damping][active % 3][nodal] : set->solids[damping][family - VSC_HEXES];
}

// Angular springs that are not computed are those of modulus 0.
static void leave_out_angular(const random_work *r, vsc_patch_kernel *without, vsc_patch_kernel *with)
{
  vsc_material material = *r->work.material;
  memset(material.angular, 0, sizeof material.angular);
  double *forces[2];
  for (int angular = 0; angular < 2; angular++) {
    vsc_patch_work work = r->work;
    work.material = &material;
    work.mixtures = NULL;
    work.angular = angular;
    work.f = forces[angular] = numbers(4 * r->nodes);
    (angular ? with : without)(&work);
  }
  assert_int_equal(memcmp(forces[0], forces[1], 4 * r->nodes * sizeof(double)), 0);
  vsc_free(forces[0]);
  vsc_free(forces[1]);
}

static void compare_springs(const random_work *r, uint32_t family, const vsc_cell_kernels *set)
{
  const vsc_cell_kernels *oracle = &vsc_kernels_baseline.cells;
  const bool tets = family == VSC_TETS;
  for (int variant = 0; variant < (tets ? 36 : 2); variant++) {
    vsc_patch_kernel *kernel = springs_kernel(set, family, variant);
    compare(r, kernel, springs_kernel(oracle, family, variant));
    if (!tets || variant < 12) leave_out_angular(r, kernel, springs_kernel(set, family, variant + 12 * tets));
  }
  if (family == VSC_TETS) compare(r, set->volume, oracle->volume);
}

// Bodies of which at least one has patches of odd numbers of packs, and one of even numbers.
static void compare_sets(const vsc_cell_kernels *set, const vsc_material_def *material, uint64_t seed)
{
  static const kinds_mesh kinds[] = {ALL_TETS, ALL_KINDS, ALL_TETS10};
  size_t packs[2] = {0};
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    random_body body;
    kinds_open(&body, mesh_of(kinds[i], 3, seed), material, VSC_VOLUME_NODAL, seed + 1);
    for (size_t p = 0; p < 2 * body.model->patch_count; p++) {
      const vsc_patch *patch = &body.model->patches[p / 2];
      const random_work r = work_of(body.model, patch, p % 2, &seed);
      packs[patch->pack_count % 2]++;
      for (int d = 0; d < 2; d++)
        compare(&r, set->laws[d][patch->family], vsc_kernels_baseline.cells.laws[d][patch->family]);
      if (material->law == VSC_LAW_SPRINGS) compare_springs(&r, patch->family, set);
      vsc_free(r.memory);
    }
    body_close(&body);
  }
  assert_true(packs[0] > 0 && packs[1] > 0);
}

static void compare_laws(const vsc_cell_kernels *set)
{
  vsc_axis_def axes[2];
  vsc_pair_def pairs[2];
  vsc_material_def springs = springs_material(axes, pairs);
  springs.active = (vsc_active_def){.kind = VSC_ACTIVE_SPRING, .stiffness = 60, .rest_stretch = 0.85, .delay_unit = 1,
                                    .curve = vsc_default_curve(VSC_CURVE_RAMP)};
  compare_sets(set, &springs, 300);
  for (int k = 0; k < TISSUE_LAWS; k++) {
    vsc_material_def tissue = tissue_law(k);
    tissue.active = (vsc_active_def){.kind = VSC_ACTIVE_TENSION, .tension = 25, .length_factor = 0.5, .delay_unit = 1,
                                     .curve = vsc_default_curve(VSC_CURVE_RAMP)};
    tissue.viscosity = 0.3;
    compare_sets(set, &tissue, 310 + (uint64_t)k);
  }
}

static void avx2_gives_the_same_bits(void **state)
{
  (void)state;
  if (!__builtin_cpu_supports("avx2")) skip();
  compare_laws(&vsc_kernels_avx2.cells);
}

static void avx512_gives_the_same_bits(void **state)
{
  (void)state;
  if (!vsc_computes_eight()) skip();
  compare_laws(&vsc_cells_avx512);
}
#endif

int main(void)
{
  const struct CMUnitTest tests[] = {
#ifdef __x86_64__
      cmocka_unit_test(avx2_gives_the_same_bits),
      cmocka_unit_test(avx512_gives_the_same_bits),
#endif
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
