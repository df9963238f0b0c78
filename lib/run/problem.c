// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/problem.h"

#include <string.h>
#include <time.h>

#include "base/mem.h"
#include "io/vtk.h"

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

// The fibres of a helix hang on named surfaces, so those are found here already.
static vsc_status make_fibers(vsc_problem *problem, vsc_error *error)
{
  const vsc_definition *definition = &problem->scene->definition;
  vsc_surface *surfaces, boundary = {0};
  if (!VSC_NEW(surfaces, definition->surface_count)) return vsc_fail_memory(error, "surfaces");
  vsc_status status = vsc_boundary(problem->mesh, &boundary, error);
  size_t made = 0;
  while (status == VSC_OK && made < definition->surface_count) {
    status = vsc_select_surface(problem->mesh, &boundary, &definition->surfaces[made],
                                &surfaces[made], error);
    made++;
  }
  if (status == VSC_OK)
    status = vsc_fibers_make(problem->mesh, &problem->scene->fibers, surfaces, made, &problem->axes,
                             &problem->fibers, error);
  for (size_t s = 0; s < made; s++) vsc_surface_free(&surfaces[s]);
  vsc_surface_free(&boundary);
  vsc_free(surfaces);
  return status;
}

vsc_status vsc_in_scene(const char *file, vsc_status status, vsc_error *error)
{
  if (status == VSC_OK || error == NULL || strstr(error->text, file) != NULL) return status;
  const vsc_error bare = *error;
  return vsc_fail(error, status, "%s: %s", file, bare.text);
}

vsc_status vsc_problem_load(const char *file, const char *const *settings, size_t setting_count,
                            vsc_problem **problem, vsc_error *error)
{
  const double start = vsc_wall_seconds();
  vsc_problem *made;
  *problem = NULL;
  if (!VSC_NEW(made, 1)) return vsc_fail_memory(error, "the scene");
  vsc_status status = vsc_scene_read(file, settings, setting_count, &made->scene, error);
  if (status == VSC_OK)
    status = vsc_vtk_read_mesh(made->scene->mesh_file, made->scene->mesh_unit, &made->mesh, error);
  if (status == VSC_OK) status = vsc_in_scene(file, make_fibers(made, error), error);
  if (status == VSC_OK)
    status = vsc_in_scene(
        file,
        vsc_model_build(made->mesh, made->axes, &made->scene->definition, &made->model, error),
        error);
  if (status != VSC_OK) {
    vsc_problem_free(made);
    return status;
  }
  made->load_seconds = vsc_wall_seconds() - start;
  *problem = made;
  return VSC_OK;
}

void vsc_problem_free(vsc_problem *problem)
{
  if (problem == NULL) return;
  vsc_model_free(problem->model);
  vsc_axes_free(problem->axes);
  vsc_mesh_free(problem->mesh);
  vsc_scene_free(problem->scene);
  vsc_free(problem);
}
