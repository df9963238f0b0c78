// SPDX-License-Identifier: GPL-3.0-or-later
// A series of runs from coarse to fine: observed orders of convergence, Richardson extrapolation.
#ifndef VSC_TOOLS_COMPARE_ORDER_H
#define VSC_TOOLS_COMPARE_ORDER_H

#include <stddef.h>

#include "base/text.h"

enum { VSC_MOST_RUNS = 16, VSC_MOST_WANTED = 64 };

typedef struct vsc_order_wish {
  size_t run_count;
  const char *runs[VSC_MOST_RUNS];  // folders that `viscera run` made, from coarse to fine
  size_t size_count;                // 0, or run_count
  double sizes[VSC_MOST_RUNS];      // of meshes or steps, any unit; none: (volume/elements)^(1/3) of their
                                    // meshes, or their steps where the meshes are all the same
  size_t signal_count;
  char signals[VSC_MOST_WANTED][VSC_NAME];  // columns of signals.csv; none: cavities and points
  double exact;                             // what the one signal should be; NAN: not known
  double reach;                             // as of vsc_pair
} vsc_order_wish;

// What `viscera compare --order` does: for each signal the last row of each run, the order by
// vsc_order_of of each three runs that follow one another, the extrapolated value and the uncertainty, and
// the slope of the errors where the exact value is known;
// then for each array of the last frames the RMS by volume of the runs' differences from the
// finest, and their slope over the sizes (vsc_order_slope). Returns the exit code.
int vsc_compare_order(const vsc_order_wish *wish);

#endif
