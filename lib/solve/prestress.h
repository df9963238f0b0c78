// SPDX-License-Identifier: GPL-3.0-or-later
// The unloaded shape of a body whose loaded shape is known: medical images show organs under pressure. By
// the inverse fixed-point iteration (Sellier 2011, J. Fluids Struct. 27, 1461): with x(X) where a body of
// the rest shape X is found under its loads,
//   X <- X + r (target - x(X)),
// r = 1 at first; where that does not bring x nearer to the target, or x(X) is not found, the step is
// taken back and done again with half of r.
#ifndef VSC_SOLVE_PRESTRESS_H
#define VSC_SOLVE_PRESTRESS_H

#include <stddef.h>

#include "base/status.h"

// How far one iteration's loaded shape is off.
typedef struct vsc_prestress_row {
  int iteration;      // from 0; 0 is the target itself taken for the rest shape
  double relaxation;  // r of the step behind it
  double largest;     // |target - x| of the worst node, mm
  double mean;        // root of the mean square of all nodes, mm
} vsc_prestress_row;

// What is asked for; four numbers a node (x, y, z, 0), mm.
typedef struct vsc_prestress {
  size_t node_count;
  const double *target;  // node_count x 4: the loaded shape
  double tolerance;      // of `largest`, mm
  int most;              // iterations
  void *context;         // for the two functions
  // Fills x (node_count x 4) with the loaded shape of the rest shape `rest`; VSC_NUMERICAL when there is
  // none, other failures end the iteration.
  vsc_status (*load)(void *context, const double *rest, double *x, vsc_error *error);
  // Sees each iteration; may be NULL.
  void (*watch)(void *context, const vsc_prestress_row *row);
} vsc_prestress;

// Fills rest (node_count x 4) with the shape that `problem` asks for, and x (likewise; may be NULL) with its loaded
// shape. VSC_NUMERICAL, with how far it is off, when it does not come within the tolerance, or with the reason
// where the target itself bears no loads; VSC_SYSTEM when memory is short; and what `load` fails with.
vsc_status vsc_prestress_find(const vsc_prestress *problem, double *rest, double *x, vsc_error *error);

#endif
