// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium: closed forms of homogeneous bodies, Newton's quadratic convergence, independence of the
// increments and of the linear solver, and what is said when there is none.
#include <gsl/gsl_multiroots.h>

#include "small_body.h"
#include "solve/linear.h"
#include "solve/solve.h"
#include "tools/shapes_block.h"

static vsc_status solve_to(small_body *body, double time, vsc_error *error)
{
  if (body->state->solver == NULL) {
    const vsc_status status = vsc_solve_start(body->model, body->state, error);
    if (status != VSC_OK) return status;
  }
  return vsc_solve_to(body->model, body->state, time, error);
}

static void must_solve_to(small_body *body, double time)
{
  vsc_error error;
  if (solve_to(body, time, &error) != VSC_OK) fail_msg("%s", error.text);
}

// ---- a free block whose fibres pull

typedef struct pull {
  double E, K, tension;
} pull;

// Stretches (l, m, m): E (l-1)/l + T + U'(J) m^2/l = 0 along the fibre, E (m-1)/m + U'(J) l = 0
// across, as second Piola-Kirchhoff stress.
static int pull_balance(const gsl_vector *at, void *context, gsl_vector *out)
{
  const pull *p = context;
  const double l = gsl_vector_get(at, 0), m = gsl_vector_get(at, 1), J = l * m * m;
  const double U = p->K / 2 * (J - 1 / J);
  gsl_vector_set(out, 0, p->E * (l - 1) / l + p->tension + U * m * m / l);
  gsl_vector_set(out, 1, p->E * (m - 1) / m + U * l);
  return GSL_SUCCESS;
}

static void solve_pull(const pull *p, double stretch[2])
{
  gsl_multiroot_fsolver *solver = gsl_multiroot_fsolver_alloc(gsl_multiroot_fsolver_hybrids, 2);
  gsl_vector *start = gsl_vector_alloc(2);
  gsl_vector_set_all(start, 1);
  gsl_multiroot_function f = {pull_balance, 2, (void *)p};
  gsl_multiroot_fsolver_set(solver, &f, start);
  for (int k = 0; k < 100 && gsl_multiroot_test_residual(solver->f, 1e-13) != GSL_SUCCESS; k++)
    gsl_multiroot_fsolver_iterate(solver);
  for (int i = 0; i < 2; i++) stretch[i] = gsl_vector_get(solver->x, (size_t)i);
  gsl_multiroot_fsolver_free(solver);
  gsl_vector_free(start);
}

static void open_pull(small_body *body, vsc_volume_kind volume, vsc_linear_kind linear)
{
  body_open(body, block_of(3, 3, 3, 2, 0.2), 200);
  body_hold_planes(body);
  body_fibers(body, (const double[]){1, 0, 0});
  body->material.stabilization = 30;
  body->material.active = vsc_default_active();
  body->material.active.kind = VSC_ACTIVE_TENSION;
  body->material.active.tension = 15;
  body->material.active.curve = vsc_default_curve(VSC_CURVE_RAMP);
  body->material.active.curve.duration = 100;
  body->definition.volume = volume;
  body->definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body->definition.solve.linear = linear;
  body->definition.solve.tolerance = 1e-12;
  body_build(body);
}

// The residual of 1e-12 leaves stretches to some 1e-11 of condition and rounding.
static void check_pull(const small_body *body, const double stretch[2])
{
  body_must_be_stretched(body, (const double[]){stretch[0], stretch[1], stretch[1]}, 1e-10);
}

static void a_free_block_takes_the_stretches_of_the_closed_form(void **state)
{
  (void)state;
  for (int volume = VSC_VOLUME_NODAL; volume <= VSC_VOLUME_ELEMENT; volume++)
    for (int way = 0; way < 4; way++) {
      small_body body;
      double stretch[2];
      open_pull(&body, (vsc_volume_kind)volume, way < 3 ? (vsc_linear_kind)way : VSC_LINEAR_AUTO);
      if (way == 3) body.model->solve.method = VSC_STATICS_RELAXATION;
      // beside node-averaged volume each frame has Ks
      const double K = volume == VSC_VOLUME_NODAL ? 230 : 200;
      must_solve_to(&body, 100);
      solve_pull(&(pull){20, K, 15}, stretch);
      assert_true(stretch[0] < 0.8);
      check_pull(&body, stretch);
      assert_true(body.state->time == 100);
      body_close(&body);
    }
}

