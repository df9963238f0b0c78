// SPDX-License-Identifier: GPL-3.0-or-later
// Which term pulls most at a node: against forces that are known.
#include "mech/culprit.h"

#include "base/mem.h"
#include "mech/force.h"
#include "mech/loads.h"
#include "sheet_body.h"
#include "trap.h"

static vsc_culprit culprit_at(const small_body *body, size_t node, bool moving)
{
  const vsc_state *state = body->state;
  return vsc_find_culprit(body->model, state->x, moving ? state->v : NULL, state->time, &body->state->scratch, node);
}

// Moves all nodes to `stretch` times where they are at rest, along each axis.
static void stretch(const small_body *body, double x, double y, double z)
{
  const double by[3] = {x, y, z};
  for (size_t n = 0; n < body->model->node_count; n++)
    for (size_t i = 0; i < 3; i++) body->state->x[4 * n + i] = by[i] * body->model->rest[4 * n + i];
}

static double force_on(const small_body *body, size_t node, bool moving)
{
  const vsc_state *state = body->state;
  vsc_force(body->model, state->x, moving ? state->v : NULL, state->time, &body->state->scratch, state->force);
  const double *f = state->force + 4 * node;
  return sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
}

static void assert_culprit(const small_body *body, size_t node, bool moving, const char *term, double force)
{
  const vsc_culprit culprit = culprit_at(body, node, moving);
  assert_non_null(culprit.term);
  assert_string_equal(culprit.term, term);
  assert_close(culprit.force, force, 1e-9, 1e-12);
}

static void open_block(small_body *body, double K)
{
  body_open(body, block_of(2, 2, 2, 1, 0.1), K);
  body_fibers(body, (double[3]){1, 0, 0});
}

// At rest springs are slack, so that a load is all there is.
static void loads_are_named(void **nothing)
{
  (void)nothing;
  small_body body;
  open_block(&body, 60);
  body.definition.gravity[2] = -0.01;
  body.definition.end_time = 300;
  body.material.active.kind = VSC_ACTIVE_TENSION;
  body.material.active.tension = 7;
  body.material.active.curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
  body_build(&body);
  const size_t node = body_node(&body, 0);
  assert_culprit(&body, node, false, "weight", 0.01 * body.model->mass[node]);
  const double weight = force_on(&body, node, false);
  body.state->time = 150;
  assert_culprit(&body, node, false, "active tension", culprit_at(&body, node, false).force);
  assert_true(culprit_at(&body, node, false).force > weight);
  body_close(&body);
}

static void pressures_and_surface_springs_are_named(void **nothing)
{
  (void)nothing;
  for (int k = 0; k < 2; k++) {
    small_body body;
    vsc_selector surface = {.kind = VSC_SELECT_BOUNDARY};
    vsc_robin_def robin = {.stiffness = 1e4};
    vsc_copy_name(surface.name, "skin");
    vsc_copy_name(robin.surface, "skin");
    open_block(&body, 60);
    body.definition.surfaces = &surface;
    body.definition.surface_count = 1;
    body.pressure = (vsc_pressure_def){.peak = 3, .curve = vsc_default_curve(VSC_CURVE_CONSTANT)};
    vsc_copy_name(body.pressure.surface, "skin");
    body.definition.pressures = &body.pressure;
    body.definition.pressure_count = k == 0;
    body.definition.robins = &robin;
    body.definition.robin_count = k == 1;
    body_build(&body);
    const size_t node = body_node(&body, 26);
    if (k == 1) stretch(&body, 1.01, 1.01, 1.01);
    double *alone = body.state->a;
    if (k == 0) vsc_loads_push(body.model, body.state->x, 0, 1, alone);
    if (k == 1) vsc_loads_hold(body.model, body.state->x, NULL, body.state->scratch.pull, alone);
    const double *f = alone + 4 * node;
    assert_culprit(&body, node, false, k == 0 ? "pressure" : "surface springs", sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]));
    body_close(&body);
  }
}

