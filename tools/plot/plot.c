// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera-plot DIR`, also `viscera plot DIR`: graphs and pictures of a simulation's results. A
// program of its own, because PLplot and cairo should not be loaded by simulations.
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/vtk.h"
#include "tools/plot/bench.h"
#include "tools/plot/errors.h"
#include "tools/plot/ink.h"
#include "tools/plot/outcomes.h"
#include "tools/plot/page.h"
#include "tools/plot/polar.h"
#include "tools/plot/several.h"
#include "tools/results.h"

typedef struct request {
  const char *folder;
  const char *polar, *title;  // instead: curves of `viscera calibrate`
  const char *outcomes;       // or what `viscera bench stability` left
  const char *errors;         // or `viscera bench error`
  const char *bench;          // or other sections of it
  char output[VSC_RESULT_PATH];
  vsc_results results;
  char signals[VSC_RESULT_PATH];  // the CSV
  double axis[3], from[3];
  bool from_given, whole;
  double time;  // s; NAN: where the cavity is smallest
} request;

static void print_help(void)
{
  puts(
      "Usage: viscera plot [OPTION]... DIR\n"
      "Draws what a simulation left in DIR (signals.csv, one .pvd series and its frames) into\n"
      "DIR/beat.png: cavity volume, wall volume and active tension against time, and the tissue\n"
      "at rest and where the first cavity is smallest, cut open along its long axis.\n\n"
      "  -o, --output FILE  the PNG to write, NAME.png\n"
      "      --at TIME      show the frame nearest to this time, in seconds\n"
      "      --axis X,Y,Z   the long axis from apex to base, upwards in the picture (0,0,1)\n"
      "      --from X,Y,Z   the direction from which to look, across the axis (widest view)\n"
      "      --whole        don't cut the tissue open\n"
      "      --view, --curves   first of all: several results in one picture, see --view --help\n"
      "      --polar CSV    instead of results: the curves that `viscera calibrate --picture` left\n"
      "      --title TEXT   their title\n"
      "      --outcomes CSV instead of results: what `viscera bench stability` left\n"
      "      --errors CSV   instead of results: what `viscera bench error` left\n"
      "      --bench CSV    instead of results: what `viscera bench throughput`, growth, skipping or start left\n"
      "  -h, --help         this text\n\n"
      "Examples:\n"
      "  viscera plot beat\n"
      "  viscera plot --axis 0,1,0 --whole -o heart.png results\n"
      "  viscera plot --polar muscle.csv -o muscle.png");
}

static int fail(const vsc_error *error)
{
  fprintf(stderr, "viscera: plot: %s\n", error->text);
  return error->status;
}

static vsc_status read_vector(const char *option, const char *text, double vector[3],
                              vsc_error *error)
{
  char rest;
  if (sscanf(text, "%lf,%lf,%lf%c", &vector[0], &vector[1], &vector[2], &rest) == 3 &&
      isfinite(vector[0] + vector[1] + vector[2]) &&
      (vector[0] != 0 || vector[1] != 0 || vector[2] != 0))
    return VSC_OK;
  return vsc_fail(error, VSC_INPUT, "--%s %s: expected a direction X,Y,Z such as 0,0,1", option,
                  text);
}

static vsc_status read_time(const char *text, double *time, vsc_error *error)
{
  char *end;
  *time = strtod(text, &end);
  if (end != text && *end == '\0' && isfinite(*time)) return VSC_OK;
  return vsc_fail(error, VSC_INPUT, "--at %s: expected a time in seconds such as 0.3", text);
}

// Finds the files of the folder.
static vsc_status find_files(request *wish, vsc_error *error)
{
  const vsc_status status = vsc_results_open(wish->folder, &wish->results, error);
  if (status != VSC_OK) return status;
  const int folder = (int)(strrchr(wish->results.pvd, '/') - wish->results.pvd);
  snprintf(wish->signals, sizeof wish->signals, "%.*s/signals.csv", folder, wish->results.pvd);
  if (wish->output[0] == '\0')
    snprintf(wish->output, sizeof wish->output, "%.*s/beat.png", folder, wish->results.pvd);
  return VSC_OK;
}

// The time at which the first cavity is smallest (or the active tension largest), in seconds.
static double most_contracted(const vsc_signals *signals)
{
  const double *time = vsc_signals_find(signals, "time");
  const size_t cavity = vsc_signals_next(signals, "cavity_", 0);
  const double *tension = vsc_signals_find(signals, "active_tension_mean");
  if (time == NULL || signals->rows == 0) return INFINITY;
  size_t best = signals->rows - 1;
  for (size_t r = 0; r < signals->rows; r++) {
    if (cavity < signals->columns) {
      const double *volume = signals->values + cavity * signals->rows;
      if (volume[r] < volume[best]) best = r;
    } else if (tension != NULL && tension[r] > tension[best]) {
      best = r;
    }
  }
  const size_t column = (size_t)(time - signals->values) / signals->rows;
  return time[best] * (strcmp(signals->units[column], "ms") == 0 ? 1e-3 : 1);
}

