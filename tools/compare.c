// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera compare`: how far apart results are: two meshes or series array by array, a series of runs
// from coarse to fine, curves over time.
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tools/compare_fields.h"
#include "tools/compare_order.h"
#include "tools/compare_signals.h"
#include "tools/results.h"
#include "tools/verbs.h"

enum { DIFFERENT = 1 };
static const double SAME_TIME = 1e-9;  // s

typedef enum mode { FIELDS, ORDER, SIGNALS } mode;

typedef struct wish {
  mode mode;
  double tolerance;  // of a relative L2
  double reach;      // mm; 0: half an element
  bool interpolate, frames;
  double share;      // of times within a band
  size_t pair_count;
  vsc_curve_pair pairs[VSC_MOST_WANTED];
  vsc_order_wish order;
} wish;

static void print_help(void)
{
  puts(
      "Usage: viscera compare [OPTION]... A B\n"
      "       viscera compare --order [OPTION]... COARSE MIDDLE FINE...\n"
      "       viscera compare --signals [OPTION]... RUN REFERENCE.csv\n"
      "Error norms of the arrays that A and B have in common: two meshes (.vtu, .vtk), two\n"
      "series (.pvd) or two folders that `viscera run` made, of which the frames at equal\n"
      "times are compared. On different meshes B's arrays are interpolated at A's nodes, and\n"
      "A's elements take the values of those of B in which their centres lie, all at rest.\n\n"
      "  max abs      largest |a - b|\n"
      "  RMS          root of the mean of (a - b)^2\n"
      "  relative L2  |a - b|_2 / |b|_2: B is the reference\n"
      "  by volume    the same with each value weighted by the tissue it stands for\n\n"
      "  -t, --tolerance X  exit code 1 when a relative L2 is above X, when a frame of one\n"
      "                     series is missing in the other, when places were left out, or when\n"
      "                     nothing was compared; else 0\n"
      "      --frames       the norms of each frame too\n"
      "      --reach MM     how far places of A may lie outside B, whose nearest place is\n"
      "                     taken; others are left out and counted [half B's elements]\n"
      "      --interpolate  also on meshes of the same connectivity\n"
      "  -h, --help         this text\n\n"
      "--order: the signals at the end of runs on finer and finer meshes or with smaller and\n"
      "smaller steps: observed order, extrapolated value, uncertainty; and the errors of the\n"
      "last frames against the finest run.\n"
      "      --signal NAME  a column of signals.csv, again for more [cavities and points]\n"
      "      --exact X      what the one signal should be: errors and their slope too\n"
      "      --sizes H,H,H  sizes of the runs [(volume/elements)^(1/3) of their meshes; on one\n"
      "                     mesh their steps]\n\n"
      "--signals: columns of RUN (a folder or a signals.csv) against those of a table; the\n"
      "first column of both is the time. Tolerance: of all columns together; exit code 1 also\n"
      "when the run does not reach all times of the table.\n"
      "      --column A=B[,LOW,HIGH]  which, again for more; LOW and HIGH are the columns of a\n"
      "                               band\n"
      "      --within SHARE           exit code 1 when less than this part of the times, 0 to\n"
      "                               1, is within the bands, or the run does not reach all\n\n"
      "Examples:\n"
      "  viscera compare old/beat.pvd new/beat.pvd\n"
      "  viscera compare --tolerance 1e-6 result.vtu reference.vtu\n"
      "  viscera compare --order --signal cavity_endo coarse middle fine\n"
      "  viscera compare --signals --column point_p0_ux=p0_ux_mean_mm run teams.csv");
}

static vsc_status open_series(const char *file, vsc_pvd **series, vsc_error *error)
{
  if (access(file, R_OK) != 0)
    return vsc_fail(error, VSC_INPUT, "%s: cannot be read: %s; check its name", file, strerror(errno));
  const vsc_status status = vsc_pvd_open(file, HUGE_VAL, series, error);
  if (status == VSC_OK && vsc_pvd_count(*series) == 0)
    return vsc_fail(error, VSC_INPUT, "%s: the series has no frames", file);
  return status;
}

// The frame of `series` at that time, or its number of frames.
static size_t frame_at(const vsc_pvd *series, double time)
{
  size_t frame = 0;
  while (frame < vsc_pvd_count(series) && fabs(vsc_pvd_time(series, frame) - time) > SAME_TIME)
    frame++;
  return frame;
}

