// SPDX-License-Identifier: GPL-3.0-or-later
// The packs of a patch, filled from its parts.
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/jacobian.h"
#include "model/paper.h"
#include "model/patches.h"

// What one part is filled from.
typedef struct filling {
  const vsc_mesh *mesh;
  const vsc_axes *axes;
  const vsc_patch *patch;
  vsc_model *model;
  const uint32_t *local;
} filling;

static void *at(const filling *fill, size_t offset)
{
  return fill->model->store + offset;
}

// The pack's nodes, [corner][lane], which are ours to write here.
static uint16_t (*nodes_of(const filling *fill, size_t k))[VSC_WIDTH]
{
  return (uint16_t(*)[VSC_WIDTH])(uintptr_t)vsc_pack_nodes(fill->model, fill->patch, k);
}

static vsc_status fill_paper_data(const filling *fill, size_t element, const double (*x)[3],
                                  const double *frame, size_t index, int lane, vsc_error *error)
{
  double r[3], w[3][8], radius[8];
  if (fill->patch->family == VSC_TETS) {
    vsc_chords *chords = (vsc_chords *)at(fill, fill->patch->law_data) + index;
    vsc_paper_tet(x, frame, r, radius);
    for (int a = 0; a < 3; a++) chords->r[a][lane] = r[a];
    chords->radius[lane] = radius[0];
    return VSC_OK;
  }
  vsc_hex_axes *axes = (vsc_hex_axes *)at(fill, fill->patch->law_data) + index;
  if (!vsc_paper_hex(x, frame, w, r, radius))
    return vsc_fail(error, VSC_INPUT,
                    "element %u: an axis of law: paper meets no two of its faces; mend this "
                    "hexahedron or use law: springs",
                    fill->mesh->element_source[element]);
  for (int a = 0; a < 3; a++) {
    axes->r[a][lane] = r[a];
    for (int i = 0; i < 8; i++) axes->w[a][i][lane] = w[a][i];
  }
  for (int i = 0; i < 8; i++) axes->radius[i][lane] = radius[i];
  axes->volume[lane] = vsc_mesh_element_volume(fill->mesh, element);
  return VSC_OK;
}

VSC_CLONED static vsc_status fill_cell(const filling *fill, size_t element, const uint32_t *corner, size_t index,
                                       int lane, vsc_error *error)
{
  static const double global_axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  vsc_model *model = fill->model;
  const vsc_patch *patch = fill->patch;
  const vsc_cell_rule *rule = &model->rules[patch->family];
  const double *frame = fill->axes ? vsc_axes_frame(fill->axes, element, 0) : global_axes;
  const size_t k = patch->first_pack + index, slot = VSC_WIDTH * k + (size_t)lane;
  vsc_frame *frames = (vsc_frame *)(uintptr_t)vsc_pack_frames(model, patch, k);
  vsc_four x[VSC_MOST_CORNERS];
  const int corners = vsc_family_corners(patch->family);
  vsc_cell_places(fill->mesh->nodes, corner, corners, x);
  for (int c = 0; c < corners; c++) nodes_of(fill, k)[c][lane] = (uint16_t)fill->local[corner[c]];
  for (int q = 0; q < rule->points; q++) {
    double J[3][4], h[3][3], T[3][3];
    vsc_cell_jacobian(rule, q, corners, x, J);
    for (int i = 0; i < 3; i++) memcpy(h[i], J[i], sizeof h[i]);
    const double *own = fill->axes ? vsc_axes_frame(fill->axes, element, q) : frame;
    frames[q].V[lane] = rule->weight[q] * vsc_stencil_frame(h, own, T);
    model->total_volume += frames[q].V[lane];
    for (int a = 0; a < 3; a++)
      for (int i = 0; i < 3; i++) frames[q].T[a][i][lane] = T[a][i];
  }
  model->mesh_element[slot] = (uint32_t)element;
  model->known[slot] = fill->axes ? fill->axes->known[element] : 0;
  if (patch->smoothed) {
    vsc_smoothed_pack *smoothed = (vsc_smoothed_pack *)at(fill, patch->smoothed) + index;
    for (int i = 0; i < 9; i++) smoothed->axes[i / 3][i % 3][lane] = frame[i];
  }
  if (patch->law_data == 0) return VSC_OK;
  double places[VSC_MOST_CORNERS][3];
  for (int c = 0; c < corners; c++) memcpy(places[c], &x[c], sizeof places[c]);
  return fill_paper_data(fill, element, places, frame, index, lane, error);
}

