// SPDX-License-Identifier: GPL-3.0-or-later
// viscera check
#include <getopt.h>
#include <stdio.h>

#include "run/check.h"
#include "tools/scene_options.h"
#include "tools/verbs.h"

static const char help[] =
    "Usage: viscera check [OPTION]... SCENE\n"
    "Says what a scene would do before it is run: what was read, where the fibres came from, the "
    "time step\n"
    "and what limits it, what the run will cost, and what looks suspicious.\n\n"
    "  -s, --set KEY=VALUE  replace or add a value of the scene\n"
    "  -t, --threads N      number of threads (default: all processors)\n"
    "  -h, --help           this text\n\n"
    "Exit codes: 0 the scene can be run (warnings or not), 2 it cannot, 3 no stable step, 4 "
    "system.\n\n"
    "Examples:\n"
    "  viscera check data/beat.yaml\n"
    "  viscera check data/beat.yaml --set 'time.end=0.4 s'\n";

int vsc_verb_check(int argc, char **argv)
{
  static const struct option options[] = {{"set", required_argument, NULL, 's'},
                                          {"threads", required_argument, NULL, 't'},
                                          {"help", no_argument, NULL, 'h'},
                                          {0}};
  vsc_scene_options scene = {0};
  for (int c; (c = getopt_long(argc, argv, "s:t:h", options, NULL)) != -1;) {
    int code = 0;
    if (c == 's')
      code = vsc_keep_setting(&scene, optarg);
    else if (c == 't')
      code = vsc_keep_threads(optarg);
    else if (c == 'h')
      return fputs(help, stdout) < 0 ? 4 : 0;
    else
      code = 2;
    if (code != 0) return code;
  }
  if (optind + 1 != argc) {
    fputs("viscera check: give one scene file; see `viscera check --help`\n", stderr);
    return 2;
  }
  scene.scene = argv[optind];
  vsc_problem *problem;
  vsc_error error;
  int code = vsc_load_scene(&scene, &problem);
  if (code != 0) return code;
  code = (int)vsc_check(problem, stdout, NULL, &error);
  if (code != 0) fprintf(stderr, "viscera: %s\n", error.text);
  vsc_problem_free(problem);
  return code;
}
