// SPDX-License-Identifier: GPL-3.0-or-later
// Strain and stress of elements: closed forms, rotation, and the nodes' forces.
#include <gsl/gsl_linalg.h>

#include "base/vec3.h"
#include "kinds_body.h"
#include "mech/prony.h"

static double *read_field(random_body *body, vsc_field field)
{
  double *values = numbers((size_t)vsc_field_components(field) * body->mesh->element_count);
  vsc_read_field(body->model, body->state, field, values);
  return values;
}

// Every element has these numbers.
static void check_field(random_body *body, vsc_field field, const double *expected, double allowed)
{
  const size_t components = (size_t)vsc_field_components(field);
  double *values = read_field(body, field);
  for (size_t i = 0; i < components * body->mesh->element_count; i++)
    assert_close(values[i], expected[i % components], 0, allowed);
  vsc_free(values);
}

// Springs without further axes on a mesh, all fibres along the rows of `frame`.
static void open_aligned(random_body *body, vsc_mesh *mesh, const double frame[9], bool damped)
{
  *body = (random_body){.mesh = mesh, .axes = vsc_axes_create(mesh->element_count)};
  for (size_t t = 0; t < mesh->element_count; t++) {
    memcpy(body->axes->frames + 9 * t, frame, 9 * sizeof *frame);
    body->axes->known[t] = 1;
  }
  body->materials[0] = springs_material(NULL, NULL);
  for (int a = 0; a < 3 && !damped; a++) body->materials[0].damping[a] = 0;
  body->definition = vsc_default_definition();
  body->definition.end_time = 1000;
  body->definition.material_count = 1;
  body->definition.materials = body->materials;
  body_build(body);
}

static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

// U'(J) of K = 60, of the element's or the nodes' volume and, of several frames, of their own with
// Ks = 4; tets alone in elements have K only, those that share volumes K and Ks.
static double volume_stress(double J)
{
  return 0.5 * (60 + 4) * (J - 1 / J);
}

// Stretch along the fibre axes: sigma_aa = lambda_a E_a (lambda_a - 1)/J + U'(J).
static void stretched_springs(void **state)
{
  (void)state;
  static const double axial[3] = {9, 6, 4}, l[3] = {1.3, 0.9, 1.1};
  const double A[9] = {l[0], 0, 0, 0, l[1], 0, 0, 0, l[2]}, J = l[0] * l[1] * l[2];
  double strain[6] = {0}, stress[6] = {0};
  for (int a = 0; a < 3; a++) {
    strain[a] = 0.5 * (l[a] * l[a] - 1);
    stress[a] = l[a] * axial[a] * (l[a] - 1) / J + volume_stress(J);
  }
  for (kinds_mesh kind = ALL_HEXES; kind <= ALL_TETS10; kind++) {
    random_body body;
    open_aligned(&body, mesh_of(kind, 2, 5), identity, false);
    deform(&body, A);
    // rounding of strains through K
    check_field(&body, VSC_FIELD_STRAIN, strain, 1e-14);
    check_field(&body, VSC_FIELD_STRAIN_FIBER, strain, 1e-14);
    check_field(&body, VSC_FIELD_STRESS, stress, 1e-12);
    check_field(&body, VSC_FIELD_STRESS_FIBER, stress, 1e-12);
    const double principal[3] = {stress[0], stress[2], stress[1]};
    assert_true(stress[0] > stress[2] && stress[2] > stress[1]);
    check_field(&body, VSC_FIELD_PRINCIPAL_STRESSES, principal, 1e-12);
    check_field(&body, VSC_FIELD_PRINCIPAL_STRESS_AXIS, identity, 1e-13);
    const double strains[3] = {strain[0], strain[2], strain[1]};
    check_field(&body, VSC_FIELD_PRINCIPAL_STRAINS, strains, 1e-14);
    check_field(&body, VSC_FIELD_PRINCIPAL_STRAIN_AXIS, identity, 1e-13);
    const double a = stress[0] - stress[1], b = stress[1] - stress[2], c = stress[2] - stress[0];
    const double mises = sqrt(0.5 * (a * a + b * b + c * c));
    check_field(&body, VSC_FIELD_VON_MISES, &mises, 1e-12);
    body_close(&body);
  }
}