static void fill_spring(const filling *fill, const uint32_t *node, size_t index, int lane)
{
  vsc_edge_pack *pack = (vsc_edge_pack *)at(fill, fill->patch->packs) + index;
  double way[3];
  const double *x = fill->mesh->nodes;
  vsc_subtract(x + 3 * (size_t)node[0], x + 3 * (size_t)node[1], way);
  pack->length[lane] = vsc_norm(way);
  for (int i = 0; i < 2; i++) pack->node[i][lane] = (uint16_t)fill->local[node[i]];
}

static void fill_triangle(const filling *fill, const vsc_sheet *sheet, uint32_t triangle,
                          size_t index, int lane)
{
  vsc_triangle_pack *pack = (vsc_triangle_pack *)at(fill, fill->patch->packs) + index;
  const vsc_membrane *membrane = &fill->model->membranes[fill->patch->material];
  for (int a = 0; a < 2; a++)
    for (int k = 0; k < 2; k++) pack->T[a][k][lane] = sheet->T[triangle][a][k];
  pack->V[lane] = membrane->thickness * sheet->area[triangle];
  for (int i = 0; i < 3; i++)
    pack->node[i][lane] = (uint16_t)fill->local[sheet->nodes[triangle][i]];
}

static void fill_bend(const filling *fill, const vsc_sheet *sheet, uint32_t triangle, size_t index,
                      int lane)
{
  vsc_bend_pack *pack = (vsc_bend_pack *)at(fill, fill->patch->packs) + index;
  for (int j = 0; j < VSC_BEND_FOLDS; j++) {
    pack->bends.rest[j][lane] = sheet->fold[triangle][j];
    for (int i = 0; i < 3; i++) pack->bends.G[i][j][lane] = sheet->G[triangle][i][j];
  }
  for (int i = 0; i < VSC_BEND_NODES; i++)
    pack->node[i][lane] = (uint16_t)fill->local[sheet->nodes[triangle][i]];
}

// Asks for the axes of an element that is to come: elements are anywhere in the mesh.
static void prefetch_axes(const vsc_axes *axes, size_t element)
{
  const char *frames = (const char *)vsc_axes_frame(axes, element, 0);
  const size_t bytes = 9 * sizeof(double) * (size_t)axes->points;
  for (size_t byte = 0; byte < bytes; byte += VSC_ALIGNMENT) __builtin_prefetch(frames + byte);
  __builtin_prefetch(frames + bytes - 1);
  __builtin_prefetch(axes->known + element);
}

vsc_status vsc_patch_fill(const vsc_mesh *mesh, const vsc_axes *axes, const vsc_patch_parts *parts,
                          const uint32_t *local, const vsc_patch *patch, vsc_model *model, vsc_error *error)
{
  enum { AHEAD = 8 };
  const filling fill = {mesh, axes, patch, model, local};
  const size_t corners = (size_t)vsc_family_corners(patch->family);
  const bool solid = vsc_patch_is_solid(patch);
  for (size_t k = 0; k < parts->count; k++) {
    const size_t index = k / VSC_WIDTH;
    const int lane = (int)(k % VSC_WIDTH);
    const uint32_t *nodes = parts->nodes + corners * k;
    if (solid && axes != NULL && k + AHEAD < parts->count) prefetch_axes(axes, parts->source[k + AHEAD]);
    if (solid) {
      const vsc_status status = fill_cell(&fill, parts->source[k], nodes, index, lane, error);
      if (status != VSC_OK) return status;
    } else if (patch->family == VSC_TRIANGLES) {
      fill_triangle(&fill, &parts->sheets[patch->material], parts->source[k], index, lane);
    } else if (patch->family == VSC_BENDS) {
      fill_bend(&fill, &parts->sheets[patch->material], parts->source[k], index, lane);
    } else {
      fill_spring(&fill, nodes, index, lane);
    }
  }
  return VSC_OK;
}
