// SPDX-License-Identifier: GPL-3.0-or-later
// What `viscera bench accuracy` computes, as tables: problems whose answers are known, in variants, with
// elements of several kinds and sizes. A case is one of each.
#ifndef VSC_TOOLS_BENCH_PROBLEM_H
#define VSC_TOOLS_BENCH_PROBLEM_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

enum { VSC_BENCH_SETTINGS = 10, VSC_BENCH_TEXT = 192 };

typedef struct vsc_outcome vsc_outcome;  // tools/bench/outcome.h
typedef struct vsc_bench_quantity vsc_bench_quantity;

typedef struct vsc_measured {
  double value;
  double reference;  // the quantity's own; those that compute theirs replace it. NAN: there is none
  bool skipped;      // what it is compared with is not there
} vsc_measured;

// Takes one number from what a run has left.
typedef vsc_status vsc_bench_measure(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                                     vsc_measured *measured, vsc_error *error);

struct vsc_bench_quantity {
  const char *name;            // in reports
  const char *unit;            // may be empty
  vsc_bench_measure *measure;  // tools/bench/measures.h says what it reads of the following
  double at[3];                // place at rest, mm
  int axis;                    // 0 x, 1 y, 2 z
  const char *column;          // of signals.csv
  const char *file;            // reference curve, in the folder --reference
  const char *file_column;     // its column; of several: what their names begin with
  double reference;            // in the same unit
  double (*formula)(double parameter);  // or this, of the variant's parameter
  double percent;              // target: |value - reference| <= this part of |reference|;
  double within;               // or this, in the same unit; both 0: no target
  unsigned held;               // kinds that the target is for; 0: all
  double from, upto;           // elements of the meshes that it is for, least and most; 0: any. Others only show how
                               // errors fall
  double order[2];             // target for the observed order, least and most; both 0: none
};

// Kinds of elements, as bits.
enum {
  VSC_BENCH_PLAIN = 1,      // tets, each with its own volume
  VSC_BENCH_NODAL = 2,      // tets, volume averaged at nodes
  VSC_BENCH_SMOOTHED = 4,   // tets, law on frames of edges, volume averaged at nodes
  VSC_BENCH_QUADRATIC = 8,  // ten-node tets
  VSC_BENCH_HEXES = 16,
  VSC_BENCH_WEDGES = 32,
  VSC_BENCH_POINTS = 64,    // ten-node tets, a volume modulus of 1 MPa at each point
  VSC_BENCH_LINEAR = VSC_BENCH_PLAIN | VSC_BENCH_NODAL | VSC_BENCH_SMOOTHED,
  VSC_BENCH_BRICKS = VSC_BENCH_HEXES | VSC_BENCH_WEDGES,
  VSC_BENCH_ALL = VSC_BENCH_LINEAR | VSC_BENCH_QUADRATIC | VSC_BENCH_BRICKS,
};

typedef struct vsc_bench_kind {
  unsigned bit;
  const char *name;                          // in names of cases
  const char *shape;                         // options of `viscera generate`; may be empty
  const char *settings[VSC_BENCH_SETTINGS];  // of the scene, "key=value"; NULL ends them
} vsc_bench_kind;

extern const vsc_bench_kind vsc_bench_kinds[];  // from the simplest to the best
extern const size_t vsc_bench_kind_count;

// A mesh of a problem.
typedef struct vsc_bench_size {
  unsigned kinds;     // that are tried on it
  const char *shape;  // options of `viscera generate`
} vsc_bench_size;

typedef struct vsc_bench_variant {
  const char *name;                          // in names of cases; empty for the only one
  double parameter;                          // of closed forms
  const char *settings[VSC_BENCH_SETTINGS];
} vsc_bench_variant;

typedef struct vsc_bench_problem {
  const char *name;     // in names of cases
  const char *title;
  const char *scene;    // in the folder --scenes
  const char *shape;    // what `viscera generate` makes; NULL: the mesh is `mesh`
  const char *mesh;     // a file in the folder --reference
  const char *settings[VSC_BENCH_SETTINGS];
  const vsc_bench_variant *variants;  // at least one
  size_t variant_count;
  const vsc_bench_size *sizes;        // from coarse to fine
  size_t size_count;
  const vsc_bench_quantity *quantities;
  size_t quantity_count;
} vsc_bench_problem;

extern const vsc_bench_problem *const vsc_bench_problems[];
extern const size_t vsc_bench_problem_count;

typedef struct vsc_bench_case {
  const vsc_bench_problem *problem;
  const vsc_bench_variant *variant;
  const vsc_bench_kind *kind;
  const vsc_bench_size *size;
  bool coarsest;              // the first size of this kind
  char name[VSC_BENCH_TEXT];  // PROBLEM[-VARIANT]-KIND-SIZE, SIZE counting from 1
} vsc_bench_case;

// Goes to the next case; begin with a zeroed one. False behind the last.
bool vsc_bench_next(vsc_bench_case *at);

#endif
