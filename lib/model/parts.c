// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/parts.h"

#include <string.h>

#include "base/mem.h"
#include "base/sort.h"

// Families of a material: the cells and the springs on their edges.
enum { OF_MATERIAL = VSC_CELLS + 1 };

// A spring between two nodes, and the element that brought it.
typedef struct spring {
  uint32_t node[2], element;
} spring;

typedef struct spring_list {
  size_t count;
  spring *items;
} spring_list;

// Groups of all materials that move, then those that never do, so that these have consecutive nodes.
static uint32_t group_of(const vsc_parts *parts, bool still, uint32_t material, bool mixed, uint32_t family)
{
  if (still) material += (uint32_t)parts->material_count;
  return (2 * material + mixed) * OF_MATERIAL + family;
}

// Groups of membranes come after those of all materials: triangles, then bends of each.
static uint32_t first_of_membranes(const vsc_parts *parts)
{
  return group_of(parts, true, (uint32_t)parts->material_count, false, 0);
}

uint32_t vsc_parts_family(const vsc_parts *parts, uint32_t group)
{
  const uint32_t first = first_of_membranes(parts);
  return group < first ? group % OF_MATERIAL : VSC_TRIANGLES + (group - first) % 2;
}

uint32_t vsc_parts_material(const vsc_parts *parts, uint32_t group)
{
  const uint32_t first = first_of_membranes(parts);
  return group < first ? group / OF_MATERIAL / 2 % (uint32_t)parts->material_count : (group - first) / 2;
}

bool vsc_parts_mixed(const vsc_parts *parts, uint32_t group)
{
  return group < first_of_membranes(parts) && group / OF_MATERIAL % 2 == 1;
}

bool vsc_parts_still(const vsc_parts *parts, uint32_t group)
{
  return group < first_of_membranes(parts) && group >= group_of(parts, true, 0, false, 0);
}

static vsc_status check_laws(const vsc_mesh *mesh, const uint32_t *material_of,
                             const vsc_model *model, vsc_error *error)
{
  for (size_t e = 0; e < mesh->element_count; e++) {
    const vsc_material *material = &model->materials[material_of[e]];
    const bool known = mesh->kinds[e] == VSC_TET || mesh->kinds[e] == VSC_HEX;
    if (material->law == VSC_LAW_CLASSICAL && mesh->kinds[e] == VSC_TET10)
      return vsc_fail(error, VSC_INPUT,
                      "materials: element %u, of material %s, is a %s, whose edges bend: law: classical "
                      "has no springs for them: use law: springs, or leave out mesh.order",
                      mesh->element_source[e], material->name, vsc_mesh_kind(mesh, e)->name);
    if (material->law == VSC_LAW_PAPER && !known)
      return vsc_fail(error, VSC_INPUT,
                      "materials: element %u, of material %s, is a %s; law: paper knows tetrahedra "
                      "and hexahedra only: use law: springs",
                      mesh->element_source[e], material->name, vsc_mesh_kind(mesh, e)->name);
    if (material->law == VSC_LAW_PAPER && mesh->kinds[e] == VSC_HEX && material->paper.volume == 0)
      return vsc_fail(error, VSC_INPUT,
                      "materials: %s has law: paper on hexahedra (element %u) without volume "
                      "springs, which leaves twelve ways to deform without force: give "
                      "paper.volume, or use law: springs",
                      material->name, mesh->element_source[e]);
  }
  return VSC_OK;
}

// ---- classical springs

static void add_spring(spring_list *list, uint32_t a, uint32_t b, size_t element)
{
  list->items[list->count++] =
      (spring){.node = {a < b ? a : b, a < b ? b : a}, .element = (uint32_t)element};
}

// One spring on each edge, of the first element that has it, and on each main diagonal of a
// hexahedron.
static vsc_status list_springs(const vsc_mesh *mesh, const uint32_t *material_of,
                               const vsc_model *model, spring_list *list, vsc_error *error)
{
  static const int diagonals[4][2] = {{0, 6}, {1, 7}, {2, 4}, {3, 5}};
  size_t most = 0;
  for (size_t e = 0; e < mesh->element_count; e++)
    if (model->materials[material_of[e]].law == VSC_LAW_CLASSICAL)
      most += (size_t)vsc_mesh_kind(mesh, e)->edge_count + (mesh->kinds[e] == VSC_HEX ? 4 : 0);
  if (!VSC_NEW(list->items, most)) return vsc_fail_memory(error, "classical springs");
  for (size_t e = 0; e < mesh->element_count; e++) {
    if (model->materials[material_of[e]].law != VSC_LAW_CLASSICAL) continue;
    const vsc_cell_kind *kind = vsc_mesh_kind(mesh, e);
    const uint32_t *corner = vsc_mesh_corners(mesh, e);
    for (int i = 0; i < kind->edge_count; i++)
      add_spring(list, corner[kind->edges[i][0]], corner[kind->edges[i][1]], e);
    for (int i = 0; i < 4 && mesh->kinds[e] == VSC_HEX; i++)
      add_spring(list, corner[diagonals[i][0]], corner[diagonals[i][1]], e);
  }
  if (!vsc_sort(list->items, list->count, sizeof *list->items / sizeof(uint32_t), 2))
    return vsc_fail_memory(error, "classical springs");
  size_t kept = 0;
  for (size_t k = 0; k < list->count; k++)
    if (kept == 0 || memcmp(list->items[kept - 1].node, list->items[k].node, 8) != 0)
      list->items[kept++] = list->items[k];
  list->count = kept;
  return VSC_OK;
}

