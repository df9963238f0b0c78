// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/robin.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/sort.h"
#include "base/vec3.h"

// The facets, and the sorted list of pairs of nodes (row << 32 | column) of the matrix's blocks.
typedef struct assembly {
  const double *rest;
  const vsc_facets *facets;
  vsc_face_rule rule;
  size_t pair_count;
  uint64_t *pairs;
} assembly;

static void gather(const assembly *a, size_t face, uint32_t node[VSC_FACE_NODES], double x[][3])
{
  const uint32_t *mid = a->facets->mid != NULL ? a->facets->mid + 3 * face : NULL;
  memcpy(node, a->facets->corners + 3 * face, 3 * sizeof *node);
  if (mid != NULL) memcpy(node + 3, mid, 3 * sizeof *node);
  vsc_face_places(node, mid, a->rest, 4, x);
}

static uint64_t pair_of(uint32_t row, uint32_t column)
{
  return (uint64_t)row << 32 | column;
}

static bool list_pairs(assembly *a)
{
  const size_t nodes = (size_t)a->rule.nodes;
  if (!VSC_NEW(a->pairs, a->facets->count * nodes * nodes)) return false;
  for (size_t face = 0; face < a->facets->count; face++) {
    uint32_t node[VSC_FACE_NODES];
    double x[VSC_FACE_NODES][3];
    gather(a, face, node, x);
    for (size_t i = 0; i < nodes; i++)
      for (size_t j = 0; j < nodes; j++) a->pairs[a->pair_count++] = pair_of(node[i], node[j]);
  }
  qsort(a->pairs, a->pair_count, sizeof *a->pairs, vsc_compare_uint64);
  size_t kept = 0;
  for (size_t k = 0; k < a->pair_count; k++)
    if (kept == 0 || a->pairs[kept - 1] != a->pairs[k]) a->pairs[kept++] = a->pairs[k];
  a->pair_count = kept;
  return true;
}

static bool list_rows(const assembly *a, vsc_robin *robin)
{
  size_t rows = 0;
  for (size_t k = 0; k < a->pair_count; k++)
    rows += k == 0 || a->pairs[k] >> 32 != a->pairs[k - 1] >> 32;
  if (!VSC_NEW(robin->nodes, rows) || !VSC_NEW(robin->start, rows + 1) ||
      !VSC_NEW(robin->columns, a->pair_count) || !VSC_NEW(robin->blocks, 12 * a->pair_count))
    return false;
  for (size_t k = 0; k < a->pair_count; k++) {
    if (k == 0 || a->pairs[k] >> 32 != a->pairs[k - 1] >> 32) {
      robin->start[robin->node_count] = (uint32_t)k;
      robin->nodes[robin->node_count++] = (uint32_t)(a->pairs[k] >> 32);
    }
  }
  robin->start[rows] = (uint32_t)a->pair_count;
  for (size_t k = 0; k < a->pair_count; k++) {
    const uint32_t column = (uint32_t)a->pairs[k];
    const uint32_t *row = bsearch(&column, robin->nodes, rows, sizeof column, vsc_compare_uint32);
    robin->columns[k] = (uint32_t)(row - robin->nodes);
  }
  return true;
}

// W_ij of one pair of a face's nodes, row-major: int N_i N_j (1, or N N^T) dA.
static void pair_block(const vsc_face_rule *rule, double normal[][3], bool along_normal, int i,
                       int j, double W[9])
{
  memset(W, 0, 9 * sizeof *W);
  for (int q = 0; q < rule->points; q++) {
    const double area = vsc_norm(normal[q]);
    const double part = rule->weight[q] * rule->N[q][i] * rule->N[q][j];
    for (int r = 0; r < 3 && area > 0; r++)
      for (int c = 0; c < 3; c++)
        W[3 * r + c] += along_normal ? part / area * (normal[q][r] * normal[q][c])
                                     : part * area * (r == c);
  }
}

static void add_block(const assembly *a, uint32_t row, uint32_t column, const double W[9],
                      vsc_robin *robin)
{
  const uint64_t pair = pair_of(row, column);
  const uint64_t *found =
      bsearch(&pair, a->pairs, a->pair_count, sizeof *a->pairs, vsc_compare_uint64);
  double *block = robin->blocks + 12 * (size_t)(found - a->pairs);
  for (int c = 0; c < 3; c++)
    for (int r = 0; r < 3; r++) block[4 * c + r] += W[3 * r + c];
}

static void add_face(const assembly *a, size_t face, vsc_robin *robin)
{
  uint32_t node[VSC_FACE_NODES];
  double x[VSC_FACE_NODES][3], normal[VSC_FACE_POINTS][3];
  const double weight = vsc_facet_weight(a->facets, face);
  gather(a, face, node, x);
  for (int q = 0; q < a->rule.points; q++) {
    double t1[3], t2[3];
    vsc_face_tangents(&a->rule, q, (const double(*)[3])x, t1, t2, normal[q]);
    robin->area += weight * a->rule.weight[q] * vsc_norm(normal[q]);
  }
  for (int i = 0; i < a->rule.nodes; i++)
    for (int j = i; j < a->rule.nodes; j++) {
      double W[9];
      pair_block(&a->rule, normal, robin->normal, i, j, W);
      for (int k = 0; k < 9; k++) W[k] *= weight;
      add_block(a, node[i], node[j], W, robin);
      if (j != i) add_block(a, node[j], node[i], W, robin);
    }
}

vsc_status vsc_robin_fill(const double *rest, const vsc_facets *facets, vsc_robin *robin, vsc_error *error)
{
  assembly a = {.rest = rest,
                .facets = facets,
                .rule = vsc_face_rule_of(facets->mid != NULL ? 6 : 3, VSC_FACE_MASS)};
  const bool listed = list_pairs(&a) && list_rows(&a, robin);
  for (size_t face = 0; face < facets->count && listed; face++) add_face(&a, face, robin);
  vsc_free(a.pairs);
  return listed ? VSC_OK : vsc_fail_memory(error, "springs on a surface");
}

void vsc_robin_free(vsc_robin *robin)
{
  vsc_free(robin->nodes);
  vsc_free(robin->start);
  vsc_free(robin->columns);
  vsc_free(robin->blocks);
}
