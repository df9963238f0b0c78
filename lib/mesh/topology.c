// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/topology.h"

#include <stdbool.h>
#include <stdlib.h>

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

// A face of an element by its nodes, ascending; a triangle has NO_NODE as its last.
typedef struct side {
  uint32_t nodes[4];
  uint32_t element;
  int number;
} side;

#define NO_NODE UINT32_MAX

static side side_of(const vsc_mesh *mesh, uint32_t element, int number)
{
  const int *at = vsc_mesh_kind(mesh, element)->faces[number];
  const uint32_t *corners = vsc_mesh_corners(mesh, element);
  side s = {.nodes = {NO_NODE, NO_NODE, NO_NODE, NO_NODE}, .element = element, .number = number};
  for (int i = 0; i < 4 && at[i] >= 0; i++) {
    const uint32_t node = corners[at[i]];
    int place = i;
    for (; place > 0 && s.nodes[place - 1] > node; place--) s.nodes[place] = s.nodes[place - 1];
    s.nodes[place] = node;
  }
  return s;
}

static int compare_nodes(const side *a, const side *b)
{
  for (int i = 0; i < 4; i++)
    if (a->nodes[i] != b->nodes[i]) return a->nodes[i] < b->nodes[i] ? -1 : 1;
  return 0;
}

static int compare_sides(const void *a, const void *b)
{
  const side *first = a, *second = b;
  const int nodes = compare_nodes(first, second);
  return nodes != 0 ? nodes : (first->element > second->element) - (first->element < second->element);
}

// Whether `node` is the smallest of a face, given as corners of an element with the nodes `corners`.
static bool is_smallest(uint32_t node, const int *at, const uint32_t *corners)
{
  bool present = false;
  for (int i = 0; i < 4 && at[i] >= 0; i++) {
    if (corners[at[i]] < node) return false;
    present |= corners[at[i]] == node;
  }
  return present;
}

// The sides of which `node` is the smallest: every face is listed at one node. `list` has room for all faces
// of the node's elements.
static size_t list_sides(const vsc_mesh *mesh, const vsc_topology *topology, uint32_t node, side *list)
{
  size_t count = 0;
  for (size_t k = topology->node_start[node]; k < topology->node_start[node + 1]; k++) {
    const uint32_t element = topology->node_elements[k];
    const vsc_cell_kind *kind = vsc_mesh_kind(mesh, element);
    const uint32_t *corners = vsc_mesh_corners(mesh, element);
    for (int number = 0; number < kind->face_count; number++)
      if (is_smallest(node, kind->faces[number], corners)) list[count++] = side_of(mesh, element, number);
  }
  return count;
}

static void sort_sides(side *list, size_t count)
{
  enum { FEW = 64 };
  if (count > FEW) {
    qsort(list, count, sizeof *list, compare_sides);
    return;
  }
  for (size_t i = 1; i < count; i++) {
    const side s = list[i];
    size_t place = i;
    for (; place > 0 && compare_sides(&list[place - 1], &s) > 0; place--) list[place] = list[place - 1];
    list[place] = s;
  }
}

// Sides with the same nodes are neighbours, each of the next in a cycle.
static void join_sides(const side *list, size_t count, vsc_topology *topology)
{
  for (size_t first = 0, end; first < count; first = end) {
    for (end = first + 1; end < count && compare_nodes(&list[first], &list[end]) == 0;) end++;
    if (end - first > 2) topology->crowded_faces++;
    for (size_t k = first; end - first > 1 && k < end; k++)
      topology->neighbours[list[k].element][list[k].number] =
          (int32_t)list[k + 1 < end ? k + 1 : first].element;
  }
}

static bool find_neighbours(const vsc_mesh *mesh, vsc_topology *topology)
{
  const size_t *start = topology->node_start;
  size_t most = 0;
  for (size_t n = 0; n < mesh->node_count; n++)
    if (start[n + 1] - start[n] > most) most = start[n + 1] - start[n];
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int i = 0; i < VSC_MOST_FACES; i++) topology->neighbours[e][i] = VSC_OUTSIDE;
  side *list;
  if (!VSC_NEW(list, VSC_MOST_FACES * most)) return false;
  for (size_t n = 0; n < mesh->node_count; n++) {
    const size_t count = list_sides(mesh, topology, (uint32_t)n, list);
    sort_sides(list, count);
    join_sides(list, count, topology);
  }
  vsc_free(list);
  return true;
}

// Whether a triangle of another element lies on a quadrilateral face: on any two opposite corners
// of it, one is the triangle's, and all its nodes are the face's.
static bool is_split(const vsc_mesh *mesh, const vsc_topology *topology, uint32_t element, int number)
{
  const int *at = vsc_mesh_kind(mesh, element)->faces[number];
  const side face = side_of(mesh, element, number);
  for (int i = 0; i < 3; i += 2) {
    const uint32_t node = vsc_mesh_corners(mesh, element)[at[i]];
    for (size_t k = topology->node_start[node]; k < topology->node_start[node + 1]; k++) {
      const uint32_t other = topology->node_elements[k];
      for (int f = 0; f < vsc_mesh_kind(mesh, other)->face_count; f++) {
        const side triangle = side_of(mesh, other, f);
        int shared = 0;
        for (int a = 0; a < 4; a++)
          for (int b = 0; b < 4; b++) shared += triangle.nodes[a] != NO_NODE && triangle.nodes[a] == face.nodes[b];
        if (triangle.nodes[3] == NO_NODE && shared == 3) return true;
      }
    }
  }
  return false;
}

static void mark_split(const vsc_mesh *mesh, vsc_topology *topology)
{
  for (size_t e = 0; e < mesh->element_count; e++) {
    const vsc_cell_kind *kind = vsc_mesh_kind(mesh, e);
    for (int i = 0; i < kind->face_count; i++)
      if (kind->faces[i][3] >= 0 && topology->neighbours[e][i] == VSC_OUTSIDE &&
          is_split(mesh, topology, (uint32_t)e, i))
        topology->neighbours[e][i] = VSC_SPLIT;
  }
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
  if (!find_neighbours(mesh, topology)) {
    vsc_topology_free(topology);
    return vsc_fail_memory(error, "the mesh's topology");
  }
  mark_split(mesh, topology);
  return VSC_OK;
}

void vsc_topology_free(vsc_topology *topology)
{
  vsc_free(topology->node_start);
  vsc_free(topology->node_elements);
  vsc_free(topology->neighbours);
  *topology = (vsc_topology){0};
}
