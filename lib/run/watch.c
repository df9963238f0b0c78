// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/watch.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "model/small_strain.h"
#include "solve/moving.h"
#include "solve/newton.h"

#define MJ 1e-3  // mJ per uJ
#define ML 1e-3  // ml per mm^3
// Parts of the largest energy or work so far by which the balance may change between two looks, and in all.
#define MOST_JUMP 0.05
#define MOST_DRIFT 0.1
#define MOST_RATIO 1e3  // of an element's volume to that at rest

static bool is_taken(const vsc_watch *watch, size_t column)
{
  for (size_t k = 0; k < VSC_SIGNALS; k++)
    if (k != column && strcmp(watch->names[k], watch->names[column]) == 0) return true;
  return false;
}

// One column of the row being made. With the first row it gets its name; numbered from 2 on where another one has
// it, as that of a second load on the same surface.
static void put(vsc_watch *watch, const char *unit, double value, const char *name,
                const char *suffix)
{
  const size_t k = watch->signal_count++;
  watch->values[k] = value;
  if (watch->names[k][0] != '\0') return;
  snprintf(watch->names[k], VSC_SIGNAL_NAME, "%s%s [%s]", name, suffix, unit);
  for (int n = 2; is_taken(watch, k); n++)
    snprintf(watch->names[k], VSC_SIGNAL_NAME, "%s%s_%d [%s]", name, suffix, n, unit);
}

static void put_energies(const vsc_model *model, vsc_watch *watch)
{
  const vsc_totals *t = &watch->totals;
  const vsc_ledger *ledger = watch->ledger;
  put(watch, "mJ", MJ * t->kinetic, "energy_kinetic", "");
  put(watch, "mJ", MJ * t->axial, "energy_axial", "");
  put(watch, "mJ", MJ * t->angular, "energy_angular", "");
  put(watch, "mJ", MJ * t->volume_energy, "energy_volume", "");
  if (model->membrane_count > 0) {
    put(watch, "mJ", MJ * t->membrane, "energy_membrane", "");
    put(watch, "mJ", MJ * t->bending, "energy_bending", "");
  }
  if (model->robin_count > 0) put(watch, "mJ", MJ * t->springs, "energy_springs", "");
  put(watch, "mJ", MJ * t->gravity_energy, "energy_gravity", "");
  put(watch, "mJ", MJ * ledger->active, "work_active", "");
  put(watch, "mJ", MJ * ledger->pressure, "work_pressure", "");
  put(watch, "mJ", MJ * ledger->dissipated, "dissipated", "");
  if (model->branch_count > 0) put(watch, "mJ", MJ * t->prony_work, "work_prony", "");
  watch->balance_column = watch->signal_count;
  put(watch, "mJ", MJ * vsc_balance_error(ledger, t), "balance_error", "");
}

// The mean force of each obstacle on its nodes since the last row (of equilibria: the force now), mN, and what contact
// does to the energy.
static void put_contact(const vsc_model *model, const vsc_state *state, vsc_watch *watch)
{
  const bool rests = model->solve.kind == VSC_SOLVE_EQUILIBRIUM;
  for (size_t o = 0; o < model->obstacle_count; o++) {
    const vsc_contact_sums *sums = &state->contact[o];
    const double passed = state->time - sums->row_time;
    char name[32];
    for (int i = 0; i < 3; i++) {
      snprintf(name, sizeof name, "obstacle_%zu_%c", o, "xyz"[i]);
      const double mean = passed > 0 ? (sums->impulse[i] - sums->row_impulse[i]) / passed : 0;
      put(watch, "mN", rests ? sums->force[i] : mean, name, "");
    }
  }
  if (model->obstacle_count == 0) return;
  put(watch, "mJ", MJ * watch->totals.contact_work, "work_obstacles", "");
  put(watch, "mJ", MJ * watch->totals.contact_lost, "lost_contact", "");
}

