// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/split.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"

// Part of the element's volume below which a tet is flat to rounding.
static const double FLAT = 1e-9;

int vsc_face_cut(const uint32_t *corners, const int face[4], uint32_t triangles[2][3])
{
  const int sides = face[3] < 0 ? 3 : 4;
  int least = 0;
  for (int i = 1; i < sides && sides == 4; i++)
    if (corners[face[i]] < corners[face[least]]) least = i;
  for (int t = 0; t < sides - 2; t++)
    for (int i = 0; i < 3; i++)
      triangles[t][i] = corners[face[(least + (i == 0 ? 0 : t + i)) % sides]];
  return sides - 2;
}

static bool face_holds(const int face[4], int corner)
{
  for (int i = 0; i < 4; i++)
    if (face[i] == corner) return true;
  return false;
}

int vsc_mesh_split(const vsc_mesh *mesh, size_t element, uint32_t tets[VSC_MOST_TETS][4])
{
  const uint32_t *corners = vsc_mesh_corners(mesh, element);
  if (mesh->kinds[element] == VSC_TET) {
    memcpy(tets[0], corners, 4 * sizeof *corners);
    return 1;
  }
  if (mesh->kinds[element] == VSC_TET10) {
    static const int parts[8][4] = {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3},
                                    {4, 9, 5, 6}, {4, 9, 6, 7}, {4, 9, 7, 8}, {4, 9, 8, 5}};
    for (int t = 0; t < 8; t++)
      for (int i = 0; i < 4; i++) tets[t][i] = corners[parts[t][i]];
    return 8;
  }
  const vsc_cell_kind *kind = vsc_mesh_kind(mesh, element);
  const double flat = FLAT * fabs(vsc_mesh_element_volume(mesh, element));
  int least = 0, count = 0;
  for (int c = 1; c < kind->corners; c++)
    if (corners[c] < corners[least]) least = c;
  for (int f = 0; f < kind->face_count; f++) {
    uint32_t triangles[2][3];
    if (face_holds(kind->faces[f], least)) continue;
    const int pieces = vsc_face_cut(corners, kind->faces[f], triangles);
    for (int t = 0; t < pieces; t++) {
      tets[count][0] = corners[least];
      memcpy(tets[count] + 1, triangles[t], sizeof triangles[t]);
      const double *x[4];
      for (int i = 0; i < 4; i++) x[i] = mesh->nodes + 3 * (size_t)tets[count][i];
      count += fabs(vsc_tet_volume(x[0], x[1], x[2], x[3])) > flat;
    }
  }
  return count;
}

// ---- a whole mesh

// The tets of a mesh, and whose they are.
typedef struct cut_tets {
  size_t count;
  uint32_t (*corners)[4];
  uint32_t *element;
} cut_tets;

static vsc_status cut_elements(const vsc_mesh *mesh, const char *name, cut_tets *tets, vsc_error *error)
{
  const size_t most = VSC_MOST_TETS * mesh->element_count;
  if (!VSC_NEW(tets->corners, most) || !VSC_NEW(tets->element, most)) return vsc_fail_memory(error, "tetrahedra");
  for (size_t e = 0; e < mesh->element_count; e++) {
    const size_t first = tets->count;
    tets->count += (size_t)vsc_mesh_split(mesh, e, tets->corners + first);
    for (size_t t = first; t < tets->count; t++) {
      const double *x[4];
      for (int i = 0; i < 4; i++) x[i] = mesh->nodes + 3 * (size_t)tets->corners[t][i];
      tets->element[t] = (uint32_t)e;
      if (!(vsc_tet_volume(x[0], x[1], x[2], x[3]) > 0))
        return vsc_fail(error, VSC_INPUT,
                        "%s: element %u, a %s, is bent so much that it cannot be cut into tetrahedra for mesh.order: 2: "
                        "mesh with tetrahedra, or leave out mesh.order",
                        name, mesh->element_source[e], vsc_mesh_kind(mesh, e)->name);
    }
  }
  return VSC_OK;
}

// Copies arrays: of tuple k that of place[k], or of k itself where there are no places.
static bool copy_arrays(const vsc_arrays *from, const uint32_t *place, size_t count, vsc_arrays *to)
{
  for (size_t a = 0; a < from->count; a++) {
    const vsc_array *array = &from->items[a];
    const size_t width = (size_t)array->components, tuples = place != NULL ? count : array->tuples;
    vsc_array *copy = vsc_arrays_add(to, array->name, array->components, tuples);
    if (copy == NULL) return false;
    copy->single = array->single;
    for (size_t k = 0; k < tuples; k++)
      memcpy(copy->values + width * k, array->values + width * (place != NULL ? place[k] : k), width * sizeof *copy->values);
  }
  return true;
}

// The mesh of the tets, or NULL when memory is short.
static vsc_mesh *mesh_of_tets(const vsc_mesh *from, const cut_tets *tets)
{
  vsc_mesh *to = vsc_mesh_create(from->node_count, tets->count, from->triangle_count);
  if (to == NULL) return NULL;
  memcpy(to->nodes, from->nodes, 3 * from->node_count * sizeof *to->nodes);
  memcpy(to->node_source, from->node_source, from->node_count * sizeof *to->node_source);
  memcpy(to->corners, tets->corners, tets->count * sizeof *tets->corners);
  for (size_t t = 0; t < tets->count; t++) to->element_source[t] = from->element_source[tets->element[t]];
  if (from->triangle_count > 0)
    memcpy(to->triangles, from->triangles, 3 * from->triangle_count * sizeof *to->triangles);
  to->report = from->report;
  if (copy_arrays(&from->node_data, NULL, 0, &to->node_data) &&
      copy_arrays(&from->element_data, tets->element, tets->count, &to->element_data) &&
      copy_arrays(&from->triangle_data, NULL, 0, &to->triangle_data))
    return to;
  vsc_mesh_free(to);
  return NULL;
}

vsc_status vsc_mesh_cut(vsc_mesh **mesh, const char *name, vsc_error *error)
{
  cut_tets tets = {0};
  vsc_mesh *made = NULL;
  vsc_status status = cut_elements(*mesh, name, &tets, error);
  if (status == VSC_OK) made = mesh_of_tets(*mesh, &tets);
  vsc_free(tets.corners);
  vsc_free(tets.element);
  if (status != VSC_OK) return status;
  if (made == NULL) return vsc_fail_memory(error, "the mesh of tetrahedra");
  vsc_mesh_free(*mesh);
  *mesh = made;
  return VSC_OK;
}
