// SPDX-License-Identifier: GPL-3.0-or-later
// Patches: their parts are those of the mesh, of one tissue and kind each, and only nodes of several patches are shared.
#include "model/patches.h"

#include "random_body.h"

// Two tissues of springs, or the second of springs on edges.
static void open_tissues(random_body *body, size_t n, bool classical)
{
  vsc_mesh *mesh = random_block(n, 3);
  body_define(body, mesh, random_axes(mesh->element_count, 4), VSC_ACTIVE_NONE, VSC_VOLUME_ELEMENT);
  if (classical) {
    body->materials[1].law = VSC_LAW_CLASSICAL;
    body->materials[1].classical = (vsc_classical_def){20, 0};
  }
  body_build(body);
}

static uint32_t mesh_node_of(const vsc_model *model, const vsc_patch *patch, size_t k, int corner, int lane)
{
  return model->mesh_node[vsc_node_of(model, patch, vsc_pack_nodes(model, patch, k)[corner][lane])];
}

// Returns whether lane `l` of pack `k` has a part, which is as it is in the mesh.
static bool check_part(const random_body *body, const vsc_patch *patch, size_t k, int l)
{
  const vsc_model *model = body->model;
  const vsc_mesh *mesh = body->mesh;
  if (patch->family == VSC_SPRINGS_ON_EDGES) {
    const vsc_edge_pack *pack = (const vsc_edge_pack *)(model->store + patch->packs) + (k - patch->first_pack);
    if (!(pack->length[l] > 0)) return false;
    double way = 0;
    for (size_t i = 0; i < 3; i++)
      way += pow(mesh->nodes[3 * mesh_node_of(model, patch, k, 0, l) + i] -
                     mesh->nodes[3 * mesh_node_of(model, patch, k, 1, l) + i], 2);
    assert_close(pack->length[l], sqrt(way), 1e-14, 0);
    return true;
  }
  const uint32_t element = model->mesh_element[VSC_WIDTH * k + (size_t)l];
  if (element == VSC_NO_ELEMENT) return false;
  const vsc_array *region = vsc_arrays_find(&mesh->element_data, "region");
  assert_true(region->values[element] == patch->material + 1.0);
  for (int c = 0; c < vsc_family_corners(patch->family); c++)
    assert_int_equal(mesh_node_of(model, patch, k, c, l), vsc_mesh_corners(mesh, element)[c]);
  return true;
}

// Counts the parts and the patches of each node.
static size_t check_patch(const random_body *body, size_t p, size_t *patches_of, size_t *seen)
{
  const vsc_model *model = body->model;
  const vsc_patch *patch = &model->patches[p];
  size_t parts = 0;
  for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
    for (int l = 0; l < VSC_WIDTH; l++) {
      if (!check_part(body, patch, k, l)) continue;
      parts++;
      for (int c = 0; c < vsc_family_corners(patch->family); c++) {
        const uint32_t node = vsc_node_of(model, patch, vsc_pack_nodes(model, patch, k)[c][l]);
        patches_of[node] += seen[node] != p + 1;
        seen[node] = p + 1;
      }
    }
  for (uint32_t s = 0; s < patch->shared_count; s++) {
    const uint32_t node = model->shared[patch->first_shared + s];
    assert_int_equal(seen[node], p + 1);
    seen[node] = 0;  // each is listed once
  }
  return parts;
}

static void patches_hold_the_mesh(void **state)
{
  (void)state;
  for (int classical = 0; classical < 2; classical++) {
    random_body body;
    open_tissues(&body, 9, classical);
    const vsc_model *model = body.model;
    size_t *patches_of, *seen, cells = 0, springs = 0;
    if (!VSC_NEW(patches_of, model->node_count) || !VSC_NEW(seen, model->node_count)) abort();
    for (size_t p = 0; p < model->patch_count; p++) {
      const size_t parts = check_patch(&body, p, patches_of, seen);
      *(model->patches[p].family == VSC_TETS ? &cells : &springs) += parts;
    }
    assert_int_equal(cells, body.mesh->element_count);
    assert_int_equal(springs > 0, classical);
    assert_true(model->patch_count > 16 && model->own_node_count > 0);
    for (size_t n = 0; n < model->node_count; n++) {
      assert_true(patches_of[n] > 0);
      assert_int_equal(patches_of[n] > 1, n >= model->own_node_count);
    }
    vsc_free(patches_of);
    vsc_free(seen);
    body_close(&body);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(patches_hold_the_mesh),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
