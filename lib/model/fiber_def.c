// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/fiber_def.h"

#include <math.h>

static const double degree = M_PI / 180;

const char *vsc_fiber_source_name(vsc_fiber_source source)
{
  static const char *const names[] = {"none",       "map",          "arrays",     "constant", "helix",    "horizontal",
                                      "diagonal",   "hemicircular", "helicoidal", "random",   "ellipsoid"};
  return (size_t)source < sizeof names / sizeof names[0] ? names[source] : "unknown";
}

vsc_vessel_def vsc_default_vessel(void)
{
  return (vsc_vessel_def){.unit = 1, .threshold = 0.05};
}

vsc_fiber_def vsc_default_fiber(void)
{
  vsc_fiber_def fiber = {
      .source = VSC_FIBER_NONE,
      .map = {.scale = degree,
              .azimuth_sense = 1,
              .elevation_sense = 1,
              .image_axes = true,
              .length_unit = 1},
      .endo_angle = 60 * degree,
      .epi_angle = -60 * degree,
      .long_axis = {0, 0, 1},
      .pitch = 30 * degree,
      .sheets_across = 1,
      .seed = 1,
  };
  vsc_copy_name(fiber.map.azimuth, "azimuth");
  vsc_copy_name(fiber.map.elevation, "elevation");
  vsc_copy_name(fiber.fiber_array, "fiber");
  vsc_copy_name(fiber.sheet_array, "sheet");
  return fiber;
}

bool vsc_fiber_needs_surfaces(const vsc_fiber_def *fiber)
{
  return fiber->source == VSC_FIBER_HELIX || (fiber->source == VSC_FIBER_ELLIPSOID && fiber->endo[0] != '\0');
}