// The ramp's half: on the way, and again from there to the end.
static void equilibria_follow_the_loads_in_time(void **state)
{
  (void)state;
  small_body body;
  double stretch[2];
  open_pull(&body, VSC_VOLUME_ELEMENT, VSC_LINEAR_AUTO);
  for (int part = 1; part <= 4; part++) {
    must_solve_to(&body, 25 * part);
    solve_pull(&(pull){20, 200, 15 * 0.25 * part}, stretch);
    check_pull(&body, stretch);
  }
  body_close(&body);
}

// A body that lies on springs all round has no reactions of supports: under a load that stays, the scale of forces is
// that of the load and of the springs: once the body has come to rest a row takes no more than one iteration.
static void springs_all_round_are_as_good_as_supports(void **state)
{
  (void)state;
  small_body body;
  vsc_selector faces[2] = {{.name = "all", .kind = VSC_SELECT_BOUNDARY},
                           {.name = "top", .kind = VSC_SELECT_NODE_ARRAY, .array = "z1", .low = 1, .high = 1}};
  vsc_robin_def bed = {.surface = "all", .stiffness = 0.1};
  body_open(&body, block_of(3, 3, 3, 2, 0.2), 200);
  body.definition.surfaces = faces;
  body.definition.surface_count = 2;
  body.definition.robins = &bed;
  body.definition.robin_count = 1;
  body.pressure = (vsc_pressure_def){.surface = "top", .peak = 1, .curve = vsc_default_curve(VSC_CURVE_CONSTANT)};
  body.definition.pressures = &body.pressure;
  body.definition.pressure_count = 1;
  body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body_build(&body);
  must_solve_to(&body, 25);
  vsc_newton *newton = body.state->solver;
  assert_true(newton->iterations > 2);
  must_solve_to(&body, 50);
  const double second = newton->iterations;
  must_solve_to(&body, 75);
  must_solve_to(&body, 100);
  assert_true(newton->iterations <= second + 2);
  body_close(&body);
}

// Where nothing pulls yet, relaxation is at rest: what is left of forces is the rounding of positions.
static void relaxation_rests_where_nothing_pulls(void **state)
{
  (void)state;
  small_body body;
  body_open(&body, block_of(3, 3, 3, 2, 0.2), 200);
  body_hold(&body, "x0", 1, 1, 1);
  body.material.active = (vsc_active_def){.kind = VSC_ACTIVE_TENSION, .tension = 15, .delay_unit = 1,
                                          .curve = vsc_default_curve(VSC_CURVE_RAMP)};
  body.material.active.curve.start = 30;
  body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body.definition.solve.method = VSC_STATICS_RELAXATION;
  body_fibers(&body, (double[3]){1, 0, 0});
  body_build(&body);
  must_solve_to(&body, 20);
  for (size_t i = 0; i < 4 * body.model->node_count; i++)
    assert_close(body.state->x[i], body.model->rest[i], 0, 1e-12);
  must_solve_to(&body, 100);
  const double *end = body.state->x + 4 * body_node(&body, body.mesh->node_count - 1);
  assert_true(end[0] < body.mesh->nodes[3 * (body.mesh->node_count - 1)] - 0.1);
  body_close(&body);
}

// The stretch l of an incompressible body, m = l^-1/2 across: the pressure p = -E (m-1)/(m l) leaves the
// sides free, and E (l-1)/l + T + p m^2/l = 0, by halving.
static double incompressible_stretch(double E, double tension)
{
  double low = 0.3, high = 1;
  for (int k = 0; k < 100; k++) {
    const double l = (low + high) / 2, m = 1 / sqrt(l), p = -E * (m - 1) / (m * l);
    *(E * (l - 1) / l + tension + p * m * m / l > 0 ? &high : &low) = l;
  }
  return low;
}