// Simple shear x += k y: between f and s c = k/sqrt(1 + k^2), and |g_s| = sqrt(1 + k^2) = n.
//   P_f = G c u_s,  P_s = E_s (n - 1) u_s + G c (u_f - c u_s)/n,  sigma = P_f f^T + P_s g_s^T
static void sheared_springs(void **state)
{
  (void)state;
  const double k = 0.6, n = sqrt(1 + k * k), c = k / n, E = 6, G = 3;
  const double A[9] = {1, k, 0, 0, 1, 0, 0, 0, 1}, us[2] = {k / n, 1 / n};
  const double Pf[2] = {G * c * (us[0] - c), G * c * us[1]};
  const double Ps[2] = {E * (n - 1) * us[0] + G * c * (1 - c * us[0]) / n,
                        E * (n - 1) * us[1] - G * c * c * us[1] / n};
  const double stress[6] = {Pf[0] + k * Ps[0], Ps[1], 0, Ps[0], 0, 0};
  const double strain[6] = {0, 0.5 * k * k, 0, 0.5 * k, 0, 0};
  // the xy component may be had from either row
  assert_close(Pf[1] + k * Ps[1], Ps[0], 1e-14, 0);
  random_body body;
  open_aligned(&body, mesh_of(ALL_KINDS, 2, 7), identity, false);
  deform(&body, A);
  check_field(&body, VSC_FIELD_STRAIN, strain, 1e-14);
  check_field(&body, VSC_FIELD_STRESS, stress, 1e-12);
  // the deformed fibre frame is the global one here
  check_field(&body, VSC_FIELD_STRESS_FIBER, stress, 1e-12);
  const double mises = sqrt(0.5 * ((stress[0] - stress[1]) * (stress[0] - stress[1]) +
                                   stress[0] * stress[0] + stress[1] * stress[1]) +
                            3 * stress[3] * stress[3]);
  check_field(&body, VSC_FIELD_VON_MISES, &mises, 1e-12);
  const double middle = 0.5 * (stress[0] + stress[1]);
  const double radius = hypot(0.5 * (stress[0] - stress[1]), stress[3]);
  assert_true(middle - radius < 0);
  const double principal[3] = {middle + radius, 0, middle - radius};
  check_field(&body, VSC_FIELD_PRINCIPAL_STRESSES, principal, 1e-12);
  body_close(&body);
}

// T' = R T R^T of xx yy zz xy yz xz.
static void turn_tensor(const double R[9], const double T[6], double turned[6])
{
  const double full[9] = {T[0], T[3], T[5], T[3], T[1], T[4], T[5], T[4], T[2]};
  for (int i = 0; i < 3; i++)
    for (int m = 0; m < 2; m++) {
      const int j = (i + m) % 3;
      double sum = 0;
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) sum += R[3 * i + a] * full[3 * a + b] * R[3 * j + b];
      turned[i + 3 * m] = sum;
    }
}

// A body turned with its velocities has turned stress, and what is counted in its own axes stays.
static void tensors_turn_with_the_body(void **state)
{
  (void)state;
  random_body body;
  uint64_t seed = 3;
  double R[9];
  random_body_open(&body, 3, VSC_ACTIVE_TENSION, VSC_VOLUME_NODAL, 12);
  const size_t nodes = body.mesh->node_count, elements = body.mesh->element_count;
  double *x = deformed(body.mesh, 0.1, 0.05, 13), *w = random_array(3 * nodes, 1, 14);
  double *both[2] = {x, w};
  body.state->time = 60;
  to_model(body.model, x, body.state->x);
  to_model(body.model, w, body.state->v);
  double *stress = read_field(&body, VSC_FIELD_STRESS);
  double *fiber = read_field(&body, VSC_FIELD_STRESS_FIBER);
  double *strain = read_field(&body, VSC_FIELD_STRAIN);
  random_rotation(&seed, R);
  for (int k = 0; k < 2; k++)
    for (size_t n = 0; n < nodes; n++) {
      double turned[3];
      rotate_vector(R, both[k] + 3 * n, turned);
      memcpy(both[k] + 3 * n, turned, sizeof turned);
    }
  to_model(body.model, x, body.state->x);
  to_model(body.model, w, body.state->v);
  double *other = read_field(&body, VSC_FIELD_STRESS);
  double *other_fiber = read_field(&body, VSC_FIELD_STRESS_FIBER);
  double *other_strain = read_field(&body, VSC_FIELD_STRAIN);
  const double most = largest_of(stress, 6 * elements);
  size_t known = 0;
  for (size_t e = 0; e < elements; e++) {
    double expected[6];
    turn_tensor(R, stress + 6 * e, expected);
    for (int i = 0; i < 6; i++) {
      // rounding of strains of order 1
      assert_close(other[6 * e + i], expected[i], 0, 1e-12 * most);
      assert_close(other_fiber[6 * e + i], fiber[6 * e + i], 0, 1e-12 * most);
      assert_close(other_strain[6 * e + i], strain[6 * e + i], 0, 1e-13);
    }
    // the trace is the same in any axes; where the fibre is not known there is nothing in its axes
    const double trace = body.axes->known[e] ? stress[6 * e] + stress[6 * e + 1] + stress[6 * e + 2] : 0;
    assert_close(fiber[6 * e] + fiber[6 * e + 1] + fiber[6 * e + 2], trace, 0, 1e-12 * most);
    known += body.axes->known[e];
  }
  assert_true(known > 0 && known < elements);
  vsc_free(stress);
  vsc_free(fiber);
  vsc_free(strain);
  vsc_free(other);
  vsc_free(other_fiber);
  vsc_free(other_strain);
  vsc_free(x);
  vsc_free(w);
  body_close(&body);
}