// The mean force of each moving support on its nodes since the last row (of equilibria: the force now), mN,
// in the directions that it holds, and the work of all.
static void put_moved(const vsc_model *model, const vsc_state *state, vsc_watch *watch)
{
  static const char *const axis[3] = {"_x", "_y", "_z"};
  const bool rests = model->solve.kind == VSC_SOLVE_EQUILIBRIUM;
  for (size_t s = 0; s < model->moved_count; s++) {
    const vsc_moved_sums *sums = &state->moved[s];
    const double passed = state->time - sums->row_time;
    char name[VSC_NAME + 16];
    snprintf(name, sizeof name, "support_%s", model->moved[s].set);
    for (int i = 0; i < 3; i++) {
      const double mean = passed > 0 ? (sums->impulse[i] - sums->row_impulse[i]) / passed : 0;
      if (model->moved[s].held[i]) put(watch, "mN", rests ? -sums->force[i] : mean, name, axis[i]);
    }
  }
  if (model->moved_count > 0)
    put(watch, "mJ", MJ * watch->totals.support_work, "work_supports", "");
}

enum { MOST_KEPT_NAMED = 16 };

// How far kept volumes are off, and the pressure of the multipliers of the body or its regions.
static void put_kept(const vsc_model *model, const vsc_state *state, vsc_watch *watch)
{
  const vsc_kept_volumes *kept = &model->kept;
  double most = 0;
  if (kept->count == 0) return;
  for (size_t k = 0; k < kept->count; k++)
    most = fmax(most, fabs(vsc_kept_volume_of(model, k, state->x) / kept->rest[k] - 1));
  put(watch, "1", most, "kept_volume_error", "");
  for (size_t k = 0; k < kept->count && k < MOST_KEPT_NAMED; k++) {
    if (kept->kind == VSC_KEEP_TOTAL) put(watch, "kPa", state->kept_pressure[k], "pressure_kept", "");
    if (kept->kind == VSC_KEEP_REGION)
      put(watch, "kPa", state->kept_pressure[k], "pressure_kept_",
          model->materials[kept->source[k]].name);
  }
}

// Displacement from the mesh and position of each observed point, sum_i N_i (x_i - X_i) and sum_i N_i x_i.
static void put_points(const vsc_problem *problem, const vsc_state *state, vsc_watch *watch)
{
  const vsc_output_def *output = &problem->scene->output;
  for (size_t p = 0; p < output->point_count; p++) {
    const vsc_place *place = &problem->points[p];
    const uint32_t *corner = vsc_mesh_corners(problem->mesh, place->element);
    double moved[3] = {0}, now[3] = {0};
    for (int i = 0; i < vsc_mesh_kind(problem->mesh, place->element)->corners; i++) {
      const size_t node = 4 * (size_t)watch->point_nodes[p][i];
      for (size_t a = 0; a < 3; a++) {
        now[a] += place->N[i] * state->x[node + a];
        moved[a] += place->N[i] * (state->x[node + a] - problem->mesh->nodes[3 * (size_t)corner[i] + a]);
      }
    }
    char name[VSC_NAME + 16];
    snprintf(name, sizeof name, "point_%s", output->points[p].name);
    for (int a = 0; a < 3; a++)
      put(watch, "mm", moved[a], name, ((const char *const[]){"_ux", "_uy", "_uz"})[a]);
    for (int a = 0; a < 3; a++)
      put(watch, "mm", now[a], name, ((const char *const[]){"_x", "_y", "_z"})[a]);
  }
}

static bool is_first_on_surface(const vsc_model *model, size_t load)
{
  for (size_t p = 0; p < load; p++)
    if (strcmp(model->pressures[p].surface, model->pressures[load].surface) == 0) return false;
  return true;
}

