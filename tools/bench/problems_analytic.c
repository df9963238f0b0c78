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
    // two independent programs find it with ten thousand linear tets; finer meshes go down further, by 5 % of it with a
    // hundred thousand
    {.name = "far corner sinks", .unit = "mm", .measure = vsc_measure_move, .at = {100, 100, 100}, .axis = 2,
     .reference = -13.61, .percent = 2, .held = VSC_BENCH_PLAIN, .upto = 20000},
};

const vsc_bench_problem vsc_bench_sagging_block = {
    .name = "sagging_block", .title = "A soft block held at one face sinks under its weight",
    .scene = "sagging_block.yaml", .shape = "block --size=100,100,100",
    .variants = only, .variant_count = 1,
    .sizes = VSC_COUNTED(cubes), .quantities = VSC_COUNTED(sags),
};

// ---- isotropic bodies, with Poisson ratios up to one half

// Springs that are an isotropic body: E_a = 2 mu, G_ab = mu = E / (2 (1 + nu)),
// K = E nu / ((1 + nu) (1 - 2 nu)); here with E in kPa as the unit.
#define ISOTROPIC(mu2, mu, lambda, unit)                                                       \
  {"materials[0].axial.f=" mu2 unit, "materials[0].axial.s=" mu2 unit,                         \
   "materials[0].axial.n=" mu2 unit, "materials[0].angular.fs=" mu unit,                       \
   "materials[0].angular.sn=" mu unit, "materials[0].angular.nf=" mu unit,                     \
   "materials[0].volume_modulus=" lambda unit}
#define RATIOS(unit)                                                                           \
  {                                                                                            \
    {"0.3", 0.3, ISOTROPIC("0.7692307692", "0.3846153846", "0.5769230769", unit)},             \
    {"0.45", 0.45, ISOTROPIC("0.6896551724", "0.3448275862", "3.103448276", unit)},            \
    {"0.49", 0.49, ISOTROPIC("0.6711409396", "0.3355704698", "16.44295302", unit)},            \
    {"0.499", 0.499, ISOTROPIC("0.6671114076", "0.3335557038", "166.4442962", unit)},          \
    {"0.4999", 0.4999, ISOTROPIC("0.6667111141", "0.3333555570", "1666.444430", unit)},        \
  }

static const vsc_bench_variant soft_ratios[] = RATIOS(" kPa"), firm_ratios[] = RATIOS("e4 kPa");

static const vsc_bench_size slabs[] = {
    {VSC_BENCH_ALL, "--cells=20,2,2"},
    {VSC_BENCH_ALL & ~VSC_BENCH_QUADRATIC, "--cells=40,4,4"},
};

static const vsc_bench_quantity beam_moves[] = {
    // a clamped face, which the formula does not know, is half to one percent stiffer
    {.name = "end sinks", .unit = "mm", .measure = vsc_measure_move, .at = {10, 0.5, 0.5}, .axis = 2,
     .formula = vsc_beam_sag, .percent = 2, .held = VSC_BENCH_QUADRATIC},
};

const vsc_bench_problem vsc_bench_beam = {
    .name = "beam", .title = "A beam sinks under its weight: Poisson's ratio from 0.3 to 0.4999",
    .scene = "beam.yaml", .shape = "block --size=10,1,1",
    .variants = VSC_COUNTED(firm_ratios), .sizes = VSC_COUNTED(slabs), .quantities = VSC_COUNTED(beam_moves),
};

// ---- a thick sphere and a thick cylinder under pressure

static const vsc_bench_size spheres[] = {
    {VSC_BENCH_ALL, "--layers=2 --around=3"},
    {VSC_BENCH_ALL, "--layers=4 --around=6"},
    {VSC_BENCH_ALL & ~VSC_BENCH_QUADRATIC, "--layers=8 --around=12"},
};

static const vsc_bench_size cylinders[] = {
    {VSC_BENCH_ALL, "--layers=2 --around=4 --along=1 --length=0.4"},
    {VSC_BENCH_ALL, "--layers=4 --around=8 --along=1 --length=0.2"},
    {VSC_BENCH_ALL, "--layers=8 --around=16 --along=1 --length=0.1"},
};

static const vsc_bench_quantity sphere_moves[] = {
    {.name = "inner wall moves", .unit = "mm", .measure = vsc_measure_sphere_move, .at = {1},
     .formula = vsc_sphere_move, .percent = 1, .held = VSC_BENCH_QUADRATIC},
};

