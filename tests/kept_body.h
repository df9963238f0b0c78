// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies whose volumes are kept, and how well they are: for tests.
#ifndef VSC_TESTS_KEPT_BODY_H
#define VSC_TESTS_KEPT_BODY_H

#include "close.h"

#include "base/mem.h"
#include "base/vec3.h"
#include "hybrid_mesh.h"
#include "small_body.h"

static const vsc_kept_volume kinds[] = {VSC_KEEP_TOTAL, VSC_KEEP_REGION, VSC_KEEP_NODE,
                                        VSC_KEEP_ELEMENT};

// A soft block that springs hardly keep from changing volume: of hexahedra and others for ELEMENT, of
// two tissues for REGION.
static inline void open_soft(small_body *body, vsc_kept_volume kind, vsc_material_def tissues[2])
{
  body_open(body, kind == VSC_KEEP_ELEMENT ? hybrid_block(2, 0.1, 5) : block_of(3, 2, 2, 1, 0.2), 4);
  body->definition.kept_volume = kind;
  if (kind != VSC_KEEP_REGION) return;
  double *region = vsc_arrays_find(&body->mesh->element_data, "region")->values;
  for (int m = 0; m < 2; m++) {
    tissues[m] = body->material;
    tissues[m].region_count = 1;
    tissues[m].regions[0] = m + 1;
    vsc_copy_name(tissues[m].name, m == 0 ? "left" : "right");
  }
  for (size_t e = 0; e < body->mesh->element_count; e++) {
    double centre[3];
    vsc_mesh_element_centre(body->mesh, e, centre);
    region[e] = centre[0] > 1.4 ? 2 : 1;
  }
  vsc_copy_name(body->definition.region_array, "region");
  body->definition.materials = tissues;
  body->definition.material_count = 2;
}

// Part of element `e` that belongs to kept volume k.
static inline double share_of(const small_body *body, size_t k, size_t e)
{
  const uint32_t source = body->model->kept.source[k];
  const vsc_mesh *mesh = body->mesh;
  switch (body->model->kept.kind) {
    case VSC_KEEP_TOTAL:
      return 1;
    case VSC_KEEP_REGION:
      return vsc_arrays_find(&mesh->element_data, "region")->values[e] == source + 1;
    case VSC_KEEP_NODE:
      for (int i = 0; i < 4; i++)
        if (vsc_mesh_corners(mesh, e)[i] == source) return 0.25;
      return 0;
    default:
      return e == source;
  }
}

// The largest change of a kept volume, from the elements' volumes at rest and now.
static inline double worst(small_body *body)
{
  vsc_mesh *mesh = body->mesh;
  const size_t count = 3 * mesh->node_count;
  double *rest = vsc_alloc(count, sizeof *rest), *before = NULL, *now = NULL, most = 0;
  assert_true(VSC_NEW(before, mesh->element_count) && VSC_NEW(now, mesh->element_count));
  for (size_t e = 0; e < mesh->element_count; e++) before[e] = vsc_mesh_element_volume(mesh, e);
  memcpy(rest, mesh->nodes, count * sizeof *rest);
  for (size_t n = 0; n < body->model->node_count; n++)
    memcpy(mesh->nodes + 3 * (size_t)body->model->mesh_node[n], body->state->x + 4 * n,
           3 * sizeof *rest);
  for (size_t e = 0; e < mesh->element_count; e++) now[e] = vsc_mesh_element_volume(mesh, e);
  memcpy(mesh->nodes, rest, count * sizeof *rest);
  for (size_t k = 0; k < body->model->kept.count; k++) {
    double sums[2] = {0};
    for (size_t e = 0; e < mesh->element_count; e++) {
      sums[0] += share_of(body, k, e) * before[e];
      sums[1] += share_of(body, k, e) * now[e];
    }
    most = fmax(most, fabs(sums[1] / sums[0] - 1));
  }
  vsc_free(rest);
  vsc_free(before);
  vsc_free(now);
  return most;
}

#endif
