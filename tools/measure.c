// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera measure`: how a slice of the tissue has moved, turned and changed its size.
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/vec3.h"
#include "io/vtk.h"
#include "tools/results.h"
#include "tools/verbs.h"

typedef struct wish {
  int axis;             // 0 to 2: the slice lies across it; -1: all nodes
  double value, reach;  // mm: nodes that are at rest within `reach` of `value`
  bool frames;          // every frame, else the last
} wish;

static void print_help(void)
{
  puts(
      "Usage: viscera measure [OPTION]... RESULT...\n"
      "Measures the nodes of a slice in a VTU file, or in the last frame of a folder that\n"
      "`viscera run` made, and prints a table (CSV):\n"
      "  time                    s; 0 for a VTU file\n"
      "  nodes                   in the slice\n"
      "  move_x move_y move_z    mean displacement, mm\n"
      "  turn                    about the vertical through its centre, degrees, "
      "counter-clockwise\n"
      "                          seen from above\n"
      "  size_x size_y size_z    root mean square distance from its centre over that at rest\n\n"
      "      --at AXIS=MM        the slice of nodes that were there at rest, as z=0 [all nodes]\n"
      "      --reach MM          how far from it they may have been [1e-3]\n"
      "      --frames            a row for each frame of the folder\n"
      "  -h, --help              this text\n\n"
      "Examples:\n"
      "  viscera measure --at z=0 block          how the bottom of a hanging block has moved\n"
      "  viscera measure --at z=20 --reach 1 --frames block");
}

static bool read_slice(const char *text, wish *wish)
{
  char axis, rest;
  if (sscanf(text, "%c=%lf%c", &axis, &wish->value, &rest) != 2) return false;
  wish->axis = axis - 'x';
  return wish->axis >= 0 && wish->axis < 3 && isfinite(wish->value);
}

// Sums over the nodes of the slice.
typedef struct slice {
  size_t count;
  double rest[3], now[3];      // means
  double before[3], after[3];  // squares of the distances from the means
  double along, across;        // of turning
} slice;

static bool within(const wish *wish, const double *node)
{
  return wish->axis < 0 || fabs(node[wish->axis] - wish->value) <= wish->reach;
}

static slice measure_nodes(const wish *wish, const vsc_mesh *mesh, const double *displacement)
{
  slice s = {0};
  for (int pass = 0; pass < 2; pass++)
    for (size_t i = 0; i < mesh->node_count; i++) {
      const double *rest = &mesh->nodes[3 * i];
      double now[3], a[3], b[3];
      if (!within(wish, rest)) continue;
      for (size_t k = 0; k < 3; k++) now[k] = rest[k] + displacement[3 * i + k];
      if (pass == 0) {
        s.count++;
        for (int k = 0; k < 3; k++) {
          s.rest[k] += (rest[k] - s.rest[k]) / (double)s.count;
          s.now[k] += (now[k] - s.now[k]) / (double)s.count;
        }
        continue;
      }
      vsc_subtract(rest, s.rest, a);
      vsc_subtract(now, s.now, b);
      for (int k = 0; k < 3; k++) {
        s.before[k] += a[k] * a[k];
        s.after[k] += b[k] * b[k];
      }
      s.along += a[0] * b[0] + a[1] * b[1];
      s.across += a[0] * b[1] - a[1] * b[0];
    }
  return s;
}

static vsc_status measure_file(const wish *wish, const char *file, double time, vsc_error *error)
{
  vsc_mesh *mesh = NULL;
  const vsc_status status = vsc_vtk_read_mesh(file, 1, &mesh, error);
  if (status != VSC_OK) return status;
  const vsc_array *moved = vsc_arrays_find(&mesh->node_data, "displacement");
  if (moved == NULL || moved->components != 3) {
    vsc_mesh_free(mesh);
    return vsc_fail(error, VSC_INPUT, "%s: there is no point array 'displacement'", file);
  }
  const slice s = measure_nodes(wish, mesh, moved->values);
  vsc_mesh_free(mesh);
  if (s.count == 0)
    return vsc_fail(error, VSC_INPUT, "%s: no node within %g mm of %c = %g mm at rest", file,
                    wish->reach, 'x' + wish->axis, wish->value);
  printf("%.9g,%zu", time, s.count);
  for (int k = 0; k < 3; k++) printf(",%.6g", s.now[k] - s.rest[k]);
  printf(",%.6g", atan2(s.across, s.along) * 180 / M_PI);
  for (int k = 0; k < 3; k++)
    printf(",%.6g", s.before[k] > 1e-12 * (double)s.count ? sqrt(s.after[k] / s.before[k]) : 1);
  putchar('\n');
  return VSC_OK;
}

static vsc_status measure_folder(const wish *wish, const char *folder, vsc_error *error)
{
  vsc_results results;
  char file[2 * VSC_RESULT_PATH];
  vsc_status status = vsc_results_open(folder, &results, error);
  if (status != VSC_OK) return status;
  const size_t count = vsc_pvd_count(results.series);
  for (size_t f = wish->frames ? 0 : count - 1; f < count && status == VSC_OK; f++) {
    vsc_pvd_frame_path(results.pvd, results.series, f, file, sizeof file);
    status = measure_file(wish, file, vsc_pvd_time(results.series, f), error);
  }
  vsc_results_close(&results);
  return status;
}

int vsc_verb_measure(int argc, char **argv)
{
  static const struct option options[] = {{"at", required_argument, NULL, 'a'},
                                          {"reach", required_argument, NULL, 'r'},
                                          {"frames", no_argument, NULL, 'f'},
                                          {"help", no_argument, NULL, 'h'},
                                          {0}};
  wish wish = {.axis = -1, .reach = 1e-3};
  optind = 0;
  for (int option; (option = getopt_long(argc, argv, "h", options, NULL)) != -1;) {
    char rest;
    bool good = option != '?';
    if (option == 'h') return print_help(), VSC_OK;
    if (option == 'a') good = read_slice(optarg, &wish);
    if (option == 'r') good = sscanf(optarg, "%lf%c", &wish.reach, &rest) == 1 && wish.reach >= 0;
    if (option == 'f') wish.frames = true;
    if (good) continue;
    if (option != '?') fprintf(stderr, "viscera: measure: '%s' does not fit\n", optarg);
    return VSC_INPUT;
  }
  if (optind == argc) {
    fprintf(stderr,
            "viscera: measure: give a VTU file or a folder of results, see `viscera "
            "measure --help`\n");
    return VSC_INPUT;
  }
  puts("time,nodes,move_x,move_y,move_z,turn,size_x,size_y,size_z");
  vsc_status status = VSC_OK;
  vsc_error error;
  for (; optind < argc && status == VSC_OK; optind++) {
    struct stat facts;
    const bool folder = stat(argv[optind], &facts) == 0 && S_ISDIR(facts.st_mode);
    status = folder ? measure_folder(&wish, argv[optind], &error)
                    : measure_file(&wish, argv[optind], 0, &error);
  }
  if (status != VSC_OK) fprintf(stderr, "viscera: measure: %s\n", error.text);
  return (int)status;
}
