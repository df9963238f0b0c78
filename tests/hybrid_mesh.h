// SPDX-License-Identifier: GPL-3.0-or-later
// A block of bricks that are whole, cut into wedges, pyramids or tets, sharing nodes, for tests.
#ifndef VSC_TESTS_HYBRID_MESH_H
#define VSC_TESTS_HYBRID_MESH_H

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "mesh/mesh.h"
#include "random.h"

// What becomes of a brick. All cuts of a face between bricks run from its lowest corner to its
// highest, so that two bricks fit wherever both cut their common face or neither does; a starred
// one fits everywhere.
typedef enum hybrid_cut {
  HYBRID_WHOLE,   // a hexahedron
  HYBRID_HALVED,  // two wedges; the faces across z are cut
  HYBRID_TETS,    // six tets (Kuhn's); all faces are cut
  HYBRID_STAR,    // round the centre: a pyramid on each whole face, two tets on each cut one
  HYBRID_CUTS,
} hybrid_cut;

typedef struct hybrid_builder {
  size_t n;
  hybrid_cut *cuts;  // n^3
  size_t count;
  uint8_t *kinds;
  uint32_t (*corners)[VSC_MOST_CORNERS];
} hybrid_builder;

static inline uint32_t hybrid_node(size_t n, const size_t at[3])
{
  return (uint32_t)(at[0] + (n + 1) * (at[1] + (n + 1) * at[2]));
}

// 1: the faces across `axis` are cut, 0: whole, -1: as the neighbour wishes.
static inline int hybrid_wish(hybrid_cut cut, int axis)
{
  if (cut == HYBRID_STAR) return -1;
  return cut == HYBRID_TETS || (cut == HYBRID_HALVED && axis == 2);
}

// The brick beside brick `b` along `axis` (side 1 or -1), or -1.
static inline long hybrid_beside(size_t n, size_t b, int axis, int side)
{
  const size_t stride = axis == 0 ? 1 : axis == 1 ? n : n * n;
  const size_t place = b / stride % n;
  if (side < 0) return place == 0 ? -1 : (long)(b - stride);
  return place + 1 == n ? -1 : (long)(b + stride);
}

static inline void hybrid_set(hybrid_builder *h, const uint8_t *done, size_t b, hybrid_cut cut)
{
  h->cuts[b] = cut;
  for (int face = 0; face < 6; face++) {
    const long other = hybrid_beside(h->n, b, face / 2, face % 2 ? 1 : -1);
    if (other < 0 || !done[other]) continue;
    const int theirs = hybrid_wish(h->cuts[other], face / 2), ours = hybrid_wish(cut, face / 2);
    if (theirs >= 0 && ours >= 0 && theirs != ours) h->cuts[b] = HYBRID_STAR;
  }
}

// The first four bricks that touch no other of them get one kind each; then chance decides.
static inline void hybrid_choose(hybrid_builder *h, uint64_t *seed)
{
  const size_t n = h->n, bricks = n * n * n;
  const size_t fixed[4] = {0, 1 + n, 1 + n * n, n + n * n};
  uint8_t *done;
  if (!VSC_NEW(done, bricks)) abort();
  for (size_t c = 0; c < 4 && (c == 0 || n > 1); c++) {
    h->cuts[fixed[c]] = (hybrid_cut)c;
    done[fixed[c]] = 1;
  }
  for (size_t b = 0; b < bricks; b++) {
    if (done[b]) continue;
    hybrid_set(h, done, b, (hybrid_cut)(HYBRID_CUTS * random_part(seed)));
    done[b] = 1;
  }
  vsc_free(done);
}

static inline void hybrid_add(hybrid_builder *h, vsc_cell kind, const uint32_t *brick,
                              const int *corners)
{
  h->kinds[h->count] = (uint8_t)kind;
  for (int i = 0; i < vsc_cells[kind].corners; i++) h->corners[h->count][i] = brick[corners[i]];
  h->count++;
}

// One face of a starred brick, whose centre is brick[8].
static inline void hybrid_add_face(hybrid_builder *h, const uint32_t brick[9], int face, bool cut)
{
  int v[4], low = 0;
  for (int i = 1; i < 4; i++)
    if (brick[vsc_cells[VSC_HEX].faces[face][i]] < brick[vsc_cells[VSC_HEX].faces[face][low]])
      low = i;
  for (int i = 0; i < 4; i++) v[i] = vsc_cells[VSC_HEX].faces[face][(low + i) % 4];
  if (cut) {
    hybrid_add(h, VSC_TET, brick, (int[]){v[0], v[2], v[1], 8});
    hybrid_add(h, VSC_TET, brick, (int[]){v[0], v[3], v[2], 8});
  } else {
    hybrid_add(h, VSC_PYRAMID, brick, (int[]){v[0], v[3], v[2], v[1], 8});
  }
}