static size_t print_missing(const vsc_pvd *have, const vsc_pvd *lack, const char *file)
{
  size_t missing = 0;
  for (size_t f = 0; f < vsc_pvd_count(have); f++) {
    if (frame_at(lack, vsc_pvd_time(have, f)) < vsc_pvd_count(lack)) continue;
    if (missing == 0) printf("times missing in %s [s]:", file);
    if (missing++ < 10) printf(" %g", vsc_pvd_time(have, f));
  }
  if (missing > 10) printf(" and %zu more", missing - 10);
  if (missing > 0) putchar('\n');
  return missing;
}

static bool print_norms(const vsc_comparison *all, double tolerance)
{
  bool within = true;
  printf("%-24s %-9s %13s %13s %13s %13s %13s\n", "array", "on", "max abs", "RMS", "relative L2",
         "RMS", "relative L2");
  printf("%-24s %-9s %13s %13s %13s %13s %13s\n", "", "", "", "", "", "by volume", "by volume");
  for (size_t k = 0; k < all->count; k++) {
    const vsc_norms *n = &all->arrays[k];
    const double relative = vsc_norms_relative(n, false);
    const bool above = !(relative <= tolerance);
    if (n->values == 0) {
      printf("%-24s %-9s %13s\n", n->name, n->where, "-");
      continue;
    }
    printf("%-24s %-9s %13.6g %13.6g %13.6g", n->name, n->where, n->largest, vsc_norms_rms(n, false),
           relative);
    if (n->volume > 0)
      printf(" %13.6g %13.6g", vsc_norms_rms(n, true), vsc_norms_relative(n, true));
    else
      printf(" %13s %13s", "-", "-");
    puts(above ? "  above the tolerance" : "");
    within = within && !above;
  }
  return within;
}

// Whether something was compared, and at all of A's places; says so when not. Equal positions are an answer
// where there are no arrays to compare.
static bool print_left_out(const vsc_comparison *all)
{
  size_t compared = 0, left_out = 0;
  for (size_t k = 0; k < all->count; k++) {
    const bool counts = all->note[0] == '\0' || strcmp(all->arrays[k].name, "(positions)") != 0;
    if (counts) compared += all->arrays[k].values;
    left_out += all->arrays[k].left_out;
  }
  if (compared == 0)
    printf("no value was compared: %s\n", left_out > 0 ? "A lies outside B" : "no array is in both");
  else if (left_out > 0)
    puts("places of A were left out: --reach says how far outside B they may lie");
  return compared > 0 && left_out == 0;
}

static void print_places(const vsc_pair *pair)
{
  if (pair->a == NULL) return;
  if (pair->same && pair->centres != NULL)
    puts("elements joined to other points or in another order: A's take the values of those of B in "
         "which their centres lie");
  if (pair->same) return;
  printf("B's values interpolated at A's nodes: %zu of %zu outside B, their nearest place taken, %zu "
         "further than %.4g mm left out",
         pair->outside, pair->a->node_count, pair->left_out, pair->limit);
  if (pair->outside + pair->left_out > 0)
    printf("; the furthest by %.4g mm, at (%.6g, %.6g, %.6g) mm", pair->furthest, pair->furthest_at[0],
           pair->furthest_at[1], pair->furthest_at[2]);
  putchar('\n');
}

static vsc_status add_frames(const wish *wish, vsc_comparison *all, vsc_pair *pair,
                             const char *file_a, const vsc_pvd *a, const char *file_b,
                             const vsc_pvd *b, size_t *missing, vsc_error *error)
{
  size_t common = 0;
  vsc_status status = VSC_OK;
  for (size_t f = 0; f < vsc_pvd_count(a) && status == VSC_OK; f++) {
    char path_a[VSC_RESULT_PATH], path_b[VSC_RESULT_PATH];
    const size_t other = frame_at(b, vsc_pvd_time(a, f));
    if (other == vsc_pvd_count(b)) continue;
    vsc_pvd_frame_path(file_a, a, f, path_a, sizeof path_a);
    vsc_pvd_frame_path(file_b, b, other, path_b, sizeof path_b);
    vsc_comparison one = {0};
    status = vsc_compare_files(&one, pair, path_a, path_b, error);
    if (status == VSC_OK && wish->frames) {
      printf("frame at %g s\n", vsc_pvd_time(a, f));
      print_norms(&one, INFINITY);
    }
    if (status == VSC_OK) status = vsc_comparison_merge(all, &one, error);
    vsc_comparison_free(&one);
    common++;
  }
  if (status != VSC_OK) return status;
  if (common == 0)
    return vsc_fail(error, VSC_INPUT, "%s and %s have no frame at the same time", file_a, file_b);
  printf("frames at equal times: %zu\n", common);
  *missing = print_missing(b, a, file_a) + print_missing(a, b, file_b);
  return VSC_OK;
}

