// SPDX-License-Identifier: GPL-3.0-or-later
// Filling elements without a fibre from their neighbours, ring by ring.
#include <stdbool.h>

#include "base/mem.h"
#include "fibers/sample.h"
#include "mesh/topology.h"

// The mean frame of the known neighbours of an element; false when it has none.
static bool mean_of_neighbours(const vsc_axes *axes, const int32_t neighbours[VSC_MOST_FACES],
                               double frame[9])
{
  double fibers[6] = {0}, sheets[6] = {0}, fiber[3], sheet[3];
  for (int i = 0; i < VSC_MOST_FACES; i++) {
    if (neighbours[i] < 0 || !axes->known[neighbours[i]]) continue;
    for (int q = 0; q < axes->points; q++) {
      const double *f = vsc_axes_frame(axes, (size_t)neighbours[i], q);
      vsc_add_square(f, 1, fibers);
      vsc_add_square(f + 3, 1, sheets);
    }
  }
  if (!vsc_top_axis(fibers, fiber, NULL) || !vsc_top_axis(sheets, sheet, NULL)) return false;
  return vsc_axes_complete(fiber, sheet, frame) != 0;
}

static bool touches_known(const vsc_axes *axes, const int32_t neighbours[VSC_MOST_FACES])
{
  for (int i = 0; i < VSC_MOST_FACES; i++)
    if (neighbours[i] >= 0 && axes->known[neighbours[i]]) return true;
  return false;
}

// Lists in `ring` those elements of `open` that touch a known one and keeps the others in `open`.
static size_t split_ring(const vsc_axes *axes, const vsc_topology *topology, uint32_t *open,
                         size_t *open_count, uint32_t *ring)
{
  size_t kept = 0, found = 0;
  for (size_t k = 0; k < *open_count; k++) {
    const uint32_t e = open[k];
    if (touches_known(axes, topology->neighbours[e]))
      ring[found++] = e;
    else
      open[kept++] = e;
  }
  *open_count = kept;
  return found;
}

vsc_status vsc_fibers_fill(const vsc_mesh *mesh, vsc_axes *axes, size_t *filled, vsc_error *error)
{
  vsc_topology topology = {0};
  uint32_t *open = NULL, *ring = NULL;
  *filled = 0;
  vsc_status status = vsc_topology_make(mesh, &topology, error);
  if (status == VSC_OK && (!VSC_NEW(open, axes->count) || !VSC_NEW(ring, axes->count)))
    status = vsc_fail_memory(error, "filling the fibres");
  size_t open_count = 0, found = 0;
  for (size_t e = 0; status == VSC_OK && e < axes->count; e++)
    if (!axes->known[e]) open[open_count++] = (uint32_t)e;
  while (status == VSC_OK && (found = split_ring(axes, &topology, open, &open_count, ring)) > 0) {
    for (size_t k = 0; k < found; k++)
      for (int q = 0; q < axes->points; q++)
        mean_of_neighbours(axes, topology.neighbours[ring[k]], vsc_axes_frame(axes, ring[k], q));
    for (size_t k = 0; k < found; k++) axes->known[ring[k]] = 1;
    *filled += found;
  }
  vsc_topology_free(&topology);
  vsc_free(open);
  vsc_free(ring);
  return status;
}
