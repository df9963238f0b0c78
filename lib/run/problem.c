// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/problem.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

#include "base/mem.h"
#include "io/vtk.h"
#include "model/small_strain.h"
#include "run/job.h"
#include "run/prestress.h"
#include "solve/mass_scaling.h"

double vsc_wall_seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double vsc_cpu_seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// The named surfaces, which fibres and curved edges hang on, and behind them the whole boundary.
typedef struct named_surfaces {
  size_t count;
  vsc_surface *items;
} named_surfaces;

static vsc_status select_surfaces(const vsc_problem *problem, named_surfaces *surfaces,
                                  vsc_error *error)
{
  const vsc_definition *definition = &problem->scene->definition;
  *surfaces = (named_surfaces){0};
  const size_t named = definition->surface_count;
  if (!VSC_NEW(surfaces->items, named + 1)) return vsc_fail_memory(error, "surfaces");
  surfaces->count = named + 1;
  vsc_surface *boundary = &surfaces->items[named];
  vsc_status status = vsc_boundary(problem->mesh, boundary, error);
  for (size_t s = 0; s < named && status == VSC_OK; s++)
    status = vsc_in_list("surfaces", s,
                         vsc_select_surface(problem->mesh, boundary, &definition->surfaces[s], &surfaces->items[s], error),
                         error);
  return status;
}

static void free_surfaces(named_surfaces *surfaces)
{
  for (size_t s = 0; s < surfaces->count; s++) vsc_surface_free(&surfaces->items[s]);
  vsc_free(surfaces->items);
}

static vsc_status bend_surface(vsc_problem *problem, const named_surfaces *surfaces,
                               const vsc_curved_def *curved, vsc_error *error)
{
  const vsc_surface *boundary = &surfaces->items[surfaces->count - 1], *surface = surfaces->items;
  while (surface < boundary && strcmp(surface->name, curved->surface) != 0) surface++;
  return vsc_mesh_bend(problem->mesh, boundary, surface, curved, error);
}

// The mesh as the scene wants it: its order, and edges bent onto ellipsoids.
static vsc_status shape_mesh(vsc_problem *problem, const char *file, vsc_error *error)
{
  const vsc_scene *scene = problem->scene;
  named_surfaces surfaces;
  vsc_status status = VSC_OK;
  if (scene->mesh_order == 2) status = vsc_mesh_raise(&problem->mesh, scene->mesh_file, error);
  if (status != VSC_OK || scene->curved_count == 0) return status;
  status = select_surfaces(problem, &surfaces, error);
  for (size_t k = 0; k < scene->curved_count && status == VSC_OK; k++)
    status = bend_surface(problem, &surfaces, &scene->curved[k], error);
  free_surfaces(&surfaces);
  return vsc_in_scene(file, status, error);
}

static vsc_status make_fibers(vsc_problem *problem, vsc_error *error)
{
  named_surfaces surfaces = {0};
  vsc_status status = VSC_OK;
  const vsc_fiber_def *fibers = &problem->scene->fibers;
  if (vsc_fiber_needs_surfaces(fibers)) status = select_surfaces(problem, &surfaces, error);
  if (status == VSC_OK)
    status = vsc_fibers_make(problem->mesh, fibers, surfaces.items, surfaces.count, &problem->axes,
                             &problem->fibers, error);
  free_surfaces(&surfaces);
  return status;
}

// Each tissue without inclusions of its own takes the vessels as inclusions.
static vsc_status include_vessels(vsc_definition *definition, vsc_error *error)
{
  for (size_t m = 0; m < definition->material_count; m++) {
    vsc_material_def *tissue = &definition->materials[m];
    if (tissue->inclusion_count > 0 || !vsc_takes_elements(definition, m)) continue;
    vsc_free(tissue->inclusions);
    if (!VSC_NEW(tissue->inclusions, definition->vessel_count))
      return vsc_fail_memory(error, "the vessels of a material");
    for (size_t v = 0; v < definition->vessel_count; v++) {
      const vsc_vessel_def *vessel = &definition->vessels[v];
      if (strcmp(vessel->material, tissue->name) == 0) continue;
      vsc_inclusion_def *made = &tissue->inclusions[tissue->inclusion_count++];
      vsc_copy_name(made->material, vessel->material);
      snprintf(made->fraction_array, VSC_NAME, "%.*s_fraction", VSC_NAME - 10, vessel->name);
    }
  }
  return VSC_OK;
}

static vsc_status make_vessels(vsc_problem *problem, vsc_error *error)
{
  vsc_definition *definition = &problem->scene->definition;
  if (definition->vessel_count == 0) return VSC_OK;
  if (!VSC_NEW(problem->vessels, definition->vessel_count))
    return vsc_fail_memory(error, "the vessels");
  vsc_status status =
      vsc_vessels_make(problem->mesh, definition->vessels, definition->vessel_count, problem->axes,
                       problem->vessels, error);
  if (status == VSC_OK) status = vsc_fiber_describe(problem->axes, &problem->fibers, error);
  return status == VSC_OK ? include_vessels(definition, error) : status;
}

