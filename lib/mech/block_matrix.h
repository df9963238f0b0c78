// SPDX-License-Identifier: GPL-3.0-or-later
// A symmetric sparse matrix of 3 x 3 blocks, one block row and column a node; only blocks (i, j) with
// i >= j are stored.
#ifndef VSC_MECH_BLOCK_MATRIX_H
#define VSC_MECH_BLOCK_MATRIX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Numbers are kept as a compressed-column matrix of 3 node_count unknowns wants them: block k of
// column j, the (k - start[j])th of its `n` blocks, has entry (r, c) at
// values[9 start[j] + 3 n c + 3 (k - start[j]) + r]. The first block of each column is the diagonal
// one; it is stored whole.
typedef struct vsc_block_matrix {
  size_t node_count;
  size_t *start;   // node_count + 1: column j has the blocks start[j] .. start[j + 1] - 1; owned
  uint32_t *row;   // of each block, ascending in each column; owned
  double *values;  // 9 for each block; owned
} vsc_block_matrix;

// The matrix of zeros with a block for each pair of nodes that some group joins: group g has the nodes
// nodes[group[g]] .. nodes[group[g + 1] - 1]. False when memory is short.
bool vsc_block_matrix_create(size_t node_count, size_t group_count, const size_t *group,
                             const uint32_t *nodes, vsc_block_matrix *matrix);

void vsc_block_matrix_free(vsc_block_matrix *matrix);  // the content

void vsc_block_matrix_clear(vsc_block_matrix *matrix);

// The number of block (i, j), i >= j, which must be there.
size_t vsc_block_matrix_find(const vsc_block_matrix *matrix, uint32_t i, uint32_t j);

// The place of the block's entry (0, 0), and the distance between its columns.
static inline double *vsc_block_at(const vsc_block_matrix *matrix, size_t column, size_t block,
                                   size_t *stride)
{
  const size_t first = matrix->start[column];
  *stride = 3 * (matrix->start[column + 1] - first);
  return matrix->values + 9 * first + 3 * (block - first);
}

// Adds factor times a block (row by row) at (i, j); blocks with i < j are left out: their mirror
// image is the one that counts. So are those that the pattern has not.
void vsc_block_matrix_add(vsc_block_matrix *matrix, uint32_t i, uint32_t j, double factor,
                          const double K[9]);

// y = A x; vectors have four numbers a node, the fourth is not touched. The sums run in an order that
// does not depend on the number of threads.
void vsc_block_matrix_times(const vsc_block_matrix *matrix, const double *x, double *y);

// Rows and columns of the unknowns whose `free` (node_count x 4) is 0 become those of the unit matrix
// times `diagonal`.
void vsc_block_matrix_hold(vsc_block_matrix *matrix, const double *free, double diagonal);

// The largest number of the diagonal among unknowns whose `free` is not 0.
double vsc_block_matrix_largest(const vsc_block_matrix *matrix, const double *free);

#endif
