// SPDX-License-Identifier: GPL-3.0-or-later
// viscera schema
#include <getopt.h>
#include <stdio.h>

#include "io/scene.h"
#include "tools/verbs.h"

int vsc_verb_schema(int argc, char **argv)
{
  static const struct option options[] = {{"help", no_argument, NULL, 'h'}, {0}};
  for (int c; (c = getopt_long(argc, argv, "h", options, NULL)) != -1;) {
    if (c != 'h') return 2;
    puts(
        "Usage: viscera schema\n"
        "Prints a commented template of everything that a scene can say, itself a valid scene.\n\n"
        "Example:\n"
        "  viscera schema > my.yaml");
    return 0;
  }
  if (optind < argc) {
    fprintf(stderr, "viscera schema: '%s' means nothing here\n", argv[optind]);
    return 2;
  }
  vsc_scene_schema(stdout);
  return 0;
}
