// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/split.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

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
