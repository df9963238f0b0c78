// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/topology.h"

#include <stdbool.h>

#include "base/mem.h"

static void list_node_elements(const vsc_mesh *mesh, vsc_topology *topology)
{
  const size_t corners = mesh->start[mesh->element_count];
  size_t *start = topology->node_start;
  for (size_t i = 0; i < corners; i++) start[mesh->corners[i] + 1]++;
  for (size_t i = 0; i < mesh->node_count; i++) start[i + 1] += start[i];
  for (size_t e = mesh->element_count; e-- > 0;)
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
      topology->node_elements[--start[mesh->corners[i] + 1]] = (uint32_t)e;
  // Filling from behind left in start[node + 1] where the list of `node` begins.
  for (size_t i = 0; i < mesh->node_count; i++) start[i] = start[i + 1];
  start[mesh->node_count] = corners;
}

// The nodes of a face.
typedef struct face {
  int count;
  uint32_t nodes[4];
} face;

static face face_of(const vsc_mesh *mesh, size_t element, int number)
{
  const int *at = vsc_mesh_kind(mesh, element)->faces[number];
  face f = {.count = at[3] < 0 ? 3 : 4};
  for (int i = 0; i < f.count; i++) f.nodes[i] = vsc_mesh_corners(mesh, element)[at[i]];
  return f;
}

// Corners of a face of a kind as a set of bits.
static unsigned face_corners(const vsc_cell_kind *kind, int number)
{
  unsigned set = 0;
  for (int i = 0; i < 4; i++)
    if (kind->faces[number][i] >= 0) set |= 1u << kind->faces[number][i];
  return set;
}

// How many corners the face of `element` has whose corners are just those that it shares with `f`;
// 0 when there is no such face.
static int common_face(const vsc_mesh *mesh, size_t element, const face *f)
{
  const vsc_cell_kind *kind = vsc_mesh_kind(mesh, element);
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  unsigned shared = 0;
  int count = 0;
  for (int i = 0; i < kind->corners; i++)
    for (int k = 0; k < f->count; k++)
      if (corner[i] == f->nodes[k]) {
        shared |= 1u << i;
        count++;
      }
  if (count < 3) return 0;
  for (int number = 0; number < kind->face_count; number++)
    if (face_corners(kind, number) == shared) return count;
  return 0;
}

// Finds the next element after `element`, in cyclic order, with the same face; says how many there
// are.
static int32_t across(const vsc_mesh *mesh, const vsc_topology *topology, size_t element,
                      const face *f, int *sharing)
{
  const size_t *start = topology->node_start;
  uint32_t node = f->nodes[0];
  for (int i = 1; i < f->count; i++)
    if (start[f->nodes[i] + 1] - start[f->nodes[i]] < start[node + 1] - start[node])
      node = f->nodes[i];
  int32_t first = VSC_OUTSIDE, after = VSC_OUTSIDE;
  *sharing = 0;
  for (size_t k = start[node]; k < start[node + 1]; k++) {
    const uint32_t other = topology->node_elements[k];
    if (common_face(mesh, other, f) != f->count) continue;
    (*sharing)++;
    if (other == element) continue;
    if (first < 0) first = (int32_t)other;
    if (after < 0 && other > element) after = (int32_t)other;
  }
  return after >= 0 ? after : first;
}

// Whether a triangle of another element lies on a quadrilateral face: on any two opposite corners
// of it, one is the triangle's.
static bool is_split(const vsc_mesh *mesh, const vsc_topology *topology, const face *f)
{
  for (int i = 0; i < 3; i += 2)
    for (size_t k = topology->node_start[f->nodes[i]]; k < topology->node_start[f->nodes[i] + 1];
         k++)
      if (common_face(mesh, topology->node_elements[k], f) == 3) return true;
  return false;
}

static void find_neighbours(const vsc_mesh *mesh, vsc_topology *topology)
{
  size_t crowded = 0;
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int i = 0; i < VSC_MOST_FACES; i++) {
      int32_t *other = &topology->neighbours[e][i];
      *other = VSC_OUTSIDE;
      if (i >= vsc_mesh_kind(mesh, e)->face_count) continue;
      const face f = face_of(mesh, e, i);
      int sharing;
      *other = across(mesh, topology, e, &f, &sharing);
      if (*other < 0 && f.count == 4 && is_split(mesh, topology, &f)) *other = VSC_SPLIT;
      // Counted once, by the element from which the cycle starts again at a smaller number.
      if (sharing > 2 && *other < (int32_t)e) crowded++;
    }
  topology->crowded_faces = crowded;
}

vsc_status vsc_topology_make(const vsc_mesh *mesh, vsc_topology *topology, vsc_error *error)
{
  *topology = (vsc_topology){.node_count = mesh->node_count, .element_count = mesh->element_count};
  if (!VSC_NEW(topology->node_start, mesh->node_count + 1) ||
      !VSC_NEW(topology->node_elements, mesh->start[mesh->element_count]) ||
      !VSC_NEW(topology->neighbours, mesh->element_count)) {
    vsc_topology_free(topology);
    return vsc_fail_memory(error, "the mesh's topology");
  }
  list_node_elements(mesh, topology);
  find_neighbours(mesh, topology);
  return VSC_OK;
}

void vsc_topology_free(vsc_topology *topology)
{
  vsc_free(topology->node_start);
  vsc_free(topology->node_elements);
  vsc_free(topology->neighbours);
  *topology = (vsc_topology){0};
}