static vsc_status add_series(const wish *wish, vsc_comparison *all, vsc_pair *pair,
                             const char *file_a, const char *file_b, size_t *missing,
                             vsc_error *error)
{
  vsc_pvd *a = NULL, *b = NULL;
  vsc_status status = open_series(file_a, &a, error);
  if (status == VSC_OK) status = open_series(file_b, &b, error);
  if (status == VSC_OK) status = add_frames(wish, all, pair, file_a, a, file_b, b, missing, error);
  vsc_pvd_free(a);
  vsc_pvd_free(b);
  return status;
}

// A folder's series, or the file itself.
static vsc_status resolve(const char *given, char file[VSC_RESULT_PATH], vsc_error *error)
{
  struct stat facts;
  vsc_results results;
  if (strlen(given) >= VSC_RESULT_PATH)
    return vsc_fail(error, VSC_INPUT, "%.60s...: the file's name is too long", given);
  snprintf(file, VSC_RESULT_PATH, "%s", given);
  if (stat(given, &facts) != 0 || !S_ISDIR(facts.st_mode)) return VSC_OK;
  const vsc_status status = vsc_results_open(given, &results, error);
  if (status != VSC_OK) return status;
  memcpy(file, results.pvd, VSC_RESULT_PATH);
  vsc_results_close(&results);
  return VSC_OK;
}

static vsc_status compare_files(const wish *wish, char *const given[2], vsc_comparison *all,
                                vsc_pair *pair, size_t *missing, vsc_error *error)
{
  char a[VSC_RESULT_PATH], b[VSC_RESULT_PATH];
  vsc_status status = resolve(given[0], a, error);
  if (status == VSC_OK) status = resolve(given[1], b, error);
  if (status != VSC_OK) return status;
  if (vsc_is_series(a) != vsc_is_series(b))
    return vsc_fail(error, VSC_INPUT,
                    "%s is a series and %s is not: give two series or two meshes",
                    vsc_is_series(a) ? a : b, vsc_is_series(a) ? b : a);
  if (vsc_is_series(a)) return add_series(wish, all, pair, a, b, missing, error);
  return vsc_compare_files(all, pair, a, b, error);
}

static int compare_fields(const wish *wish, char *const given[2])
{
  vsc_error error;
  vsc_comparison all = {0};
  vsc_pair pair = {.reach = wish->reach, .interpolate = wish->interpolate};
  size_t missing = 0;
  int code = compare_files(wish, given, &all, &pair, &missing, &error);
  if (code == VSC_OK) {
    print_places(&pair);
    const bool within = print_norms(&all, wish->tolerance), complete = print_left_out(&all);
    if (all.note[0] != '\0') printf("not compared: %s\n", all.note);
    if (!within || ((missing > 0 || !complete) && isfinite(wish->tolerance))) code = DIFFERENT;
  } else {
    fflush(stdout);
    fprintf(stderr, "viscera: compare: %s\n", error.text);
  }
  vsc_comparison_free(&all);
  vsc_pair_free(&pair);
  return code;
}

static bool read_number(const char *text, double least, double *value)
{
  char *end;
  *value = strtod(text, &end);
  return end != text && *end == '\0' && *value >= least;
}

static bool read_sizes(const char *text, vsc_order_wish *order)
{
  order->size_count = 0;
  while (order->size_count < VSC_MOST_RUNS) {
    char *end;
    const double size = strtod(text, &end);
    if (end == text || !(size > 0) || (*end != ',' && *end != '\0')) return false;
    order->sizes[order->size_count++] = size;
    if (*end == '\0') return true;
    text = end + 1;
  }
  return false;
}

// Options without a letter of their own.
enum { FRAMES = 256, REACH, INTERPOLATE, ORDERS, SIGNAL, SIZES, CURVES, COLUMN, WITHIN, EXACT };

