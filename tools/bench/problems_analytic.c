// SPDX-License-Identifier: GPL-3.0-or-later
// Problems with closed forms, and ones on which independent programs agree.
#include "tools/bench/closed_forms.h"
#include "tools/bench/measures.h"
#include "tools/bench/problems.h"

static const vsc_bench_variant only[] = {{.name = ""}};

// ---- a cube of 0.1 m of neo-Hookean rubber, E = 20 kPa, nu = 0.45, held at one face, under its weight

// Of 10,140 and 98,415 tets.
static const vsc_bench_size cubes[] = {
    {VSC_BENCH_LINEAR, "--cells=13,13,12"},
    {VSC_BENCH_LINEAR, "--cells=27,27,27"},
};

static const vsc_bench_quantity sags[] = {
    // two independent programs find it with 10 thousand linear tets
    {.name = "far corner sinks", .unit = "mm", .measure = vsc_measure_move, .at = {100, 100, 100}, .axis = 2,
     .reference = -13.61, .percent = 2, .held = VSC_BENCH_PLAIN},
};

const vsc_bench_problem vsc_bench_sagging_block = {
    .name = "sagging_block", .title = "A soft block held at one face sinks under its weight",
    .scene = "sagging_block.yaml", .shape = "block --size=100,100,100",
    .variants = only, .variant_count = 1,
    .sizes = VSC_COUNTED(cubes), .quantities = VSC_COUNTED(sags),
};

// ---- Timoshenko's beam: locking where the Poisson ratio comes near one half

// Springs that are an isotropic body: E_a = 2 mu, G_ab = mu = E / (2 (1 + nu)),
// K = E nu / ((1 + nu) (1 - 2 nu)), E = 10 MPa.
#define ISOTROPIC(mu2, mu, lambda)                                                          \
  {"materials[0].axial.f=" mu2 " kPa", "materials[0].axial.s=" mu2 " kPa",                  \
   "materials[0].axial.n=" mu2 " kPa", "materials[0].angular.fs=" mu " kPa",                \
   "materials[0].angular.sn=" mu " kPa", "materials[0].angular.nf=" mu " kPa",              \
   "materials[0].volume_modulus=" lambda " kPa"}

static const vsc_bench_variant ratios[] = {
    {"0.3", 0.3, ISOTROPIC("7692.307692", "3846.153846", "5769.230769")},
    {"0.45", 0.45, ISOTROPIC("6896.551724", "3448.275862", "31034.48276")},
    {"0.49", 0.49, ISOTROPIC("6711.409396", "3355.704698", "164429.5302")},
    {"0.499", 0.499, ISOTROPIC("6671.114076", "3335.557038", "1664442.962")},
    {"0.4999", 0.4999, ISOTROPIC("6667.111141", "3333.555570", "16664444.30")},
};

static const vsc_bench_size slabs[] = {
    {VSC_BENCH_ALL, "--cells=20,2,2"},
    {VSC_BENCH_ALL & ~VSC_BENCH_QUADRATIC, "--cells=40,4,4"},
};

static const vsc_bench_quantity beam_moves[] = {
    // a clamped face, which the formula does not know, is half to one percent stiffer
    {.name = "end sinks", .unit = "mm", .measure = vsc_measure_move, .at = {10, 0.5, 0.5}, .axis = 2,
     .formula = vsc_beam_sag, .percent = 2, .held = VSC_BENCH_QUADRATIC | VSC_BENCH_HEXES},
};

const vsc_bench_problem vsc_bench_beam = {
    .name = "beam", .title = "A beam sinks under its weight: Poisson's ratio from 0.3 to 0.4999",
    .scene = "beam.yaml", .shape = "block --size=10,1,1",
    .variants = VSC_COUNTED(ratios), .sizes = VSC_COUNTED(slabs), .quantities = VSC_COUNTED(beam_moves),
};