// The first load on each surface has its column's name before any is numbered, so that pressure_NAME is the surface NAME's.
static void put_pressures(const vsc_model *model, const vsc_state *state, vsc_watch *watch)
{
  for (size_t p = 0; p < model->pressure_count; p++)
    if (is_first_on_surface(model, p))
      snprintf(watch->names[watch->signal_count + p], VSC_SIGNAL_NAME, "pressure_%s [kPa]", model->pressures[p].surface);
  for (size_t p = 0; p < model->pressure_count; p++)
    put(watch, "kPa", vsc_model_pressure(model, p, state->time), "pressure_", model->pressures[p].surface);
}

static void make_row(const vsc_problem *problem, vsc_state *state, vsc_watch *watch)
{
  static const char *const axis[3] = {"x", "y", "z"};
  const vsc_model *model = problem->model;
  const vsc_totals *t = &watch->totals;
  watch->signal_count = 0;
  put(watch, "s", 1e-3 * state->time, "time", "");
  put(watch, "ms", state->part > 0 ? state->part : model->step > 0 ? model->step : state->limit.step, "step", "");
  for (size_t c = 0; c < watch->cavity_count; c++)
    put(watch, "ml", ML * vsc_cavity_volume(&watch->cavities[c], state->x, 4), "cavity_",
        problem->scene->output.cavities[c]);
  put(watch, "ml", ML * t->volume, "wall_volume", "");
  put_pressures(model, state, watch);
  put(watch, "kPa", t->tension_mean, "active_tension_mean", "");
  put(watch, "kPa", t->tension_high, "active_tension_max", "");
  put(watch, "1", t->stretch_low, "stretch_f_min", "");
  put(watch, "1", t->stretch_mean, "stretch_f_mean", "");
  put(watch, "1", t->stretch_high, "stretch_f_max", "");
  put(watch, "1", t->J_low, "J_min", "");
  put(watch, "1", t->J_high, "J_max", "");
  if (model->terms.nodal_volume) {
    put(watch, "1", t->group_low, "J_node_min", "");
    put(watch, "1", t->group_high, "J_node_max", "");
  }
  put(watch, "1", t->inverted, "inverted_elements", "");
  put_energies(model, watch);
  put_contact(model, state, watch);
  put_moved(model, state, watch);
  put_kept(model, state, watch);
  for (int i = 0; i < 3; i++) put(watch, "mg m/s", t->momentum[i], "momentum_", axis[i]);
  for (int i = 0; i < 3; i++)
    put(watch, "mg mm m/s", t->angular_momentum[i], "angular_momentum_", axis[i]);
  put_points(problem, state, watch);
}

static vsc_status make_cavities(const vsc_problem *problem, vsc_watch *watch, vsc_error *error)
{
  const vsc_model *model = problem->model;
  const vsc_output_def *output = &problem->scene->output;
  uint32_t *number = vsc_model_node_numbers(model);
  if (number == NULL || !VSC_NEW(watch->cavities, output->cavity_count)) {
    vsc_free(number);
    return vsc_fail_memory(error, "cavities");
  }
  vsc_status status = VSC_OK;
  for (size_t c = 0; c < output->cavity_count && status == VSC_OK; c++) {
    const int s = vsc_model_find_surface(model, output->cavities[c]);
    if (s < 0) {
      status = vsc_fail(error, VSC_INPUT,
                        "output.cavities[%zu]: no surface is called '%s'; define it under surfaces",
                        c, output->cavities[c]);
      break;
    }
    status = vsc_cavity_make(&model->surfaces[s], model->node_count, &watch->cavities[c], error);
    if (status != VSC_OK) break;
    watch->cavity_count++;
    vsc_cavity_renumber(&watch->cavities[c], number);
  }
  vsc_free(number);
  return status;
}

