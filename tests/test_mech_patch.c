// SPDX-License-Identifier: GPL-3.0-or-later
// Patch test on an irregular mesh, and the modulus of a block against the closed form of the
// springs law:
//
//   S_ab = delta_ab/E_a - K/(1 + K s) / (E_a E_b),  s = 1/E_f + 1/E_s + 1/E_n,
//   1/Y(d) = sum_ab S_ab d_a^2 d_b^2 + sum_{a<b} d_a^2 d_b^2 / G_ab     (d: direction cosines to f,
//   s, n)
#include "base/vec3.h"
#include "close.h"
#include "mech/step_limit.h"
#include "random_body.h"

static const vsc_volume_kind volumes[] = {VSC_VOLUME_NODAL, VSC_VOLUME_ELEMENT};

// A jittered block of n^3 bricks of one passive tissue with the same frame in all tets.
static void open_uniform(random_body *body, size_t n, const double frame[9],
                         const vsc_material_def *material, vsc_volume_kind volume)
{
  vsc_mesh *mesh = random_block(n, 300 + n);
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  for (size_t t = 0; t < mesh->element_count; t++) {
    memcpy(axes->frames + 9 * t, frame, 9 * sizeof *frame);
    axes->known[t] = 1;
  }
  body_define(body, mesh, axes, VSC_ACTIVE_NONE, volume);
  body->materials[0] = *material;
  body->definition.material_count = 1;
  body->definition.pressure_count = 0;
  memset(body->definition.gravity, 0, sizeof body->definition.gravity);
  body_build(body);
}

static vsc_material_def tissue(const double axial[3], const double angular[3], double K)
{
  vsc_material_def material = vsc_default_material();
  memcpy(material.axial, axial, sizeof material.axial);
  memcpy(material.angular, angular, sizeof material.angular);
  material.volume_modulus = K;
  vsc_copy_name(material.name, "tissue");
  return material;
}

static bool is_inside(const vsc_mesh *mesh, size_t node)
{
  static const char *const faces[] = {"x0", "x1", "y0", "y1", "z0", "z1"};
  for (int f = 0; f < 6; f++)
    if (vsc_arrays_find(&mesh->node_data, faces[f])->values[node] != 0) return false;
  return true;
}

// Relaxes the free directions (`free`, nodes x 3, mesh order: 1 or 0): x and v as a heavy ball,
// v <- keep v + dt^2 f/m, x <- x + v, until the largest free force is `enough`. Returns that force.
static double relax(random_body *body, const double *free, double *x, double keep, double enough)
{
  const vsc_model *model = body->model;
  const size_t count = 3 * model->node_count;
  double *v = numbers(count), *force = numbers(count), *scale = numbers(count), most = 0;
  to_model(model, x, body->state->x);
  vsc_limit_refresh(model, body->state, 0, 60);
  for (size_t n = 0; n < model->node_count; n++)
    for (size_t i = 0; i < 3; i++) {
      const size_t place = 3 * (size_t)model->mesh_node[n] + i;
      scale[place] =
          free[place] * body->state->limit.step * body->state->limit.step / model->mass[n];
    }
  for (int k = 0; k < 4000; k++) {
    body_force(body, x, NULL, 0, force);
    most = 0;
    for (size_t i = 0; i < count; i++) {
      most = fmax(most, fabs(free[i] * force[i]));
      v[i] = keep * v[i] + scale[i] * force[i];
      x[i] += v[i];
    }
    if (most <= enough) break;
  }
  vsc_free(v);
  vsc_free(force);
  vsc_free(scale);
  return most;
}

static const double anisotropic[3] = {9, 6, 4}, shear[3] = {3, 2, 5};

// Affine positions x = F X everywhere: no force inside, whatever the sizes of the tets; then the
// inner nodes are moved away and find back.
static void affine_positions_are_in_balance(void **state)
{
  (void)state;
  uint64_t seed = 310;
  for (int round = 0; round < 6; round++) {
    random_body body;
    double frame[9];
    vsc_material_def material = tissue(anisotropic, shear, 40);
    material.stabilization = 3;
    random_rotation(&seed, frame);
    open_uniform(&body, 4, frame, &material, volumes[round % 2]);
    const size_t nodes = body.mesh->node_count;
    double *x = deformed(body.mesh, 0.25, 0, 311 + (uint64_t)round), *affine = numbers(3 * nodes);
    double *force = numbers(3 * nodes), *free = numbers(3 * nodes);
    memcpy(affine, x, 3 * nodes * sizeof *x);
    body_force(&body, x, NULL, 0, force);
    const double size = largest_of(force, 3 * nodes);
    assert_true(size > 0.1);
    for (size_t n = 0; n < nodes; n++) {
      if (!is_inside(body.mesh, n)) continue;
      for (size_t i = 3 * n; i < 3 * n + 3; i++) {
        assert_close(force[i], 0, 0, 1e-13 * size);
        free[i] = 1;
        x[i] += random_between(&seed, -0.08, 0.08);
      }
    }
    // forces of 1e-13 on springs of some kPa mm: positions to some 1e-14 mm
    relax(&body, free, x, 0.85, 2e-13);
    for (size_t i = 0; i < 3 * nodes; i++) assert_close(x[i], affine[i], 0, 1e-13);
    vsc_free(x);
    vsc_free(affine);
    vsc_free(force);
    vsc_free(free);
    body_close(&body);
  }
}