// Reads the frame that shall be shown into `page`, which then refers to *mesh.
static vsc_status read_frame(const request *wish, vsc_page *page, vsc_mesh **mesh, vsc_error *error)
{
  char file[2 * VSC_RESULT_PATH];
  const size_t frame = vsc_results_nearest(
      &wish->results, isnan(wish->time) ? most_contracted(page->signals) : wish->time);
  page->time = vsc_pvd_time(wish->results.series, frame);
  page->chosen = !isnan(wish->time);
  vsc_pvd_frame_path(wish->results.pvd, wish->results.series, frame, file, sizeof file);
  const vsc_status status = vsc_vtk_read_mesh(file, 1, mesh, error);
  if (status != VSC_OK) return status;
  const vsc_array *displacement = vsc_arrays_find(&(*mesh)->node_data, "displacement");
  const vsc_array *tension = vsc_arrays_find(&(*mesh)->element_data, "active_tension");
  if (displacement == NULL || displacement->components != 3)
    return vsc_fail(error, VSC_INPUT, "%s: there is no point array 'displacement' of 3 components",
                    file);
  if (tension == NULL)
    fprintf(stderr, "viscera: plot: %s: there is no cell array 'active_tension': not coloured\n",
            file);
  page->mesh = *mesh;
  page->displacement = displacement->values;
  page->tension = tension != NULL && tension->components == 1 ? tension->values : NULL;
  return VSC_OK;
}

static void make_title(const request *wish, vsc_page *page)
{
  const char *name = strrchr(wish->results.pvd, '/') + 1;
  snprintf(page->title, sizeof page->title, "%.*s", (int)(strlen(name) - strlen(".pvd")), name);
}

static vsc_status draw(request *wish, vsc_error *error)
{
  vsc_page page = {0};
  vsc_signals *signals = NULL;
  vsc_mesh *mesh = NULL;
  vsc_status status = find_files(wish, error);
  if (status == VSC_OK) status = vsc_signals_read(wish->signals, &signals, error);
  page.signals = signals;
  if (status == VSC_OK) status = read_frame(wish, &page, &mesh, error);
  if (status == VSC_OK) {
    make_title(wish, &page);
    page.camera =
        vsc_camera_make(mesh, wish->axis, wish->from_given ? wish->from : NULL, wish->whole);
    status = vsc_page_draw(&page, wish->output, error);
  }
  vsc_mesh_free(mesh);
  vsc_signals_free(signals);
  vsc_results_close(&wish->results);
  return status;
}

static vsc_status read_option(int option, request *wish, vsc_error *error)
{
  switch (option) {
    case 'o':
      if (vsc_check_png(optarg, error) != VSC_OK) return error->status;
      if (snprintf(wish->output, sizeof wish->output, "%s", optarg) < VSC_RESULT_PATH - 8) return VSC_OK;
      return vsc_fail(error, VSC_INPUT, "--output: the name is too long");
    case 't':
      return read_time(optarg, &wish->time, error);
    case 'a':
      return read_vector("axis", optarg, wish->axis, error);
    case 'f':
      wish->from_given = true;
      return read_vector("from", optarg, wish->from, error);
    case 'w':
      wish->whole = true;
      return VSC_OK;
    case 'p':
      wish->polar = optarg;
      return VSC_OK;
    case 'O':
      wish->outcomes = optarg;
      return VSC_OK;
    case 'E':
      wish->errors = optarg;
      return VSC_OK;
    case 'B':
      wish->bench = optarg;
      return VSC_OK;
    case 'T':
      wish->title = optarg;
      return VSC_OK;
    default:
      return vsc_fail(error, VSC_INPUT, "`viscera plot --help` lists the options");
  }
}

static vsc_status draw_csv(const request *wish, bool folder, vsc_error *error)
{
  if (wish->output[0] == '\0' || folder)
    return vsc_fail(error, VSC_INPUT, "--%s: give the PNG by -o, and no folder",
                    wish->polar != NULL      ? "polar"
                    : wish->outcomes != NULL ? "outcomes"
                    : wish->errors != NULL   ? "errors"
                                             : "bench");
  if (wish->polar != NULL) return vsc_polar_draw(wish->polar, wish->title, wish->output, error);
  if (wish->outcomes != NULL) return vsc_outcomes_draw(wish->outcomes, wish->output, error);
  return wish->errors != NULL ? vsc_errors_draw(wish->errors, wish->output, error)
                              : vsc_bench_picture(wish->bench, wish->output, error);
}

int main(int argc, char **argv)
{
  static const struct option options[] = {
      {"output", required_argument, NULL, 'o'}, {"at", required_argument, NULL, 't'},
      {"axis", required_argument, NULL, 'a'},   {"from", required_argument, NULL, 'f'},
      {"whole", no_argument, NULL, 'w'},        {"help", no_argument, NULL, 'h'},
      {"version", no_argument, NULL, 'v'},      {"polar", required_argument, NULL, 'p'},
      {"title", required_argument, NULL, 'T'},  {"outcomes", required_argument, NULL, 'O'},
      {"errors", required_argument, NULL, 'E'}, {"bench", required_argument, NULL, 'B'}, {0}};
  if (argc > 1 && (strcmp(argv[1], "--view") == 0 || strcmp(argv[1], "--curves") == 0))
    return vsc_plot_several(argc - 1, argv + 1);
  request wish = {.title = "", .axis = {0, 0, 1}, .time = NAN};
  vsc_error error;
  for (int option; (option = getopt_long(argc, argv, "o:h", options, NULL)) != -1;) {
    if (option == 'h') {
      print_help();
      return VSC_OK;
    }
    if (option == 'v') {
      puts("viscera-plot " VISCERA_VERSION);
      return VSC_OK;
    }
    if (read_option(option, &wish, &error) != VSC_OK) return fail(&error);
  }
  if (wish.polar != NULL || wish.outcomes != NULL || wish.errors != NULL || wish.bench != NULL)
    return draw_csv(&wish, argc != optind, &error) == VSC_OK ? VSC_OK : fail(&error);
  if (argc - optind != 1) {
    vsc_fail(&error, VSC_INPUT, "give one folder of results; `viscera plot --help` tells more");
    return fail(&error);
  }
  wish.folder = argv[optind];
  return draw(&wish, &error) == VSC_OK ? VSC_OK : fail(&error);
}
