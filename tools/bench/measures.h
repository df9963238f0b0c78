// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers that the benchmarks take from what a run has left; all but the helpers at the end are
// vsc_bench_measure.
#ifndef VSC_TOOLS_BENCH_MEASURES_H
#define VSC_TOOLS_BENCH_MEASURES_H

#include "tools/bench/outcome.h"

// Where the point of the tissue that rests at quantity->at is in the last frame, along quantity->axis; how
// far it has moved. VSC_INPUT when it lies outside the body by more than 1 % of its size.
vsc_bench_measure vsc_measure_place, vsc_measure_move;

// The last row of quantity->column; its least and its largest value; oscillations per second of it
// (vsc_curve_frequency); the strongest tone in it from quantity->at[0] to at[1] Hz (vsc_curve_tone).
vsc_bench_measure vsc_measure_signal, vsc_measure_least, vsc_measure_most, vsc_measure_frequency, vsc_measure_tone;

// By how much quantity->column falls below its first value. Of a case of the variant "implicit" the
// reference is that of "explicit", whose results lie beside its own; other cases have none.
vsc_bench_measure vsc_measure_stroke;

// Mean distance from the origin (sphere) or from the axis z (cylinder) of the nodes that rest at the
// distance quantity->at[0], in the last frame; how much larger it is than at rest.
vsc_bench_measure vsc_measure_sphere, vsc_measure_cylinder, vsc_measure_sphere_move,
    vsc_measure_cylinder_move;

// Land's ventricle (rs = 7 + 3 t, rl = 17 + 3 t mm; x = rs sin u, z = rl cos u in the half plane y = 0,
// x <= 0; s is the part of the way from u = -pi in the apex to the base). The mid-wall line t = 0.5 in
// the last frame: largest distance from the reference curve (columns s, x_mm, y_mm, z_mm of
// quantity->file) at the same s, from 0.02 on: fibres have no direction in the apex; largest y.
vsc_bench_measure vsc_measure_midline, vsc_measure_midline_peak;

// Land's beam, 10 mm x 1 mm x 1 mm along x, in the last frame: largest distance, mm, of the points x = 5, 7.5, 9 and
// 10 mm of its mid-line (x, 0.5, 0.5) mm from where a program with 60 x 6 x 6 bricks of order 2 has them (torchcor); its
// strains, percent by which the distances from the points x = 0, 1 to 9 mm of that line to the neighbours 1 mm further
// along x, 0.4 mm along y and 0.4 mm along z change: largest difference from that program's, in percent points.
vsc_bench_measure vsc_measure_beam_line, vsc_measure_beam_strains;

// The strains of the paper's figures: percent by which the distances of neighbours among the points
// s = 0.095 k, t = 0.1, 0.5, 0.9 change, along the circumference (to the image turned by 18 degrees), the
// meridian and through the wall. Largest difference from those of quantity->file for the problem number
// quantity->axis, in percent points, over points 2 to 9.
vsc_bench_measure vsc_measure_strains;

// Histories of a point: signals.csv has the columns quantity->column with x, y, z behind, mm, and the
// reference curves those of quantity->file_column: NAME_ux_mean_mm, NAME_ux_min_mm, NAME_ux_max_mm, and
// so on. At the reference's times: relative distance to the mean over time and components; the part of
// time points, percent, at which component quantity->axis is between least and most.
vsc_bench_measure vsc_measure_history, vsc_measure_band;

// What that part is for a team of the benchmark itself: the median over all columns TEAM_NAME_u<x|y|z>_mm of
// quantity->file (NAME is quantity->file_column, the component quantity->axis), each against the band of the others.
vsc_bench_measure vsc_measure_team_band;

// Histories of a point again, against reference curves in metres: columns t_s and u<x|y|z>_NAME_m, NAME being
// quantity->file_column: relative distance over time and components.
vsc_bench_measure vsc_measure_course;

// When a point is back where it was, s: the first time that the distance of its displacement quantity->column
// with x, y, z behind from 0 is least and below a tenth of its largest, after it was above a half (a parabola through
// the squares of three rows); not before quantity->at[0] s: a whole turn ends there, too.
vsc_bench_measure vsc_measure_return;

// The largest |balance_error| in percent of the largest energy_kinetic.
vsc_bench_measure vsc_measure_balance;

// Where the point of that mid-wall line at `s` is in the last frame, mm. VSC_INPUT as above.
vsc_status vsc_midline_point(const vsc_outcome *outcome, double s, double now[3], vsc_error *error);

// Where the point of the tissue that rests at `at` is in the last frame, mm. VSC_INPUT as above.
vsc_status vsc_moved_point(const vsc_outcome *outcome, const double at[3], double now[3],
                           vsc_error *error);

// A column of signals.csv, in its own unit; VSC_INPUT when there is none, or it has no rows.
vsc_status vsc_find_column(const vsc_outcome *outcome, const char *name, const double **values,
                           vsc_error *error);

// Reads quantity->file, which the caller owns; *table is NULL, and measured->skipped true, where there is
// no such file.
vsc_status vsc_open_reference(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                              vsc_signals **table, vsc_measured *measured, vsc_error *error);

#endif
