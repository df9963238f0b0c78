// SPDX-License-Identifier: GPL-3.0-or-later
// The problems of `viscera bench accuracy`, each defined with its sources in problems_*.c.
#ifndef VSC_TOOLS_BENCH_PROBLEMS_H
#define VSC_TOOLS_BENCH_PROBLEMS_H

#include "tools/bench/problem.h"

#define VSC_COUNTED(array) array, sizeof(array) / sizeof((array)[0])

// Land et al. 2015, Proc. R. Soc. A 471:20150641.
extern const vsc_bench_problem vsc_bench_land_p1;  // a beam bends under pressure
extern const vsc_bench_problem vsc_bench_land_p2;  // a ventricle is inflated
extern const vsc_bench_problem vsc_bench_land_p3;  // a ventricle is inflated and contracts

// Closed forms and values on which independent programs agree.
extern const vsc_bench_problem vsc_bench_sagging_block;  // a soft cube held at one face
extern const vsc_bench_problem vsc_bench_lame_sphere, vsc_bench_lame_cylinder;      // at small strain
extern const vsc_bench_problem vsc_bench_rubber_sphere, vsc_bench_rubber_cylinder;  // at large strain
extern const vsc_bench_problem vsc_bench_cook;       // Cook's membrane at large strain, likewise
extern const vsc_bench_problem vsc_bench_beam;       // Timoshenko's, up to a Poisson ratio of 0.4999
extern const vsc_bench_problem vsc_bench_vibration;  // a soft bar swings
extern const vsc_bench_problem vsc_bench_bending_column, vsc_bench_twisting_column;  // set in motion
extern const vsc_bench_problem vsc_bench_beat;       // time steps of the shipped beat

// Arostica et al. 2025, Comput. Methods Appl. Mech. Engrg. 435:117485.
extern const vsc_bench_problem vsc_bench_arostica_0a;            // a ventricle contracts
extern const vsc_bench_problem vsc_bench_arostica_0b;            // is filled, and snaps through
extern const vsc_bench_problem vsc_bench_arostica_1;             // both
extern const vsc_bench_problem vsc_bench_arostica_biventricle; // two ventricles

#endif
