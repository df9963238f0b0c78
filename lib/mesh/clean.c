// SPDX-License-Identifier: GPL-3.0-or-later
// vsc_mesh_clean: what a mesh from outside must satisfy before anything is computed on it.
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/mesh.h"

enum { NAMED = 5 };  // ids that a message names
static const double DEGENERATE = 1e-12;  // volume over the cube of the longest edge

// The first few of the things that are wrong, and how many there are.
typedef struct culprits {
  size_t count;
  size_t ids[NAMED];
} culprits;

static void blame(culprits *list, size_t id)
{
  if (list->count < NAMED) list->ids[list->count] = id;
  list->count++;
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

static vsc_status check_numbers(const vsc_mesh *mesh, const char *name, vsc_error *error)
{
  culprits tets = {0}, triangles = {0};
  char ids[160];
  for (size_t t = 0; t < mesh->element_count; t++)
    for (int i = 0; i < 4; i++)
      if (mesh->corners[4 * t + i] >= mesh->node_count) {
        blame(&tets, mesh->element_source[t]);
        break;
      }
  if (tets.count > 0)
    return vsc_fail(error, VSC_INPUT,
                    "%s: %zu tetrahedra name points that are not among the %zu of the mesh (cells "
                    "%s): point numbers count from 0, write the mesh again",
                    name, tets.count, mesh->node_count, spell(&tets, ids, sizeof ids));
  for (size_t t = 0; t < mesh->triangle_count; t++)
    for (int i = 0; i < 3; i++)
      if (mesh->triangles[3 * t + i] >= mesh->node_count) {
        blame(&triangles, t);
        break;
      }
  if (triangles.count > 0)
    return vsc_fail(error, VSC_INPUT,
                    "%s: %zu triangles name points that are not among the %zu of the mesh "
                    "(triangles %s, counted among the triangles): write the mesh again",
                    name, triangles.count, mesh->node_count, spell(&triangles, ids, sizeof ids));
  return VSC_OK;
}

static void mark_used(const vsc_mesh *mesh, uint8_t *used)
{
  for (size_t i = 0; i < 4 * mesh->element_count; i++) used[mesh->corners[i]] = 1;
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

static double longest_edge(const vsc_mesh *mesh, size_t tet)
{
  const uint32_t *corner = mesh->corners + 4 * tet;
  double longest = 0, edge[3];
  for (int i = 0; i < 4; i++)
    for (int j = i + 1; j < 4; j++) {
      vsc_subtract(mesh->nodes + 3 * (size_t)corner[j], mesh->nodes + 3 * (size_t)corner[i], edge);
      longest = fmax(longest, vsc_norm(edge));
    }
  return longest;
}

static bool repeats_node(const uint32_t tet[4])
{
  for (int i = 0; i < 4; i++)
    for (int j = i + 1; j < 4; j++)
      if (tet[i] == tet[j]) return true;
  return false;
}

static vsc_status check_tets(const vsc_mesh *mesh, const char *name, vsc_error *error)
{
  culprits repeated = {0}, flat = {0};
  char ids[160];
  for (size_t t = 0; t < mesh->element_count; t++) {
    if (repeats_node(mesh->corners + 4 * t)) {
      blame(&repeated, mesh->element_source[t]);
      continue;
    }
    const double edge = longest_edge(mesh, t);
    const double relative = fabs(vsc_mesh_element_volume(mesh, t)) / edge / edge / edge;
    if (!(relative >= DEGENERATE)) blame(&flat, mesh->element_source[t]);
  }
  if (repeated.count > 0)
    return vsc_fail(error, VSC_INPUT,
                    "%s: %zu tetrahedra name the same point twice (cells %s): remove them or mesh "
                    "again",
                    name, repeated.count, spell(&repeated, ids, sizeof ids));
  if (flat.count > 0)
    return vsc_fail(error, VSC_INPUT,
                    "%s: %zu tetrahedra are degenerate, their volume is below 1e-12 of the longest "
                    "edge cubed (cells %s): remove them or mesh again",
                    name, flat.count, spell(&flat, ids, sizeof ids));
  return VSC_OK;
}

static void turn_left_handed(vsc_mesh *mesh)
{
  mesh->report.turned_tets = 0;
  for (size_t t = 0; t < mesh->element_count; t++) {
    if (vsc_mesh_element_volume(mesh, t) > 0) continue;
    uint32_t *corner = mesh->corners + 4 * t;
    const uint32_t third = corner[2];
    corner[2] = corner[3];
    corner[3] = third;
    mesh->report.turned_tets++;
  }
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

static void drop_loose_triangles(vsc_mesh *mesh, const uint8_t *used, uint8_t *keep)
{
  size_t kept = 0;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const uint32_t *corner = mesh->triangles + 3 * t;
    keep[t] = used[corner[0]] && used[corner[1]] && used[corner[2]];
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
  for (size_t i = 0; i < mesh->node_count; i++) {
    place[i] = (uint32_t)kept;
    if (!used[i]) continue;
    memmove(mesh->nodes + 3 * kept, mesh->nodes + 3 * i, 3 * sizeof *mesh->nodes);
    mesh->node_source[kept++] = mesh->node_source[i];
  }
  for (size_t i = 0; i < 4 * mesh->element_count; i++) mesh->corners[i] = place[mesh->corners[i]];
  for (size_t i = 0; i < 3 * mesh->triangle_count; i++)
    mesh->triangles[i] = place[mesh->triangles[i]];
  squeeze_arrays(&mesh->node_data, used, kept);
  mesh->report.unused_nodes = mesh->node_count - kept;
  mesh->node_count = kept;
}

static vsc_status drop_unused(vsc_mesh *mesh, const uint8_t *used, vsc_error *error)
{
  uint8_t *keep = NULL;
  uint32_t *place = NULL;
  const bool memory = VSC_NEW(keep, mesh->triangle_count) && VSC_NEW(place, mesh->node_count);
  if (memory) {
    drop_loose_triangles(mesh, used, keep);
    drop_unused_nodes(mesh, used, place);
  }
  vsc_free(keep);
  vsc_free(place);
  return memory ? VSC_OK : vsc_fail_memory(error, "the mesh's node numbers");
}

vsc_status vsc_mesh_clean(vsc_mesh *mesh, const char *name, vsc_error *error)
{
  if (mesh->element_count == 0)
    return vsc_fail(error, VSC_INPUT, "%s: holds no tetrahedra: mesh the organ's volume", name);
  if (mesh->report.file_nodes == 0) mesh->report.file_nodes = mesh->node_count;
  if (mesh->report.file_cells == 0)
    mesh->report.file_cells = mesh->element_count + mesh->triangle_count;
  vsc_status status = check_numbers(mesh, name, error);
  if (status != VSC_OK) return status;

  uint8_t *used;
  if (!VSC_NEW(used, mesh->node_count)) return vsc_fail_memory(error, "the mesh's node numbers");
  mark_used(mesh, used);
  status = check_nodes(mesh, used, name, error);
  if (status == VSC_OK) status = check_tets(mesh, name, error);
  if (status == VSC_OK) {
    turn_left_handed(mesh);
    status = drop_unused(mesh, used, error);
  }
  vsc_free(used);
  return status;
}
