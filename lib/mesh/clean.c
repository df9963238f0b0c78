// SPDX-License-Identifier: GPL-3.0-or-later
// vsc_mesh_clean: what a mesh from outside must satisfy before anything is computed on it.
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/edges.h"
#include "mesh/mesh.h"
#include "mesh/topology.h"

enum { NAMED = 5 };  // ids that a message names
static const double DEGENERATE = 1e-12;  // volume over the cube of the longest edge

// The first few of the things that are wrong, and how many there are, of each kind of elements.
typedef struct culprits {
  size_t count;
  size_t ids[NAMED];
  size_t kinds[VSC_CELLS];
} culprits;

static void blame(culprits *list, size_t id)
{
  if (list->count < NAMED) list->ids[list->count] = id;
  list->count++;
}

static void blame_element(culprits *list, const vsc_mesh *mesh, size_t element)
{
  blame(list, mesh->element_source[element]);
  list->kinds[mesh->kinds[element]]++;
}

// "12, 14, 15 and 7 more"
static const char *spell(const culprits *list, char *text, size_t size)
{
  size_t used = 0;
  text[0] = '\0';
  for (size_t i = 0; i < list->count && i < NAMED && used < size; i++)
    used += (size_t)snprintf(text + used, size - used, "%s%zu", i == 0 ? "" : ", ", list->ids[i]);
  if (list->count > NAMED && used < size)
    snprintf(text + used, size - used, " and %zu more", list->count - NAMED);
  return text;
}

// Refuses the mesh for the culprits, if there are any: "mesh.vtu: `fault` 3 wedges (cells 1, 2, 7):
// `remedy`".
static vsc_status refuse(const culprits *list, const char *name, const char *fault,
                         const char *remedy, vsc_error *error)
{
  char ids[160], kinds[160];
  if (list->count == 0) return VSC_OK;
  vsc_spell_kinds(list->kinds, kinds, sizeof kinds);
  return vsc_fail(error, VSC_INPUT, "%s: %s %s (cells %s): %s", name, fault, kinds,
                  spell(list, ids, sizeof ids), remedy);
}

static vsc_status check_numbers(const vsc_mesh *mesh, const char *name, vsc_error *error)
{
  culprits elements = {0}, triangles = {0};
  char text[160];
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int i = 0; i < vsc_mesh_kind(mesh, e)->corners; i++)
      if (vsc_mesh_corners(mesh, e)[i] >= mesh->node_count) {
        blame_element(&elements, mesh, e);
        break;
      }
  snprintf(text, sizeof text, "points that are not among the %zu of the mesh are named by",
           mesh->node_count);
  const vsc_status status = refuse(&elements, name, text,
                                   "point numbers count from 0, write the mesh again", error);
  if (status != VSC_OK) return status;
  for (size_t t = 0; t < mesh->triangle_count; t++)
    for (int i = 0; i < 3; i++)
      if (mesh->triangles[3 * t + i] >= mesh->node_count) {
        blame(&triangles, t);
        break;
      }
  if (triangles.count == 0) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s: %zu triangles name points that are not among the %zu of the mesh "
                  "(triangles %s, counted among the triangles): write the mesh again",
                  name, triangles.count, mesh->node_count, spell(&triangles, text, sizeof text));
}

// Nodes of elements or, on a surface, of triangles.
static void mark_used(const vsc_mesh *mesh, uint8_t *used)
{
  for (size_t i = 0; i < mesh->start[mesh->element_count]; i++) used[mesh->corners[i]] = 1;
  if (mesh->element_count > 0) return;
  for (size_t i = 0; i < 3 * mesh->triangle_count; i++) used[mesh->triangles[i]] = 1;
}

