// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/keep_volume.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "solve/cholmod.h"
#include "solve/contact.h"

enum { MOST_ITERATIONS = 30, SLOW = 8 };

// A = g M^-1/2, held and blocked directions 0: one row for each volume, whose entries are three for
// each of its nodes. CHOLMOD factorises A A^T. Stored by columns of A^T: row k of A is column k.
typedef struct keeper {
  const vsc_cholmod *cholmod;
  cholmod_common common;
  cholmod_sparse *rows;  // A^T: 3 nodes x volumes
  cholmod_factor *factor;
  cholmod_dense *right;
  uint32_t *slot;  // kept triangles x 3: place of a corner's node in its volume's list
  size_t *first;   // volumes + 1: of the nodes of a volume
  uint32_t *node;  // nodes of the volumes
  double *gradient;  // node list x 3: g_k at the step's start, not weighed
  double *former;    // node_count x 4: positions at the step's start
  double *lambda, *defect;
} keeper;

static void release(void *memory)
{
  keeper *k = memory;
  k->cholmod->free_sparse(&k->rows, &k->common);
  k->cholmod->free_factor(&k->factor, &k->common);
  k->cholmod->free_dense(&k->right, &k->common);
  k->cholmod->finish(&k->common);
  vsc_free(k->slot);
  vsc_free(k->first);
  vsc_free(k->node);
  vsc_free(k->gradient);
  vsc_free(k->former);
  vsc_free(k->lambda);
  vsc_free(k->defect);
  vsc_free(k);
}

// ---- which node is where

// Lists the nodes of each volume; with node NULL only counts. `place` maps a node to its place in the
// present volume's list, `seen` says for which volume.
static size_t list_nodes(const vsc_model *model, keeper *k, uint32_t *place, uint32_t *seen)
{
  const vsc_kept_volumes *kept = &model->kept;
  size_t count = 0;
  memset(seen, 0xff, model->node_count * sizeof *seen);
  for (size_t v = 0; v < kept->count; v++) {
    k->first[v] = count;
    for (size_t i = 3 * kept->start[v]; i < 3 * kept->start[v + 1]; i++) {
      const uint32_t node = kept->triangles[i];
      if (seen[node] != v) {
        seen[node] = (uint32_t)v;
        place[node] = (uint32_t)(count - k->first[v]);
        if (k->node) k->node[count] = node;
        count++;
      }
      k->slot[i] = place[node];
    }
  }
  k->first[kept->count] = count;
  return count;
}

static bool make_rows(const vsc_model *model, keeper *k, size_t count)
{
  const size_t volumes = model->kept.count;
  k->rows = k->cholmod->allocate_sparse(3 * model->node_count, volumes, 3 * count, 0, 1, 0, CHOLMOD_REAL,
                                    &k->common);
  k->right = k->cholmod->allocate_dense(volumes, 1, volumes, CHOLMOD_REAL, &k->common);
  if (k->rows == NULL || k->right == NULL) return false;
  int *start = k->rows->p, *row = k->rows->i;
  for (size_t v = 0; v <= volumes; v++) start[v] = (int)(3 * k->first[v]);
  for (size_t i = 0; i < count; i++)
    for (int a = 0; a < 3; a++) row[3 * i + (size_t)a] = (int)(3 * k->node[i]) + a;
  return true;
}