const vsc_bench_problem vsc_bench_lame_sphere = {
    .name = "lame_sphere", .title = "A thick sphere under a small pressure",
    .scene = "lame_sphere.yaml", .shape = "octant --inner=1 --outer=2",
    .variants = VSC_COUNTED(soft_ratios), .sizes = VSC_COUNTED(spheres),
    .quantities = VSC_COUNTED(sphere_moves),
};

static const vsc_bench_quantity cylinder_moves[] = {
    {.name = "inner wall moves", .unit = "mm", .measure = vsc_measure_cylinder_move, .at = {1},
     .formula = vsc_cylinder_move, .percent = 1, .held = VSC_BENCH_QUADRATIC},
};

const vsc_bench_problem vsc_bench_lame_cylinder = {
    .name = "lame_cylinder", .title = "A thick cylinder under a small pressure",
    .scene = "lame_cylinder.yaml", .shape = "cylinder --inner=1 --outer=2",
    .variants = VSC_COUNTED(soft_ratios), .sizes = VSC_COUNTED(cylinders),
    .quantities = VSC_COUNTED(cylinder_moves),
};

// Pressures that widen the inner radius by a quarter and by a half.
static const vsc_bench_variant sphere_pressures[] = {
    {"0.55", 0.551869, {"pressures[0].peak=0.551869 kPa"}},
    {"0.76", 0.755433, {"pressures[0].peak=0.755433 kPa"}},
};

static const vsc_bench_quantity sphere_radii[] = {
    {.name = "inner radius", .unit = "mm", .measure = vsc_measure_sphere, .at = {1},
     .formula = vsc_sphere_inner, .percent = 1, .held = VSC_BENCH_QUADRATIC},
};

const vsc_bench_problem vsc_bench_rubber_sphere = {
    .name = "rubber_sphere", .title = "A thick sphere of rubber is inflated",
    .scene = "rubber_sphere.yaml", .shape = "octant --inner=1 --outer=2",
    .variants = VSC_COUNTED(sphere_pressures), .sizes = VSC_COUNTED(spheres),
    .quantities = VSC_COUNTED(sphere_radii),
};

static const vsc_bench_variant cylinder_pressures[] = {
    {"0.28", 0.275712, {"pressures[0].peak=0.275712 kPa"}},
    {"0.43", 0.428228, {"pressures[0].peak=0.428228 kPa"}},
};

static const vsc_bench_quantity cylinder_radii[] = {
    {.name = "inner radius", .unit = "mm", .measure = vsc_measure_cylinder, .at = {1},
     .formula = vsc_cylinder_inner, .percent = 1, .held = VSC_BENCH_QUADRATIC},
};

const vsc_bench_problem vsc_bench_rubber_cylinder = {
    .name = "rubber_cylinder", .title = "A thick cylinder of rubber is inflated",
    .scene = "rubber_cylinder.yaml", .shape = "cylinder --inner=1 --outer=2",
    .variants = VSC_COUNTED(cylinder_pressures), .sizes = VSC_COUNTED(cylinders),
    .quantities = VSC_COUNTED(cylinder_radii),
};

// ---- Cook's membrane in plane strain, rubber of E = 240.565 kPa under a dead traction of 6.25 kPa

#define RUBBER(shear, bulk) \
  {"materials[0].neo_hookean.shear=" shear " kPa", "materials[0].volume_modulus=" bulk " kPa"}

static const vsc_bench_variant rubbers[] = {
    {"0.3", 0.3, RUBBER("92.525", "200.4708333")},
    {"0.4", 0.4, RUBBER("85.91607143", "400.9416667")},
    {"0.49", 0.49, RUBBER("80.72651007", "4009.416667")},
    {"0.499", 0.499, RUBBER("80.24182789", "40094.16667")},
    {"0.4999", 0.4999, RUBBER("80.19367958", "400941.6667")},
};

static const vsc_bench_size panels[] = {
    {VSC_BENCH_ALL, "--cells=8,8,1"},
    {VSC_BENCH_ALL, "--cells=16,16,1"},
    {VSC_BENCH_ALL & ~VSC_BENCH_QUADRATIC, "--cells=32,32,1"},
};

static const vsc_bench_quantity rises[] = {
    {.name = "end rises", .unit = "mm", .measure = vsc_measure_move, .at = {48, 52, 0.5}, .axis = 1,
     .formula = vsc_cook_rise, .percent = 1, .held = VSC_BENCH_QUADRATIC, .from = 1280},
};

const vsc_bench_problem vsc_bench_cook = {
    .name = "cook", .title = "Cook's membrane of rubber: Poisson's ratio from 0.3 to 0.4999",
    .scene = "cook.yaml", .shape = "cook",
    .variants = VSC_COUNTED(rubbers), .sizes = VSC_COUNTED(panels), .quantities = VSC_COUNTED(rises),
};