static double closed_form(const vsc_material_def *m, const double d[3])
{
  const double s = 1 / m->axial[0] + 1 / m->axial[1] + 1 / m->axial[2], K = m->volume_modulus;
  double compliance = 0;
  for (int a = 0; a < 3; a++) {
    for (int b = 0; b < 3; b++)
      compliance +=
          d[a] * d[a] * d[b] * d[b] *
          ((a == b ? 1 / m->axial[a] : 0) - K / (1 + K * s) / (m->axial[a] * m->axial[b]));
    const int next = (a + 1) % 3;
    compliance += d[a] * d[a] * d[next] * d[next] / m->angular[a];
  }
  return 1 / compliance;
}

// A frame whose axes have the direction cosines d to the x axis: first column d.
static void frame_at(const double d[3], double frame[9])
{
  const double hint[3] = {0.1, -0.3, 1};
  double columns[9];
  vsc_axes_complete(d, hint, columns);
  for (int a = 0; a < 3; a++)
    for (int i = 0; i < 3; i++) frame[3 * a + i] = columns[3 * i + a];
}

// The ends x = 0 and x = L slide in their planes, pulled apart by `strain` L; force on the end over
// its area and the strain. Such a state is homogeneous also where stretch and shear are coupled,
// because the ends do not hinder shear along them.
static double measured(random_body *body, double strain)
{
  const vsc_mesh *mesh = body->mesh;
  const size_t nodes = mesh->node_count;
  const double *first = vsc_arrays_find(&mesh->node_data, "x0")->values;
  const double *last = vsc_arrays_find(&mesh->node_data, "x1")->values;
  double *x = numbers(3 * nodes), *free = numbers(3 * nodes), *force = numbers(3 * nodes);
  for (size_t n = 0; n < nodes; n++) {
    memcpy(x + 3 * n, mesh->nodes + 3 * n, 3 * sizeof *x);
    x[3 * n] *= 1 + strain;
    free[3 * n] = first[n] == 0 && last[n] == 0;
    free[3 * n + 1] = free[3 * n + 2] = 1;
  }
  // a node of the end carries some 10 kPa . strain . 1 mm^2
  assert_true(relax(body, free, x, 0.96, 1e-6 * strain) <= 1e-6 * strain);
  body_force(body, x, NULL, 0, force);
  double pull = 0, area = 1;
  for (size_t n = 0; n < nodes; n++)
    if (last[n] != 0) {
      pull -= force[3 * n];
      area = mesh->nodes[3 * n] * mesh->nodes[3 * n];  // a cube
    }
  vsc_free(x);
  vsc_free(free);
  vsc_free(force);
  return pull / area / strain;
}

// On axis, 22.5 and 45 degrees in the fs plane, along (1,1,1); blocks of 2^3, 4^3 and 8^3 bricks.
// Strain 1e-6: the law's curvature changes the modulus by as much; the relaxation stops at 1e-6.
static void check_modulus(const vsc_material_def *material, const double *expected)
{
  const double c = cos(acos(-1) / 8), s = sin(acos(-1) / 8), r = sqrt(0.5), q = 1 / sqrt(3);
  const double directions[4][3] = {{1, 0, 0}, {c, s, 0}, {r, r, 0}, {q, q, q}};
  for (int d = 0; d < 4; d++) {
    double frame[9];
    frame_at(directions[d], frame);
    const double modulus = closed_form(material, directions[d]);
    if (expected) assert_close(modulus, expected[d], 1e-14, 0);
    for (size_t n = 2; n <= 8; n *= 2) {
      random_body body;
      open_uniform(&body, n, frame, material, volumes[n == 4]);
      assert_close(measured(&body, 1e-6), modulus, 1e-5, 0);
      body_close(&body);
    }
  }
}

// E_a = 20, G = 10, K = 20: isotropic, mu = 10, lambda = 20: Y = mu (3 lambda + 2 mu)/(lambda + mu)
// = 80/3.
static void an_isotropic_block_has_its_young_modulus(void **state)
{
  (void)state;
  const double axial[3] = {20, 20, 20}, angular[3] = {10, 10, 10};
  const double expected[4] = {80. / 3, 80. / 3, 80. / 3, 80. / 3};
  const vsc_material_def material = tissue(axial, angular, 20);
  check_modulus(&material, expected);
}

// With G = E = 20 = K the moduli differ: in units of E, S_aa = 3/4, S_ab = -1/4, so that
// 1/Y = 3/4; c^4, s^4 and 2 c^2 s^2 = 1/4 at 22.5 degrees: 3/4 . 3/4 + 1/4 (-1/4) + 1/8 = 5/8;
// 3/8 - 1/8 + 1/4 = 1/2; (9/4 - 6/4)/9 + 1/3 = 5/12.
static void a_cubic_block_has_its_young_modulus(void **state)
{
  (void)state;
  const double axial[3] = {20, 20, 20}, angular[3] = {20, 20, 20};
  const double expected[4] = {80. / 3, 32, 40, 48};
  const vsc_material_def material = tissue(axial, angular, 20);
  check_modulus(&material, expected);
}

static void an_orthotropic_block_has_its_young_modulus(void **state)
{
  (void)state;
  const vsc_material_def material = tissue(anisotropic, shear, 12);
  check_modulus(&material, NULL);
}

int main(void)
{
  vsc_parallel_set_threads(1);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(affine_positions_are_in_balance),
      cmocka_unit_test(an_isotropic_block_has_its_young_modulus),
      cmocka_unit_test(a_cubic_block_has_its_young_modulus),
      cmocka_unit_test(an_orthotropic_block_has_its_young_modulus),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
