// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/first_frame.h"

#include <fcntl.h>
#include <getopt.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/parallel.h"
#include "base/sort.h"
#include "tools/beside.h"
#include "tools/bench/machine.h"
#include "tools/bench/output.h"
#include "tools/results.h"
#include "tools/scene_options.h"
#include "tools/shipped.h"

static const char help[] =
    "Usage: viscera bench start [OPTION]...\n"
    "How long a user waits: the time from starting the program to the first frame on the disk, taken several times,\n"
    "and what part of a run of 0.1 s with 100 frames a beat goes into input, building, stepping and output.\n\n"
    "  -o, --output DIR     of the runs, of start.csv and a picture of it, start.png [start]\n"
    "      --scene FILE     [beat.yaml, of the data that come with viscera]\n"
    "      --times N        starts [20]\n"
    "  -t, --threads N      number of threads (default: all processors)\n"
    "  -h, --help           this text\n\n"
    "Example:\n"
    "  viscera bench start -o /tmp/start\n";

#define STOP "0.1 s"          // of the run whose time is shared out
#define EACH_FRAME "8 ms"     // a hundredth of a beat
enum { MOST_STARTS = 1000 };

typedef struct wish {
  const char *output, *scene;
  int starts;
  FILE *csv;
} wish;

typedef struct start {
  double frame;  // s from the start of the program until its first frame was on the disk
  double all;    // until the program's end
  double cpu;    // processor time
} start;

// The program as a shell starts it, what it prints going to a file.
static void be_run(const char *folder, char **words)
{
  char log[PATH_MAX];
  snprintf(log, sizeof log, "%s/log.txt", folder);
  const int file = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (file >= 0) dup2(file, STDERR_FILENO);
  if (file >= 0) dup2(file, STDOUT_FILENO);
  _exit(vsc_become("viscera", "build it", words));
}