static inline void hybrid_add_brick(hybrid_builder *h, size_t b, const uint32_t brick[9])
{
  static const int tets[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                 {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  static const int halves[2][6] = {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}};
  static const int whole[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  switch (h->cuts[b]) {
    case HYBRID_WHOLE:
      hybrid_add(h, VSC_HEX, brick, whole);
      return;
    case HYBRID_HALVED:
      for (int i = 0; i < 2; i++) hybrid_add(h, VSC_WEDGE, brick, halves[i]);
      return;
    case HYBRID_TETS:
      for (int i = 0; i < 6; i++) hybrid_add(h, VSC_TET, brick, tets[i]);
      return;
    default:
      break;
  }
  for (int face = 0; face < 6; face++) {
    const long other = hybrid_beside(h->n, b, face / 2, face % 2 ? 1 : -1);
    hybrid_add_face(h, brick, face, other >= 0 && hybrid_wish(h->cuts[other], face / 2) == 1);
  }
}

// Node numbers of a brick: its eight corners and `centre`.
static inline void hybrid_brick(size_t n, size_t b, uint32_t centre, uint32_t brick[9])
{
  static const size_t corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                      {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (int i = 0; i < 8; i++) {
    const size_t at[3] = {b % n + corner[i][0], b / n % n + corner[i][1], b / n / n + corner[i][2]};
    brick[i] = hybrid_node(n, at);
  }
  brick[8] = centre;
}

// Where node `node` of the grid lies: nodes on the block's faces and edges stay on them.
static inline void hybrid_place(size_t n, size_t node, double jitter, uint64_t *seed, double *x)
{
  const size_t at[3] = {node % (n + 1), node / (n + 1) % (n + 1), node / (n + 1) / (n + 1)};
  for (int k = 0; k < 3; k++) {
    const double shift = random_between(seed, -jitter, jitter);
    x[k] = (double)at[k] + (at[k] == 0 || at[k] == n ? 0 : shift);
  }
}

// The mesh of the bricks, cut as h->cuts says; takes what `h` owns.
static inline vsc_mesh *hybrid_build(hybrid_builder *h, double jitter, uint64_t *seed)
{
  const size_t n = h->n, bricks = n * n * n, grid = (n + 1) * (n + 1) * (n + 1);
  size_t nodes = grid;
  for (size_t b = 0; b < bricks; b++) {
    uint32_t brick[9];
    hybrid_brick(n, b, (uint32_t)nodes, brick);
    hybrid_add_brick(h, b, brick);
    nodes += h->cuts[b] == HYBRID_STAR;
  }
  vsc_mesh *mesh = vsc_mesh_create_cells(nodes, h->count, h->kinds, 0);
  if (mesh == NULL) abort();
  for (size_t e = 0; e < h->count; e++)
    memcpy(mesh->corners + mesh->start[e], h->corners[e],
           (size_t)vsc_mesh_kind(mesh, e)->corners * sizeof(uint32_t));
  for (size_t i = 0; i < grid; i++) hybrid_place(n, i, jitter, seed, mesh->nodes + 3 * i);
  size_t centre = grid;
  for (size_t b = 0; b < bricks; b++) {
    if (h->cuts[b] != HYBRID_STAR) continue;
    uint32_t brick[9];
    hybrid_brick(n, b, (uint32_t)centre, brick);
    for (int i = 0; i < 8; i++)
      for (int k = 0; k < 3; k++)
        mesh->nodes[3 * centre + (size_t)k] += mesh->nodes[3 * (size_t)brick[i] + (size_t)k] / 8;
    centre++;
  }
  vsc_free(h->cuts);
  vsc_free(h->kinds);
  vsc_free(h->corners);
  return mesh;
}

static inline hybrid_builder hybrid_begin(size_t n)
{
  const size_t bricks = n * n * n;
  hybrid_builder h = {.n = n};
  if (!VSC_NEW(h.cuts, bricks) || !VSC_NEW(h.kinds, 12 * bricks) || !VSC_NEW(h.corners, 12 * bricks)) abort();
  return h;
}

// A cube of n x n x n bricks of 1 mm, [0, n]^3, right-handed and conforming, with elements of all
// four kinds in mixed order when n > 1. Grid nodes move by up to `jitter` (mm, along each axis; 0.2
// keeps all elements sound) within the block's faces and edges, so that those stay plane; which
// brick is cut how, and where nodes go, comes from `seed`, which must not be 0. To be freed with
// vsc_mesh_free.
static inline vsc_mesh *hybrid_block(size_t n, double jitter, uint64_t seed)
{
  hybrid_builder h = hybrid_begin(n);
  hybrid_choose(&h, &seed);
  return hybrid_build(&h, jitter, &seed);
}

// The same with every brick cut alike: hexahedra, wedges, tets, or pyramids alone.
static inline vsc_mesh *hybrid_block_of(size_t n, hybrid_cut cut, double jitter, uint64_t seed)
{
  hybrid_builder h = hybrid_begin(n);
  for (size_t b = 0; b < n * n * n; b++) h.cuts[b] = cut;
  return hybrid_build(&h, jitter, &seed);
}

#endif
