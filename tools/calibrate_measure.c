// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/calibrate_measure.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mech/force.h"
#include "tools/shapes.h"

static const double PROBE = 1e-5;  // mm: a part of an edge whose square is rounding

struct vsc_sample {
  vsc_mesh *mesh;
  vsc_model *model;
  vsc_state *state;
  vsc_surface boundary;  // nodes of the mesh
  uint32_t *number;      // of the mesh's nodes in the model
  size_t free;           // unknowns
  int32_t *unknown;      // 3 x nodes of the model; -1: pinned
  gsl_matrix *stiffness; // Cholesky factor
};

// Rigid motion is taken away by six pins on three nodes: the loads are in balance, so they bear none.
static void pin(vsc_sample *s)
{
  static const double corners[3][3] = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}};
  static const int pinned[3][3] = {{1, 1, 1}, {0, 1, 1}, {0, 0, 1}};
  int32_t next = 0;
  memset(s->unknown, 0, 3 * s->model->node_count * sizeof *s->unknown);
  for (size_t n = 0; n < s->model->node_count; n++)
    for (int c = 0; c < 3; c++) {
      double way[3];
      vsc_subtract(s->model->rest + 4 * n, corners[c], way);
      for (int i = 0; i < 3 && vsc_norm(way) < 1e-9; i++)
        if (pinned[c][i]) s->unknown[3 * n + (size_t)i] = -1;
    }
  for (size_t i = 0; i < 3 * s->model->node_count; i++)
    if (s->unknown[i] == 0) s->unknown[i] = next++;
  s->free = (size_t)next;
}

static vsc_status assemble(vsc_sample *s, vsc_error *error)
{
  const size_t nodes = s->model->node_count;
  double *x = s->state->x, *side[2] = {s->state->v, s->state->force};
  s->stiffness = gsl_matrix_calloc(s->free, s->free);
  if (s->stiffness == NULL) return vsc_fail_memory(error, "a stiffness matrix");
  for (size_t j = 0; j < 3 * nodes; j++) {
    if (s->unknown[j] < 0) continue;
    double *moved = x + 4 * (j / 3) + j % 3, rest = *moved;
    for (int k = 0; k < 2; k++) {
      *moved = rest + (k == 0 ? PROBE : -PROBE);
      vsc_force(s->model, x, NULL, 0, &s->state->scratch, side[k]);
    }
    *moved = rest;
    for (size_t i = 0; i < 3 * nodes; i++) {
      const size_t place = 4 * (i / 3) + i % 3;
      if (s->unknown[i] >= 0)
        gsl_matrix_set(s->stiffness, (size_t)s->unknown[i], (size_t)s->unknown[j],
                       (side[1][place] - side[0][place]) / (2 * PROBE));
    }
  }
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  const int failed = gsl_linalg_cholesky_decomp1(s->stiffness);
  gsl_set_error_handler(handler);
  if (!failed) return VSC_OK;
  return vsc_fail(error, VSC_NUMERICAL,
                  "a block of the material does not resist every deformation: give it shear springs "
                  "and a volume modulus");
}

static vsc_status build(vsc_sample *s, const vsc_material_def *material, vsc_volume_kind volume,
                        vsc_error *error)
{
  const vsc_block_shape shape = {
      .cells = {3, 3, 3}, .size = {3, 3, 3}, .tets_per_cell = 6, .jitter = 0.25, .seed = 5};
  vsc_material_def passive = *material;
  vsc_definition definition = vsc_default_definition();
  passive.active = vsc_default_active();
  passive.region_count = passive.inclusion_count = 0;
  definition.materials = &passive;
  definition.material_count = 1;
  definition.volume = volume;
  definition.end_time = 1;
  vsc_status status = vsc_block_mesh(&shape, &s->mesh, error);
  if (status == VSC_OK) status = vsc_boundary(s->mesh, &s->boundary, error);
  if (status == VSC_OK) status = vsc_model_build(s->mesh, NULL, &definition, &s->model, error);
  if (status == VSC_OK) status = vsc_state_create(s->model, &s->state, error);
  if (status != VSC_OK) return status;
  s->number = vsc_model_node_numbers(s->model);
  if (s->number == NULL || !VSC_NEW(s->unknown, 3 * s->model->node_count))
    return vsc_fail_memory(error, "a block of the material");
  pin(s);
  return assemble(s, error);
}

vsc_status vsc_sample_open(const vsc_material_def *material, vsc_volume_kind volume,
                           vsc_sample **sample, vsc_error *error)
{
  *sample = NULL;
  if (!VSC_NEW(*sample, 1)) return vsc_fail_memory(error, "a block of the material");
  const vsc_status status = build(*sample, material, volume, error);
  if (status == VSC_OK) return VSC_OK;
  vsc_sample_close(*sample);
  *sample = NULL;
  return status;
}

// The vector of area of a boundary triangle at rest.
static void area_of(const vsc_sample *s, size_t t, double area[3])
{
  const double *x[3];
  double first[3], second[3];
  for (int c = 0; c < 3; c++)
    x[c] = s->mesh->nodes + 3 * (size_t)s->boundary.triangles[3 * t + (size_t)c];
  vsc_subtract(x[1], x[0], first);
  vsc_subtract(x[2], x[0], second);
  vsc_cross(first, second, area);
  for (int i = 0; i < 3; i++) area[i] /= 2;
}

double vsc_sample_young(const vsc_sample *s, const double d[3])
{
  gsl_vector *u = gsl_vector_calloc(s->free);
  for (size_t t = 0; t < s->boundary.count; t++) {
    double area[3];
    area_of(s, t, area);
    for (int c = 0; c < 3; c++)
      for (int i = 0; i < 3; i++) {
        const size_t node = s->number[s->boundary.triangles[3 * t + (size_t)c]];
        const int32_t k = s->unknown[3 * node + (size_t)i];
        if (k >= 0)
          gsl_vector_set(u, (size_t)k,
                         gsl_vector_get(u, (size_t)k) + vsc_dot(area, d) * d[i] / 3);
      }
  }
  gsl_linalg_cholesky_svx(s->stiffness, u);
  // mean of d . grad u d = 1/V sum over the boundary of (u . d)(n . d)
  double strain = 0;
  for (size_t t = 0; t < s->boundary.count; t++) {
    double area[3], along = 0;
    area_of(s, t, area);
    for (int c = 0; c < 3; c++)
      for (int i = 0; i < 3; i++) {
        const size_t node = s->number[s->boundary.triangles[3 * t + (size_t)c]];
        const int32_t k = s->unknown[3 * node + (size_t)i];
        if (k >= 0) along += gsl_vector_get(u, (size_t)k) * d[i] / 3;
      }
    strain += along * vsc_dot(area, d) / s->model->total_volume;
  }
  gsl_vector_free(u);
  return 1 / strain;
}

void vsc_sample_close(vsc_sample *s)
{
  if (s == NULL) return;
  gsl_matrix_free(s->stiffness);
  vsc_free(s->unknown);
  vsc_free(s->number);
  vsc_surface_free(&s->boundary);
  vsc_state_free(s->state);
  vsc_model_free(s->model);
  vsc_mesh_free(s->mesh);
  vsc_free(s);
}
