// SPDX-License-Identifier: GPL-3.0-or-later
// What a run reads is not among what it writes.
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "run/job.h"

// Whether both names lead to one and the same file or folder.
static bool is_same(const char *a, const char *b)
{
  struct stat first, second;
  return stat(a, &first) == 0 && stat(b, &second) == 0 && first.st_dev == second.st_dev &&
         first.st_ino == second.st_ino;
}

static bool lies_in(const char *file, const char *folder)
{
  char parent[VSC_PATH] = ".";
  const char *slash = strrchr(file, '/');
  if (slash != NULL) snprintf(parent, sizeof parent, "%.*s", (int)(slash + 1 - file), file);
  return is_same(parent, folder);
}

// The scene of a run that is resumed may be the one that the run itself has left.
static vsc_status spare(const vsc_job *job, const char *input, bool scene, vsc_error *error)
{
  static const char *const written[] = {"signals.csv", "summary.json",  "checkpoint.h5", "convergence.csv", "prestress.csv",
                                        "reference.vtu", ".pvd", "scene.yaml"};
  const size_t count = sizeof written / sizeof written[0] - (scene && job->options->resume);
  char path[VSC_PATH];
  for (size_t k = 0; k < count; k++) {
    vsc_job_path(job, written[k], path);
    if (is_same(input, path))
      return vsc_fail(error, VSC_INPUT, "%s: the run needs this file and would replace it by its own results; choose "
                      "another folder than %s with -o", input, job->options->directory);
  }
  vsc_job_path(job, "frames", path);
  if (!lies_in(input, path)) return VSC_OK;
  return vsc_fail(error, VSC_INPUT, "%s: the run needs this file and would put its own frames beside or over it; choose "
                  "another folder than %s with -o", input, job->options->directory);
}

// A scene.yaml that no run has left is the user's.
static vsc_status spare_other_scene(const vsc_job *job, vsc_error *error)
{
  char path[VSC_PATH], line[sizeof VSC_SCENE_UNDERSTOOD] = "";
  vsc_job_path(job, "scene.yaml", path);
  FILE *file = fopen(path, "r");
  if (file == NULL) return VSC_OK;
  const size_t length = fread(line, 1, sizeof line - 1, file);
  fclose(file);
  if (length == 0 || strcmp(line, VSC_SCENE_UNDERSTOOD) == 0) return VSC_OK;
  return vsc_fail(error, VSC_INPUT, "%s: is a scene that no run has left, and this run would replace it by its own as "
                  "understood; choose another folder with -o", path);
}

vsc_status vsc_job_spare_inputs(const vsc_job *job, vsc_error *error)
{
  const vsc_scene *scene = job->problem->scene;
  vsc_status status = spare(job, scene->file, true, error);
  if (status == VSC_OK) status = spare_other_scene(job, error);
  for (size_t i = 0; i < scene->input_count && status == VSC_OK; i++)
    status = spare(job, scene->inputs[i], false, error);
  return status;
}