// Takes one option; false, with *expected, when its value does not fit.
static bool take(int option, wish *wish, const char **expected)
{
  *expected = "a number >= 0";
  if (option == 't') return read_number(optarg, 0, &wish->tolerance);
  if (option == REACH) return read_number(optarg, 0, &wish->reach);
  if (option == WITHIN) return read_number(optarg, 0, &wish->share);
  *expected = "a number";
  if (option == EXACT) return read_number(optarg, -INFINITY, &wish->order.exact);
  if (option == FRAMES) wish->frames = true;
  if (option == INTERPOLATE) wish->interpolate = true;
  if (option == ORDERS) wish->mode = ORDER;
  if (option == CURVES) wish->mode = SIGNALS;
  *expected = "as many sizes as runs, such as 4,2,1";
  if (option == SIZES) return read_sizes(optarg, &wish->order);
  *expected = "COLUMN=REFERENCE or COLUMN=REFERENCE,LOW,HIGH, 64 at most";
  if (option == COLUMN)
    return wish->pair_count < VSC_MOST_WANTED &&
           vsc_curve_pair_read(optarg, &wish->pairs[wish->pair_count++], NULL) == VSC_OK;
  *expected = "a column of signals.csv, 64 at most";
  if (option != SIGNAL) return true;
  if (wish->order.signal_count == VSC_MOST_WANTED) return false;
  vsc_copy_name(wish->order.signals[wish->order.signal_count++], optarg);
  return true;
}

static const struct option options[] = {{"help", no_argument, NULL, 'h'},
                                        {"tolerance", required_argument, NULL, 't'},
                                        {"frames", no_argument, NULL, FRAMES},
                                        {"reach", required_argument, NULL, REACH},
                                        {"interpolate", no_argument, NULL, INTERPOLATE},
                                        {"order", no_argument, NULL, ORDERS},
                                        {"signal", required_argument, NULL, SIGNAL},
                                        {"sizes", required_argument, NULL, SIZES},
                                        {"exact", required_argument, NULL, EXACT},
                                        {"signals", no_argument, NULL, CURVES},
                                        {"column", required_argument, NULL, COLUMN},
                                        {"within", required_argument, NULL, WITHIN},
                                        {0}};

static int compare(wish *wish, int count, char **given)
{
  vsc_order_wish *order = &wish->order;
  if (wish->mode == ORDER) {
    if (count < 3 || count > VSC_MOST_RUNS || (order->size_count > 0 && order->size_count != (size_t)count)) {
      fprintf(stderr, "viscera: compare: --order: give 3 to %d runs, and as many --sizes if any\n",
              VSC_MOST_RUNS);
      return VSC_INPUT;
    }
    if (!isnan(order->exact) && order->signal_count != 1) {
      fputs("viscera: compare: --exact: give the one --signal that it is for\n", stderr);
      return VSC_INPUT;
    }
    order->reach = wish->reach;
    for (; order->run_count < (size_t)count; order->run_count++)
      order->runs[order->run_count] = given[order->run_count];
    return vsc_compare_order(order);
  }
  if (count != 2 || (wish->mode == SIGNALS && wish->pair_count == 0)) {
    fprintf(stderr, "viscera: compare: give two files, A and B%s; `viscera compare --help` tells more\n",
            wish->mode == SIGNALS ? ", and --column" : "");
    return VSC_INPUT;
  }
  if (wish->mode == SIGNALS)
    return vsc_compare_signals(given[0], given[1], wish->pair_count, wish->pairs, wish->tolerance,
                               wish->share);
  return compare_fields(wish, given);
}

int vsc_verb_compare(int argc, char **argv)
{
  static wish wish;
  wish = (struct wish){.tolerance = INFINITY, .order.exact = NAN};
  for (int option, index = 0; (option = getopt_long(argc, argv, "ht:", options, &index)) != -1;) {
    const char *expected;
    if (option == 'h') {
      print_help();
      return VSC_OK;
    }
    if (option == '?') return VSC_INPUT;
    if (take(option, &wish, &expected)) continue;
    fprintf(stderr, "viscera: compare: --%s %s: expected %s\n",
            option == 't' ? "tolerance" : options[index].name, optarg, expected);
    return VSC_INPUT;
  }
  return compare(&wish, argc - optind, argv + optind);
}