// Deformed volume of each element: its rest volume times the mean of J.
static double *volumes_now(random_body *body)
{
  double *volume = read_field(body, VSC_FIELD_VOLUME_RATIO), *rest;
  rest = numbers(body->mesh->element_count);
  for (size_t p = 0; p < body->model->patch_count; p++) {
    const vsc_patch *patch = &body->model->patches[p];
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      for (int l = 0; l < VSC_WIDTH; l++) {
        const size_t e = body->model->mesh_element[VSC_WIDTH * k + (size_t)l];
        if (e == VSC_NO_ELEMENT) continue;
        for (int q = 0; q < vsc_family_frames(body->model, patch->family); q++)
          rest[e] += vsc_pack_frames(body->model, patch, k)[q].V[l];
      }
  }
  for (size_t e = 0; e < body->mesh->element_count; e++) volume[e] *= rest[e];
  vsc_free(rest);
  return volume;
}

// Power of the stresses in a velocity field v = L x: sum_e v_e sigma_e : L = - f . v, whatever acts.
static void stress_works_as_the_forces_do(random_body *body, const double *x, const double *w,
                                          double time)
{
  const size_t nodes = body->mesh->node_count;
  to_model(body->model, x, body->state->x);
  to_model(body->model, w, body->state->v);
  body->state->time = time;
  double *force = numbers(3 * nodes), *stress = read_field(body, VSC_FIELD_STRESS);
  double *volume = volumes_now(body), size = 0;
  body_force(body, x, w, time, force);
  double moment[3][3] = {{0}}, sum[6] = {0};
  for (size_t n = 0; n < nodes; n++)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) moment[i][j] -= force[3 * n + i] * x[3 * n + j];
  for (size_t e = 0; e < body->mesh->element_count; e++)
    for (int i = 0; i < 6; i++) {
      sum[i] += volume[e] * stress[6 * e + i];
      size += fabs(volume[e] * stress[6 * e + i]);
    }
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3;
    // rounding of sums of some hundred terms
    assert_close(sum[i], moment[i][i], 0, 1e-13 * size);
    assert_close(sum[3 + i], moment[i][j], 0, 1e-13 * size);
    assert_close(sum[3 + i], moment[j][i], 0, 1e-13 * size);
  }
  vsc_free(force);
  vsc_free(stress);
  vsc_free(volume);
}

// Springs with all that they can have, and tissue laws of the full and the isochoric deformation.
static vsc_material_def any_material(int which, vsc_axis_def axes[2], vsc_pair_def pairs[2])
{
  static vsc_prony_def prony[2] = {{0.3, 4}, {0.2, 20}};
  vsc_material_def material = springs_material(axes, pairs);
  material.viscosity = 0.4;
  for (int a = 0; a < 3; a++) material.coupling[a] = 0.5 * a;
  if (which == 0) return material;
  material.axis_count = material.pair_count = 0;
  material.isochoric = which == 2;
  material.prony = prony;
  material.prony_count = which == 1 ? 2 : 0;
  material.law = which < 3 ? VSC_LAW_NEO_HOOKEAN : VSC_LAW_HOLZAPFEL_OGDEN;
  material.shear = 8;
  material.holzapfel_ogden = (vsc_holzapfel_ogden_def){
      .a = 2, .b = 3, .a_f = 4, .b_f = 2, .a_s = 3, .b_s = 1, .a_fs = 2, .b_fs = 2};
  return material;
}
enum { MATERIALS = 4 };