static vsc_status number_points(const vsc_problem *problem, vsc_watch *watch, vsc_error *error)
{
  const size_t count = problem->scene->output.point_count;
  if (count == 0) return VSC_OK;
  uint32_t *number = vsc_model_node_numbers(problem->model);
  const bool made = number != NULL && VSC_NEW(watch->point_nodes, count);
  for (size_t p = 0; p < count && made; p++) {
    const size_t element = problem->points[p].element;
    const uint32_t *corner = vsc_mesh_corners(problem->mesh, element);
    for (int i = 0; i < vsc_mesh_kind(problem->mesh, element)->corners; i++)
      watch->point_nodes[p][i] = number[corner[i]];
  }
  vsc_free(number);
  return made ? VSC_OK : vsc_fail_memory(error, "observed points");
}

static vsc_status open_file(const char *file, double keep_until, vsc_watch *watch, vsc_error *error)
{
  const vsc_status status = keep_until >= 0 ? vsc_watch_trim(file, keep_until, error) : VSC_OK;
  if (status != VSC_OK) return status;
  snprintf(watch->path, sizeof watch->path, "%s", file);
  watch->file = fopen(file, keep_until >= 0 ? "a" : "w");
  if (watch->file == NULL)
    return vsc_fail(error, VSC_SYSTEM, "%s: cannot be written: %s", file, strerror(errno));
  return VSC_OK;
}

// The energy of 3 % strain everywhere: what is smaller is no measure of anything.
static double least_energy(const vsc_model *model)
{
  double energy = 0;
  for (size_t m = 0; m < model->material_count; m++) {
    const vsc_material *material = &model->materials[m];
    double stiff = fmax(material->axial[0], fmax(material->axial[1], material->axial[2]));
    if (vsc_law_is_of_strain(material->law) && material->law != VSC_LAW_SPRINGS)
      stiff = 2 * vsc_material_shear(model, material);
    if (!vsc_law_is_of_strain(material->law))  // of an element's size
      stiff = fmax(material->classical.stiffness, material->paper.axial[0]) / model->element_size;
    energy += 0.5 * stiff * material->volume * 0.03 * 0.03;
  }
  for (size_t k = 0; k < model->membrane_count; k++) {
    const vsc_membrane *m = &model->membranes[k];
    const double stiff = fmax(m->moduli.axial[0], m->moduli.axial[1]);
    energy += 0.5 * stiff * m->thickness * m->area * 0.03 * 0.03;
  }
  return energy;
}

vsc_status vsc_watch_open(const vsc_problem *problem, const char *file, double keep_until,
                          vsc_watch **watch, vsc_error *error)
{
  vsc_watch *made;
  *watch = NULL;
  if (!VSC_NEW(made, 1)) return vsc_fail_memory(error, "signals");
  made->energy_scale = least_energy(problem->model);
  vsc_status status = vsc_ledger_create(problem->model, &made->ledger, error);
  if (status == VSC_OK) status = make_cavities(problem, made, error);
  if (status == VSC_OK) status = number_points(problem, made, error);
  if (status == VSC_OK) status = open_file(file, keep_until, made, error);
  if (status != VSC_OK) {
    vsc_watch_free(made);
    return status;
  }
  *watch = made;
  return VSC_OK;
}

// Which of the body's energies has changed most since the last look.
static const char *busiest_term(const vsc_totals *now, const vsc_totals *before)
{
  const struct {
    const char *name;
    double change;
  } terms[] = {{"kinetic", now->kinetic - before->kinetic},
               {"axial", now->axial - before->axial},
               {"angular", now->angular - before->angular},
               {"volume", now->volume_energy - before->volume_energy},
               {"membrane", now->membrane - before->membrane},
               {"bending", now->bending - before->bending},
               {"springs", now->springs - before->springs}};
  size_t most = 0;
  for (size_t k = 0; k < sizeof terms / sizeof terms[0]; k++) {
    if (!isfinite(terms[k].change)) return terms[k].name;
    if (fabs(terms[k].change) > fabs(terms[most].change)) most = k;
  }
  return terms[most].name;
}

