// SPDX-License-Identifier: GPL-3.0-or-later
// Fields of elements beside strain and stress (test_mech_tensors.c).
#include "base/vec3.h"
#include "kinds_body.h"

// A fibre at 30 degrees above the circumference on a cylinder round a line that is not an axis of the
// coordinates; the body stretched along the line by s and turned: atan(s tan 30).
static void helix_angles(void **state)
{
  (void)state;
  uint64_t seed = 61;
  double R[9], turned[9];
  const double s = 1.4, angle = M_PI / 6, centre[3] = {4, -3, 0.5};
  random_rotation(&seed, R);
  vsc_mesh *mesh = mesh_of(ALL_KINDS, 3, 62);
  random_body body = {.mesh = mesh, .axes = vsc_axes_create(mesh->element_count)};
  for (size_t e = 0; e < mesh->element_count; e++) {
    double at[3] = {0};
    const uint32_t *corner = vsc_mesh_corners(mesh, e);
    const int corners = vsc_mesh_kind(mesh, e)->corners;
    for (int c = 0; c < corners; c++)
      for (int i = 0; i < 3; i++) at[i] += mesh->nodes[3 * (size_t)corner[c] + (size_t)i] / corners;
    const double x = at[0] - centre[0], y = at[1] - centre[1], r = hypot(x, y);
    // every other fibre points the other way: an axis has no direction
    const double sign = e % 2 ? -1 : 1;
    const double fiber[3] = {-sign * cos(angle) * y / r, sign * cos(angle) * x / r, sign * sin(angle)};
    vsc_axes_set(body.axes, e, fiber, NULL);
  }
  body.materials[0] = springs_material(NULL, NULL);
  body.definition = vsc_default_definition();
  body.definition.end_time = 1000;
  body.definition.material_count = 1;
  body.definition.materials = body.materials;
  body_build(&body);
  const double stretched[9] = {1, 0, 0, 0, 1, 0, 0, 0, s};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) turned[3 * i + j] = R[3 * i + j] * stretched[4 * j];
  deform(&body, turned);
  double *values = numbers(mesh->element_count), there[3];
  const double axis[3] = {3 * R[2], 3 * R[5], 3 * R[8]};
  rotate_vector(turned, centre, there);
  vsc_read_helix_angle(body.model, body.state, there, axis, values);
  for (size_t e = 0; e < mesh->element_count; e++)
    // rounding of an angle in degrees
    assert_close(values[e], 180 / M_PI * atan(s * tan(angle)), 0, 1e-11);
  vsc_free(values);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(helix_angles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