static vsc_status find_points(vsc_problem *problem, vsc_error *error)
{
  const vsc_mesh *mesh = problem->mesh;
  const vsc_output_def *output = &problem->scene->output;
  if (output->point_count == 0) return VSC_OK;
  if (mesh->element_count == 0)
    return vsc_fail(error, VSC_INPUT,
                    "output.points: points are observed within elements, and %s has none: remove them",
                    problem->scene->mesh_file);
  if (!VSC_NEW(problem->points, output->point_count))
    return vsc_fail_memory(error, "the observed points");
  const double size = vsc_mesh_element_size(mesh);
  for (size_t k = 0; k < output->point_count; k++) {
    const vsc_point_def *point = &output->points[k];
    const double reach = point->reach > 0 ? point->reach : 0.1 * size;
    vsc_place *place = &problem->points[k];
    double nearest[3];
    vsc_place_find(mesh, point->at, place);
    vsc_place_value(mesh, place, 3, mesh->nodes, nearest);
    if (place->distance > reach)
      return vsc_fail(error, VSC_INPUT,
                      "output.points[%zu]: %s at (%.6g, %.6g, %.6g) mm lies %.4g mm outside the body, "
                      "further than %.4g mm; its nearest place is (%.6g, %.6g, %.6g) mm: take that, or "
                      "give a reach",
                      k, point->name, point->at[0], point->at[1], point->at[2], place->distance,
                      reach, nearest[0], nearest[1], nearest[2]);
  }
  return VSC_OK;
}

vsc_status vsc_in_scene(const char *file, vsc_status status, vsc_error *error)
{
  if (status == VSC_OK || error == NULL || strstr(error->text, file) != NULL) return status;
  const vsc_error bare = *error;
  return vsc_fail(error, status, "%s: %s", file, bare.text);
}

static vsc_status read_problem(const char *file, const char *const *settings, size_t setting_count,
                               vsc_problem *problem, vsc_error *error)
{
  vsc_status status = vsc_scene_read(file, settings, setting_count, &problem->scene, error);
  if (status == VSC_OK)
    status = vsc_vtk_read_mesh(problem->scene->mesh_file, problem->scene->mesh_unit, &problem->mesh, error);
  if (status == VSC_OK) status = shape_mesh(problem, file, error);
  if (status == VSC_OK) status = vsc_in_scene(file, find_points(problem, error), error);
  if (status == VSC_OK) status = vsc_in_scene(file, make_fibers(problem, error), error);
  return status == VSC_OK ? vsc_in_scene(file, make_vessels(problem, error), error) : status;
}

// Arrays that hold no fibre at all were meant to give directions.
static vsc_status check_fibers(const vsc_problem *problem, vsc_error *error)
{
  const vsc_fiber_report *report = &problem->fibers;
  const vsc_fiber_def *def = &problem->scene->fibers;
  if (def->source != VSC_FIBER_ARRAYS || report->passive < report->elements) return VSC_OK;
  const size_t undirected = vsc_undirected_elements(problem->model);
  if (undirected == 0) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "fibers.arrays.fiber: none of the vectors of '%s' is a direction (of %zu elements they are zero or not "
                  "finite), and the material of %zu elements depends on it: correct the array or name another",
                  def->fiber_array, report->invalid, undirected);
}

static vsc_status build_problem(vsc_problem *problem, vsc_error *error)
{
  const vsc_definition *definition = &problem->scene->definition;
  vsc_status status = vsc_model_build(problem->mesh, problem->axes, definition, &problem->model, error);
  if (status == VSC_OK) status = check_fibers(problem, error);
  if (status == VSC_OK) status = vsc_scale_masses(problem->model, definition, error);
  if (status == VSC_OK) status = vsc_frames_check(problem, error);
  return vsc_in_scene(problem->scene->file, status, error);
}

vsc_status vsc_problem_load(const char *file, const char *const *settings, size_t setting_count,
                            vsc_problem **problem, vsc_error *error)
{
  const double start = vsc_wall_seconds();
  vsc_problem *made;
  *problem = NULL;
  if (!VSC_NEW(made, 1)) return vsc_fail_memory(error, "the scene");
  vsc_status status = read_problem(file, settings, setting_count, made, error);
  made->input_seconds = vsc_wall_seconds() - start;
  if (status == VSC_OK) status = build_problem(made, error);
  made->build_seconds = vsc_wall_seconds() - start - made->input_seconds;
  if (status == VSC_OK)
    *problem = made;
  else
    vsc_problem_free(made);
  return status;
}

vsc_status vsc_problem_start(const vsc_problem *problem, vsc_state **state, vsc_error *error)
{
  const vsc_model *model = problem->model;
  const vsc_unloaded *unloaded = problem->unloaded;
  const vsc_status status = vsc_state_create(model, state, error);
  if (status != VSC_OK || unloaded == NULL || !unloaded->found) return status;
  for (size_t n = 0; n < model->node_count; n++)
    memcpy((*state)->x + 4 * n, unloaded->start + 4 * (size_t)model->mesh_node[n], 4 * sizeof(double));
  (*state)->time = problem->scene->prestress.time;
  (*state)->loaded = true;
  return VSC_OK;
}

void vsc_problem_free(vsc_problem *problem)
{
  if (problem == NULL) return;
  vsc_unloaded_free(problem->unloaded);
  vsc_model_free(problem->model);
  vsc_axes_free(problem->axes);
  vsc_free(problem->vessels);
  vsc_free(problem->points);
  vsc_mesh_free(problem->mesh);
  vsc_scene_free(problem->scene);
  vsc_free(problem);
}
