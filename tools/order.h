// SPDX-License-Identifier: GPL-3.0-or-later
// How fast results approach their limit as meshes or steps become finer.
#ifndef VSC_TOOLS_ORDER_H
#define VSC_TOOLS_ORDER_H

#include <stddef.h>

typedef enum vsc_trend {
  VSC_TREND_CONVERGES,   // the differences shrink, all with one sign
  VSC_TREND_OSCILLATES,  // they change their sign
  VSC_TREND_DIVERGES,    // they do not shrink with the size
  VSC_TREND_STANDS,      // the last two results are equal
} vsc_trend;

typedef struct vsc_order {
  vsc_trend trend;
  double order;        // p; NAN unless VSC_TREND_CONVERGES, like what follows
  double limit;        // F, Richardson's extrapolation
  double uncertainty;  // of the finest result: the grid convergence index in the unit of f
} vsc_order;

// The order of three results f at sizes h[0] > h[1] > h[2] > 0, of f(h) = F + C h^p: p solves
//   (f_0 - f_1)/(f_1 - f_2) = (h_0^p - h_1^p)/(h_1^p - h_2^p),
// whose right side rises with p, from ln(h_0/h_1)/ln(h_1/h_2) at p = 0; p up to 40 is looked for. With it
// F = f_2 + (f_2 - f_1)/((h_1/h_2)^p - 1) and the uncertainty 1.25 |F - f_2| (Roache 1994; Celik et al.
// 2008).
vsc_order vsc_order_of(const double h[3], const double f[3]);

// The slope of ln e over ln h by least squares of `count` errors, leaving out those that are 0 or not
// finite; NAN when fewer than two are left.
double vsc_order_slope(size_t count, const double *h, const double *e);

// "converges", "oscillates", ... with what that means for the user.
const char *vsc_trend_text(vsc_trend trend);

#endif
