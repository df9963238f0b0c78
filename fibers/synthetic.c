// SPDX-License-Identifier: GPL-3.0-or-later
#include "fibers/synthetic.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/ellipsoid.h"

static void constant(const vsc_fiber_def *definition, double f[3], double hint[3])
{
  for (int a = 0; a < 3; a++) {
    f[a] = definition->direction[a];
    hint[a] = definition->sheet_direction[a];
  }
}

static void hemicircular(const double low[3], const double high[3], const double at[3], double f[3],
                         double hint[3])
{
  hint[0] = at[0] - (low[0] + high[0]) / 2;
  hint[2] = at[2] - low[2];
  f[0] = hint[2];
  f[2] = -hint[0];
  if (f[0] == 0 && f[2] == 0) f[0] = 1;
}

static void helicoidal(const double low[3], const double high[3], const double at[3], double pitch,
                       double f[3], double hint[3])
{
  for (int a = 0; a < 2; a++) hint[a] = at[a] - (low[a] + high[a]) / 2;
  const double r = vsc_norm(hint);
  f[2] = 1;
  if (r == 0) return;
  f[0] = -cos(pitch) * hint[1] / r;
  f[1] = cos(pitch) * hint[0] / r;
  f[2] = sin(pitch);
}

static void between_ellipsoids(const vsc_fiber_def *definition, const double at[3], double f[3],
                               double hint[3])
{
  double frame[9];
  if (!vsc_ellipsoid_frame(definition, at, frame)) return;
  for (int a = 0; a < 3; a++) {
    f[a] = frame[a];
    hint[a] = frame[3 + a];
  }
}

// Fibre and hint at a place.
static void formula(const vsc_fiber_def *definition, const double low[3], const double high[3],
                    const double at[3], double f[3], double hint[3])
{
  for (int a = 0; a < 3; a++) f[a] = hint[a] = 0;
  switch (definition->source) {
    case VSC_FIBER_CONSTANT: constant(definition, f, hint); break;
    case VSC_FIBER_HORIZONTAL: f[0] = 1; break;
    case VSC_FIBER_DIAGONAL: f[0] = f[2] = 1; break;
    case VSC_FIBER_HEMICIRCULAR: hemicircular(low, high, at, f, hint); break;
    case VSC_FIBER_ELLIPSOID: between_ellipsoids(definition, at, f, hint); break;
    default: helicoidal(low, high, at, definition->pitch, f, hint);
  }
}

static vsc_status check(const vsc_fiber_def *definition, vsc_error *error)
{
  const double *d = definition->direction;
  const vsc_fiber_source source = definition->source;
  if (source != VSC_FIBER_CONSTANT &&
      (source < VSC_FIBER_HORIZONTAL || source > VSC_FIBER_ELLIPSOID))
    return vsc_fail(error, VSC_INPUT, "fibers.source: %s is not a formula; take constant, horizontal, diagonal, "
                    "hemicircular, helicoidal, random or ellipsoid, or vsc_fibers_make", vsc_fiber_source_name(source));
  if (source == VSC_FIBER_ELLIPSOID) return vsc_ellipsoid_check(definition, error);
  const double length = vsc_norm(d);
  if (definition->source == VSC_FIBER_CONSTANT && !(isfinite(length) && length >= 1e-6))
    return vsc_fail(error, VSC_INPUT,
                    "constant fibres: direction (%g, %g, %g) must be finite and not zero", d[0],
                    d[1], d[2]);
  if (definition->source == VSC_FIBER_HELICOIDAL && !isfinite(definition->pitch))
    return vsc_fail(error, VSC_INPUT, "helicoidal fibres: pitch %g must be finite",
                    definition->pitch);
  return VSC_OK;
}

vsc_status vsc_fibers_synthetic(const vsc_mesh *mesh, const vsc_fiber_def *definition,
                                vsc_axes *axes, vsc_error *error)
{
  const vsc_status status = check(definition, error);
  if (status != VSC_OK) return status;
  gsl_rng *random = NULL;
  if (definition->source == VSC_FIBER_RANDOM) {
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    random = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_set_error_handler(handler);
    if (random == NULL) return vsc_fail_memory(error, "the random fibres");
    gsl_rng_set(random, definition->seed);
  }
  double low[3], high[3], f[3], hint[3];
  vsc_mesh_box(mesh, low, high);
  const vsc_cell_rule rule = vsc_cell_rule_of(VSC_TET10);  // read where there are several points
  for (size_t e = 0; e < mesh->element_count; e++) {
    int known = 1;
    if (random != NULL) gsl_ran_dir_3d(random, &f[0], &f[1], &f[2]);
    for (int q = 0; q < axes->points; q++) {
      double at[3];
      vsc_axes_place(axes, mesh, &rule, e, q, at);
      if (random == NULL) formula(definition, low, high, at, f, hint);
      known &= vsc_axes_complete(f, random == NULL ? hint : NULL, vsc_axes_frame(axes, e, q));
    }
    vsc_axes_finish(axes, e, known);
  }
  if (random != NULL) gsl_rng_free(random);
  return VSC_OK;
}
