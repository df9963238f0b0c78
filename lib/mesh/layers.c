// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/layers.h"

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/surface.h"

// What a node is, as a sum.
enum { OUTER = 1, BESIDE_INNER = 2, OF_INNER_ELEMENT = 4 };

static void mark_boundary(const vsc_surface *boundary, uint8_t *nodes)
{
  for (size_t k = 0; k < 3 * boundary->count; k++) nodes[boundary->triangles[k]] = OUTER;
}

static int outer_corners(const vsc_mesh *mesh, size_t element, const uint8_t *nodes)
{
  int count = 0;
  for (int c = 0; c < vsc_mesh_kind(mesh, element)->vertices; c++)
    count += (nodes[vsc_mesh_corners(mesh, element)[c]] & OUTER) != 0;
  return count;
}

// Tells the corners of each element what it is.
static void mark_inside(const vsc_mesh *mesh, uint8_t *nodes)
{
  for (size_t e = 0; e < mesh->element_count; e++) {
    const int vertices = vsc_mesh_kind(mesh, e)->vertices, outer = outer_corners(mesh, e, nodes);
    const uint8_t mark = (uint8_t)((outer < vertices ? BESIDE_INNER : 0) + (outer == 0 ? OF_INNER_ELEMENT : 0));
    for (int c = 0; c < vertices; c++) nodes[vsc_mesh_corners(mesh, e)[c]] |= mark;
  }
}

static uint8_t flags_of(const vsc_mesh *mesh, size_t element, const uint8_t *nodes)
{
  const int vertices = vsc_mesh_kind(mesh, element)->vertices;
  uint8_t met = 0;
  for (int c = 0; c < vertices; c++) met |= nodes[vsc_mesh_corners(mesh, element)[c]];
  return (uint8_t)((outer_corners(mesh, element, nodes) == vertices ? VSC_ON_SURFACE : 0) +
                   (met & OF_INNER_ELEMENT ? 0 : VSC_FEW_LAYERS) + (met & BESIDE_INNER ? 0 : VSC_ONE_LAYER));
}

vsc_status vsc_mesh_layers(const vsc_mesh *mesh, uint8_t *flags, vsc_error *error)
{
  vsc_surface boundary = {0};
  uint8_t *nodes;
  if (!VSC_NEW(nodes, mesh->node_count)) return vsc_fail_memory(error, "layers of elements");
  const vsc_status status = vsc_boundary(mesh, &boundary, error);
  if (status == VSC_OK) {
    mark_boundary(&boundary, nodes);
    mark_inside(mesh, nodes);
    for (size_t e = 0; e < mesh->element_count; e++) flags[e] = flags_of(mesh, e, nodes);
  }
  vsc_surface_free(&boundary);
  vsc_free(nodes);
  return status;
}

double vsc_mesh_slenderness(const vsc_mesh *mesh)
{
  vsc_surface boundary = {0};
  double low[3], high[3], size[3], volume = 0;
  if (mesh->element_count == 0 || vsc_boundary(mesh, &boundary, NULL) != VSC_OK) return 0;
  const double area = vsc_surface_area(&boundary, mesh->nodes, 3);
  vsc_surface_free(&boundary);
  for (size_t e = 0; e < mesh->element_count; e++) volume += vsc_mesh_element_volume(mesh, e);
  vsc_mesh_box(mesh, low, high);
  vsc_subtract(high, low, size);
  return 0.5 * vsc_norm(size) * area / volume;
}