// With multipliers the volume is kept though K is only 20 times the shear modulus: to 1e-7, which is 1e-6
// mm of the block's 6.
static void multipliers_keep_volumes(void **state)
{
  (void)state;
  for (int kind = 0; kind < 2; kind++) {
    small_body body;
    double stretch[2];
    vsc_mesh *mesh = block_of(3, 3, 3, 2, 0);
    if (kind == 1) {
      vsc_mesh_free(mesh);
      const vsc_block_shape shape = {.cells = {3, 3, 3}, .size = {6, 6, 6}, .tets_per_cell = 5};
      assert_int_equal(vsc_block_of(&shape, VSC_BLOCK_HEXES, &mesh, NULL), VSC_OK);
    }
    body_open(&body, mesh, 200);
    body_hold_planes(&body);
    body_fibers(&body, (const double[]){1, 0, 0});
    body.material.active = vsc_default_active();
    body.material.active.kind = VSC_ACTIVE_TENSION;
    body.material.active.tension = 15;
    body.definition.volume = VSC_VOLUME_NODAL;
    body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
    body.definition.solve.tolerance = 1e-11;
    body.definition.solve.incompressible = 1e-7;
    body_build(&body);
    must_solve_to(&body, 100);
    stretch[0] = incompressible_stretch(20, 15);
    stretch[1] = 1 / sqrt(stretch[0]);
    body_must_be_stretched(&body, (const double[]){stretch[0], stretch[1], stretch[1]}, 6e-6);
    body_close(&body);
  }
}

// Tets with volumes of their own have no multipliers.
static void multipliers_of_single_tets_are_refused(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  body_open(&body, block_of(2, 2, 2, 1, 0), 200);
  body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body.definition.solve.incompressible = 1e-4;
  assert_int_equal(vsc_model_build(body.mesh, NULL, &body.definition, &body.model, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "solver.incompressible: linear tetrahedra that each keep a volume of their own"));
  assert_non_null(strstr(error.text, "use volume: nodal, or mesh.order: 2"));
  body_close(&body);
}

// ---- Newton's method

static void open_bar(small_body *body, double gravity)
{
  body_open(body, block_of(8, 3, 3, 1, 0.2), 60);
  body_hold(body, "x0", 1, 1, 1);
  body->definition.gravity[2] = gravity;
  body->definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body->definition.solve.linear = VSC_LINEAR_DIRECT;
  body->definition.solve.tolerance = 1e-13;
  body_build(body);
}

// r_{k+1} <= C r_k^2 with one C, once the residual is below the forces at work and until rounding.
static void newton_converges_quadratically(void **state)
{
  (void)state;
  small_body body;
  open_bar(&body, -0.15);
  must_solve_to(&body, 1);
  const vsc_newton *newton = vsc_solve_newton(body.model, body.state);
  int seen = 0;
  for (size_t k = 1; k < newton->row_count; k++) {
    const vsc_newton_row *a = &newton->rows[k - 1], *b = &newton->rows[k];
    if (b->iteration == 0 || a->residual > 1 || a->residual < 1e-7) continue;
    assert_true(b->residual <= 100 * a->residual * a->residual);
    seen++;

  }
  assert_true(seen >= 2);
  body_close(&body);
}

// One increment or ten, one linear solver or the other: the same equilibrium, to the tolerance.
static void equilibrium_does_not_depend_on_the_way(void **state)
{
  (void)state;
  double *first = NULL;
  for (int way = 0; way < 4; way++) {
    small_body body;
    open_bar(&body, -0.15);
    if (way == 3) body.model->solve.method = VSC_STATICS_RELAXATION;
    body.model->solve.linear = way == 1 ? VSC_LINEAR_ITERATIVE : VSC_LINEAR_DIRECT;
    for (int part = 1; way == 2 && part < 10; part++) must_solve_to(&body, part);
    must_solve_to(&body, 10);
    const size_t count = 4 * body.model->node_count;
    if (way == 0) {
      first = malloc(count * sizeof *first);
      memcpy(first, body.state->x, count * sizeof *first);
      double sunk = 0;
      for (size_t n = 0; n < count; n += 4)
        sunk = fmin(sunk, body.state->x[n + 2] - body.model->rest[n + 2]);
      assert_true(sunk < -2);  // a bar of 8 mm: far from linear
    }
    // the bar is some 1e3 times softer in bending than its elements
    for (size_t i = 0; i < count; i++) assert_close(body.state->x[i], first[i], 0, 1e-8);
    body_close(&body);
  }
  free(first);
}