// ---- the list

static void add_part(vsc_parts *parts, uint32_t group, uint32_t source, const uint32_t *nodes,
                     size_t count)
{
  const size_t k = parts->count++;
  parts->group[k] = group;
  parts->source[k] = source;
  if (parts->own_nodes == NULL) return;
  memcpy(parts->own_nodes + parts->own_start[k], nodes, count * sizeof *nodes);
  parts->own_start[k + 1] = parts->own_start[k] + count;
}

static bool are_still(const uint8_t *still, const uint32_t *nodes, size_t count)
{
  for (size_t k = 0; k < count; k++)
    if (!still[nodes[k]]) return false;
  return true;
}

static void add_cell(vsc_parts *parts, const vsc_mesh *mesh, size_t e, uint32_t material, bool mixed,
                     const uint8_t *still)
{
  const uint32_t *corners = vsc_mesh_corners(mesh, e);
  const size_t count = (size_t)vsc_mesh_kind(mesh, e)->corners;
  add_part(parts, group_of(parts, are_still(still, corners, count), material, mixed, mesh->kinds[e]),
           (uint32_t)e, corners, count);
}

static void add_sheet(vsc_parts *parts, uint32_t membrane)
{
  const vsc_sheet *sheet = &parts->sheets[membrane];
  const uint32_t group = first_of_membranes(parts) + 2 * membrane;
  for (uint32_t t = 0; t < sheet->count; t++) {
    add_part(parts, group, t, sheet->nodes[t], 3);
    if (sheet->G != NULL) add_part(parts, group + 1, t, sheet->nodes[t], VSC_BEND_NODES);
  }
}

vsc_status vsc_parts_list(const vsc_mesh *mesh, const uint32_t *material_of, const uint8_t *mixed,
                          const uint8_t *still, const vsc_sheet *sheets, const vsc_model *model,
                          vsc_parts *parts, vsc_error *error)
{
  spring_list springs = {0};
  *parts = (vsc_parts){.material_count = model->material_count, .sheets = sheets};
  vsc_status status = check_laws(mesh, material_of, model, error);
  if (status == VSC_OK) status = list_springs(mesh, material_of, model, &springs, error);
  const size_t elements = mesh->element_count;
  size_t count = elements + springs.count, nodes = mesh->start[elements] + 2 * springs.count;
  for (size_t m = 0; m < model->membrane_count; m++) {
    count += sheets[m].count * (sheets[m].G != NULL ? 2 : 1);
    nodes += sheets[m].count * (sheets[m].G != NULL ? 3 + VSC_BEND_NODES : 3);
  }
  if (status == VSC_OK &&
      (!VSC_NEW(parts->group, count) || !VSC_NEW(parts->source, count) ||
       (count > elements && (!VSC_NEW(parts->own_start, count + 1) || !VSC_NEW(parts->own_nodes, nodes)))))
    status = vsc_fail_memory(error, "the list of elements");
  parts->start = count > elements ? parts->own_start : mesh->start;
  parts->nodes = count > elements ? parts->own_nodes : mesh->corners;
  if (status == VSC_OK) {
    for (size_t e = 0; e < elements; e++)
      add_cell(parts, mesh, e, material_of[e], mixed[e] != 0, still);
    for (size_t s = 0; s < springs.count; s++)
      add_part(parts, group_of(parts, are_still(still, springs.items[s].node, 2),
                               material_of[springs.items[s].element], false, VSC_SPRINGS_ON_EDGES),
               VSC_NO_ELEMENT, springs.items[s].node, 2);
    for (uint32_t m = 0; m < model->membrane_count; m++) add_sheet(parts, m);
  }
  vsc_free(springs.items);
  return status;
}

void vsc_parts_free(vsc_parts *parts)
{
  vsc_free(parts->group);
  vsc_free(parts->source);
  vsc_free(parts->own_start);
  vsc_free(parts->own_nodes);
  *parts = (vsc_parts){0};
}