static vsc_status check_nodes(const vsc_mesh *mesh, const uint8_t *used, const char *name,
                              vsc_error *error)
{
  culprits nodes = {0};
  char ids[160];
  for (size_t i = 0; i < mesh->node_count; i++) {
    const double *x = mesh->nodes + 3 * i;
    if (used[i] && !(isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2])))
      blame(&nodes, mesh->node_source[i]);
  }
  if (nodes.count == 0) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s: %zu points have coordinates that are not finite numbers (points %s): remove "
                  "them or mesh again",
                  name, nodes.count, spell(&nodes, ids, sizeof ids));
}

static double longest_edge(const vsc_mesh *mesh, size_t element)
{
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  const vsc_cell_kind *kind = vsc_mesh_kind(mesh, element);
  double square = 0, edge[3];
  for (int k = 0; k < kind->edge_count; k++) {
    vsc_subtract(mesh->nodes + 3 * (size_t)corner[kind->edges[k][1]],
                 mesh->nodes + 3 * (size_t)corner[kind->edges[k][0]], edge);
    square = fmax(square, vsc_dot(edge, edge));
  }
  return sqrt(square);
}

static bool repeats_node(const uint32_t *corner, int corners)
{
  for (int i = 0; i < corners; i++)
    for (int j = i + 1; j < corners; j++)
      if (corner[i] == corner[j]) return true;
  return false;
}

// The corners in another order, so that the volume changes sign: a tet's last two and a pyramid's
// second and fourth are exchanged, a hexahedron's bottom and top, a wedge's triangles.
static void turn(vsc_mesh *mesh, size_t element)
{
  static const int turned[VSC_CELLS][VSC_MOST_CORNERS] = {[VSC_TET] = {0, 1, 3, 2},
                                                          [VSC_HEX] = {4, 5, 6, 7, 0, 1, 2, 3},
                                                          [VSC_WEDGE] = {3, 4, 5, 0, 1, 2},
                                                          [VSC_PYRAMID] = {0, 3, 2, 1, 4},
                                                          [VSC_TET10] = {0, 1, 3, 2, 4, 8, 7, 6, 5,
                                                                         9}};
  uint32_t before[VSC_MOST_CORNERS], *corner = mesh->corners + mesh->start[element];
  const int corners = vsc_mesh_kind(mesh, element)->corners;
  memcpy(before, corner, (size_t)corners * sizeof *corner);
  for (int i = 0; i < corners; i++) corner[i] = before[turned[mesh->kinds[element]][i]];
  mesh->report.turned_elements++;
}

static bool is_folded(const vsc_mesh *mesh, size_t element, const vsc_cell_rule *rule)
{
  if (mesh->kinds[element] == VSC_TET) return false;
  double det[VSC_MOST_POINTS];
  vsc_mesh_jacobians(mesh, element, rule, det);
  for (int q = 0; q < rule->points; q++)
    if (!(det[q] > 0)) return true;
  return false;
}

static vsc_status refuse_folded(const culprits *folded, const char *name, vsc_error *error)
{
  return refuse(folded, name,
                "folded, with a Jacobian that is not positive at an integration point:",
                "check the order of their points, or mesh again", error);
}

// Turns left-handed elements, and refuses those that are nothing to compute on.
static vsc_status check_elements(vsc_mesh *mesh, const char *name, vsc_error *error)
{
  culprits repeated = {0}, flat = {0}, folded = {0};
  vsc_cell_rule rules[VSC_CELLS];
  for (int kind = 0; kind < VSC_CELLS; kind++) rules[kind] = vsc_cell_rule_of((vsc_cell)kind);
  mesh->report.turned_elements = 0;
  for (size_t e = 0; e < mesh->element_count; e++) {
    const vsc_cell_rule *rule = &rules[mesh->kinds[e]];
    vsc_mesh_prefetch(mesh, e);
    if (repeats_node(vsc_mesh_corners(mesh, e), vsc_mesh_kind(mesh, e)->corners)) {
      blame_element(&repeated, mesh, e);
      continue;
    }
    const double edge = longest_edge(mesh, e), volume = vsc_mesh_volume_by(mesh, e, rule);
    const double relative = edge > 0 ? fabs(volume) / edge / edge / edge : 0;
    if (!(relative >= DEGENERATE)) blame_element(&flat, mesh, e);
    if (!(volume > 0)) turn(mesh, e);
    if (is_folded(mesh, e, rule)) blame_element(&folded, mesh, e);
  }
  vsc_status status = refuse(&repeated, name, "the same point twice in",
                             "remove them or mesh again", error);
  if (status == VSC_OK)
    status = refuse(&flat, name, "degenerate, with a volume below 1e-12 of the longest edge cubed:",
                    "remove them or mesh again", error);
  return status == VSC_OK ? refuse_folded(&folded, name, error) : status;
}

