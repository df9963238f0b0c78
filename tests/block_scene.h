// SPDX-License-Identifier: GPL-3.0-or-later
// A scene that runs in a moment: a small block with a fibre of its own in each element, held at one
// end, contracting. For tests of the program.
#ifndef VSC_TESTS_BLOCK_SCENE_H
#define VSC_TESTS_BLOCK_SCENE_H

#include "io/vtk.h"
#include "mesh/mesh.h"
#include "program.h"
#include "tools/shapes.h"
#include "write_tets.h"

static const char block_scene[] =
    "mesh: {file: block.vtu, unit: mm, region_array: region}\n"
    "surfaces:\n"
    "  - {name: skin, boundary: true}\n"
    "  - {name: end, node_array: x1, value: 1}\n"
    "node_sets:\n"
    "  - {name: left, node_array: x0, value: 1}\n"
    "fibers: {source: arrays, arrays: {fiber: direction}}\n"
    "materials:\n"
    "  - name: muscle\n"
    "    axial: {f: 20 kPa, s: 20 kPa, n: 20 kPa}\n"
    "    angular: {fs: 10 kPa, sn: 10 kPa, nf: 10 kPa}\n"
    "    damping: {f: 5 Pa s, s: 5 Pa s, n: 5 Pa s}\n"
    "    volume_modulus: 500 kPa\n"
    "    stabilization: 10 kPa\n"
    "    active: {kind: tension, tension: 10 kPa, curve: {kind: half_sine, duration: 20 ms}}\n"
    "supports:\n"
    "  - {set: left, held: [x, y, z]}\n"
    "pressures:\n"
    "  - {surface: end, peak: 1 kPa, curve: {kind: ramp, duration: 10 ms}}\n"
    "time: {end: 20 ms}\n"
    "output: {frames: 2 ms, signals: 1 ms, cavities: [skin]}\n";

// A number in [0, n) that is the same everywhere.
static inline uint32_t draw(uint64_t *seed, size_t n)
{
  *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (uint32_t)((*seed >> 33) % n);
}

// A random order of n things.
static inline uint32_t *shuffled(size_t n, uint64_t seed)
{
  uint32_t *order = malloc(n * sizeof *order);
  if (order == NULL) fail_msg("no memory");
  for (size_t k = 0; k < n; k++) order[k] = (uint32_t)k;
  for (size_t k = n; k-- > 1;) {
    const uint32_t other = draw(&seed, k + 1), kept = order[k];
    order[k] = order[other];
    order[other] = kept;
  }
  return order;
}

static inline vsc_mesh *block_for_scene(void)
{
  const vsc_block_shape shape = {
      .cells = {6, 4, 4}, .size = {20, 10, 10}, .tets_per_cell = 5, .jitter = 0.2, .seed = 3};
  vsc_mesh *mesh = NULL;
  if (vsc_block_mesh(&shape, &mesh, NULL) != VSC_OK) fail_msg("no block");
  return mesh;
}

// Writes the block with cell array `direction` (each element its own) to `file` of the folder.
// Place p of the file holds node node_order[p] and element tet_order[p]; with NULL nothing is
// exchanged. Every seventh element of a permuted file is left-handed.
static inline void write_block(const char *file, const uint32_t *node_order,
                               const uint32_t *tet_order)
{
  vsc_mesh *mesh = block_for_scene();
  const size_t nodes = mesh->node_count, tets = mesh->element_count;
  double *x = malloc(3 * nodes * sizeof *x), *fiber = malloc(3 * tets * sizeof *fiber);
  double *face[2] = {malloc(nodes * sizeof(double)), malloc(nodes * sizeof(double))};
  double *region = malloc(tets * sizeof *region);
  uint32_t *corner = malloc(4 * tets * sizeof *corner), *place = malloc(nodes * sizeof *place);
  for (size_t p = 0; p < nodes; p++) {
    const size_t n = node_order ? node_order[p] : p;
    place[n] = (uint32_t)p;
    memcpy(x + 3 * p, mesh->nodes + 3 * n, 3 * sizeof *x);
    for (int a = 0; a < 2; a++)
      face[a][p] = vsc_arrays_find(&mesh->node_data, a ? "x1" : "x0")->values[n];
  }
  for (size_t p = 0; p < tets; p++) {
    const size_t t = tet_order ? tet_order[p] : p;
    for (int c = 0; c < 4; c++) corner[4 * p + c] = place[mesh->corners[4 * t + c]];
    if (tet_order != NULL && p % 7 == 0) {
      const uint32_t kept = corner[4 * p];
      corner[4 * p] = corner[4 * p + 1];
      corner[4 * p + 1] = kept;
    }
    region[p] = 1;
    fiber[3 * p] = 1;
    fiber[3 * p + 1] = 0.2 * sin((double)t);
    fiber[3 * p + 2] = 0.3 * cos((double)t);
  }
  const vsc_vtk_array arrays[] = {{"x0", 1, face[0], VSC_ON_NODES, false},
                                  {"x1", 1, face[1], VSC_ON_NODES, false},
                                  {"region", 1, region, VSC_ON_ELEMENTS, true},
                                  {"direction", 3, fiber, VSC_ON_ELEMENTS, false}};
  if (write_tets(in_folder(file), nodes, x, tets, corner, 0, NULL, 4, arrays, true, NULL) !=
      VSC_OK)
    fail_msg("%s", file);
  free(x);
  free(fiber);
  free(face[0]);
  free(face[1]);
  free(region);
  free(corner);
  free(place);
  vsc_mesh_free(mesh);
}

// Group set-up: the folder with block.vtu and block.yaml.
static inline int block_open(void **state)
{
  if (program_open(state) != 0) return 1;
  write_block("block.vtu", NULL, NULL);
  save_text("block.yaml", block_scene);
  return 0;
}

#endif
