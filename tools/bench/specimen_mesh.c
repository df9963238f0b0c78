// SPDX-License-Identifier: GPL-3.0-or-later
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "io/vtk.h"
#include "mesh/quadratic.h"
#include "run/problem.h"
#include "tools/bench/specimen.h"
#include "tools/shapes_block.h"
#include "tools/shapes_cloud.h"

enum { LARGEST_CLOUD = 12000, SEEDS = 20, FILE_TEXT = 4096 };

// ---- random order

static size_t random_below(size_t count)
{
  return (size_t)(((double)rand() / ((double)RAND_MAX + 1)) * (double)count);
}

static void exchange(void *a, void *b, size_t bytes)
{
  char kept[64];
  memcpy(kept, a, bytes);
  memcpy(a, b, bytes);
  memcpy(b, kept, bytes);
}

// Puts tets and nodes into random order, the same at each call.
static vsc_status shuffle(vsc_mesh *mesh, vsc_error *error)
{
  uint32_t *number, *former;
  const size_t nodes = mesh->node_count;
  if (!VSC_NEW(former, nodes)) return vsc_fail_memory(error, "shuffling");
  if (!VSC_NEW(number, nodes)) {
    vsc_free(former);
    return vsc_fail_memory(error, "shuffling");
  }
  srand(1);
  for (size_t n = 0; n < nodes; n++) former[n] = (uint32_t)n;
  for (size_t n = nodes - 1; n > 0; n--) {
    const size_t other = random_below(n + 1);
    exchange(former + n, former + other, sizeof *former);
    exchange(mesh->nodes + 3 * n, mesh->nodes + 3 * other, 3 * sizeof(double));
  }
  for (size_t n = 0; n < nodes; n++) number[former[n]] = (uint32_t)n;
  for (size_t i = 0; i < 4 * mesh->element_count; i++) mesh->corners[i] = number[mesh->corners[i]];
  for (size_t t = mesh->element_count - 1; t > 0; t--)
    exchange(mesh->corners + 4 * t, mesh->corners + 4 * random_below(t + 1), 4 * sizeof(uint32_t));
  vsc_free(former);
  vsc_free(number);
  return VSC_OK;
}

// ---- a cloud and its mirror images

// A cube of `size` mm with about `tets` tets.
static vsc_status cloud_of(size_t tets, double size, vsc_mesh **mesh, vsc_error *error)
{
  // as many as clouds of 500 to 3000 points have, to 1 %: fewer to each point on the surface
  const double points = 0.1553 * (double)tets + 1.158 * pow((double)tets, 2.0 / 3);
  vsc_cloud_shape shape = {.size = {size, size, size}, .points = (size_t)points};
  if (shape.points < 27) shape.points = 27;
  vsc_status status = VSC_NUMERICAL;
  for (shape.seed = 1; shape.seed <= SEEDS && status == VSC_NUMERICAL; shape.seed++)
    status = vsc_cloud_mesh(&shape, mesh, error);
  return status;
}

// A cloud, and how it is repeated: `copies` times in each direction, every other one mirrored, so that they fit.
typedef struct tiling {
  const vsc_mesh *cloud;
  double size;  // mm
  size_t copies;
  size_t node_count;
  double *nodes;     // x 3
  uint32_t *number;  // copies^3 x the cloud's nodes: theirs among all
  uint32_t *tets;    // copies^3 x the cloud's tets x 4
} tiling;

// Numbers a copy's nodes, of which those on its lower faces are the former copies'.
static void place_copy(tiling *all, const size_t at[3], size_t copy)
{
  const size_t points = all->cloud->node_count, step[3] = {1, all->copies, all->copies * all->copies};
  uint32_t *number = all->number + copy * points;
  for (size_t p = 0; p < points; p++) {
    const double *x = all->cloud->nodes + 3 * p;
    size_t former = copy;
    for (int a = 0; a < 3; a++)
      if (at[a] > 0 && x[a] == (at[a] % 2 == 0 ? 0 : all->size)) former = copy - step[a];
    number[p] = former < copy ? all->number[former * points + p] : (uint32_t)all->node_count;
    if (former < copy) continue;
    double *to = all->nodes + 3 * all->node_count++;
    for (int a = 0; a < 3; a++)
      to[a] = at[a] % 2 == 0 ? (double)at[a] * all->size + x[a] : (double)(at[a] + 1) * all->size - x[a];
  }
}