vsc_status vsc_mesh_check_folds(const vsc_mesh *mesh, const char *name, vsc_error *error)
{
  culprits folded = {0};
  vsc_cell_rule rules[VSC_CELLS];
  for (int kind = 0; kind < VSC_CELLS; kind++) rules[kind] = vsc_cell_rule_of((vsc_cell)kind);
  for (size_t e = 0; e < mesh->element_count; e++)
    if (is_folded(mesh, e, &rules[mesh->kinds[e]])) blame_element(&folded, mesh, e);
  return refuse_folded(&folded, name, error);
}

// A force across a quadrilateral spreads over four nodes in another way than across two triangles
// on the same nodes, so that even a constant stress would push there.
static vsc_status check_conforming(const vsc_mesh *mesh, const char *name, vsc_error *error)
{
  vsc_topology topology;
  culprits split = {0};
  const vsc_status status = vsc_topology_make(mesh, &topology, error);
  if (status != VSC_OK) return status;
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int i = 0; i < VSC_MOST_FACES; i++)
      if (topology.neighbours[e][i] == VSC_SPLIT) {
        blame_element(&split, mesh, e);
        break;
      }
  vsc_topology_free(&topology);
  return refuse(&split, name,
                "not conforming, with triangles of other elements on a quadrilateral face:",
                "put pyramids between quadrilaterals and tetrahedra, or mesh again", error);
}

// Only a mesh that has faces of both kinds can have unlike ones meet.
static bool has_unlike_faces(const vsc_mesh *mesh)
{
  bool has[VSC_CELLS] = {false};
  for (size_t e = 0; e < mesh->element_count; e++) has[mesh->kinds[e]] = true;
  return has[VSC_WEDGE] || has[VSC_PYRAMID] || (has[VSC_TET] && has[VSC_HEX]);
}

static bool has_quadratic(const vsc_mesh *mesh)
{
  for (size_t e = 0; e < mesh->element_count; e++)
    if (mesh->kinds[e] == VSC_TET10) return true;
  return false;
}

static bool has_linear(const vsc_mesh *mesh)
{
  for (size_t e = 0; e < mesh->element_count; e++)
    if (mesh->kinds[e] != VSC_TET10) return true;
  return false;
}

static vsc_status refuse_linear(const vsc_mesh *mesh, const char *name, vsc_error *error)
{
  culprits linear = {0};
  for (size_t e = 0; e < mesh->element_count; e++)
    if (mesh->kinds[e] != VSC_TET10) blame_element(&linear, mesh, e);
  return refuse(&linear, name, "beside quadratic tetrahedra there are",
                "make all elements quadratic tetrahedra, or all linear", error);
}