// One term of a body is so strong that it is all but the whole force.
static void terms_of_elements_are_named(void **nothing)
{
  (void)nothing;
  static const struct {
    double axial, angular, volume, stabilization, damping;
    vsc_volume_kind kind;
    double to[3];
    const char *term;
  } cases[] = {{1e9, 10, 60, 0, 0, VSC_VOLUME_ELEMENT, {1.1, 1, 1}, "axial springs"},
               {20, 10, 1e9, 0, 0, VSC_VOLUME_ELEMENT, {1.1, 1, 1}, "volume"},
               {20, 10, 1e9, 1, 0, VSC_VOLUME_NODAL, {1.1, 1, 1}, "volume"},
               {20, 10, 60, 1e9, 0, VSC_VOLUME_NODAL, {1.1, 1, 1}, "stabilization"},
               {20, 10, 60, 0, 1e9, VSC_VOLUME_ELEMENT, {1.1, 1, 1}, "damping"}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    small_body body;
    open_block(&body, cases[k].volume);
    body.definition.volume = cases[k].kind;
    body.material.stabilization = cases[k].stabilization;
    for (int a = 0; a < 3; a++) {
      body.material.axial[a] = cases[k].axial;
      body.material.angular[a] = cases[k].angular;
      body.material.damping[a] = cases[k].damping;
    }
    body_build(&body);
    stretch(&body, cases[k].to[0], cases[k].to[1], cases[k].to[2]);
    body_shake(&body, 1);
    const size_t node = body_node(&body, 0);
    const vsc_culprit culprit = culprit_at(&body, node, true);
    assert_string_equal(culprit.term, cases[k].term);
    assert_close(culprit.force, force_on(&body, node, true), 1e-5, 0);
    body_close(&body);
  }
}

// A sheet that is stretched, and one that is folded along its middle.
static void sheets_are_named(void **nothing)
{
  (void)nothing;
  for (int k = 0; k < 2; k++) {
    small_body body;
    vsc_membrane_def membrane;
    open_strip(&body, &membrane, 4, 0);
    membrane.bending *= k == 1 ? 1e9 : 1;
    body_build(&body);
    for (size_t n = 0; n < body.model->node_count; n++) {
      double *x = body.state->x + 4 * n;
      if (k == 0) x[0] *= 1.1;
      if (k == 1) x[2] += 0.1 * fabs(x[0] - 5);
    }
    const vsc_culprit culprit = culprit_at(&body, body_node(&body, 2), false);
    assert_string_equal(culprit.term, k == 0 ? "membranes" : "bending");
    assert_true(culprit.element == VSC_NO_ELEMENT);
    body_close(&body);
  }
}

// Shear in the plane of fibre and sheet turns the axes towards each other.
static void angular_springs_are_named(void **nothing)
{
  (void)nothing;
  small_body body;
  open_block(&body, 60);
  body.material.angular[0] = 1e9;
  body_build(&body);
  for (size_t n = 0; n < body.model->node_count; n++) body.state->x[4 * n] += 0.1 * body.model->rest[4 * n + 1];
  const size_t node = body_node(&body, 26);
  assert_string_equal(culprit_at(&body, node, false).term, "angular springs");
  assert_close(culprit_at(&body, node, false).force, force_on(&body, node, false), 1e-5, 0);
  body_close(&body);
}

// A tissue law is one term, and has its volume beside it.
static void laws_are_named(void **nothing)
{
  (void)nothing;
  small_body body;
  body_open(&body, block_of(2, 2, 2, 1, 0.1), 60);
  body.material.law = VSC_LAW_NEO_HOOKEAN;
  body.material.shear = 1e6;
  body_build(&body);
  stretch(&body, 1.2, 1, 1);
  assert_string_equal(culprit_at(&body, body_node(&body, 0), false).term, "the material's law");
  body_close(&body);
}

