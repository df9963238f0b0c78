// SPDX-License-Identifier: GPL-3.0-or-later
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "io/vtk.h"
#include "run/job.h"

// What a frame can hold: names are those of the scene's output.arrays.
static const struct {
  const char *name;
  vsc_field field;
  bool by_default;
} known_fields[] = {
    {"displacement", VSC_FIELD_DISPLACEMENT, true},
    {"velocity", VSC_FIELD_VELOCITY, true},
    {"fiber", VSC_FIELD_FIBER, true},
    {"sheet", VSC_FIELD_SHEET, false},
    {"normal", VSC_FIELD_NORMAL, false},
    {"active_tension", VSC_FIELD_ACTIVE_TENSION, true},
    {"stretch_f", VSC_FIELD_STRETCH, true},
    {"volume_ratio", VSC_FIELD_VOLUME_RATIO, true},
    {"volume_ratio", VSC_FIELD_GROUP_RATIO, true},  // on the nodes, beside the elements' own
    {"strain_fiber", VSC_FIELD_STRAIN_FIBER, false},
    {"strain", VSC_FIELD_STRAIN, false},
    {"principal_strains", VSC_FIELD_PRINCIPAL_STRAINS, false},
    {"principal_strain_axis", VSC_FIELD_PRINCIPAL_STRAIN_AXIS, false},
    {"stress_fiber", VSC_FIELD_STRESS_FIBER, false},
    {"stress", VSC_FIELD_STRESS, false},
    {"von_mises", VSC_FIELD_VON_MISES, false},
    {"principal_stresses", VSC_FIELD_PRINCIPAL_STRESSES, false},
    {"principal_stress_axis", VSC_FIELD_PRINCIPAL_STRESS_AXIS, false},
    {"helix_angle", VSC_FIELD_HELIX_ANGLE, false},
};
enum { FIELDS = sizeof known_fields / sizeof known_fields[0] };
_Static_assert((int)FIELDS < (int)VSC_SNAPSHOT_ARRAYS, "and the regions");

static bool is_wanted(const vsc_output_def *output, const char *name, bool by_default,
                      bool first_frame)
{
  // the first frame shows the axes that were used
  if (first_frame &&
      (strcmp(name, "fiber") == 0 || strcmp(name, "sheet") == 0 || strcmp(name, "normal") == 0))
    return true;
  if (output->array_count == 0) return by_default;
  for (size_t k = 0; k < output->array_count; k++)
    if (strcmp(output->arrays[k], name) == 0) return true;
  return false;
}

vsc_status vsc_frames_check(const vsc_problem *problem, vsc_error *error)
{
  for (int k = 0; k < FIELDS; k++) {
    vsc_error found;
    if (!is_wanted(&problem->scene->output, known_fields[k].name, known_fields[k].by_default, false))
      continue;
    const vsc_status status = vsc_field_check(problem->model, known_fields[k].field, &found);
    if (status != VSC_OK)
      return vsc_fail(error, status, "output.arrays: %s: %s", known_fields[k].name, found.text);
  }
  return VSC_OK;
}

// The line that helix angles are seen from.
static void read_helix_angle(const vsc_job *job, double *values)
{
  const vsc_scene *scene = job->problem->scene;
  const double *axis =
      vsc_norm(scene->output.axis) > 0 ? scene->output.axis : scene->fibers.long_axis;
  vsc_read_helix_angle(job->problem->model, job->state, scene->output.centre, axis, values);
}

// x - X with the mesh's nodes X, whatever the shape at rest is.
static void read_displacement(const vsc_job *job, double *values)
{
  const vsc_model *model = job->problem->model;
  for (size_t n = 0; n < model->node_count; n++)
    for (size_t i = 0, at = 3 * (size_t)model->mesh_node[n]; i < 3; i++)
      values[at + i] = job->state->x[4 * n + i] - job->problem->mesh->nodes[at + i];
}

static double *region_values(const vsc_problem *problem)
{
  const vsc_array *array =
      vsc_arrays_find(&problem->mesh->element_data, problem->scene->definition.region_array);
  return array != NULL && array->components == 1 ? array->values : NULL;
}

static void add_array(vsc_snapshot *frame, vsc_vtk_array array, bool owned)
{
  frame->owned[frame->count] = owned;
  frame->arrays[frame->count++] = array;
}

// Reads the wanted fields into the frame.
static vsc_status read_fields(vsc_job *job, bool first_frame, vsc_snapshot *frame, vsc_error *error)
{
  const vsc_model *model = job->problem->model;
  const vsc_output_def *output = &job->problem->scene->output;
  for (int k = 0; k < FIELDS; k++) {
    const vsc_field field = known_fields[k].field;
    if (!is_wanted(output, known_fields[k].name, known_fields[k].by_default, first_frame)) continue;
    if (field == VSC_FIELD_GROUP_RATIO && !model->terms.nodal_volume) continue;
    if (field == VSC_FIELD_ACTIVE_TENSION && model->terms.active == VSC_ACTIVE_NONE) continue;
    const bool on_nodes = vsc_field_on_nodes(field);
    const int components = vsc_field_components(field);
    double *values;
    if (!VSC_NEW(values, components * (on_nodes ? model->node_count : model->element_count)))
      return vsc_fail_memory(error, "a frame");
    if (field == VSC_FIELD_HELIX_ANGLE)
      read_helix_angle(job, values);
    else if (field == VSC_FIELD_DISPLACEMENT)
      read_displacement(job, values);
    else
      vsc_read_field(model, job->state, field, values);
    add_array(frame, (vsc_vtk_array){known_fields[k].name, components, values, on_nodes ? VSC_ON_NODES : VSC_ON_ELEMENTS, false}, true);
  }
  double *regions = region_values(job->problem);
  if (regions != NULL && is_wanted(output, "region", true, first_frame))
    add_array(frame, (vsc_vtk_array){"region", 1, regions, VSC_ON_ELEMENTS, true}, false);
  return VSC_OK;
}

vsc_status vsc_job_write_frame(vsc_job *job, vsc_error *error)
{
  vsc_snapshot *frame;
  if (!VSC_NEW(frame, 1)) return vsc_fail_memory(error, "a frame");
  frame->shown = *job->problem->mesh;
  // a body's own triangles would lie on its elements' faces, without their fields
  if (frame->shown.element_count > 0) frame->shown.triangle_count = 0;
  frame->time = 1e-3 * job->state->time;
  frame->double_precision = job->problem->scene->output.double_precision;
  snprintf(frame->name, sizeof frame->name, VSC_FRAME_NAME, job->name, job->frames);
  vsc_job_path(job, frame->name, frame->file);
  const vsc_status status = read_fields(job, job->frames == 0, frame, error);
  if (status != VSC_OK) {
    vsc_snapshot_free(frame);
    return status;
  }
  job->frames++;
  job->last_frame = job->state->time;
  return vsc_frame_writer_take(job->writer, frame, error);
}
