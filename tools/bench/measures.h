// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers that the benchmarks take from what a run has left; all are vsc_bench_measure.
#ifndef VSC_TOOLS_BENCH_MEASURES_H
#define VSC_TOOLS_BENCH_MEASURES_H

#include "tools/bench/outcome.h"

// Where the node that rests at quantity->at is in the last frame, along quantity->axis; how far it has
// moved. VSC_INPUT when there is no node within 1e-4 of the body's size.
vsc_bench_measure vsc_measure_place, vsc_measure_move;

// The last row of quantity->column; oscillations per second of it (vsc_curve_frequency).
vsc_bench_measure vsc_measure_signal, vsc_measure_frequency;

// Mean distance from the origin (sphere) or from the axis z (cylinder) of the nodes that rest at the
// distance quantity->at[0], in the last frame; how much larger it is than at rest.
vsc_bench_measure vsc_measure_sphere, vsc_measure_cylinder, vsc_measure_sphere_move,
    vsc_measure_cylinder_move;

// The mid-wall line of Land's ventricle: the nodes that rest halfway through the wall in the half plane
// y = 0, x <= 0, with s, the part of the meridian angle from apex to base. Largest distance from the
// reference curve (columns s, x_mm, y_mm, z_mm of quantity->file) at the same s, behind s = 0.02: fibres
// have no direction in the apex; largest y.
vsc_bench_measure vsc_measure_midline, vsc_measure_midline_peak;

// Histories of a point: signals.csv has the columns quantity->column with x, y, z behind, mm, and the
// reference curves those of quantity->file_column: NAME_ux_mean_mm, NAME_ux_min_mm, NAME_ux_max_mm, and so on. At
// the reference's times: relative distance to the mean over time and components; the part of time points,
// percent, at which component quantity->axis is between least and most.
vsc_bench_measure vsc_measure_history, vsc_measure_band;

#endif