// A corner of the block is pulled out: of the elements round the node in its middle it is one at that corner.
static void the_element_has_the_node_and_the_energy(void **nothing)
{
  (void)nothing;
  small_body body;
  open_block(&body, 60);
  body_build(&body);
  const size_t corner = body_node(&body, 0), middle = body_node(&body, 13);
  for (size_t i = 0; i < 3; i++) body.state->x[4 * corner + i] -= 0.3;
  const uint32_t element = culprit_at(&body, middle, false).element;
  assert_true(element < body.mesh->element_count);
  int found = 0;
  const uint32_t *corners = vsc_mesh_corners(body.mesh, element);
  for (int c = 0; c < 4; c++) found += corners[c] == 0 || corners[c] == 13;
  assert_int_equal(found, 2);
  body_close(&body);
}

// Of a force that is no number the term is the one without which it is.
static void infinite_terms_are_named(void **nothing)
{
  (void)nothing;
  small_body body;
  open_block(&body, 60);
  body.material.damping[0] = 1;
  body_build(&body);
  const size_t node = body_node(&body, 0);
  body.state->v[4 * node] = INFINITY;
  trap_off();
  const vsc_culprit culprit = culprit_at(&body, node, true);
  trap_on();
  assert_string_equal(culprit.term, "damping");
  assert_true(isinf(culprit.force));
  body_close(&body);
}

// Looking leaves forces as they were, and the body's own numbers too.
static void nothing_is_changed(void **nothing)
{
  (void)nothing;
  small_body body;
  open_block(&body, 60);
  body.definition.volume = VSC_VOLUME_NODAL;
  body_build(&body);
  stretch(&body, 1.1, 0.9, 1);
  const size_t node = body_node(&body, 3);
  const double before = force_on(&body, node, false);
  culprit_at(&body, node, false);
  assert_true(force_on(&body, node, false) == before);
  body_close(&body);
}

// What is known is told, and no more; without memory that is the element.
static void texts(void **nothing)
{
  (void)nothing;
  char text[VSC_CULPRIT_TEXT];
  vsc_culprit culprit = {.term = "volume", .force = 3.14, .element = 7};
  assert_string_equal(vsc_name_culprit(&culprit, "", text, sizeof text),
                      "; it is of element 7, and the largest force on it, 3.1 mN, is that of volume");
  vsc_culprit_weigh(&culprit, "an obstacle", (double[3]){3, 0, 0});
  assert_string_equal(culprit.term, "volume");
  vsc_culprit_weigh(&culprit, "an obstacle", (double[3]){0, 4, 3});
  culprit.element = VSC_NO_ELEMENT;
  assert_string_equal(vsc_name_culprit(&culprit, " a step before", text, sizeof text),
                      "; the largest force on it, 5 mN a step before, is that of an obstacle");
  small_body body;
  open_block(&body, 60);
  body_build(&body);
  for (int k = 0; k < 5; k++) {
    vsc_alloc_fail_after(k);
    culprit = culprit_at(&body, 0, false);
    vsc_alloc_fail_after(-1);
    assert_null(culprit.term);
    assert_true(culprit.element != VSC_NO_ELEMENT);
    vsc_name_culprit(&culprit, "", text, sizeof text);
    assert_non_null(strstr(text, "; it is of element "));
    assert_null(strstr(text, "and"));
  }
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(loads_are_named),
      cmocka_unit_test(pressures_and_surface_springs_are_named),
      cmocka_unit_test(terms_of_elements_are_named),
      cmocka_unit_test(sheets_are_named),
      cmocka_unit_test(angular_springs_are_named),
      cmocka_unit_test(laws_are_named),
      cmocka_unit_test(the_element_has_the_node_and_the_energy),
      cmocka_unit_test(infinite_terms_are_named),
      cmocka_unit_test(nothing_is_changed),
      cmocka_unit_test(texts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
