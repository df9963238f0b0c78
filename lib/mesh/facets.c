// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/facets.h"

#include <string.h>

#include "base/mem.h"

void vsc_facets_of_halves(const uint32_t halves[6], uint32_t facets[4][3])
{
  static const int cuts[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};
  const uint32_t corner[4] = {halves[0], halves[1], halves[2], halves[5]};
  for (int k = 0; k < 4; k++)
    for (int i = 0; i < 3; i++) facets[k][i] = corner[cuts[k][i]];
}

static bool is_paired(const vsc_surface *surface, size_t t)
{
  return surface->paired != NULL && surface->paired[t];
}

static void fill(const vsc_surface *surface, vsc_facets *facets)
{
  uint32_t *whole = facets->corners, *half = whole + 3 * facets->whole;
  for (size_t t = 0; t < surface->count; t++) {
    const uint32_t *triangle = surface->triangles + 3 * t;
    if (is_paired(surface, t)) {
      uint32_t four[4][3];
      vsc_facets_of_halves(triangle, four);
      memcpy(half, four, sizeof four);
      half += 12;
      t++;
    } else {
      memcpy(whole, triangle, 3 * sizeof *whole);
      whole += 3;
    }
  }
  if (facets->mid != NULL) memcpy(facets->mid, surface->mid, 3 * surface->count * sizeof *facets->mid);
}

vsc_status vsc_facets_make(const vsc_surface *surface, vsc_facets *facets, vsc_error *error)
{
  size_t pairs = 0;
  for (size_t t = 0; t < surface->count; t++) pairs += is_paired(surface, t);
  *facets = (vsc_facets){.count = surface->count + 2 * pairs, .whole = surface->count - 2 * pairs};
  if (!VSC_NEW(facets->corners, 3 * facets->count) ||
      (surface->mid != NULL && !VSC_NEW(facets->mid, 3 * facets->count))) {
    vsc_facets_free(facets);
    return vsc_fail_memory(error, "a surface");
  }
  fill(surface, facets);
  return VSC_OK;
}

void vsc_facets_renumber(vsc_facets *facets, const uint32_t *number)
{
  for (size_t k = 0; k < 3 * facets->count; k++) {
    facets->corners[k] = number[facets->corners[k]];
    if (facets->mid != NULL) facets->mid[k] = number[facets->mid[k]];
  }
}

void vsc_facets_free(vsc_facets *facets)
{
  vsc_free(facets->corners);
  vsc_free(facets->mid);
  *facets = (vsc_facets){0};
}
