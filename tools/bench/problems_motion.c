// SPDX-License-Identifier: GPL-3.0-or-later
// Problems in time: a bar that swings, and the ventricles of Arostica et al. 2025 with the curves of its
// ten programs.
#include <math.h>

#include "tools/bench/measures.h"
#include "tools/bench/problems.h"

static const vsc_bench_variant explicit_or_not[] = {
    {"explicit", 0, {"solve=explicit"}},
    {"implicit", 0, {"solve=implicit"}},
};

// ---- a soft bar of 10 mm x 10 mm x 100 mm, E = 10 kPa, nu = 0.3, swings at one end

static const vsc_bench_size bars[] = {
    {VSC_BENCH_ALL, "--cells=2,2,20"},
    {VSC_BENCH_HEXES | VSC_BENCH_NODAL, "--cells=4,4,40"},
};

static const vsc_bench_quantity tones[] = {
    // Timoshenko's beam with Cowper's shear; 0.5108 Hz by Euler and Bernoulli
    {.name = "frequency", .unit = "Hz", .measure = vsc_measure_frequency, .column = "momentum_x",
     .reference = 0.506874, .percent = 1, .held = VSC_BENCH_QUADRATIC},
    // likewise; 3.2014 and 8.9639 Hz
    {.name = "second frequency", .unit = "Hz", .measure = vsc_measure_tone, .column = "momentum_x", .at = {2, 4.5},
     .reference = 3.03973, .percent = 2, .held = VSC_BENCH_QUADRATIC},
    {.name = "third frequency", .unit = "Hz", .measure = vsc_measure_tone, .column = "momentum_x", .at = {6, 11},
     .reference = 8.00108, .percent = 5, .held = VSC_BENCH_QUADRATIC},
};

const vsc_bench_problem vsc_bench_vibration = {
    .name = "vibration", .title = "A soft bar swings: its three lowest frequencies",
    .scene = "vibration.yaml", .shape = "block --size=10,10,100",
    .variants = VSC_COUNTED(explicit_or_not), .sizes = VSC_COUNTED(bars),
    .quantities = VSC_COUNTED(tones),
};

// ---- a column of rubber, 1 m x 1 m x 6 m, held at its foot, is set in motion (Bonet, Gil et al. 2015)

static const vsc_bench_size bent[] = {
    {VSC_BENCH_QUADRATIC, "--cells=2,2,12"},
    {VSC_BENCH_ALL, "--cells=4,4,24"},
    {VSC_BENCH_ALL & ~VSC_BENCH_QUADRATIC, "--cells=8,8,48"},
};

// Lumped masses lie too far out: the energy of a twist is 12 % too large with four linear bricks across the width, 3 %
// with eight or with four quadratic ones, and courses part with the phase.
static const vsc_bench_size twisted[] = {
    {VSC_BENCH_ALL, "--cells=4,4,24"},
    {VSC_BENCH_ALL, "--cells=8,8,48"},
};

#define COLUMN(curves, away, back, part, most, least)                                                            \
  {.name = "distance of a corner", .unit = "1", .measure = vsc_measure_course, .column = "point_corner_u",       \
   .file = curves, .file_column = "corner", .reference = 0, .within = most, .held = VSC_BENCH_QUADRATIC,         \
   .from = least},                                                                                               \
  {.name = "back after", .unit = "s", .measure = vsc_measure_return, .column = "point_corner_u",                 \
   .at = {away}, .reference = back, .percent = part, .held = VSC_BENCH_QUADRATIC, .from = least},                \
  {.name = "energy off by", .unit = "%", .measure = vsc_measure_balance, .reference = 0, .within = 0.1},         \
  {.name = "smallest J", .unit = "1", .measure = vsc_measure_least, .column = "J_min", .reference = NAN}

static const vsc_bench_variant explicit_only[] = {{"explicit", 0, {"solve=explicit"}}};

static const vsc_bench_quantity bends[] = {COLUMN("column_bending.csv", 0, 0.909, 1, 0.02, 1920)};

