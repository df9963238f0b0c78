// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera plot --view` and `viscera plot --curves`: several results in one picture.
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tools/plot/curves.h"
#include "tools/plot/ink.h"
#include "tools/plot/panels.h"
#include "tools/plot/several.h"

enum { MOST_ITEMS = 24 };

typedef struct wish {
  vsc_panels panels;
  vsc_curves curves;
  const char *output;
  vsc_panel items[MOST_ITEMS];
} wish;

static void print_help(void)
{
  puts(
      "Usage: viscera plot --view [OPTION]... RESULT[=CAPTION]...\n"
      "       viscera plot --curves COLUMN [OPTION]... DIR[=CAPTION]...\n"
      "Several results in one picture: the tissue as it has moved, with the edges of its "
      "elements,\n"
      "in grey where it was at rest; or a column of signals.csv against time. A RESULT is a VTU\n"
      "file or a folder that `viscera run` made.\n\n"
      "  -o, --output FILE       the PNG to write [view.png]\n"
      "      --title TEXT        above the picture\n"
      "--view:\n"
      "      --array NAME        point or cell array that gives the colours [displacement]\n"
      "      --unit TEXT         written behind its name\n"
      "      --range LOW,HIGH    of the colours\n"
      "      --at TIME           frame of the folders, in seconds [the last]\n"
      "      --from X,Y,Z        the direction from which to look [0.3,-1,0]\n"
      "      --columns N         panels in a row [4]\n"
      "      --sphere X,Y,Z,R    a ball, mm\n"
      "--curves:\n"
      "      --relative          as the change from the first value, in percent\n"
      "  -h, --help              this text\n\n"
      "Examples:\n"
      "  viscera plot --view -o blocks.png \"soft=classical springs\" \"stiff=our law\"\n"
      "  viscera plot --curves wall_volume --relative -o volume.png soft stiff");
}

enum { TITLE = 256, ARRAY, UNIT, RANGE, TIME, FROM, COLUMNS, SPHERE, RELATIVE };

static const struct option options[] = {{"output", required_argument, NULL, 'o'},
                                        {"title", required_argument, NULL, TITLE},
                                        {"array", required_argument, NULL, ARRAY},
                                        {"unit", required_argument, NULL, UNIT},
                                        {"range", required_argument, NULL, RANGE},
                                        {"at", required_argument, NULL, TIME},
                                        {"from", required_argument, NULL, FROM},
                                        {"columns", required_argument, NULL, COLUMNS},
                                        {"sphere", required_argument, NULL, SPHERE},
                                        {"relative", no_argument, NULL, RELATIVE},
                                        {"help", no_argument, NULL, 'h'},
                                        {0}};

static bool read_option(int option, wish *wish)
{
  vsc_panels *p = &wish->panels;
  char rest;
  switch (option) {
    case 'o':
      wish->output = optarg;
      return true;
    case TITLE:
      p->title = wish->curves.title = optarg;
      return true;
    case ARRAY:
      p->array = optarg;
      return true;
    case UNIT:
      p->unit = optarg;
      return true;
    case RANGE:
      return sscanf(optarg, "%lf,%lf%c", &p->low, &p->high, &rest) == 2;
    case TIME:
      return sscanf(optarg, "%lf%c", &p->time, &rest) == 1;
    case FROM:
      return sscanf(optarg, "%lf,%lf,%lf%c", &p->from[0], &p->from[1], &p->from[2], &rest) == 3;
    case COLUMNS:
      return sscanf(optarg, "%d%c", &p->columns, &rest) == 1 && p->columns > 0;
    case SPHERE: {
      if (p->sphere_count == VSC_MOST_SPHERES) return false;
      double *s = p->spheres[p->sphere_count++];
      return sscanf(optarg, "%lf,%lf,%lf,%lf%c", &s[0], &s[1], &s[2], &s[3], &rest) == 4;
    }
    default:
      wish->curves.relative = true;
      return true;
  }
}

static void read_items(wish *wish, int count, char **texts)
{
  for (int k = 0; k < count; k++) {
    char *equals = strchr(texts[k], '=');
    if (equals != NULL) *equals = '\0';
    wish->items[k] = (vsc_panel){texts[k], equals == NULL ? texts[k] : equals + 1};
  }
  wish->panels.count = wish->curves.count = (size_t)count;
  wish->panels.items = wish->items;
  wish->curves.items = wish->items;
}

int vsc_plot_several(int argc, char **argv)
{
  wish wish = {.panels = {.title = "",
                          .unit = "",
                          .low = NAN,
                          .high = NAN,
                          .time = NAN,
                          .from = {0.3, -1, 0},
                          .columns = 4},
               .curves = {.title = ""},
               .output = "view.png"};
  const bool view = strcmp(argv[0], "--view") == 0;
  if (!view && argc > 1 && argv[1][0] != '-') {
    wish.curves.column = argv[1];
    argc--, argv++;
  }
  argv[0] = "viscera: plot";  // before getopt's messages
  int index = 0;
  for (int option; (option = getopt_long(argc, argv, "o:h", options, &index)) != -1;) {
    if (option == 'h') return print_help(), VSC_OK;
    if (option == '?') return VSC_INPUT;
    if (!read_option(option, &wish)) {
      fprintf(stderr, "viscera: plot: --%s %s does not fit, see `viscera plot --view --help`\n",
              options[index].name, optarg);
      return VSC_INPUT;
    }
  }
  if (argc - optind < 1 || argc - optind > MOST_ITEMS) {
    fprintf(stderr, "viscera: plot: give 1 to %d results, see `viscera plot --view --help`\n",
            MOST_ITEMS);
    return VSC_INPUT;
  }
  if (!view && wish.curves.column == NULL) {
    fprintf(stderr, "viscera: plot: --curves: give a column of signals.csv\n");
    return VSC_INPUT;
  }
  read_items(&wish, argc - optind, argv + optind);
  vsc_error error;
  vsc_status status = vsc_check_png(wish.output, &error);
  if (status == VSC_OK)
    status = view ? vsc_panels_draw(&wish.panels, wish.output, &error)
                  : vsc_curves_draw(&wish.curves, wish.output, &error);
  if (status != VSC_OK) fprintf(stderr, "viscera: plot: %s\n", error.text);
  return status;
}
