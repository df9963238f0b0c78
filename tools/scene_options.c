// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/scene_options.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/parallel.h"

int vsc_keep_setting(vsc_scene_options *options, const char *setting)
{
  if (options->setting_count == VSC_MOST_SETTINGS) {
    fprintf(stderr, "viscera: more than %d --set options: put the values into the scene\n",
            VSC_MOST_SETTINGS);
    return 2;
  }
  options->settings[options->setting_count++] = setting;
  return 0;
}

int vsc_keep_threads(const char *text)
{
  char *end;
  const long threads = strtol(text, &end, 10);
  if (*end != '\0' || end == text || threads < 1 || threads > 1024) {
    fprintf(stderr, "viscera: --threads %s: expected a whole number from 1 to 1024\n", text);
    return 2;
  }
  vsc_parallel_set_threads((int)threads);
  return 0;
}

int vsc_load_scene(const vsc_scene_options *options, vsc_problem **problem)
{
  vsc_error error;
  const vsc_status status =
      vsc_problem_load(options->scene, options->settings, options->setting_count, problem, &error);
  if (status != VSC_OK) fprintf(stderr, "viscera: %s\n", error.text);
  return (int)status;
}
