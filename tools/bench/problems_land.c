// SPDX-License-Identifier: GPL-3.0-or-later
// The three problems of Land et al. 2015, with the converged values of Simula's submission (axisymmetric
// elements of order 2 to 5) and of an own axisymmetric program that agrees with it.
#include "tools/bench/measures.h"
#include "tools/bench/problems.h"

static const vsc_bench_variant only[] = {{.name = ""}};

// ---- problem 1

// Hexahedra are cubes: twice as long as wide they are a tenth too stiff.
static const vsc_bench_size beams[] = {
    {VSC_BENCH_LINEAR | VSC_BENCH_QUADRATIC, "--cells=10,2,2"},
    {VSC_BENCH_ALL, "--cells=20,2,2"},
    {VSC_BENCH_QUADRATIC, "--cells=20,3,3"},
    {VSC_BENCH_ALL & ~VSC_BENCH_QUADRATIC, "--cells=40,4,4"},
    {VSC_BENCH_ALL & ~VSC_BENCH_QUADRATIC, "--cells=60,6,6"},
};

static const vsc_bench_quantity beam_places[] = {
    // within 0.3 % with at most 1,000 quadratic tets
    {.name = "z of (10, 0.5, 1)", .unit = "mm", .measure = vsc_measure_place, .at = {10, 0.5, 1}, .axis = 2,
     .reference = 4.1695, .percent = 0.3, .held = VSC_BENCH_QUADRATIC, .from = 400},
    {.name = "x of (10, 0.5, 1)", .unit = "mm", .measure = vsc_measure_place, .at = {10, 0.5, 1}, .axis = 0,
     .reference = 9.1766},
    {.name = "distance of the mid-line", .unit = "mm", .measure = vsc_measure_beam_line, .reference = 0,
     .within = 0.02, .held = VSC_BENCH_QUADRATIC, .from = 400},
    {.name = "strains", .unit = "pp", .measure = vsc_measure_beam_strains, .reference = 0, .within = 0.1,
     .held = VSC_BENCH_QUADRATIC, .from = 900},
};

const vsc_bench_problem vsc_bench_land_p1 = {
    .name = "land_p1", .title = "Land 2015, problem 1: a beam bends under pressure",
    .scene = "land_p1.yaml", .shape = "block --size=10,1,1",
    .variants = only, .variant_count = 1,
    .sizes = VSC_COUNTED(beams), .quantities = VSC_COUNTED(beam_places),
};

// ---- problems 2 and 3

#define LAND_VENTRICLE "lv --like=land"

// Of 2,080, 5,120, 9,900 and 23,040 tets.
static const vsc_bench_size ventricles[] = {
    {VSC_BENCH_ALL, "--around=16 --along=12 --layers=2"},
    {VSC_BENCH_QUADRATIC, "--around=16 --along=15 --layers=4"},
    {VSC_BENCH_ALL, "--around=24 --along=26 --layers=3"},
    {VSC_BENCH_ALL & ~VSC_BENCH_QUADRATIC, "--around=32 --along=34 --layers=4"},
};

static const vsc_bench_quantity inflated[] = {
    // within 0.5 % with at most 2,300 quadratic tets
    {.name = "z of the apex inside", .unit = "mm", .measure = vsc_measure_place, .at = {0, 0, -17}, .axis = 2,
     .reference = -26.612, .percent = 0.5, .held = VSC_BENCH_QUADRATIC},
    {.name = "z of the apex outside", .unit = "mm", .measure = vsc_measure_place, .at = {0, 0, -20},
     .axis = 2, .reference = -28.279, .percent = 0.5, .held = VSC_BENCH_QUADRATIC},
    {.name = "cavity", .unit = "ml", .measure = vsc_measure_signal, .column = "cavity_endo",
     .reference = 10.7343, .percent = 1, .held = VSC_BENCH_QUADRATIC},
    {.name = "distance of the mid-wall line", .unit = "mm", .measure = vsc_measure_midline,
     .file = "land_p2_midline.csv", .reference = 0, .within = 0.13, .held = VSC_BENCH_QUADRATIC},
    {.name = "strains", .unit = "pp", .measure = vsc_measure_strains, .file = "land_strains.csv", .axis = 2,
     .reference = 0, .within = 2, .held = VSC_BENCH_QUADRATIC},
};

const vsc_bench_problem vsc_bench_land_p2 = {
    .name = "land_p2", .title = "Land 2015, problem 2: a ventricle is inflated",
    .scene = "land_p2.yaml", .shape = LAND_VENTRICLE,
    .variants = only, .variant_count = 1,
    .sizes = VSC_COUNTED(ventricles), .quantities = VSC_COUNTED(inflated),
};

static const vsc_bench_quantity contracted[] = {
    // within the participants' spread with at most 10,000 quadratic tets
    {.name = "z of the apex inside", .unit = "mm", .measure = vsc_measure_place, .at = {0, 0, -17}, .axis = 2,
     .reference = -12.347, .within = 0.7, .held = VSC_BENCH_QUADRATIC},
    {.name = "z of the apex outside", .unit = "mm", .measure = vsc_measure_place, .at = {0, 0, -20},
     .axis = 2, .reference = -15.452, .within = 0.25, .held = VSC_BENCH_QUADRATIC},
    // a volume modulus of 1 MPa takes 1.3 % from it, 10 MPa 0.12 %
    {.name = "cavity", .unit = "ml", .measure = vsc_measure_signal, .column = "cavity_endo",
     .reference = 1.7959, .percent = 2, .held = VSC_BENCH_QUADRATIC},
    {.name = "largest y of the mid-wall line", .unit = "mm", .measure = vsc_measure_midline_peak,
     .reference = 1.510, .percent = 5, .held = VSC_BENCH_QUADRATIC},
    {.name = "distance of the mid-wall line", .unit = "mm", .measure = vsc_measure_midline,
     .file = "land_p3_midline.csv", .reference = 0, .within = 0.25, .held = VSC_BENCH_QUADRATIC},
    {.name = "strains", .unit = "pp", .measure = vsc_measure_strains, .file = "land_strains.csv", .axis = 3,
     .reference = 0, .within = 2, .held = VSC_BENCH_QUADRATIC, .from = 5120},
};

const vsc_bench_problem vsc_bench_land_p3 = {
    .name = "land_p3", .title = "Land 2015, problem 3: a ventricle is inflated and contracts",
    .scene = "land_p3.yaml", .shape = LAND_VENTRICLE,
    .variants = only, .variant_count = 1,
    .sizes = VSC_COUNTED(ventricles), .quantities = VSC_COUNTED(contracted),
};