// `what` has happened: which element is worst off.
static vsc_status fail_apart(const vsc_problem *problem, const vsc_state *state, const char *what, vsc_error *error)
{
  uint32_t worst = 0;
  const double ratio = vsc_smallest_ratio(problem->model, state->x, &worst);
  const vsc_mesh *mesh = problem->mesh;
  double at[3] = {0};
  char where[160] = "";
  for (size_t c = mesh->start[worst]; mesh->element_count > 0 && c < mesh->start[worst + 1]; c++)
    for (size_t i = 0; i < 3; i++)
      at[i] += mesh->nodes[3 * mesh->corners[c] + i] / (double)(mesh->start[worst + 1] - mesh->start[worst]);
  if (mesh->element_count > 0)
    snprintf(where, sizeof where, "; element %u at (%.4g, %.4g, %.4g) mm has the smallest volume, %.2g of its own",
             mesh->element_source[worst], at[0], at[1], at[2], ratio);
  return vsc_fail(error, VSC_NUMERICAL,
                  "at %.6g ms %s%s: the simulation is coming apart; take a smaller %s, more damping, or a smaller load",
                  state->time, what, where, problem->model->step > 0 ? "time.step" : "time.safety");
}

// Volume ratios that no tissue has: law PAPER, whose energy need not balance, ends there.
static vsc_status check_shape(const vsc_problem *problem, const vsc_state *state, const vsc_watch *watch,
                              vsc_error *error)
{
  const vsc_totals *t = &watch->totals;
  char what[128];
  if (problem->mesh->element_count == 0 || fmax(fabs(t->J_low), fabs(t->J_high)) <= MOST_RATIO) return VSC_OK;
  snprintf(what, sizeof what, "elements have from %.3g to %.3g times their volume", t->J_low, t->J_high);
  return fail_apart(problem, state, what, error);
}

// The largest energy or work so far.
static double largest_energy(const vsc_watch *watch)
{
  const vsc_totals *t = &watch->totals;
  const vsc_ledger *ledger = watch->ledger;
  const double sizes[] = {
      t->kinetic + t->axial + t->angular + t->volume_energy + t->membrane + t->bending + t->springs,
      fabs(ledger->active), fabs(ledger->pressure), ledger->dissipated, fabs(t->contact_work),
      fabs(t->support_work)};
  double scale = watch->energy_scale;
  for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) scale = fmax(scale, sizes[k]);
  return scale;
}

// How far the balance has jumped since the last look, and whether that is more than may be, or it is off by more in all.
static bool is_off(const vsc_watch *watch, double scale, double *jump)
{
  const double error_now = vsc_balance_error(watch->ledger, &watch->totals);
  *jump = error_now - watch->balance;
  return !(fabs(*jump) <= MOST_JUMP * scale && fabs(error_now) <= MOST_DRIFT * scale);
}

// Where the speed of a support has jumped since the last look, at `from`, the power of damping has jumped with it, and no
// trapezoid tells what was dissipated: it is what the balance leaves, not below 0. `before`: dissipated at `from`.
static void settle_jump(const vsc_model *model, double from, double before, vsc_watch *watch)
{
  vsc_ledger *ledger = watch->ledger;
  double jump;
  if (model->moved_count == 0 || !model->terms.damping || ledger->calls <= 1) return;
  if (!is_off(watch, largest_energy(watch), &jump)) return;
  if (vsc_moving_jumps(model, from, ledger->time)) ledger->dissipated = fmax(ledger->dissipated - jump, before);
}