static vsc_status open_keeper(const vsc_model *model, vsc_state *state, vsc_error *error)
{
  const vsc_kept_volumes *kept = &model->kept;
  keeper *k;
  uint32_t *place = NULL, *seen = NULL;
  if (state->keeper != NULL) return VSC_OK;
  const vsc_cholmod *cholmod;
  const vsc_status status = vsc_cholmod_load(&cholmod, error);
  if (status != VSC_OK) return status;
  if (!VSC_NEW(k, 1)) return vsc_fail_memory(error, "kept volumes");
  k->cholmod = cholmod;
  cholmod->start(&k->common);
  // one thread and no BLAS: the same bits everywhere
  k->common.supernodal = CHOLMOD_SIMPLICIAL;
  k->common.final_ll = 1;
  k->common.print = 0;
  bool good = VSC_NEW(k->slot, 3 * kept->start[kept->count]) && VSC_NEW(k->first, kept->count + 1) &&
              VSC_NEW(k->former, 4 * model->node_count) && VSC_NEW(k->lambda, kept->count) &&
              VSC_NEW(k->defect, kept->count) && VSC_NEW(place, model->node_count) &&
              VSC_NEW(seen, model->node_count);
  if (good) {
    const size_t count = list_nodes(model, k, place, seen);
    good = VSC_NEW(k->node, count) && VSC_NEW(k->gradient, 3 * count);
    if (good) list_nodes(model, k, place, seen);
    good = good && make_rows(model, k, count);
  }
  vsc_free(place);
  vsc_free(seen);
  if (!good) {
    release(k);
    return vsc_fail_memory(error, "kept volumes");
  }
  state->keeper = k;
  state->release_keeper = release;
  return VSC_OK;
}

// ---- gradients and the matrix

// g_k at positions x, node by node of each volume.
static void find_gradients(const vsc_model *model, keeper *k, const double *x)
{
  const vsc_kept_volumes *kept = &model->kept;
  memset(k->gradient, 0, 3 * k->first[kept->count] * sizeof *k->gradient);
  for (size_t v = 0; v < kept->count; v++)
    for (size_t t = kept->start[v]; t < kept->start[v + 1]; t++) {
      double at[3][3], part[3][3];
      vsc_kept_triangle(model, v, t, x, at, part);
      for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < 3; i++) k->gradient[3 * (k->first[v] + k->slot[3 * t + c]) + i] += part[c][i];
    }
}

static bool is_stopped(const vsc_state *state, uint32_t node)
{
  return state->contact_count[node] == VSC_TOUCHES || state->contact_count[node] == VSC_TOUCHES_SEVERAL;
}

// What of a force on the node moves it: not held directions, nor the normal of its contact.
static void free_part(const vsc_model *model, const vsc_state *state, uint32_t node,
                      const double force[3], double part[3])
{
  const double *inverse = model->inverse_mass + 4 * (size_t)node;
  for (int i = 0; i < 3; i++) part[i] = inverse[i] > 0 ? force[i] : 0;
  if (model->obstacle_count == 0 || !is_stopped(state, node)) return;
  const double *normal = state->contact_normal + 4 * (size_t)node;
  const double along = vsc_dot(part, normal);
  const bool blocked = state->contact_count[node] == VSC_TOUCHES_SEVERAL;
  for (int i = 0; i < 3; i++) part[i] = blocked ? 0 : part[i] - along * normal[i];
}

// Volumes may depend on one another (nodes of one element at a corner of the body): a little is added
// to the diagonal, of which Newton's iteration makes nothing.
static const double REGULAR = 1e-11;

static double mean_square(const vsc_model *model, const keeper *k)
{
  const double *entry = k->rows->x;
  double sum = 0;
  for (size_t i = 0; i < 3 * k->first[model->kept.count]; i++) sum += entry[i] * entry[i];
  return sum / (double)model->kept.count;
}

static void fill_rows(const vsc_model *model, const vsc_state *state, keeper *k)
{
  double *entry = k->rows->x;
  for (size_t i = 0; i < k->first[model->kept.count]; i++) {
    const uint32_t node = k->node[i];
    free_part(model, state, node, k->gradient + 3 * i, entry + 3 * i);
    const double root = 1 / sqrt(model->mass[node]);
    for (int a = 0; a < 3; a++) entry[3 * i + (size_t)a] *= root;
  }
}

