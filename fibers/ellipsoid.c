// SPDX-License-Identifier: GPL-3.0-or-later
#include "fibers/ellipsoid.h"

#include <math.h>
#include <stdbool.h>

#include "base/vec3.h"
#include "fibers/helix.h"

#define OFF 0.1  // of the wall: what lies as far from both ellipsoids is off them

enum { HALVINGS = 60 };  // of an interval of 4: to rounding

static double radius(const vsc_ellipsoid_def *wall, double t)
{
  return (1 - t) * wall->endo_radius + t * wall->epi_radius;
}

static double half_length(const vsc_ellipsoid_def *wall, double t)
{
  return (1 - t) * wall->endo_length + t * wall->epi_length;
}

// A point's distance z along the axis (made a unit vector) from the centre, and the vector from the axis.
static double split(const vsc_ellipsoid_def *wall, double axis[3], const double point[3],
                    double across[3])
{
  vsc_normalize(axis);
  vsc_subtract(point, wall->centre, across);
  const double z = vsc_dot(across, axis);
  for (int a = 0; a < 3; a++) across[a] -= z * axis[a];
  return z;
}

double vsc_ellipsoid_depth(const vsc_ellipsoid_def *wall, const double long_axis[3],
                           const double point[3])
{
  double across[3], axis[3] = {long_axis[0], long_axis[1], long_axis[2]};
  const double z = split(wall, axis, point, across), square = vsc_dot(across, across);
  double low = -1, high = 3;
  for (int i = 0; i < HALVINGS; i++) {
    const double t = (low + high) / 2, rs = radius(wall, t), rl = half_length(wall, t);
    const bool outside = rs <= 0 || rl <= 0 || square / (rs * rs) + z * z / (rl * rl) > 1;
    if (outside)
      low = t;
    else
      high = t;
  }
  return (low + high) / 2;
}

void vsc_ellipsoid_normal(const vsc_ellipsoid_def *wall, const double long_axis[3],
                          const double point[3], double t, double outwards[3])
{
  double across[3], axis[3] = {long_axis[0], long_axis[1], long_axis[2]};
  const double z = split(wall, axis, point, across);
  const double rs = radius(wall, t), rl = half_length(wall, t);
  for (int a = 0; a < 3; a++) outwards[a] = across[a] / (rs * rs) + z * axis[a] / (rl * rl);
}

int vsc_ellipsoid_frame_at(const vsc_fiber_def *definition, const double point[3], double t,
                           double frame[9])
{
  double outwards[3];
  vsc_ellipsoid_normal(&definition->ellipsoid, definition->long_axis, point, t, outwards);
  const double angle = (1 - t) * definition->endo_angle + t * definition->epi_angle;
  if (!vsc_helix_frame(outwards, definition->long_axis, angle, frame)) return 0;
  for (int a = 3; a < 6 && !definition->sheets_across; a++) {
    const double e_t = frame[a];
    frame[a] = frame[3 + a];
    frame[3 + a] = -e_t;
  }
  return 1;
}

int vsc_ellipsoid_frame(const vsc_fiber_def *definition, const double point[3], double frame[9])
{
  const double t = vsc_ellipsoid_depth(&definition->ellipsoid, definition->long_axis, point);
  return vsc_ellipsoid_frame_at(definition, point, fmin(fmax(t, 0), 1), frame);
}

void vsc_ellipsoid_judge(const vsc_fiber_def *definition, const vsc_mesh *mesh, const vsc_surface *surface, size_t *faces,
                         size_t *off)
{
  const vsc_ellipsoid_def *wall = &definition->ellipsoid;
  for (size_t k = 0; k < surface->count; k++) {
    double edge[2][3], normal[3], outwards[3], t = 0;
    const double *corner[3];
    bool far = true;
    for (int i = 0; i < 3; i++) {
      corner[i] = &mesh->nodes[3 * (size_t)surface->triangles[3 * k + (size_t)i]];
      t = vsc_ellipsoid_depth(wall, definition->long_axis, corner[i]);
      far = far && fmin(fabs(t), fabs(1 - t)) > OFF;
    }
    for (int i = 0; i < 2; i++) vsc_subtract(corner[i], corner[2], edge[i]);
    vsc_cross(edge[0], edge[1], normal);
    vsc_ellipsoid_normal(wall, definition->long_axis, corner[2], t, outwards);
    if (!(fabs(vsc_dot(normal, outwards)) > 0.5 * vsc_norm(normal) * vsc_norm(outwards))) continue;
    ++*faces;
    *off += far;
  }
}

vsc_status vsc_ellipsoid_check(const vsc_fiber_def *definition, vsc_error *error)
{
  const vsc_ellipsoid_def *wall = &definition->ellipsoid;
  const double axis = vsc_norm(definition->long_axis), place = vsc_norm(wall->centre);
  if (!(wall->endo_radius > 0 && wall->endo_length > 0 && wall->epi_radius > wall->endo_radius &&
        wall->epi_length > wall->endo_length && isfinite(wall->epi_radius) &&
        isfinite(wall->epi_length)))
    return vsc_fail(error, VSC_INPUT,
                    "ellipsoid fibres: endo_radius %g and endo_length %g mm must be above 0 and below "
                    "epi_radius and epi_length, %g and %g mm",
                    wall->endo_radius, wall->endo_length, wall->epi_radius, wall->epi_length);
  if (!(isfinite(axis) && axis > 0 && isfinite(place)))
    return vsc_fail(error, VSC_INPUT,
                    "ellipsoid fibres: long_axis (%g, %g, %g) must not be zero, centre finite",
                    definition->long_axis[0], definition->long_axis[1], definition->long_axis[2]);
  if (!isfinite(definition->endo_angle) || !isfinite(definition->epi_angle))
    return vsc_fail(error, VSC_INPUT, "ellipsoid fibres: the angles %g and %g must be finite",
                    definition->endo_angle, definition->epi_angle);
  return VSC_OK;
}
