// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/topology.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

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

static void put_in_order(uint32_t *a, uint32_t *b)
{
  const uint32_t low = *a < *b ? *a : *b, high = *a < *b ? *b : *a;
  *a = low;
  *b = high;
}

static side side_of(const vsc_mesh *mesh, uint32_t element, int number)
{
  const int *at = vsc_mesh_kind(mesh, element)->faces[number];
  const uint32_t *corners = vsc_mesh_corners(mesh, element);
  side s = {.nodes = {corners[at[0]], corners[at[1]], corners[at[2]], at[3] < 0 ? NO_NODE : corners[at[3]]},
            .element = element,
            .number = number};
  put_in_order(&s.nodes[0], &s.nodes[1]);
  put_in_order(&s.nodes[2], &s.nodes[3]);
  put_in_order(&s.nodes[0], &s.nodes[2]);
  put_in_order(&s.nodes[1], &s.nodes[3]);
  put_in_order(&s.nodes[1], &s.nodes[2]);
  return s;
}

static bool are_one_face(const side *a, const side *b)
{
  return memcmp(a->nodes, b->nodes, sizeof a->nodes) == 0;
}

// All sides, and for each the next one with the same nodes, in a cycle; one that is alone is its own next.
typedef struct side_list {
  size_t count;
  side *items;
  size_t *next;
} side_list;

// Sides are sorted by ranges of their smallest node first, so that the search for those with the same nodes stays in
// the caches: meshes whose nodes and elements come in any order take little longer than others.
enum { RANGES = 256 };

// A node's range is its number divided by 2^bits.
static int range_bits(const vsc_mesh *mesh)
{
  int bits = 0;
  while (mesh->node_count >> bits >= RANGES) bits++;
  return bits;
}

// Range r gets the sides from start[r] on.
static void fill_ranges(const vsc_mesh *mesh, side_list *sides, size_t start[RANGES + 1])
{
  const int bits = range_bits(mesh);
  size_t place[RANGES + 1] = {0};
  for (uint32_t e = 0; e < mesh->element_count; e++)
    for (int i = 0; i < vsc_mesh_kind(mesh, e)->face_count; i++) place[(side_of(mesh, e, i).nodes[0] >> bits) + 1]++;
  for (int r = 0; r < RANGES; r++) place[r + 1] += place[r];
  memcpy(start, place, sizeof place);
  for (uint32_t e = 0; e < mesh->element_count; e++)
    for (int i = 0; i < vsc_mesh_kind(mesh, e)->face_count; i++) {
      const side s = side_of(mesh, e, i);
      sides->items[place[s.nodes[0] >> bits]++] = s;
    }
}

// A number without pattern for the nodes of a side.
static size_t mix(const side *s)
{
  uint64_t h = 0;
  for (int i = 0; i < 4; i++) h = (h ^ s->nodes[i]) * UINT64_C(0x9e3779b97f4a7c15);
  return (size_t)(h >> 32);
}

// The places of a table for `count` sides: a power of two.
static size_t places_for(size_t count)
{
  size_t places = 1;
  while (places < 2 * count) places *= 2;
  return places;
}

// Joins the sides [first, end) in cycles. `table` has room for them and holds 1 + the last side of each face that has
// come.
static void join_range(side_list *sides, size_t first, size_t end, size_t *table)
{
  const size_t places = places_for(end - first);
  memset(table, 0, places * sizeof *table);
  for (size_t k = first; k < end; k++) {
    size_t *at = table + (mix(&sides->items[k]) & (places - 1));
    while (*at != 0 && !are_one_face(&sides->items[*at - 1], &sides->items[k]))
      if (++at == table + places) at = table;
    sides->next[k] = k;
    if (*at != 0) {
      sides->next[k] = sides->next[*at - 1];
      sides->next[*at - 1] = k;
    }
    *at = k + 1;
  }
}

static bool join_sides(side_list *sides, const size_t start[RANGES + 1])
{
  size_t most = 0, *table;
  for (int r = 0; r < RANGES; r++) most = start[r + 1] - start[r] > most ? start[r + 1] - start[r] : most;
  if (!VSC_NEW(table, places_for(most))) return false;
  for (int r = 0; r < RANGES; r++) join_range(sides, start[r], start[r + 1], table);
  vsc_free(table);
  return true;
}

static void free_sides(side_list *sides)
{
  vsc_free(sides->items);
  vsc_free(sides->next);
}

// To be released also when memory was short.
static bool list_sides(const vsc_mesh *mesh, side_list *sides)
{
  size_t start[RANGES + 1];
  *sides = (side_list){0};
  for (size_t e = 0; e < mesh->element_count; e++) sides->count += (size_t)vsc_mesh_kind(mesh, e)->face_count;
  if (!VSC_NEW(sides->items, sides->count) || !VSC_NEW(sides->next, sides->count)) return false;
  fill_ranges(mesh, sides, start);
  return join_sides(sides, start);
}

// The node behind the smallest one as a face goes round its element.
static uint32_t second_node(const vsc_mesh *mesh, const side *s)
{
  const int *at = vsc_mesh_kind(mesh, s->element)->faces[s->number], corners = at[3] < 0 ? 3 : 4;
  const uint32_t *nodes = vsc_mesh_corners(mesh, s->element);
  int i = 0;
  while (nodes[at[i]] != s->nodes[0]) i++;
  return nodes[at[(i + 1) % corners]];
}

static bool find_neighbours(const vsc_mesh *mesh, vsc_topology *topology)
{
  side_list sides;
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int i = 0; i < VSC_MOST_FACES; i++) topology->neighbours[e][i] = VSC_OUTSIDE;
  const bool listed = list_sides(mesh, &sides);
  for (size_t k = 0; k < sides.count && listed; k++) {
    const side *s = &sides.items[k];
    const size_t next = sides.next[k];
    if (next == k) continue;
    topology->neighbours[s->element][s->number] = (int32_t)sides.items[next].element;
    if (next > k) continue;
    if (sides.next[next] != k) {
      if (topology->crowded_faces++ == 0) topology->crowded_element = s->element;
    } else if (second_node(mesh, s) == second_node(mesh, &sides.items[next])) {
      if (topology->one_sided_faces++ == 0) topology->one_sided_element = s->element;
    }
  }
  free_sides(&sides);
  return listed;
}

vsc_status vsc_open_faces(const vsc_mesh *mesh, uint8_t *open, vsc_error *error)
{
  side_list sides;
  const bool listed = list_sides(mesh, &sides);
  memset(open, 0, mesh->element_count);
  for (size_t k = 0; k < sides.count && listed; k++)
    if (sides.next[k] == k) open[sides.items[k].element] |= (uint8_t)(1 << sides.items[k].number);
  free_sides(&sides);
  return listed ? VSC_OK : vsc_fail_memory(error, "the mesh's boundary");
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
