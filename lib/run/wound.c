// SPDX-License-Identifier: GPL-3.0-or-later
#include <string.h>

#include "base/mem.h"
#include "run/job.h"

// The body in the model's order, in which what is near lies near in memory, whatever the order of the mesh.
typedef struct ordered {
  size_t count;
  uint32_t *elements;  // count: the mesh's elements; owned
  uint8_t *kinds;      // of these; owned
  uint32_t *number;    // the model's number of each node of the mesh; owned
  double *x;           // node_count x 3: places of the model's nodes, mm; owned
  vsc_mesh *rest;      // elements and nodes in this order, at rest; owned
} ordered;

static void free_ordered(ordered *body)
{
  vsc_free(body->elements);
  vsc_free(body->kinds);
  vsc_free(body->number);
  vsc_free(body->x);
  vsc_mesh_free(body->rest);
}

// Elements as patches have them; those behind, which are springs on edges there, as the mesh does.
static bool order_elements(const vsc_model *model, const vsc_mesh *mesh, ordered *body)
{
  uint8_t *listed;
  if (!VSC_NEW(listed, mesh->element_count)) return false;
  for (size_t slot = 0; slot < VSC_WIDTH * model->pack_count; slot++) {
    const uint32_t element = model->mesh_element[slot];
    if (element == VSC_NO_ELEMENT || listed[element]) continue;
    listed[element] = 1;
    body->elements[body->count++] = element;
  }
  for (size_t e = 0; e < mesh->element_count; e++)
    if (!listed[e]) body->elements[body->count++] = (uint32_t)e;
  for (size_t k = 0; k < body->count; k++) body->kinds[k] = mesh->kinds[body->elements[k]];
  vsc_free(listed);
  return true;
}

// False when memory is short.
static bool make_ordered(const vsc_model *model, const vsc_mesh *mesh, const double *x, ordered *body)
{
  const size_t nodes = model->node_count;
  *body = (ordered){.number = vsc_model_node_numbers(model)};
  if (body->number == NULL || !VSC_NEW(body->elements, mesh->element_count) || !VSC_NEW(body->kinds, mesh->element_count) ||
      !VSC_NEW(body->x, 3 * nodes) || !order_elements(model, mesh, body))
    return false;
  body->rest = vsc_mesh_create_cells(nodes, body->count, body->kinds, 0);
  if (body->rest == NULL) return false;
  for (size_t n = 0; n < nodes; n++) {
    memcpy(body->x + 3 * n, x + 4 * n, 3 * sizeof *x);
    memcpy(body->rest->nodes + 3 * n, model->rest + 4 * n, 3 * sizeof *x);
  }
  for (size_t k = 0; k < body->count; k++) {
    const uint32_t *from = vsc_mesh_corners(mesh, body->elements[k]);
    uint32_t *to = body->rest->corners + body->rest->start[k];
    for (int i = 0; i < vsc_cells[body->kinds[k]].corners; i++) to[i] = body->number[from[i]];
  }
  return true;
}

vsc_status vsc_job_find_wound(vsc_job *job, vsc_error *error)
{
  const vsc_model *model = job->problem->model;
  ordered body;
  vsc_status status = make_ordered(model, job->problem->mesh, job->state->x, &body)
                          ? VSC_OK : vsc_fail_memory(error, "the body in the model's order");
  if (status == VSC_OK) status = vsc_wound_find(body.rest, body.x, &job->wound, error);
  if (status == VSC_OK && job->wound.folded > 0) job->wound.element = body.elements[job->wound.element];
  free_ordered(&body);
  for (int i = 0; i < 2 && status == VSC_OK && job->wound.count > 0; i++)
    job->wound.ends[i] = model->mesh_node[job->wound.ends[i]];
  return status;
}