// Beyond what the tissue can carry: the last good state stays, and the message has the time.
static void a_load_too_large_is_told_and_leaves_the_last_good_state(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  body_open(&body, block_of(4, 2, 2, 1, 0.1), 20);
  body_hold(&body, "x0", 1, 1, 1);
  body.definition.gravity[0] = 1e3;
  body.material.active = vsc_default_active();
  body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  for (int a = 0; a < 3; a++) body.material.axial[a] = body.material.angular[a] = 1e-3;
  body_build(&body);
  // against gravity the block is crushed: nothing holds
  for (size_t i = 0; i < 4 * body.model->node_count; i++) body.model->weight[i] *= -1;
  assert_int_equal(solve_to(&body, 10, &error), VSC_NUMERICAL);
  assert_non_null(strstr(error.text, " ms no equilibrium was found: "));
  assert_non_null(strstr(error.text, "better mesh there, solver.method: relaxation, or solve: implicit or explicit"));
  assert_non_null(strstr(error.text, " mm; it is of element "));
  assert_non_null(strstr(error.text, " mN, is that of weight; take a smaller load"));
  uint32_t element;
  assert_true(vsc_smallest_ratio(body.model, body.state->x, &element) > 0);
  assert_true(body.state->time < 10);
  body_close(&body);
}

// A balance that a wrong tangent keeps from ever being found: the body's masses pull, and the tangent is
// `stiff` times these, so that each step is `pull`/`stiff` along every axis.
typedef struct wrong_balance {
  const vsc_model *model;
  double pull, stiff;
} wrong_balance;

static void wrong_residual(void *context, const double *x, double *r)
{
  (void)x;
  const wrong_balance *w = context;
  for (size_t i = 0; i < 4 * w->model->node_count; i++) r[i] = w->pull * w->model->mass[i / 4];
}

static void wrong_tangent(void *context, const double *x, const double *before, vsc_tangent *tangent)
{
  (void)x;
  (void)before;
  const wrong_balance *w = context;
  vsc_block_matrix_clear(&tangent->matrix);
  vsc_tangent_add_masses(w->model, tangent, w->stiff);
}

// Steps of 5e-15 of the body's size stand still, but the forces are all still there; where they are a
// thousandth of those at work it is an end.
static void standing_still_under_load_is_no_equilibrium(void **state)
{
  (void)state;
  for (int part = 0; part < 2; part++) {
    small_body body;
    vsc_error error;
    vsc_newton *newton;
    int iterations;
    open_bar(&body, 0);
    assert_int_equal(vsc_newton_create(body.model, &newton, &error), VSC_OK);
    const double size = vsc_body_size(body.model);
    wrong_balance wrong = {body.model, 1, 1 / (5e-15 * size)};
    const vsc_balance balance = {&wrong, wrong_residual, wrong_tangent, NULL, NULL};
    wrong_residual(&wrong, NULL, body.state->force);
    vsc_newton_begin(newton, body.state->force);
    if (part == 1) newton->scale *= 1.1e3;
    if (part == 0) body.model->solve.kind = VSC_SOLVE_IMPLICIT;
    const vsc_status status =
        vsc_newton_solve(newton, &balance, 1, 1, body.state->x, &iterations, &error);
    assert_int_equal(status, part == 0 ? VSC_NUMERICAL : VSC_OK);
    if (part == 0) assert_non_null(strstr(error.text, "the residual is"));
    if (part == 0) assert_non_null(strstr(error.text, "better mesh there, or solve: explicit"));
    if (part == 1) assert_int_equal(iterations, 1);
    vsc_newton_free(newton);
    body_close(&body);
  }
}

// What rounding leaves of forces is known with smoothed tets too, whose law is not in the matrix itself: to
// the factor between edges' means and elements.
static void rounding_knows_smoothed_laws(void **state)
{
  (void)state;
  double floor[2];
  for (int tets = VSC_TETS_PLAIN; tets <= VSC_TETS_SMOOTHED; tets++) {
    small_body body;
    body_open(&body, block_of(4, 2, 2, 1, 0.1), NO_VOLUME);
    body_hold(&body, "x0", 1, 1, 1);
    body.definition.tets = (vsc_tets_kind)tets;
    body.definition.gravity[2] = -0.01;
    body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
    body_build(&body);
    must_solve_to(&body, 1);
    floor[tets] = vsc_solve_newton(body.model, body.state)->floor;
    body_close(&body);
  }
  assert_true(floor[1] > floor[0] / 3 && floor[1] < floor[0] * 3);
}