static void place_tets(tiling *all, const size_t at[3], size_t copy)
{
  const size_t count = all->cloud->element_count;
  const bool mirrored = (at[0] + at[1] + at[2]) % 2 == 1;
  for (size_t t = 0; t < count; t++) {
    uint32_t *tet = all->tets + 4 * (copy * count + t);
    for (size_t c = 0; c < 4; c++)
      tet[c] = all->number[copy * all->cloud->node_count + all->cloud->corners[4 * t + c]];
    if (mirrored) exchange(tet + 2, tet + 3, sizeof *tet);
  }
}

static vsc_status tile(const vsc_mesh *cloud, double size, size_t copies, vsc_mesh **mesh, vsc_error *error)
{
  tiling all = {.cloud = cloud, .size = size, .copies = copies};
  const size_t count = copies * copies * copies;
  vsc_status status = VSC_OK;
  if (VSC_NEW(all.nodes, 3 * count * cloud->node_count) && VSC_NEW(all.number, count * cloud->node_count) &&
      VSC_NEW(all.tets, 4 * count * cloud->element_count)) {
    for (size_t copy = 0; copy < count; copy++) {
      const size_t at[3] = {copy % copies, copy / copies % copies, copy / copies / copies};
      place_copy(&all, at, copy);
      place_tets(&all, at, copy);
    }
    vsc_free(all.number);
    all.number = NULL;
    status = vsc_mesh_from_arrays(all.node_count, all.nodes, count * cloud->element_count, all.tets, mesh, error);
  } else {
    status = vsc_fail_memory(error, "an unstructured block");
  }
  vsc_free(all.nodes);
  vsc_free(all.number);
  vsc_free(all.tets);
  return status;
}

static vsc_status make_cloud(size_t elements, vsc_mesh **mesh, vsc_error *error)
{
  size_t copies = 1;
  while (copies * copies * copies * LARGEST_CLOUD < elements) copies++;
  const size_t tets = elements / (copies * copies * copies);
  const double size = fmax(1, round(cbrt((double)tets / 5)));
  vsc_mesh *cloud = NULL;
  vsc_status status = cloud_of(tets, size, &cloud, error);
  if (status == VSC_OK) status = tile(cloud, size, copies, mesh, error);
  vsc_mesh_free(cloud);
  if (status == VSC_OK) status = shuffle(*mesh, error);
  return status;
}

// Writes the mesh to a file and reads it again.
static vsc_status by_way_of_a_file(vsc_mesh **mesh, double *read, vsc_error *error)
{
  char file[FILE_TEXT];
  const char *folder = getenv("TMPDIR");
  snprintf(file, sizeof file, "%s/viscera-bench-XXXXXX.vtu", folder != NULL ? folder : "/tmp");
  const int made = mkstemps(file, (int)strlen(".vtu"));
  if (made < 0) return vsc_fail(error, VSC_SYSTEM, "%s: cannot be made; name another folder by TMPDIR", file);
  close(made);
  vsc_status status = vsc_vtk_write_mesh(file, *mesh, 0, NULL, true, error);
  vsc_mesh_free(*mesh);
  *mesh = NULL;
  const double start = vsc_cpu_seconds();
  if (status == VSC_OK) status = vsc_vtk_read_mesh(file, 1, mesh, error);
  *read = vsc_cpu_seconds() - start;
  unlink(file);
  return status;
}

vsc_status vsc_specimen_mesh(vsc_specimen_kind kind, size_t elements, vsc_mesh **mesh, double *read,
                             vsc_error *error)
{
  *mesh = NULL;
  *read = NAN;
  if (kind == VSC_SPECIMEN_CLOUD) {
    const vsc_status status = make_cloud(elements, mesh, error);
    return status == VSC_OK ? by_way_of_a_file(mesh, read, error) : status;
  }
  vsc_block_shape shape = vsc_block_default();
  const bool hexes = kind == VSC_SPECIMEN_HEXES;
  size_t cells = 1;
  while ((hexes ? 1 : 5) * cells * cells * cells < elements) cells++;
  for (int i = 0; i < 3; i++) {
    shape.cells[i] = cells;
    shape.size[i] = (double)cells;
  }
  vsc_status status = vsc_block_of(&shape, hexes ? VSC_BLOCK_HEXES : VSC_BLOCK_TETS, mesh, error);
  if (status == VSC_OK && kind == VSC_SPECIMEN_QUADRATIC) status = vsc_mesh_raise(mesh, "the block", error);
  return status;
}
