// SPDX-License-Identifier: GPL-3.0-or-later
// The triangles over which integrals over a surface are summed.
#ifndef VSC_MESH_FACETS_H
#define VSC_MESH_FACETS_H

#include "mesh/select.h"

// Facets of a surface: its triangles; but of a quadrilateral face the four triangles of both its cuts, which
// count half. What a flux through the face, uniform over it, gives its nodes, and the volume under it,
// are then those of the bilinear face, bent ones too: no corner is favoured.
typedef struct vsc_facets {
  size_t count;
  size_t whole;       // facets whole, whole + 1, ... count half, those before them whole
  uint32_t *corners;  // count x 3, turned as the surface is; owned
  uint32_t *mid;      // count x 3: the middles of edges 01, 12, 20, or NULL; owned
} vsc_facets;

// Lists the facets of `surface`, in its order where it has no quadrilateral faces. VSC_SYSTEM when memory is
// short. The content of `facets` is owned by the caller.
vsc_status vsc_facets_make(const vsc_surface *surface, vsc_facets *facets, vsc_error *error);

// How much facet `k` counts: 1 or 1/2.
static inline double vsc_facet_weight(const vsc_facets *facets, size_t k)
{
  return k < facets->whole ? 1 : 0.5;
}

// The four facets of the quadrilateral that is cut into the two triangles `halves` (see vsc_surface).
void vsc_facets_of_halves(const uint32_t halves[6], uint32_t facets[4][3]);

// Node i becomes node number[i].
void vsc_facets_renumber(vsc_facets *facets, const uint32_t *number);

// Frees the content; a zeroed one is fine.
void vsc_facets_free(vsc_facets *facets);

#endif