static void what_has_no_tangent_is_refused(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  body_open(&body, block_of(2, 2, 2, 1, 0), 20);
  body.material.law = VSC_LAW_CLASSICAL;
  body.material.classical.stiffness = 1;
  body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body_build(&body);
  assert_int_equal(solve_to(&body, 1, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "solve: explicit"));
  body_close(&body);
}

// ---- linear systems

// Each kind solves to the tolerance, and a second time with a factor that is older than the matrix.
static void linear_systems_are_solved_to_the_tolerance(void **state)
{
  (void)state;
  for (int kind = VSC_LINEAR_AUTO; kind <= VSC_LINEAR_ITERATIVE; kind++) {
    small_body body;
    vsc_error error;
    vsc_tangent *tangent;
    vsc_linear *linear;
    open_bar(&body, -0.15);
    const size_t count = 4 * body.model->node_count;
    const double *open = body.model->inverse_mass;
    double *b = malloc(count * sizeof *b), *d = malloc(count * sizeof *d), *y = calloc(count, sizeof *y);
    uint64_t seed = 7;
    for (size_t i = 0; i < count; i++) b[i] = any_number(&seed);
    assert_int_equal(vsc_tangent_create(body.model, &tangent, &error), VSC_OK);
    assert_int_equal(vsc_linear_create(body.model, tangent, (vsc_linear_kind)kind, &linear, &error), VSC_OK);
    for (int round = 0; round < 3; round++) {
      bool indefinite;
      for (size_t i = 0; i < count; i++)
        if (open[i] != 0) body.state->x[i] += 1e-4 * round * any_number(&seed);
      vsc_tangent_assemble(body.model, tangent, body.state->x, NULL, NULL, 0, 1, 0, &body.state->scratch);
      assert_int_equal(vsc_linear_solve(linear, tangent, open, body.state->x, b, 1e-9, d, &indefinite,
                                        &error),
                       VSC_OK);
      assert_false(indefinite);
      vsc_tangent_times(tangent, open, d, y);
      double rest = 0, whole = 0;
      for (size_t i = 0; i < count; i++) {
        if (open[i] == 0) continue;
        rest += (b[i] - y[i]) * (b[i] - y[i]);
        whole += b[i] * b[i];
      }
      // the residual of conjugate gradients is carried along, and drifts by rounding
      assert_true(sqrt(rest / whole) < 2e-9);
      for (size_t i = 0; i < count; i++)
        if (open[i] == 0) assert_true(d[i] == 0);
    }
    const vsc_linear_counts counts = vsc_linear_counted(linear);
    if (kind == VSC_LINEAR_ITERATIVE) assert_true(counts.factorizations == 0);
    if (kind == VSC_LINEAR_DIRECT) assert_true(counts.factorizations == 1 && counts.factor_entries > 0);
    vsc_linear_free(linear);
    vsc_tangent_free(tangent);
    free(b);
    free(d);
    free(y);
    body_close(&body);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_free_block_takes_the_stretches_of_the_closed_form),
      cmocka_unit_test(equilibria_follow_the_loads_in_time),
      cmocka_unit_test(springs_all_round_are_as_good_as_supports),
      cmocka_unit_test(relaxation_rests_where_nothing_pulls),
      cmocka_unit_test(multipliers_keep_volumes),
      cmocka_unit_test(multipliers_of_single_tets_are_refused),
      cmocka_unit_test(newton_converges_quadratically),
      cmocka_unit_test(equilibrium_does_not_depend_on_the_way),
      cmocka_unit_test(a_load_too_large_is_told_and_leaves_the_last_good_state),
      cmocka_unit_test(standing_still_under_load_is_no_equilibrium),
      cmocka_unit_test(rounding_knows_smoothed_laws),
      cmocka_unit_test(what_has_no_tangent_is_refused),
      cmocka_unit_test(linear_systems_are_solved_to_the_tolerance),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