static vsc_status factorise(const vsc_model *model, const vsc_state *state, keeper *k,
                            vsc_error *error)
{
  fill_rows(model, state, k);
  double beta[2] = {REGULAR * mean_square(model, k), 0};
  cholmod_sparse *A = k->cholmod->transpose(k->rows, 1, &k->common);
  if (A != NULL && k->factor == NULL) k->factor = k->cholmod->analyze(A, &k->common);
  const bool good = A != NULL && k->factor != NULL &&
                    k->cholmod->factorize_p(A, beta, NULL, 0, k->factor, &k->common) && k->common.status == CHOLMOD_OK;
  k->cholmod->free_sparse(&A, &k->common);
  if (good) return VSC_OK;
  if (k->common.status == CHOLMOD_OUT_OF_MEMORY) return vsc_fail_memory(error, "kept volumes");
  return vsc_fail(error, VSC_NUMERICAL,
                  "at %.6g ms no multipliers can keep all %zu volumes: nothing that could change one "
                  "of them can move; use keep_volume: region or total",
                  state->time, model->kept.count);
}

// right <- (A A^T)^-1 right
static bool solve(keeper *k)
{
  cholmod_dense *x = k->cholmod->solve(CHOLMOD_A, k->factor, k->right, &k->common);
  if (x == NULL) return false;
  memcpy(k->right->x, x->x, k->right->nrow * sizeof(double));
  k->cholmod->free_dense(&x, &k->common);
  return true;
}

// What obstacles bear of the impulses sum_k size (right_k) g_k, mN ms: the parts that free_part takes away.
static void load_obstacles(const vsc_model *model, vsc_state *state, const keeper *k, double size, double dt)
{
  const double *amount = k->right->x;
  if (model->obstacle_count == 0) return;
  for (size_t v = 0; v < model->kept.count; v++)
    for (size_t i = k->first[v]; i < k->first[v + 1]; i++) {
      const uint32_t node = k->node[i];
      double part[3], impulse[3];
      if (!is_stopped(state, node)) continue;
      free_part(model, state, node, k->gradient + 3 * i, part);
      for (int a = 0; a < 3; a++) {
        const bool held = model->inverse_mass[4 * (size_t)node + (size_t)a] == 0;
        impulse[a] = held ? 0 : size * amount[v] * (part[a] - k->gradient[3 * i + (size_t)a]);
      }
      vsc_contact_load(model, state, node, impulse, dt);
    }
}

// y += size M^-1 sum_k (right_k) g_k, free parts only; y is node_count x 4.
static void push(const vsc_model *model, const vsc_state *state, const keeper *k, double size,
                 double *y)
{
  const double *amount = k->right->x;
  for (size_t v = 0; v < model->kept.count; v++)
    for (size_t i = k->first[v]; i < k->first[v + 1]; i++) {
      const uint32_t node = k->node[i];
      double part[3];
      free_part(model, state, node, k->gradient + 3 * i, part);
      for (int a = 0; a < 3; a++)
        y[4 * (size_t)node + (size_t)a] += size * amount[v] / model->mass[node] * part[a];
    }
}

// ---- the step

// "node 12", "element 3": what the volume furthest off is kept of; empty for regions and the body.
static const char *name_worst(const vsc_model *model, const keeper *k, char text[VSC_NODE_TEXT])
{
  const vsc_kept_volumes *kept = &model->kept;
  size_t worst = 0;
  for (size_t v = 1; v < kept->count; v++)
    if (!(fabs(k->defect[v]) / kept->rest[v] <= fabs(k->defect[worst]) / kept->rest[worst])) worst = v;
  text[0] = '\0';
  if (kept->kind != VSC_KEEP_NODE && kept->kind != VSC_KEEP_ELEMENT) return text;
  char place[VSC_NODE_TEXT];
  vsc_name_node(model, kept->triangles[3 * kept->start[worst]], place, sizeof place);
  const bool node = kept->kind == VSC_KEEP_NODE;
  snprintf(text, VSC_NODE_TEXT, ", that of %s %u near %s", node ? "node" : "element",
           vsc_source_number(node ? model->node_source : model->element_source, kept->source[worst]), strchr(place, '('));
  return text;
}

