// SPDX-License-Identifier: GPL-3.0-or-later
// Sheets that are solved for: for tests of membranes.
#ifndef VSC_TESTS_SHEET_BODY_H
#define VSC_TESTS_SHEET_BODY_H

#include "close.h"

#include "sheet_mesh.h"
#include "small_body.h"
#include "solve/solve.h"

// A body that is nothing but the membrane of its triangles, whose numbers are still to be given.
static inline void open_surface(small_body *body, vsc_mesh *mesh, vsc_membrane_def *membrane)
{
  body_open(body, mesh, 0);
  body->definition.material_count = 0;
  *membrane = vsc_default_membrane();
  vsc_copy_name(membrane->name, "sheet");
  vsc_copy_name(membrane->surface, "triangles");
  body->definition.membranes = membrane;
  body->definition.membrane_count = 1;
}

// A strip of 10 mm that stands out from a wall, of q l^3 = `load` D. Two columns of nodes are clamped, between which
// the wall lies.
static inline void open_strip(small_body *body, vsc_membrane_def *membrane, size_t cells, double load)
{
  const double h = 10. / ((double)cells + 0.5), E = 1200, t = 0.1, D = E * t * t * t / 12;
  vsc_mesh *mesh = sheet_mesh(cells + 1, 2, h, h, CUT_BY_TURNS, 0.2, 6);
  open_surface(body, mesh, membrane);
  membrane->thickness = t;
  membrane->density = 1;
  membrane->axial[0] = membrane->axial[1] = E;
  membrane->angular = E / 2;
  membrane->bending = D;
  body->definition.gravity[2] = -load * D / 1e3 / t;
  body->sets[0] = (vsc_selector){
      .kind = VSC_SELECT_BOX, .box_low = {-1, -1, -1}, .box_high = {1.01 * h, 99, 1}};
  vsc_copy_name(body->sets[0].name, "wall");
  body->supports[0] = (vsc_support_def){.held = {1, 1, 1}};
  vsc_copy_name(body->supports[0].set, "wall");
  body->definition.set_count = body->definition.support_count = 1;
}

// Steps with every velocity damped at `rate` (1/ms) until `time`.
static inline void settle(small_body *body, double rate, double time)
{
  const double dt = body->state->limit.step;
  for (double t = 0; t < time; t += dt) {
    body_steps(body, dt, 1);
    for (size_t i = 0; i < 4 * body->model->node_count; i++) body->state->v[i] *= 1 - rate * dt;
  }
}

// The solution at `time` by the scene's own method.
static inline void solve_to(small_body *body, double time)
{
  vsc_error error;
  if (vsc_solve_start(body->model, body->state, &error) != VSC_OK ||
      vsc_solve_to(body->model, body->state, time, &error) != VSC_OK)
    fail_msg("%s", error.text);
}

#endif