static void stress_is_what_pulls_at_the_nodes(void **state)
{
  (void)state;
  static vsc_axis_def axes[2];
  static vsc_pair_def pairs[2];
  for (int which = 0; which < MATERIALS; which++)
    for (kinds_mesh kind = ALL_HEXES; kind <= ALL_TETS10; kind++)
      for (int alone = 0; alone < 2; alone++) {
        random_body body;
        const vsc_material_def material = any_material(which, axes, pairs);
        kinds_open(&body, mesh_of(kind, 3, 21), &material,
                   alone ? VSC_VOLUME_ELEMENT : VSC_VOLUME_NODAL, 22);
        const size_t count = 3 * body.mesh->node_count;
        double *x = deformed(body.mesh, 0.12, 0.05, 23), *w = random_array(count, 1, 24);
        to_model(body.model, x, body.state->x);
        if (body.state->prony != NULL) vsc_prony_step(body.model, body.state, 3);
        stress_works_as_the_forces_do(&body, x, w, 0);
        vsc_free(x);
        vsc_free(w);
        body_close(&body);
      }
}

// The multipliers of solver.incompressible pull at the nodes too.
static void multipliers_are_in_the_stress(void **state)
{
  (void)state;
  for (kinds_mesh kind = ALL_HEXES; kind <= ALL_TETS10; kind++) {
    random_body body = {.mesh = mesh_of(kind, 3, 25)};
    body.axes = random_axes(body.mesh->element_count, 26);
    body.materials[0] = springs_material(NULL, NULL);
    memset(body.materials[0].damping, 0, sizeof body.materials[0].damping);
    body.definition = vsc_default_definition();
    body.definition.end_time = 1000;
    body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
    body.definition.solve.incompressible = 1e-4;
    body.definition.material_count = 1;
    body.definition.materials = body.materials;
    body_build(&body);
    uint64_t seed = 27;
    vsc_scratch *scratch = &body.state->scratch;
    random_fill(&seed, 20, scratch->node_multiplier, (int)body.model->node_count);
    random_fill(&seed, 20, scratch->pack_multiplier, VSC_WIDTH * (int)body.model->pack_count);
    const size_t count = 3 * body.mesh->node_count;
    double *x = deformed(body.mesh, 0.12, 0.05, 28), *w = random_array(count, 1, 29);
    stress_works_as_the_forces_do(&body, x, w, 0);
    vsc_free(x);
    vsc_free(w);
    body_close(&body);
  }
}

static void activity_is_in_the_stress(void **state)
{
  (void)state;
  static const vsc_active_kind kinds[2] = {VSC_ACTIVE_TENSION, VSC_ACTIVE_SPRING};
  for (int k = 0; k < 2; k++) {
    random_body body;
    vsc_mesh *mesh = random_block(3, 31);
    body_define(&body, mesh, random_axes(mesh->element_count, 32), kinds[k], VSC_VOLUME_NODAL);
    body.definition.pressure_count = 0;
    memset(body.definition.gravity, 0, sizeof body.definition.gravity);
    body_build(&body);
    double *x = deformed(mesh, 0.1, 0.05, 33), *w = random_array(3 * mesh->node_count, 1, 34);
    stress_works_as_the_forces_do(&body, x, w, 70);
    vsc_free(x);
    vsc_free(w);
    body_close(&body);
  }
}

// A block pressed from all sides by p, in balance: sigma = -p 1.
static void pressed_block(void **state)
{
  (void)state;
  const double p = 12;
  double J = 1, l = 1;
  // lambda E (lambda - 1)/J + U'(J) = -p with one E for all axes, by Newton's method in lambda
  for (int k = 0; k < 50; k++) {
    J = l * l * l;
    const double value = 20 * (l - 1) / (l * l) + volume_stress(J) + p;
    const double slope = 20 * (2 - l) / (l * l * l) + 32 * (1 + 1 / (J * J)) * 3 * l * l;
    l -= value / slope;
  }
  random_body body;
  // tets, whose faces are triangles as those of the pressure
  vsc_mesh *mesh = mesh_of(ALL_TETS, 2, 41);
  body = (random_body){.mesh = mesh, .axes = random_axes(mesh->element_count, 42)};
  body.materials[0] = springs_material(NULL, NULL);
  for (int a = 0; a < 3; a++) body.materials[0].axial[a] = 20;
  body.definition = vsc_default_definition();
  body.definition.end_time = 1000;
  body.definition.material_count = 1;
  body.definition.materials = body.materials;
  body.pressure = (vsc_pressure_def){.peak = p, .curve = vsc_default_curve(VSC_CURVE_RAMP)};
  body.pressure.curve.duration = 1;
  vsc_copy_name(body.pressure.surface, "boundary");
  body.definition.pressures = &body.pressure;
  body.definition.pressure_count = 1;
  body_build(&body);
  body.state->time = 10;
  const double A[9] = {l, 0, 0, 0, l, 0, 0, 0, l}, expected[6] = {-p, -p, -p, 0, 0, 0};
  deform(&body, A);
  check_field(&body, VSC_FIELD_STRESS, expected, 1e-12);
  const double none = 0;
  check_field(&body, VSC_FIELD_VON_MISES, &none, 1e-12);
  // and it is in balance: what the closed form says is what the pressure asks for
  double *x = numbers(3 * mesh->node_count), *force = numbers(3 * mesh->node_count);
  to_mesh(body.model, body.state->x, x);
  body_force(&body, x, NULL, 10, force);
  assert_true(largest_of(force, 3 * mesh->node_count) < 1e-12 * p);
  vsc_free(x);
  vsc_free(force);
  body_close(&body);
}