static double seconds_of(struct timespec t)
{
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static vsc_status time_run(const wish *wish, char **words, start *taken, vsc_error *error)
{
  struct timespec begin, end;
  struct rusage used;
  vsc_results results;
  struct stat frame;
  char file[2 * VSC_RESULT_PATH];
  int state;
  clock_gettime(CLOCK_REALTIME, &begin);
  const pid_t child = fork();
  if (child == 0) be_run(wish->output, words);
  if (child < 0 || wait4(child, &state, 0, &used) < 0) return vsc_fail(error, VSC_SYSTEM, "no further process");
  clock_gettime(CLOCK_REALTIME, &end);
  if (!WIFEXITED(state) || WEXITSTATUS(state) != VSC_OK)
    return vsc_fail(error, VSC_SYSTEM, "the run failed; %s/log.txt says why", wish->output);
  vsc_status status = vsc_results_open(wish->output, &results, error);
  if (status != VSC_OK) return status;
  snprintf(file, sizeof file, "%s/%s", wish->output, vsc_pvd_frame(results.series, 0));
  vsc_results_close(&results);
  if (stat(file, &frame) != 0) return vsc_fail(error, VSC_SYSTEM, "%s: is missing", file);
  // the system's clock of files ticks each four milliseconds
  taken->frame = seconds_of(frame.st_mtim) - seconds_of(begin);
  taken->all = seconds_of(end) - seconds_of(begin);
  taken->cpu = (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
               1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  return VSC_OK;
}

static void say_spread(const wish *wish, const char *what, double *values, int count)
{
  qsort(values, (size_t)count, sizeof *values, vsc_compare_doubles);
  printf("  %-46s %8.3f %8.3f %8.3f\n", what, values[0], values[count / 2], values[count - 1]);
  fprintf(wish->csv, "to the first frame,\"%s\",%.5g,%.5g,%.5g\n", what, values[count / 2], values[0], values[count - 1]);
}

static vsc_status bench_starts(const wish *wish, vsc_error *error)
{
  enum { FRAME, CPU, INPUT, BUILD, BEGIN, COLUMNS };
  static const char *const names[COLUMNS] = {"shell to first frame", "processor time of it all",
                                             "of these: reading scene, mesh, fibres", "building the model",
                                             "first forces, stable step"};
  static const char *const keys[COLUMNS] = {[INPUT] = "input_seconds", [BUILD] = "build_seconds",
                                            [BEGIN] = "begin_seconds"};
  static double values[COLUMNS][MOST_STARTS];
  char threads[16];
  snprintf(threads, sizeof threads, "%d", vsc_parallel_threads());
  for (int k = 0; k < wish->starts; k++) {
    char *words[] = {"viscera", "run", "-q", "-t", threads, "--stop", "1 us", "-o", (char *)wish->output,
                     (char *)wish->scene, NULL};
    start taken;
    const vsc_status status = time_run(wish, words, &taken, error);
    if (status != VSC_OK) return status;
    values[FRAME][k] = taken.frame;
    values[CPU][k] = taken.cpu;
    for (int c = INPUT; c < COLUMNS; c++) values[c][k] = vsc_results_number(wish->output, keys[c]);
  }
  printf("%s, %d starts\n  %-46s %8s %8s %8s\n", wish->scene, wish->starts, "seconds", "least", "median", "most");
  for (int c = 0; c < COLUMNS; c++) say_spread(wish, names[c], values[c], wish->starts);
  return VSC_OK;
}

static vsc_status bench_shares(const wish *wish, int threads, vsc_error *error)
{
  char count[16];
  snprintf(count, sizeof count, "%d", threads);
  char *words[] = {"viscera", "run", "-q", "-t", count, "--stop", STOP, "--set", "output.frames=" EACH_FRAME, "-o",
                   (char *)wish->output, (char *)wish->scene, NULL};
  start taken;
  const vsc_status status = time_run(wish, words, &taken, error);
  if (status != VSC_OK) return status;
  enum { LOADING, INPUT, BUILD, STEPS, OUTPUT, PARTS };
  static const char *const names[PARTS] = {"loading", "input", "build", "steps", "output"};
  const double begin = vsc_results_number(wish->output, "begin_seconds");
  double parts[PARTS] = {[INPUT] = vsc_results_number(wish->output, "input_seconds"),
                         [BUILD] = vsc_results_number(wish->output, "build_seconds") + begin,
                         [OUTPUT] = vsc_results_number(wish->output, "output_seconds")};
  parts[STEPS] = vsc_results_number(wish->output, "wall_seconds") - begin - parts[OUTPUT];
  parts[LOADING] = taken.all - parts[INPUT] - parts[BUILD] - parts[OUTPUT] - parts[STEPS];
  printf("  %7d %9.2f", threads, taken.all);
  for (int k = 0; k < PARTS; k++) {
    printf(" %8.1f", 100 * parts[k] / taken.all);
    fprintf(wish->csv, "" STOP " on %d thread%s,%s,%.5g,,\n", threads, threads > 1 ? "s" : "", names[k], parts[k]);
  }
  printf(" %16.1f\n", 100 * vsc_results_number(wish->output, "frame_cpu_seconds") / taken.cpu);
  return VSC_OK;
}

static vsc_status bench(const wish *wish, vsc_error *error)
{
  vsc_machine_say(stdout);
  fprintf(wish->csv, "table,what,seconds,least,most\n");
  vsc_status status = bench_starts(wish, error);
  if (status != VSC_OK) return status;
  puts("\n" STOP " with a frame each " EACH_FRAME ", per cent of the wall clock; frames: per cent of the processor time\n"
       "  threads   seconds  loading    input    build    steps   output   writing frames");
  status = bench_shares(wish, 1, error);
  if (status == VSC_OK && vsc_parallel_threads() > 1) status = bench_shares(wish, vsc_parallel_threads(), error);
  return status;
}

static vsc_status bench_into(wish *wish, vsc_error *error)
{
  vsc_bench_output output;
  vsc_status status = vsc_shipped_check(wish->scene, "--scene", error);
  if (status == VSC_OK) status = vsc_bench_output_begin(&output, wish->output, "start", NULL, error);
  if (status != VSC_OK) return status;
  wish->csv = output.csv;
  return vsc_bench_output_end(&output, bench(wish, error), error);
}

int vsc_bench_start(int argc, char **argv)
{
  enum { SCENE = 256, TIMES };
  static const struct option options[] = {{"output", required_argument, NULL, 'o'},
                                          {"scene", required_argument, NULL, SCENE},
                                          {"times", required_argument, NULL, TIMES},
                                          {"threads", required_argument, NULL, 't'},
                                          {"help", no_argument, NULL, 'h'},
                                          {0}};
  char shipped[PATH_MAX];
  wish wish = {.output = "start", .scene = vsc_shipped("beat.yaml", shipped, sizeof shipped), .starts = 20};
  int code = VSC_OK;
  for (int c; code == VSC_OK && (c = getopt_long(argc, argv, "o:t:h", options, NULL)) != -1;) {
    if (c == 'o') wish.output = optarg;
    else if (c == SCENE) wish.scene = optarg;
    else if (c == TIMES) wish.starts = atoi(optarg);
    else if (c == 't') code = vsc_keep_threads(optarg);
    else if (c == 'h') return fputs(help, stdout) < 0 ? VSC_SYSTEM : VSC_OK;
    else code = VSC_INPUT;
  }
  if (code == VSC_OK && optind < argc) {
    fprintf(stderr, "viscera bench start: '%s' means nothing here\n", argv[optind]);
    code = VSC_INPUT;
  }
  if (code == VSC_OK && (wish.starts < 1 || wish.starts > MOST_STARTS)) {
    fprintf(stderr, "viscera bench start: --times: expected a number from 1 to %d\n", MOST_STARTS);
    code = VSC_INPUT;
  }
  if (code != VSC_OK) return code;
  vsc_error error;
  const vsc_status status = bench_into(&wish, &error);
  if (status != VSC_OK) fprintf(stderr, "viscera bench start: %s\n", error.text);
  return (int)status;
}
