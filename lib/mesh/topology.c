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

// The nodes of an element's face, ascending; a triangle has NO_NODE as its last.
typedef struct side {
  uint32_t nodes[4];
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
  side s = {{corners[at[0]], corners[at[1]], corners[at[2]], at[3] < 0 ? NO_NODE : corners[at[3]]}};
  put_in_order(&s.nodes[0], &s.nodes[1]);
  put_in_order(&s.nodes[2], &s.nodes[3]);
  put_in_order(&s.nodes[0], &s.nodes[2]);
  put_in_order(&s.nodes[1], &s.nodes[3]);
  put_in_order(&s.nodes[1], &s.nodes[2]);
  return s;
}

// Sides are sorted by ranges of their smallest node, so that the search for those with the same nodes stays in the
// caches: meshes whose nodes and elements come in any order take little longer than others. A side then is
//   element, number + 8 (smallest node - first of the range), the other nodes: two, or three where faces have four,
// in as little memory as that takes: there are many.
enum { RANGES = 1024, ELEMENT = 0, FACE = 1, OTHERS = 2, NUMBER_BITS = 3 };

typedef struct side_list {
  const vsc_mesh *mesh;
  size_t words;              // of a side
  int bits;                  // a node's range is its number divided by 2^bits
  size_t start[RANGES + 1];  // range r has the sides from start[r] on
  uint32_t *items;
  // of one range:
  uint32_t *table;           // 1 + the last side of each face that has come
  uint32_t *next;            // the next side with the same nodes, in a cycle; one that is alone is its own next
} side_list;

static const uint32_t *side_at(const side_list *sides, size_t k)
{
  return sides->items + sides->words * k;
}

static int number_of(const uint32_t *item)
{
  return (int)(item[FACE] & ((1 << NUMBER_BITS) - 1));
}

static void count_sides(side_list *sides)
{
  const vsc_mesh *mesh = sides->mesh;
  bool cornered[2] = {false};  // faces have three nodes, four
  while (mesh->node_count >> sides->bits >= RANGES) sides->bits++;
  for (uint32_t e = 0; e < mesh->element_count; e++) {
    const vsc_cell_kind *kind = vsc_mesh_kind(mesh, e);
    for (int i = 0; i < kind->face_count; i++) {
      cornered[kind->faces[i][3] >= 0] = true;
      sides->start[(side_of(mesh, e, i).nodes[0] >> sides->bits) + 1]++;
    }
  }
  for (int r = 0; r < RANGES; r++) sides->start[r + 1] += sides->start[r];
  sides->words = OTHERS + (cornered[1] ? 3 : 2);
}

static void fill_sides(side_list *sides)
{
  const vsc_mesh *mesh = sides->mesh;
  const uint32_t mask = (uint32_t)((UINT64_C(1) << sides->bits) - 1);
  size_t place[RANGES + 1];
  memcpy(place, sides->start, sizeof place);
  for (uint32_t e = 0; e < mesh->element_count; e++)
    for (int i = 0; i < vsc_mesh_kind(mesh, e)->face_count; i++) {
      const side s = side_of(mesh, e, i);
      uint32_t *item = sides->items + sides->words * place[s.nodes[0] >> sides->bits]++;
      item[ELEMENT] = e;
      item[FACE] = (s.nodes[0] & mask) << NUMBER_BITS | (uint32_t)i;
      for (size_t w = OTHERS; w < sides->words; w++) item[w] = s.nodes[w - OTHERS + 1];
    }
}

// A number without pattern for the nodes of a side.
static size_t mix(const uint32_t *item, size_t words)
{
  uint64_t h = item[FACE] >> NUMBER_BITS;
  for (size_t w = OTHERS; w < words; w++) h = (h ^ item[w]) * UINT64_C(0x9e3779b97f4a7c15);
  return (size_t)(h >> 32);
}

static bool are_one_face(const uint32_t *a, const uint32_t *b, size_t words)
{
  bool same = a[FACE] >> NUMBER_BITS == b[FACE] >> NUMBER_BITS;
  for (size_t w = OTHERS; w < words; w++) same = same && a[w] == b[w];
  return same;
}

// The places of a table for `count` sides: a power of two.
static size_t places_for(size_t count)
{
  size_t places = 1;
  while (places < 2 * count) places *= 2;
  return places;
}

