// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/mass_matrix.h"

#include <string.h>

#include "base/mem.h"
#include "mech/tangent.h"
#include "model/masses.h"

// int N_i N_j dV of corners i, j of the element or triangle in lane l of a pack.
static double element_mass(const vsc_model *model, const vsc_patch *patch, size_t k, int i, int j, int l)
{
  if (patch->family == VSC_TRIANGLES)
    return vsc_triangles_of(model, patch)[k - patch->first_pack].V[l] * (i == j ? 2 : 1) / 12;
  const vsc_frame *frames = vsc_pack_frames(model, patch, k);
  if (patch->family == VSC_TETS) return frames->V[l] * (i == j ? 0.1 : 0.05);
  const vsc_cell_rule *rule = &model->rules[patch->family];
  double sum = 0;
  if (patch->family == VSC_TETS10) {
    for (int q = 0; q < rule->points; q++) sum += frames[q].V[l];
    return sum * vsc_quadratic_mass(i, j);
  }
  for (int q = 0; q < rule->points; q++) sum += frames[q].V[l] * rule->N[q][i] * rule->N[q][j];
  return sum;
}

// Takes rho int N_i N_j dV of nodes a and b of the model, i >= j.
typedef void mass_sink(void *context, uint32_t a, uint32_t b, double mass);

static void for_masses(const vsc_model *model, mass_sink *sink, void *context)
{
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    const bool triangles = patch->family == VSC_TRIANGLES;
    if (!vsc_patch_is_solid(patch) && !triangles) continue;
    const double density =
        triangles ? model->membranes[patch->material].density : model->materials[patch->material].density;
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      for (int l = 0; l < VSC_WIDTH; l++) {
        if (!triangles && model->mesh_element[VSC_WIDTH * k + (size_t)l] == VSC_NO_ELEMENT) continue;
        const uint16_t(*node)[VSC_WIDTH] = vsc_pack_nodes(model, patch, k);
        for (int i = 0; i < vsc_family_corners(patch->family); i++)
          for (int j = 0; j <= i; j++) {
            const uint32_t a = vsc_node_of(model, patch, node[i][l]);
            const uint32_t b = vsc_node_of(model, patch, node[j][l]);
            sink(context, a, b, density * element_mass(model, patch, k, i, j, l));
          }
      }
  }
}

typedef struct entries_sum {
  const vsc_block_matrix *pattern;
  double *entries;
} entries_sum;

static void add_entry(void *context, uint32_t a, uint32_t b, double mass)
{
  const entries_sum *sum = context;
  sum->entries[vsc_block_matrix_find(sum->pattern, a > b ? a : b, a > b ? b : a)] += mass;
}

bool vsc_mass_matrix(const vsc_model *model, const vsc_block_matrix *pattern, double **entries)
{
  if (!VSC_NEW(*entries, pattern->start[model->node_count])) return false;
  entries_sum sum = {pattern, *entries};
  for_masses(model, add_entry, &sum);
  return true;
}

typedef struct product {
  const double *v;
  double *y;
} product;

static void add_product(void *context, uint32_t a, uint32_t b, double mass)
{
  const product *p = context;
  for (size_t i = 0; i < 3; i++) {
    p->y[4 * (size_t)a + i] += mass * p->v[4 * (size_t)b + i];
    if (a != b) p->y[4 * (size_t)b + i] += mass * p->v[4 * (size_t)a + i];
  }
}

void vsc_consistent_masses_times(const vsc_model *model, const double *v, double *y)
{
  product p = {v, y};
  memset(y, 0, 4 * model->node_count * sizeof *y);
  for_masses(model, add_product, &p);
}

void vsc_tangent_add_masses(const vsc_model *model, vsc_tangent *tangent, double factor)
{
  const vsc_block_matrix *matrix = &tangent->matrix;
  for (size_t n = 0; n < model->node_count; n++)
    for (size_t k = matrix->start[n]; k < matrix->start[n + 1]; k++) {
      size_t stride;
      double *block = vsc_block_at(matrix, n, k, &stride);
      const double mass = tangent->masses != NULL ? tangent->masses[k]
                          : matrix->row[k] == n   ? model->mass[n]
                                                  : 0;
      for (size_t i = 0; i < 3; i++) block[stride * i + i] += factor * mass;
    }
}

void vsc_tangent_masses_times(const vsc_model *model, const vsc_tangent *tangent, double factor,
                              const double *a, double *y)
{
  const vsc_block_matrix *matrix = &tangent->matrix;
  for (size_t n = 0; n < model->node_count; n++) {
    if (tangent->masses == NULL) {
      for (size_t i = 4 * n; i < 4 * n + 3; i++) y[i] += factor * model->mass[n] * a[i];
      continue;
    }
    for (size_t k = matrix->start[n]; k < matrix->start[n + 1]; k++) {
      const size_t m = matrix->row[k];
      const double mass = factor * tangent->masses[k];
      for (size_t i = 0; i < 3; i++) {
        y[4 * n + i] += mass * a[4 * m + i];
        if (m != n) y[4 * m + i] += mass * a[4 * n + i];
      }
    }
  }
}
