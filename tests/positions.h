// SPDX-License-Identifier: GPL-3.0-or-later
// Where a body's nodes are, kept to compare with: for tests. The caller frees it.
#ifndef VSC_TESTS_POSITIONS_H
#define VSC_TESTS_POSITIONS_H

#include <stdlib.h>

#include "small_body.h"

static inline double *positions(const small_body *body)
{
  const size_t bytes = 4 * body->model->node_count * sizeof(double);
  double *x = malloc(bytes);
  memcpy(x, body->state->x, bytes);
  return x;
}

// The largest difference of a coordinate.
static inline double distance(const small_body *body, const double *x)
{
  double most = 0;
  for (size_t i = 0; i < 4 * body->model->node_count; i++) most = fmax(most, fabs(body->state->x[i] - x[i]));
  return most;
}

#endif