const vsc_bench_problem vsc_bench_bending_column = {
    .name = "bending_column", .title = "A column bends and swings back, 10 m/s at its top",
    .scene = "column.yaml", .shape = "column --bend=10",
    .variants = VSC_COUNTED(explicit_only), .sizes = VSC_COUNTED(bent), .quantities = VSC_COUNTED(bends),
};

static const vsc_bench_quantity twists[] = {COLUMN("column_twisting.csv", 0.12, 0.179, 1, 0.08, 15360)};

const vsc_bench_problem vsc_bench_twisting_column = {
    .name = "twisting_column", .title = "A column twists by most of a turn and back, 105 rad/s at its top",
    .scene = "column.yaml", .shape = "column --twist=105",
    .settings = {"time.end=0.4 s"},
    .variants = VSC_COUNTED(explicit_only), .sizes = VSC_COUNTED(twisted), .quantities = VSC_COUNTED(twists),
};

// ---- Arostica et al. 2025

// Of a component the part of time points in the band of all teams, and what that part is for a team in the band of the
// others: what a program that is as right as theirs comes to. The target, of quadratic tets alone, is what README tells of
// the component that is least in the band, `lost` percent short of all time points.
#define IN_BAND(p, letter, number, curves, lost)                                                                 \
  {.name = p " " letter " in the band", .unit = "%", .measure = vsc_measure_band, .column = "point_" p "_u",     \
   .file = curves "_stats.csv", .file_column = p, .axis = number, .reference = 100, .within = lost,              \
   .held = VSC_BENCH_POINTS},                                                                                     \
  {.name = p " " letter " of a team", .unit = "%", .measure = vsc_measure_team_band, .file = curves "_all.csv",  \
   .file_column = p, .axis = number, .reference = NAN}

#define POINT(p, curves, most, lost)                                                                             \
  {.name = "distance of " p, .unit = "1", .measure = vsc_measure_history, .column = "point_" p "_u",             \
   .file = curves "_stats.csv", .file_column = p, .reference = 0, .within = most},                               \
  IN_BAND(p, "x", 0, curves, lost), IN_BAND(p, "y", 1, curves, lost), IN_BAND(p, "z", 2, curves, lost)

// Viscosity and dashpots bring the stable step down to 0.003 ms: inertia of neighbours against one another makes it 0.1 ms,
// which moves no distance below by more than 0.013.
static const vsc_bench_variant both_ways[] = {
    {"implicit", 0, {"solve=implicit"}},
    {"explicit", 0, {"solve=explicit", "time.selective_mass_scaling=0.1 ms"}},
};

// On the benchmark's own mesh of 17,625 tets: its programs' springs hold on the normals of its flat
// triangles, and on a smooth ellipsoid the wall slides 5 % further than theirs. Most of its programs have quadratic
// elements with the volume's energy at each point.
static const vsc_bench_size walls[] = {
    {VSC_BENCH_NODAL | VSC_BENCH_POINTS, ""},
};

static const vsc_bench_quantity contracts[] = {
    POINT("p0", "arostica_mono_0A", 0.05, 6), POINT("p1", "arostica_mono_0A", 0.05, 6),
    // 77.4 to 78.9 ml of the programs that agree, and two millilitres about them
    {.name = "smallest cavity", .unit = "ml", .measure = vsc_measure_least, .column = "cavity_endo",
     .reference = 78.15, .within = 2.75}};

const vsc_bench_problem vsc_bench_arostica_0a = {
    .name = "arostica_0a", .title = "Arostica 2025, case 0A: a ventricle contracts",
    .scene = "arostica_0a.yaml", .mesh = "monoventricle_5mm.vtu",
    .variants = VSC_COUNTED(both_ways), .sizes = VSC_COUNTED(walls),
    .quantities = VSC_COUNTED(contracts),
};

static const vsc_bench_quantity snaps[] = {
    POINT("p0", "arostica_mono_0B", 0.15, 18), POINT("p1", "arostica_mono_0B", 0.15, 18),
    // 252.6 to 264.7 ml, likewise
    {.name = "largest cavity", .unit = "ml", .measure = vsc_measure_most, .column = "cavity_endo",
     .reference = 258.65, .within = 8.05}};

