// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/block_matrix.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/sort.h"

// Which groups each node is in: members[at[n]] .. members[at[n + 1] - 1].
static bool list_members(size_t node_count, size_t group_count, const size_t *group,
                         const uint32_t *nodes, size_t **at, uint32_t **members)
{
  *members = NULL;
  if (!VSC_NEW(*at, node_count + 2) || !VSC_NEW(*members, group[group_count] + 1)) return false;
  for (size_t k = 0; k < group[group_count]; k++) (*at)[nodes[k] + 2]++;
  for (size_t n = 2; n <= node_count + 1; n++) (*at)[n] += (*at)[n - 1];
  // at[n + 1] is where node n's next member goes
  for (size_t g = 0; g < group_count; g++)
    for (size_t k = group[g]; k < group[g + 1]; k++) (*members)[(*at)[nodes[k] + 1]++] = (uint32_t)g;
  return true;
}

// The nodes i >= j that share a group with j, into `found`, unsorted; returns how many.
static size_t neighbours(uint32_t j, const size_t *at, const uint32_t *members, const size_t *group,
                         const uint32_t *nodes, uint32_t *mark, uint32_t *found)
{
  size_t count = 0;
  mark[j] = j + 1;
  found[count++] = j;
  for (size_t m = at[j]; m < at[j + 1]; m++)
    for (size_t k = group[members[m]]; k < group[members[m] + 1]; k++) {
      const uint32_t i = nodes[k];
      if (i < j || mark[i] == j + 1) continue;
      mark[i] = j + 1;
      found[count++] = i;
    }
  return count;
}

bool vsc_block_matrix_create(size_t node_count, size_t group_count, const size_t *group,
                             const uint32_t *nodes, vsc_block_matrix *matrix)
{
  *matrix = (vsc_block_matrix){.node_count = node_count};
  size_t *at = NULL;
  uint32_t *members = NULL, *mark = NULL, *found = NULL;
  bool made = list_members(node_count, group_count, group, nodes, &at, &members) &&
              VSC_NEW(mark, node_count) && VSC_NEW(found, node_count) &&
              VSC_NEW(matrix->start, node_count + 1);
  for (uint32_t j = 0; made && j < node_count; j++)
    matrix->start[j + 1] =
        matrix->start[j] + neighbours(j, at, members, group, nodes, mark, found);
  const size_t blocks = made ? matrix->start[node_count] : 0;
  made = made && VSC_NEW(matrix->row, blocks) && VSC_NEW(matrix->values, 9 * blocks);
  if (made) memset(mark, 0, node_count * sizeof *mark);
  for (uint32_t j = 0; made && j < node_count; j++) {
    uint32_t *rows = matrix->row + matrix->start[j];
    const size_t count = neighbours(j, at, members, group, nodes, mark, rows);
    qsort(rows, count, sizeof *rows, vsc_compare_uint32);
  }
  vsc_free(at);
  vsc_free(members);
  vsc_free(mark);
  vsc_free(found);
  if (!made) vsc_block_matrix_free(matrix);
  return made;
}

void vsc_block_matrix_free(vsc_block_matrix *matrix)
{
  vsc_free(matrix->start);
  vsc_free(matrix->row);
  vsc_free(matrix->values);
  *matrix = (vsc_block_matrix){0};
}

void vsc_block_matrix_clear(vsc_block_matrix *matrix)
{
  memset(matrix->values, 0, 9 * matrix->start[matrix->node_count] * sizeof *matrix->values);
}

size_t vsc_block_matrix_find(const vsc_block_matrix *matrix, uint32_t i, uint32_t j)
{
  size_t low = matrix->start[j], high = matrix->start[j + 1];
  while (high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    if (matrix->row[middle] <= i)
      low = middle;
    else
      high = middle;
  }
  return low;
}

void vsc_block_matrix_add(vsc_block_matrix *matrix, uint32_t i, uint32_t j, double factor,
                          const double K[9])
{
  if (i < j) return;
  const size_t place = vsc_block_matrix_find(matrix, i, j);
  if (matrix->row[place] != i) return;
  size_t stride;
  double *block = vsc_block_at(matrix, j, place, &stride);
  for (int c = 0; c < 3; c++)
    for (int r = 0; r < 3; r++) block[stride * (size_t)c + (size_t)r] += factor * K[3 * r + c];
}

void vsc_block_matrix_times(const vsc_block_matrix *matrix, const double *x, double *y)
{
  for (size_t n = 0; n < matrix->node_count; n++) y[4 * n] = y[4 * n + 1] = y[4 * n + 2] = 0;
  for (size_t j = 0; j < matrix->node_count; j++) {
    const size_t first = matrix->start[j], count = matrix->start[j + 1] - first;
    const double *column[3], *own = x + 4 * j;
    for (size_t c = 0; c < 3; c++) column[c] = matrix->values + 9 * first + 3 * count * c;
    double sum[3] = {0, 0, 0};
    // the diagonal block is whole
    for (int r = 0; r < 3; r++)
      y[4 * j + (size_t)r] +=
          column[0][r] * own[0] + column[1][r] * own[1] + column[2][r] * own[2];
    for (size_t k = 1; k < count; k++) {
      double *to = y + 4 * (size_t)matrix->row[first + k];
      const double *other = x + 4 * (size_t)matrix->row[first + k];
      for (size_t r = 0; r < 3; r++) {
        to[r] += column[0][3 * k + r] * own[0] + column[1][3 * k + r] * own[1] +
                 column[2][3 * k + r] * own[2];
        for (int c = 0; c < 3; c++) sum[c] += column[c][3 * k + r] * other[r];
      }
    }
    for (int r = 0; r < 3; r++) y[4 * j + (size_t)r] += sum[r];
  }
}

void vsc_block_matrix_hold(vsc_block_matrix *matrix, const double *free, double diagonal)
{
  for (size_t j = 0; j < matrix->node_count; j++)
    for (size_t k = matrix->start[j]; k < matrix->start[j + 1]; k++) {
      const size_t i = matrix->row[k];
      size_t stride;
      double *block = vsc_block_at(matrix, j, k, &stride);
      for (size_t c = 0; c < 3; c++)
        for (size_t r = 0; r < 3; r++)
          if (free[4 * i + r] == 0 || free[4 * j + c] == 0)
            block[stride * c + r] = i == j && r == c ? diagonal : 0;
    }
}

double vsc_block_matrix_largest(const vsc_block_matrix *matrix, const double *free)
{
  double most = 0;
  for (size_t j = 0; j < matrix->node_count; j++) {
    size_t stride;
    const double *block = vsc_block_at(matrix, j, matrix->start[j], &stride);
    for (size_t r = 0; r < 3; r++)
      if (free[4 * j + r] != 0) most = fmax(most, fabs(block[stride * r + r]));
  }
  return most;
}