static vsc_status check_balance(const vsc_problem *problem, const vsc_state *state, vsc_watch *watch,
                                vsc_error *error)
{
  const vsc_model *model = problem->model;
  const vsc_ledger *ledger = watch->ledger;
  double jump;
  watch->energy_scale = largest_energy(watch);
  const bool balances = !is_off(watch, watch->energy_scale, &jump);
  const double error_now = vsc_balance_error(ledger, &watch->totals);
  watch->balance = error_now;
  // law PAPER makes energy, and a forced step is the user's own risk
  // equilibria store work along ways that the ledger does not see
  const bool may_jump = ledger->calls <= 1 || model->solve.kind != VSC_SOLVE_EXPLICIT ||
                        model->terms.paper || model->force_step;
  if (isfinite(error_now) && (may_jump || balances)) return VSC_OK;
  char what[200];
  const bool drifts = fabs(jump) <= MOST_JUMP * watch->energy_scale;
  const double off = drifts ? fabs(error_now) : fabs(jump);
  snprintf(what, sizeof what, "the energy balance %s by %.3g mJ, %.0f %% of the largest energy so far, most in the %s energy",
           drifts ? "is off" : "jumped", MJ * off, 100 * off / watch->energy_scale,
           busiest_term(&watch->totals, &watch->former));
  return fail_apart(problem, state, what, error);
}

static vsc_status write_row(vsc_watch *watch, vsc_error *error)
{
  const long place = ftell(watch->file);
  if (place == 0)
    for (size_t k = 0; k < watch->signal_count; k++)
      fprintf(watch->file, "%s%s", k ? "," : "", watch->names[k]);
  if (place == 0) fputc('\n', watch->file);
  for (size_t k = 0; k < watch->signal_count; k++)
    fprintf(watch->file, k ? ",%.12g" : "%.12g", watch->values[k]);
  fputc('\n', watch->file);
  if (fflush(watch->file) != 0 || ferror(watch->file) != 0)
    return vsc_fail(error, VSC_SYSTEM, "%s: cannot be written: %s", watch->path, strerror(errno));
  return VSC_OK;
}

vsc_status vsc_watch_observe(const vsc_problem *problem, vsc_state *state, vsc_watch *watch,
                             vsc_error *error)
{
  const double from = watch->ledger->time, before = watch->ledger->dissipated;
  watch->former = watch->totals;
  vsc_observe(problem->model, state, watch->ledger, false, &watch->totals);
  if (watch->settles) settle_jump(problem->model, from, before, watch);
  const vsc_status status = check_balance(problem, state, watch, error);
  return status == VSC_OK ? check_shape(problem, state, watch, error) : status;
}

vsc_status vsc_watch_row(const vsc_problem *problem, vsc_state *state, vsc_watch *watch,
                         vsc_error *error)
{
  make_row(problem, state, watch);
  for (size_t o = 0; o < problem->model->obstacle_count; o++) {
    vsc_contact_sums *sums = &state->contact[o];
    memcpy(sums->row_impulse, sums->impulse, sizeof sums->impulse);
    sums->row_time = state->time;
  }
  for (size_t s = 0; s < problem->model->moved_count; s++) {
    vsc_moved_sums *sums = &state->moved[s];
    memcpy(sums->row_impulse, sums->impulse, sizeof sums->impulse);
    sums->row_time = state->time;
  }
  for (size_t k = 0; k < watch->signal_count; k++) {
    watch->low[k] = watch->rows > 0 ? fmin(watch->low[k], watch->values[k]) : watch->values[k];
    watch->high[k] = watch->rows > 0 ? fmax(watch->high[k], watch->values[k]) : watch->values[k];
  }
  watch->rows++;
  return write_row(watch, error);
}

void vsc_watch_resume(const vsc_problem *problem, vsc_state *state, vsc_watch *watch)
{
  vsc_observe(problem->model, state, watch->ledger, true, &watch->totals);
  make_row(problem, state, watch);
}

double vsc_watch_energy_made(const vsc_watch *watch)
{
  if (watch->rows == 0) return 0;
  return fmax(watch->high[watch->balance_column], 0) / (MJ * watch->energy_scale);
}

void vsc_watch_free(vsc_watch *watch)
{
  if (watch == NULL) return;
  if (watch->file != NULL) fclose(watch->file);
  for (size_t c = 0; c < watch->cavity_count; c++) vsc_cavity_free(&watch->cavities[c]);
  vsc_free(watch->cavities);
  vsc_free(watch->point_nodes);
  vsc_ledger_free(watch->ledger);
  vsc_free(watch);
}