const vsc_bench_problem vsc_bench_arostica_0b = {
    .name = "arostica_0b", .title = "Arostica 2025, case 0B: a ventricle is filled and snaps through",
    .scene = "arostica_0b.yaml", .mesh = "monoventricle_5mm.vtu",
    .variants = VSC_COUNTED(both_ways), .sizes = VSC_COUNTED(walls),
    .quantities = VSC_COUNTED(snaps),
};
static const vsc_bench_quantity beats[] = {
    POINT("p0", "arostica_mono_1", 0.05, 11), POINT("p1", "arostica_mono_1", 0.05, 11),
    // 81.1 to 82.8 ml of five programs that agree
    {.name = "smallest cavity", .unit = "ml", .measure = vsc_measure_least, .column = "cavity_endo",
     .reference = 82, .within = 2}};

const vsc_bench_problem vsc_bench_arostica_1 = {
    .name = "arostica_1", .title = "Arostica 2025, case 1: a ventricle beats",
    .scene = "arostica_1.yaml", .mesh = "monoventricle_5mm.vtu",
    .variants = VSC_COUNTED(both_ways), .sizes = VSC_COUNTED(walls),
    .quantities = VSC_COUNTED(beats),
};

static const vsc_bench_quantity two_beat[] = {
    POINT("p0", "arostica_biv_coarse", 0.15, 27), POINT("p1", "arostica_biv_coarse", 0.15, 27),
    POINT("p2", "arostica_biv_coarse", 0.15, 27)};

const vsc_bench_problem vsc_bench_arostica_biventricle = {
    .name = "arostica_biventricle", .title = "Arostica 2025, case 2: two ventricles beat",
    .scene = "arostica_biventricle.yaml", .mesh = "biventricle_coarse.vtu",
    .variants = VSC_COUNTED(both_ways), .sizes = VSC_COUNTED(walls),
    .quantities = VSC_COUNTED(two_beat),
};
// ---- order in time, and explicit against implicit, on the first half second of a beat

// None is longer than the 2 ms between rows, which would cut it.
static const vsc_bench_variant steps[] = {
    {"explicit", 0, {"solve=explicit"}},
    {"implicit", 0, {"solve=implicit"}},
    {"explicit-0.016", 0.016, {"solve=explicit", "time.step=0.016 ms"}},
    {"explicit-0.008", 0.008, {"solve=explicit", "time.step=0.008 ms"}},
    {"explicit-0.004", 0.004, {"solve=explicit", "time.step=0.004 ms"}},
    {"implicit-0.5", 0.5, {"solve=implicit", "time.step=0.5 ms", "solver.tolerance=1e-8"}},
    {"implicit-0.25", 0.25, {"solve=implicit", "time.step=0.25 ms", "solver.tolerance=1e-8"}},
    {"implicit-0.125", 0.125, {"solve=implicit", "time.step=0.125 ms", "solver.tolerance=1e-8"}},
};

static const vsc_bench_size small_hearts[] = {
    {VSC_BENCH_NODAL, "--around=16 --along=7 --layers=2"},
};

static const vsc_bench_quantity strokes[] = {
    {.name = "stroke", .unit = "ml", .measure = vsc_measure_stroke, .column = "cavity_endo",
     .reference = NAN, .percent = 0.5, .order = {1.8, 2.2}},
    {.name = "cavity at the end", .unit = "ml", .measure = vsc_measure_signal, .column = "cavity_endo",
     .reference = NAN, .order = {1.8, 2.2}},
};

const vsc_bench_problem vsc_bench_beat = {
    .name = "beat", .title = "Half a beat: order in time, explicit against implicit",
    .scene = "../beat.yaml", .shape = "lv",
    .settings = {"time.end=0.4 s", "output.frames=0.4 s"},
    .variants = VSC_COUNTED(steps), .sizes = VSC_COUNTED(small_hearts),
    .quantities = VSC_COUNTED(strokes),
};