// Joins the `count` sides from `first` on in cycles.
static void join_range(side_list *sides, size_t first, size_t count)
{
  const size_t places = places_for(count);
  uint32_t *const table = sides->table, *const next = sides->next;
  memset(table, 0, places * sizeof *table);
  for (uint32_t k = 0; k < count; k++) {
    const uint32_t *item = side_at(sides, first + k);
    uint32_t *at = table + (mix(item, sides->words) & (places - 1));
    while (*at != 0 && !are_one_face(side_at(sides, first + *at - 1), item, sides->words))
      if (++at == table + places) at = table;
    next[k] = k;
    if (*at != 0) {
      next[k] = next[*at - 1];
      next[*at - 1] = k;
    }
    *at = k + 1;
  }
}

// Takes the `count` sides of a range, joined, and the context.
typedef void take_range(const side_list *sides, size_t first, size_t count, void *context);

// Gives `take` all sides, range by range. False when memory is short.
static bool join_sides(const vsc_mesh *mesh, take_range *take, void *context)
{
  side_list *sides;
  size_t most = 0;
  bool room = VSC_NEW(sides, 1);
  if (!room) return false;
  sides->mesh = mesh;
  count_sides(sides);
  for (int r = 0; r < RANGES; r++)
    if (sides->start[r + 1] - sides->start[r] > most) most = sides->start[r + 1] - sides->start[r];
  room = most < UINT32_MAX && VSC_NEW(sides->items, sides->words * sides->start[RANGES]) &&
         VSC_NEW(sides->table, places_for(most)) && VSC_NEW(sides->next, most);
  if (room) fill_sides(sides);
  for (int r = 0; r < RANGES && room; r++) {
    const size_t first = sides->start[r], count = sides->start[r + 1] - first;
    join_range(sides, first, count);
    take(sides, first, count, context);
  }
  vsc_free(sides->items);
  vsc_free(sides->table);
  vsc_free(sides->next);
  vsc_free(sides);
  return room;
}

// The node behind the smallest one as a face goes round its element.
static uint32_t second_node(const vsc_mesh *mesh, const uint32_t *item)
{
  const int *at = vsc_mesh_kind(mesh, item[ELEMENT])->faces[number_of(item)], corners = at[3] < 0 ? 3 : 4;
  const uint32_t *nodes = vsc_mesh_corners(mesh, item[ELEMENT]);
  int smallest = 0;
  for (int i = 1; i < corners; i++)
    if (nodes[at[i]] < nodes[at[smallest]]) smallest = i;
  return nodes[at[(smallest + 1) % corners]];
}

static void note_neighbours(const side_list *sides, size_t first, size_t count, void *context)
{
  vsc_topology *topology = context;
  for (size_t k = 0; k < count; k++) {
    const size_t next = sides->next[k];
    const uint32_t *item = side_at(sides, first + k), *other = side_at(sides, first + next);
    if (next == k) continue;
    topology->neighbours[item[ELEMENT]][number_of(item)] = (int32_t)other[ELEMENT];
    if (next > k) continue;
    if (sides->next[next] != k) {
      if (topology->crowded_faces++ == 0) topology->crowded_element = item[ELEMENT];
    } else if (second_node(sides->mesh, item) == second_node(sides->mesh, other)) {
      if (topology->one_sided_faces++ == 0) topology->one_sided_element = item[ELEMENT];
    }
  }
}

static bool find_neighbours(const vsc_mesh *mesh, vsc_topology *topology)
{
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int i = 0; i < VSC_MOST_FACES; i++) topology->neighbours[e][i] = VSC_OUTSIDE;
  return join_sides(mesh, note_neighbours, topology);
}

static void note_open(const side_list *sides, size_t first, size_t count, void *context)
{
  uint8_t *open = context;
  for (size_t k = 0; k < count; k++) {
    const uint32_t *item = side_at(sides, first + k);
    if (sides->next[k] == k) open[item[ELEMENT]] |= (uint8_t)(1 << number_of(item));
  }
}

vsc_status vsc_open_faces(const vsc_mesh *mesh, uint8_t *open, vsc_error *error)
{
  memset(open, 0, mesh->element_count);
  return join_sides(mesh, note_open, open) ? VSC_OK : vsc_fail_memory(error, "the mesh's boundary");
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
