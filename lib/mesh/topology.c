// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/topology.h"

#include <stdbool.h>

#include "base/mem.h"

const int vsc_tet_faces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

static void list_node_tets(const vsc_mesh *mesh, vsc_topology *topology)
{
  size_t *start = topology->node_start;
  for (size_t i = 0; i < 4 * mesh->element_count; i++) start[mesh->corners[i] + 1]++;
  for (size_t i = 0; i < mesh->node_count; i++) start[i + 1] += start[i];
  for (size_t t = mesh->element_count; t-- > 0;)
    for (int i = 0; i < 4; i++) {
      const uint32_t node = mesh->corners[4 * t + i];
      topology->node_elements[--start[node + 1]] = (uint32_t)t;
    }
  // Filling from behind left in start[node + 1] where the list of `node` begins.
  for (size_t i = 0; i < mesh->node_count; i++) start[i] = start[i + 1];
  start[mesh->node_count] = 4 * mesh->element_count;
}

// The corner of `tet` opposite the face with the given nodes, or -1 when it has no such face.
static int opposite_corner(const uint32_t tet[4], const uint32_t face[3])
{
  int opposite = -1;
  for (int i = 0; i < 4; i++) {
    if (tet[i] == face[0] || tet[i] == face[1] || tet[i] == face[2]) continue;
    if (opposite >= 0) return -1;
    opposite = i;
  }
  return opposite;
}

// Finds the next tet after `tet`, in cyclic order, with the same face; says how many there are.
static int32_t across(const vsc_mesh *mesh, const vsc_topology *topology, size_t tet, int corner,
                      int *sharing)
{
  uint32_t face[3];
  for (int i = 0; i < 3; i++) face[i] = mesh->corners[4 * tet + vsc_tet_faces[corner][i]];
  uint32_t node = face[0];
  for (int i = 1; i < 3; i++) {
    const size_t *start = topology->node_start;
    if (start[face[i] + 1] - start[face[i]] < start[node + 1] - start[node]) node = face[i];
  }
  int32_t first = -1, after = -1;
  *sharing = 0;
  for (size_t k = topology->node_start[node]; k < topology->node_start[node + 1]; k++) {
    const uint32_t other = topology->node_elements[k];
    if (opposite_corner(mesh->corners + 4 * (size_t)other, face) < 0) continue;
    (*sharing)++;
    if (other == tet) continue;
    if (first < 0) first = (int32_t)other;
    if (after < 0 && other > tet) after = (int32_t)other;
  }
  return after >= 0 ? after : first;
}

static void find_neighbours(const vsc_mesh *mesh, vsc_topology *topology)
{
  size_t crowded = 0;
  for (size_t t = 0; t < mesh->element_count; t++)
    for (int i = 0; i < 4; i++) {
      int sharing;
      const int32_t other = across(mesh, topology, t, i, &sharing);
      topology->neighbours[t][i] = other;
      // Counted once, by the tet from which the cycle starts again at a smaller number.
      if (sharing > 2 && other < (int32_t)t) crowded++;
    }
  topology->crowded_faces = crowded;
}

vsc_status vsc_topology_make(const vsc_mesh *mesh, vsc_topology *topology, vsc_error *error)
{
  *topology = (vsc_topology){.node_count = mesh->node_count, .element_count = mesh->element_count};
  if (!VSC_NEW(topology->node_start, mesh->node_count + 1) ||
      !VSC_NEW(topology->node_elements, 4 * mesh->element_count) ||
      !VSC_NEW(topology->neighbours, mesh->element_count)) {
    vsc_topology_free(topology);
    return vsc_fail_memory(error, "the mesh's topology");
  }
  list_node_tets(mesh, topology);
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
