// SPDX-License-Identifier: GPL-3.0-or-later
// What is left of the search for the shape at rest: prestress.csv and reference.vtu.
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "io/replace.h"
#include "io/vtk.h"
#include "run/job.h"
#include "run/prestress.h"

static void write_rows(const vsc_unloaded *unloaded, FILE *file)
{
  fputs("iteration,relaxation [1],largest [mm],mean [mm]\n", file);
  for (size_t k = 0; k < unloaded->row_count; k++) {
    const vsc_prestress_row *row = &unloaded->rows[k];
    fprintf(file, "%d,%.6g,%.6e,%.6e\n", row->iteration, row->relaxation, row->largest, row->mean);
  }
}

static vsc_status write_table(const vsc_job *job, vsc_error *error)
{
  char path[VSC_PATH];
  vsc_replacement table;
  vsc_job_path(job, "prestress.csv", path);
  const vsc_status status = vsc_replace_begin(path, &table, error);
  if (status != VSC_OK) return status;
  write_rows(job->problem->unloaded, table.stream);
  return vsc_replace_end(&table, false, error);
}

// Nodes at rest, and from there to the mesh's.
static void fill_nodes(const vsc_problem *problem, double *nodes, double *displacement)
{
  for (size_t i = 0; i < 3 * problem->mesh->node_count; i++) {
    nodes[i] = problem->unloaded->rest[4 * (i / 3) + i % 3];
    displacement[i] = problem->mesh->nodes[i] - nodes[i];
  }
}

static vsc_status write_shape(const vsc_job *job, vsc_state *state, const char *file, vsc_error *error)
{
  enum { AXES = 3, ARRAYS = AXES + 2 };
  static const char *const names[AXES] = {"fiber", "sheet", "normal"};
  const vsc_problem *problem = job->problem;
  const vsc_mesh *mesh = problem->mesh;
  const vsc_array *region = vsc_arrays_find(&mesh->element_data, problem->scene->definition.region_array);
  vsc_mesh shown = *mesh;
  double *displacement = NULL, *axes[AXES] = {NULL};
  vsc_vtk_array arrays[ARRAYS];
  bool made = VSC_NEW(shown.nodes, 3 * mesh->node_count) && VSC_NEW(displacement, 3 * mesh->node_count);
  size_t count = 0;
  if (made) fill_nodes(problem, shown.nodes, displacement);
  arrays[count++] = (vsc_vtk_array){"displacement", 3, displacement, VSC_ON_NODES, false};
  for (int a = 0; a < AXES && made; a++) {
    made = VSC_NEW(axes[a], 3 * mesh->element_count);
    if (made) vsc_read_field(problem->model, state, (vsc_field)(VSC_FIELD_FIBER + a), axes[a]);
    arrays[count++] = (vsc_vtk_array){names[a], 3, axes[a], VSC_ON_ELEMENTS, false};
  }
  if (region != NULL && region->components == 1)
    arrays[count++] = (vsc_vtk_array){"region", 1, region->values, VSC_ON_ELEMENTS, true};
  shown.triangle_count = 0;
  const vsc_status status = made ? vsc_vtk_write_mesh(file, &shown, count, arrays, true, error)
                                 : vsc_fail_memory(error, "the shape at rest");
  for (int a = 0; a < AXES; a++) vsc_free(axes[a]);
  vsc_free(displacement);
  vsc_free(shown.nodes);
  return status;
}

vsc_status vsc_job_write_unloaded(vsc_job *job, vsc_error *error)
{
  const vsc_unloaded *unloaded = job->problem->unloaded;
  char path[VSC_PATH];
  vsc_state *state;
  vsc_status status = unloaded != NULL ? write_table(job, error) : VSC_OK;
  if (status != VSC_OK) return status;
  vsc_job_path(job, "reference.vtu", path);
  unlink(path);
  if (unloaded == NULL || !unloaded->found) return VSC_OK;
  status = vsc_state_create(job->problem->model, &state, error);
  if (status == VSC_OK) status = write_shape(job, state, path, error);
  vsc_state_free(state);
  return status;
}