// Axial damping eta along each axis of an undeformed block: sigma_aa = eta_a L_aa.
static void damping_is_in_the_stress(void **state)
{
  (void)state;
  random_body body;
  open_aligned(&body, mesh_of(ALL_KINDS, 2, 51), identity, true);
  const double L[3] = {0.5, -0.2, 0.1};
  for (size_t n = 0; n < body.model->node_count; n++)
    for (int i = 0; i < 3; i++) body.state->v[4 * n + i] = L[i] * body.state->x[4 * n + i];
  const double expected[6] = {0.3 * L[0], 0.2 * L[1], 0.1 * L[2], 0, 0, 0};
  check_field(&body, VSC_FIELD_STRESS, expected, 1e-13);
  body_close(&body);
}

static void stress_needs_a_law_of_strain(void **state)
{
  (void)state;
  const vsc_material_def materials[2] = {paper_material(), classical_material()};
  static const char *const words[2] = {"paper", "classical"};
  for (int k = 0; k < 2; k++) {
    random_body body;
    vsc_error error;
    kinds_open(&body, mesh_of(ALL_TETS, 2, 71), &materials[k], VSC_VOLUME_NODAL, 72);
    assert_int_equal(vsc_field_check(body.model, VSC_FIELD_VON_MISES, &error), VSC_INPUT);
    assert_non_null(strstr(error.text, words[k]));
    assert_int_equal(vsc_field_check(body.model, VSC_FIELD_STRAIN, &error), VSC_OK);
    assert_int_equal(vsc_field_check(body.model, VSC_FIELD_HELIX_ANGLE, &error), VSC_OK);
    const double none[6] = {0};
    const double A[9] = {1.2, 0, 0, 0, 1, 0, 0, 0, 1}, strain[6] = {0.22};
    deform(&body, A);
    check_field(&body, VSC_FIELD_STRESS, none, 0);
    check_field(&body, VSC_FIELD_STRAIN, strain, 1e-14);
    body_close(&body);
  }
}

// The same bits on any number of threads.
static void threads_change_nothing(void **state)
{
  (void)state;
  double *stress[2];
  size_t bytes = 0;
  for (int k = 0; k < 2; k++) {
    random_body body;
    vsc_parallel_set_threads(k == 0 ? 1 : 4);
    random_body_open(&body, 5, VSC_ACTIVE_TENSION, VSC_VOLUME_NODAL, 82);
    double *x = deformed(body.mesh, 0.1, 0.05, 83);
    to_model(body.model, x, body.state->x);
    body.state->time = 60;
    stress[k] = read_field(&body, VSC_FIELD_PRINCIPAL_STRESSES);
    bytes = 3 * body.mesh->element_count * sizeof(double);
    vsc_free(x);
    body_close(&body);
  }
  vsc_parallel_set_threads(0);
  assert_memory_equal(stress[0], stress[1], bytes);
  vsc_free(stress[0]);
  vsc_free(stress[1]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stretched_springs),
      cmocka_unit_test(sheared_springs),
      cmocka_unit_test(tensors_turn_with_the_body),
      cmocka_unit_test(stress_is_what_pulls_at_the_nodes),
      cmocka_unit_test(multipliers_are_in_the_stress),
      cmocka_unit_test(activity_is_in_the_stress),
      cmocka_unit_test(pressed_block),
      cmocka_unit_test(damping_is_in_the_stress),
      cmocka_unit_test(stress_needs_a_law_of_strain),
      cmocka_unit_test(threads_change_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