// Quadratic elements fit together where they have the middles of common edges in common, and where no
// node is the middle of one element's edge and another's corner. Lists the edges.
static vsc_status check_middles(const vsc_mesh *mesh, const char *name, vsc_edges *edges, vsc_error *error)
{
  culprits apart = {0};
  uint8_t *is_corner;
  if (has_linear(mesh)) return refuse_linear(mesh, name, error);
  if (!VSC_NEW(is_corner, mesh->node_count)) return vsc_fail_memory(error, "the mesh's edges");
  const vsc_status status = vsc_edges_list(mesh, edges, error);
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int i = 0; i < 4; i++) is_corner[vsc_mesh_corners(mesh, e)[i]] = 1;
  for (size_t e = 0; e < mesh->element_count && status == VSC_OK; e++) {
    const uint32_t *corner = vsc_mesh_corners(mesh, e);
    bool sound = true;
    for (int k = 0; k < 6; k++) {
      const int *ends = vsc_cells[VSC_TET10].edges[k];
      const uint32_t middle = corner[4 + k];
      sound = sound && !is_corner[middle];
      if (edges->apart)
        sound = sound && vsc_edges_find(edges, corner[ends[0]], corner[ends[1]])->middle == middle;
    }
    if (!sound) blame_element(&apart, mesh, e);
  }
  vsc_free(is_corner);
  if (status != VSC_OK) return status;
  return refuse(&apart, name, "not conforming, with a node in the middle of an edge that is not its "
                "neighbours':", "give each edge one middle node, or mesh again", error);
}

// A surface's triangles.
static vsc_status check_triangles(const vsc_mesh *mesh, const char *name, vsc_error *error)
{
  culprits flat = {0};
  char ids[160];
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const double *at[3];
    double edge[3][3], normal[3], longest = 0;
    for (int i = 0; i < 3; i++) at[i] = mesh->nodes + 3 * (size_t)mesh->triangles[3 * t + i];
    for (int i = 0; i < 3; i++) {
      vsc_subtract(at[(i + 1) % 3], at[i], edge[i]);
      longest = fmax(longest, vsc_norm(edge[i]));
    }
    vsc_cross(edge[0], edge[1], normal);
    if (!(vsc_norm(normal) / longest / longest >= DEGENERATE)) blame(&flat, t);
  }
  if (flat.count == 0) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s: %zu triangles are degenerate, their area is below 1e-12 of the longest edge "
                  "squared (triangles %s, counted among the triangles): remove them or mesh again",
                  name, flat.count, spell(&flat, ids, sizeof ids));
}

// Keeps the tuples whose `keep` is set, in their order.
static void squeeze_arrays(vsc_arrays *arrays, const uint8_t *keep, size_t kept)
{
  for (size_t a = 0; a < arrays->count; a++) {
    vsc_array *array = &arrays->items[a];
    const size_t width = (size_t)array->components;
    size_t to = 0;
    for (size_t from = 0; from < array->tuples; from++)
      if (keep[from])
        memmove(array->values + width * to++, array->values + width * from,
                width * sizeof *array->values);
    array->tuples = kept;
  }
}

// Finds the middles of a triangle's edges 01, 12, 20; false when one of them is on no element.
static bool find_middles(const vsc_edges *edges, const uint32_t corner[3], uint32_t middle[3])
{
  for (int i = 0; i < 3; i++) {
    const vsc_edge *edge = vsc_edges_find(edges, corner[i], corner[(i + 1) % 3]);
    if (edge == NULL) return false;
    middle[i] = edge->middle;
  }
  return true;
}

// Keeps the triangles on elements. `edges` (NULL: of linear elements) gives them their middles.
static void drop_loose_triangles(vsc_mesh *mesh, const uint8_t *used, const vsc_edges *edges,
                                 uint8_t *keep)
{
  size_t kept = 0;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const uint32_t *corner = mesh->triangles + 3 * t;
    keep[t] = used[corner[0]] && used[corner[1]] && used[corner[2]] &&
              (edges == NULL || find_middles(edges, corner, mesh->triangle_mid + 3 * kept));
    if (keep[t]) memmove(mesh->triangles + 3 * kept++, corner, 3 * sizeof *corner);
  }
  squeeze_arrays(&mesh->triangle_data, keep, kept);
  mesh->report.loose_triangles = mesh->triangle_count - kept;
  mesh->triangle_count = kept;
}