// defect_k = V_k - v_k(x); returns the largest part of a volume.
static double find_defects(const vsc_model *model, const vsc_state *state, keeper *k)
{
  double most = 0;
  for (size_t v = 0; v < model->kept.count; v++) {
    k->defect[v] = model->kept.rest[v] - vsc_kept_volume_of(model, v, state->x);
    most = fmax(most, fabs(k->defect[v]) / model->kept.rest[v]);
  }
  return isfinite(most) ? most : HUGE_VAL;
}

vsc_status vsc_keep_volume_ready(const vsc_model *model, vsc_error *error)
{
  const vsc_cholmod *cholmod;
  return model->kept.count > 0 ? vsc_cholmod_load(&cholmod, error) : VSC_OK;
}

vsc_status vsc_keep_volume(const vsc_model *model, vsc_state *state, double dt, bool first,
                           vsc_error *error)
{
  vsc_status status = open_keeper(model, state, error);
  keeper *k = state->keeper;
  if (status != VSC_OK) return status;
  for (size_t i = 0; i < 4 * model->node_count; i++)
    k->former[i] = state->x[i] - dt * state->v[i];
  find_gradients(model, k, k->former);
  // contact changes what can move
  if (first || model->obstacle_count > 0) status = factorise(model, state, k, error);
  memset(k->lambda, 0, model->kept.count * sizeof *k->lambda);
  double most = find_defects(model, state, k);
  for (int round = 0; status == VSC_OK && most > 0.1 * VSC_KEPT_TOLERANCE; round++) {
    if (round == MOST_ITERATIONS) break;
    if (round == SLOW) status = factorise(model, state, k, error);
    memcpy(k->right->x, k->defect, model->kept.count * sizeof(double));
    if (status == VSC_OK && !solve(k)) status = vsc_fail_memory(error, "kept volumes");
    if (status != VSC_OK) break;
    load_obstacles(model, state, k, 1 / dt, dt);
    push(model, state, k, 1, state->x);
    push(model, state, k, 1 / dt, state->v);
    if (model->terms.damping) push(model, state, k, (first ? 2 : 1.5) / dt, state->scratch.predicted);
    for (size_t v = 0; v < model->kept.count; v++) k->lambda[v] += ((double *)k->right->x)[v];
    const double before = most;
    most = find_defects(model, state, k);
    if (most > 0.5 * before && most <= VSC_KEPT_TOLERANCE) break;  // rounding
  }
  for (size_t v = 0; v < model->kept.count; v++) state->kept_pressure[v] += k->lambda[v] / dt / dt;
  char worst[VSC_NODE_TEXT];
  if (status == VSC_OK && !(most <= 100 * VSC_KEPT_TOLERANCE))
    status = vsc_fail(error, VSC_NUMERICAL,
                      "at %.6g ms kept volumes could not be kept (%.2g of one is left over%s): an "
                      "element is crushed or blocked all round; use keep_volume: region or total, or "
                      "a smaller load",
                      state->time, most, name_worst(model, k, worst));
  return status;
}

vsc_status vsc_keep_volume_settle(const vsc_model *model, vsc_state *state, double dt, vsc_error *error)
{
  vsc_status status = open_keeper(model, state, error);
  if (status != VSC_OK) return status;
  keeper *k = state->keeper;
  find_gradients(model, k, state->x);
  status = factorise(model, state, k, error);
  if (status != VSC_OK) return status;
  double *change = k->right->x;
  for (size_t v = 0; v < model->kept.count; v++) {
    change[v] = 0;
    for (size_t i = k->first[v]; i < k->first[v + 1]; i++)
      change[v] += vsc_dot(k->gradient + 3 * i, state->v + 4 * (size_t)k->node[i]);
  }
  if (!solve(k)) return vsc_fail_memory(error, "kept volumes");
  load_obstacles(model, state, k, -1, dt);
  push(model, state, k, -1, state->v);
  return VSC_OK;
}
