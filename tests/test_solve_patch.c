// SPDX-License-Identifier: GPL-3.0-or-later
// Patch test of loads: a block under a uniform pressure, dead traction, or on springs over one side stretches
// uniformly, whatever its elements, whose faces there are any quadrilaterals and triangles.
#include "hybrid_mesh.h"
#include "small_body.h"
#include "solve/solve.h"

enum { PRESSED, DRAGGED, BEDDED, LOADS };

typedef struct patch {
  small_body body;
  vsc_selector surface;
  vsc_robin_def bed;
} patch;

// Holds, or moves, the side x_axis = at.
static void hold_side(small_body *body, const char *name, size_t axis, double at, double motion)
{
  const size_t k = body->definition.set_count++;
  body->definition.support_count++;
  body->sets[k] = (vsc_selector){.kind = VSC_SELECT_PLANE, .tolerance = 1e-9};
  body->sets[k].point[axis] = at;
  body->sets[k].normal[axis] = 1;
  body->supports[k] = (vsc_support_def){.curve = vsc_default_curve(VSC_CURVE_CONSTANT)};
  body->supports[k].held[axis] = true;
  body->supports[k].motion[axis] = motion;
  vsc_copy_name(body->sets[k].name, name);
  vsc_copy_name(body->supports[k].set, name);
}

// n bricks along each edge of 1 mm. The surface is x = n, or x = 0 on springs while x = n is moved.
static void open_patch(patch *p, size_t n, int load, vsc_statics method, uint64_t seed)
{
  small_body *body = &p->body;
  body_open(body, hybrid_block(n, 0.2, seed), 50);
  p->surface = (vsc_selector){.name = "side", .kind = VSC_SELECT_PLANE, .normal = {1, 0, 0}, .tolerance = 1e-9};
  p->surface.point[0] = load == BEDDED ? 0 : (double)n;
  p->bed = (vsc_robin_def){.surface = "side", .stiffness = 8, .normal = true};
  body->pressure = (vsc_pressure_def){.surface = "side", .peak = 5, .curve = vsc_default_curve(VSC_CURVE_CONSTANT)};
  if (load == DRAGGED) body->pressure.direction[0] = -1;
  body->definition.surfaces = &p->surface;
  body->definition.surface_count = 1;
  body->definition.pressures = &body->pressure;
  body->definition.pressure_count = load != BEDDED;
  body->definition.robins = &p->bed;
  body->definition.robin_count = load == BEDDED;
  hold_side(body, "x", 0, load == BEDDED ? (double)n : 0, load == BEDDED ? 0.5 : 0);
  hold_side(body, "y", 1, 0, 0);
  hold_side(body, "z", 2, 0, 0);
  body->definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body->definition.solve.method = method;
  body->definition.solve.tolerance = 1e-12;
  body_build(body);
}

// E (l - 1) + U'(J) m^2 = P along the load, E (m - 1) + U'(J) l m = 0 across, as nominal stress.
static void check_stress(const patch *p, int load, double l, double m, double u)
{
  const double E = 20, K = 50, J = l * m * m, U = K / 2 * (J - 1 / J);
  const double P = load == PRESSED ? -5 * m * m : load == DRAGGED ? -5 : p->bed.stiffness * u;
  assert_close(E * (l - 1) + U * m * m, P, 0, 1e-9);
  assert_close(E * (m - 1) + U * l * m, 0, 0, 1e-9);
}

static void check_patch(const patch *p, size_t n, int load)
{
  const vsc_model *model = p->body.model;
  const double *x = p->body.state->x, *rest = model->rest;
  const size_t origin = 4 * body_node(&p->body, 0);
  const size_t corner = 4 * body_node(&p->body, (n + 1) * (n + 1) * (n + 1) - 1);
  const double u = x[origin], l = (x[corner] - u) / (double)n, m = x[corner + 1] / (double)n;
  assert_true(fabs(l - 1) > 0.05);
  for (size_t k = 0; k < 4 * model->node_count; k++)
    if (k % 4 < 3) assert_close(x[k], k % 4 == 0 ? u + l * rest[k] : m * rest[k], 0, 1e-10 * (double)n);
  check_stress(p, load, l, m, u);
}

static void a_uniform_load_stretches_uniformly(void **state)
{
  (void)state;
  for (int load = 0; load < LOADS; load++)
    for (size_t n = 1; n <= 3; n++)
      for (int method = 0; method < 2; method++) {
        patch p;
        vsc_error error;
        open_patch(&p, n, load, method == 0 ? VSC_STATICS_NEWTON : VSC_STATICS_RELAXATION, 40 + n);
        if (vsc_solve_start(p.body.model, p.body.state, &error) != VSC_OK ||
            vsc_solve_to(p.body.model, p.body.state, 100, &error) != VSC_OK)
          fail_msg("%s", error.text);
        check_patch(&p, n, load);
        body_close(&p.body);
      }
}

int main(void)
{
  vsc_parallel_set_threads(1);
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_uniform_load_stretches_uniformly)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