// Node numbers become `place`, the count of used nodes before each.
static void drop_unused_nodes(vsc_mesh *mesh, const uint8_t *used, uint32_t *place)
{
  size_t kept = 0;
  mesh->report.unused_nodes = 0;
  if (memchr(used, 0, mesh->node_count) == NULL) return;
  for (size_t i = 0; i < mesh->node_count; i++) {
    place[i] = (uint32_t)kept;
    if (!used[i]) continue;
    memmove(mesh->nodes + 3 * kept, mesh->nodes + 3 * i, 3 * sizeof *mesh->nodes);
    mesh->node_source[kept++] = mesh->node_source[i];
  }
  for (size_t i = 0; i < mesh->start[mesh->element_count]; i++)
    mesh->corners[i] = place[mesh->corners[i]];
  for (size_t i = 0; i < 3 * mesh->triangle_count; i++)
    mesh->triangles[i] = place[mesh->triangles[i]];
  for (size_t i = 0; i < 3 * mesh->triangle_count && mesh->triangle_mid != NULL; i++)
    mesh->triangle_mid[i] = place[mesh->triangle_mid[i]];
  squeeze_arrays(&mesh->node_data, used, kept);
  mesh->report.unused_nodes = mesh->node_count - kept;
  mesh->node_count = kept;
}

// `edges`: those of quadratic elements, else none.
static vsc_status drop_unused(vsc_mesh *mesh, const uint8_t *used, const vsc_edges *edges, vsc_error *error)
{
  uint8_t *keep = NULL;
  uint32_t *place = NULL;
  const bool quadratic = vsc_mesh_is_quadratic(mesh);
  vsc_status status = VSC_OK;
  vsc_free(mesh->triangle_mid);
  mesh->triangle_mid = NULL;
  if (!VSC_NEW(keep, mesh->triangle_count) || !VSC_NEW(place, mesh->node_count) ||
      (quadratic && !VSC_NEW(mesh->triangle_mid, 3 * mesh->triangle_count)))
    status = vsc_fail_memory(error, "the mesh's node numbers");
  if (status == VSC_OK) {
    drop_loose_triangles(mesh, used, quadratic ? edges : NULL, keep);
    drop_unused_nodes(mesh, used, place);
  }
  vsc_free(keep);
  vsc_free(place);
  return status;
}

static vsc_status check_shapes(vsc_mesh *mesh, const char *name, vsc_edges *edges, vsc_error *error)
{
  if (mesh->element_count == 0) return check_triangles(mesh, name, error);
  vsc_status status = check_elements(mesh, name, error);
  if (status == VSC_OK && has_unlike_faces(mesh)) status = check_conforming(mesh, name, error);
  if (status == VSC_OK && has_quadratic(mesh)) status = check_middles(mesh, name, edges, error);
  return status;
}

vsc_status vsc_mesh_clean(vsc_mesh *mesh, const char *name, vsc_error *error)
{
  if (mesh->element_count + mesh->triangle_count == 0)
    return vsc_fail(error, VSC_INPUT,
                    "%s: holds neither elements (tetrahedra, hexahedra, wedges, pyramids) nor "
                    "triangles: mesh the organ's volume or its surface",
                    name);
  if (mesh->report.file_nodes == 0) mesh->report.file_nodes = mesh->node_count;
  if (mesh->report.file_cells == 0)
    mesh->report.file_cells = mesh->element_count + mesh->triangle_count;
  vsc_status status = check_numbers(mesh, name, error);
  if (status != VSC_OK) return status;

  uint8_t *used;
  vsc_edges edges = {0};
  if (!VSC_NEW(used, mesh->node_count)) return vsc_fail_memory(error, "the mesh's node numbers");
  mark_used(mesh, used);
  status = check_nodes(mesh, used, name, error);
  if (status == VSC_OK) status = check_shapes(mesh, name, &edges, error);
  if (status == VSC_OK) status = drop_unused(mesh, used, &edges, error);
  vsc_edges_free(&edges);
  vsc_free(used);
  return status;
}
