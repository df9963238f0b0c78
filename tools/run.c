// SPDX-License-Identifier: GPL-3.0-or-later
// viscera run
#include <errno.h>
#include <getopt.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "io/units.h"
#include "run/check.h"
#include "run/prestress.h"
#include "run/run.h"
#include "tools/scene_options.h"
#include "tools/verbs.h"

static const char help[] =
    "Usage: viscera run [OPTION]... SCENE\n"
    "Simulates a scene: frames for ParaView (NAME.pvd), signals.csv, summary.json, "
    "checkpoint.h5.\n\n"
    "  -o, --output DIR     results go to DIR (default: the scene's name without its ending)\n"
    "  -s, --set KEY=VALUE  replace or add a value of the scene\n"
    "  -t, --threads N      number of threads (default: all processors)\n"
    "  -r, --resume         go on from the checkpoint in DIR\n"
    "      --stop TIME      stop at TIME (as '0.4 s') or the next look at the energy, and leave a checkpoint\n"
    "  -q, --quiet          no progress, no warnings\n"
    "  -h, --help           this text\n\n"
    "Ctrl-C (and the signals TERM and HUP) leave a checkpoint of the last look at the energy (explicit steps: each\n"
    "millisecond or 32 steps; else each row of signals); half a second later they end the program at once.\n\n"
    "Exit codes: 0 good, 2 the user's input, 3 numerical failure (the last good state is kept), 4 "
    "system,\n128 and the number of the signal that stopped it.\n\n"
    "Examples:\n"
    "  viscera run data/beat.yaml -o beat\n"
    "  viscera run data/beat.yaml -o half --set 'time.end=0.4 s' --threads 1\n"
    "  viscera run data/beat.yaml -o beat --resume\n";

typedef struct run_arguments {
  vsc_scene_options scene;
  vsc_run_options run;
  bool quiet;
} run_arguments;

// One line, overwritten, while stderr is a terminal. `context` is where the counting began: time in
// ms and wall seconds of the first call, which a resumed run makes late.
static void show_progress(void *context, double time, double end, double wall_seconds)
{
  double *begin = context;
  if (begin[1] < 0) {
    begin[0] = time;
    begin[1] = wall_seconds;
  }
  const double done = time - begin[0], speed = done > 0 ? done / (wall_seconds - begin[1]) : 0;
  fprintf(stderr, "\r%6.1f of %.1f ms   %.3g simulated s per minute   ", time, end,
          60 * 1e-3 * speed);
  if (speed > 0) fprintf(stderr, "%.0f s left   ", (end - time) / speed);
  fflush(stderr);
}

static int keep_stop(const char *text, run_arguments *arguments)
{
  vsc_error error;
  double stop = 0;
  if (vsc_units_read(text, VSC_TIME, &stop, &error) == VSC_OK && stop <= 0)
    vsc_fail(&error, VSC_INPUT, "%s: expected a time above zero", text);
  arguments->run.stop_time = stop;
  if (stop > 0) return 0;
  fprintf(stderr, "viscera: --stop: %s\n", error.text);
  return 2;
}

static int read_arguments(int argc, char **argv, run_arguments *arguments, bool *helped)
{
  enum { STOP = 256 };
  static const struct option options[] = {
      {"output", required_argument, NULL, 'o'},  {"set", required_argument, NULL, 's'},
      {"threads", required_argument, NULL, 't'}, {"resume", no_argument, NULL, 'r'},
      {"stop", required_argument, NULL, STOP},   {"quiet", no_argument, NULL, 'q'},
      {"help", no_argument, NULL, 'h'},          {0}};
  for (int c; (c = getopt_long(argc, argv, "o:s:t:rqh", options, NULL)) != -1;) {
    int code = 0;
    switch (c) {
      case 'o':
        arguments->run.directory = optarg;
        break;
      case 's':
        code = vsc_keep_setting(&arguments->scene, optarg);
        break;
      case 't':
        code = vsc_keep_threads(optarg);
        break;
      case 'r':
        arguments->run.resume = true;
        break;
      case STOP:
        code = keep_stop(optarg, arguments);
        break;
      case 'q':
        arguments->quiet = true;
        break;
      case 'h':
        *helped = true;
        return fputs(help, stdout) < 0 ? 4 : 0;
      default:
        code = 2;
    }
    if (code != 0) return code;
  }
  if (optind + 1 == argc) {
    arguments->scene.scene = argv[optind];
    return 0;
  }
  fputs("viscera run: give one scene file; see `viscera run --help`\n", stderr);
  return 2;
}

static void report_unloaded(const vsc_unloaded *unloaded)
{
  if (unloaded == NULL) return;
  const vsc_prestress_row *last = &unloaded->rows[unloaded->row_count - 1];
  printf("the shape at rest, in reference.vtu, is up to %.3g mm from the mesh, to which the loads take it to %.2g mm "
         "(%d iterations)\n", unloaded->furthest, last->largest, last->iteration);
}

static void report(const vsc_run_result *result)
{
  printf(
      "%s: %.4g ms in %.0f steps, %.3g s (%.3g s of CPU, %.3g million element updates per CPU "
      "second), %zu frames\n",
      result->series, result->simulated, result->steps, result->wall_seconds, result->cpu_seconds,
      1e-6 * result->updates_per_second, result->frames);
  if (result->repeated > 0)
    printf("%.0f times a stretch was gone again with shorter steps: energy did not balance, or elements turned inside out\n",
           result->repeated);
  if (result->most_inverted > 0)
    printf("up to %.0f elements were inside out, %.0f in the end (inverted_elements in signals.csv)\n",
           result->most_inverted, result->inverted);
  if (result->repeats)
    printf("cycle %.0f repeats the one before to %.2g: stopped there\n", result->cycles,
           result->cycle_difference);
}

static volatile sig_atomic_t interrupted = 0;

static double seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// Stops the run with a checkpoint; later than half a second, in which one signal may come several times, ends it at once.
static void interrupt(int number)
{
  static const char told[] = "\nviscera: stopping; once more to end at once\n";
  static volatile double first;
  const int before = errno;
  if (interrupted != 0 && seconds() > first + 0.5) signal(number, SIG_DFL), raise(number);
  if (interrupted != 0) return;
  first = seconds();
  interrupted = number;
  (void)!write(STDERR_FILENO, told, sizeof told - 1);
  errno = before;
}

static void heed_signals(vsc_run_options *options)
{
  static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
  const struct sigaction heeded = {.sa_handler = interrupt, .sa_flags = SA_RESTART};
  for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++) {
    struct sigaction usual;
    const bool ignored = sigaction(numbers[k], NULL, &usual) == 0 && usual.sa_handler == SIG_IGN;
    if (!ignored) sigaction(numbers[k], &heeded, NULL);  // not under nohup
  }
  options->interrupted = &interrupted;
}

// `code`, or that of the signal which stopped the run.
static int code_of(int code, const vsc_run_result *result)
{
  if (code != 0 || !result->interrupted) return code;
  fprintf(stderr, "viscera: stopped after %.6g ms; the same command with --resume goes on from there\n",
          result->simulated);
  return 128 + interrupted;
}

int vsc_verb_run(int argc, char **argv)
{
  run_arguments arguments = {0};
  bool helped = false;
  char directory[VSC_PATH];
  int code = read_arguments(argc, argv, &arguments, &helped);
  if (code != 0 || helped) return code;
  if (arguments.run.directory == NULL) {
    vsc_run_name(arguments.scene.scene, directory, sizeof directory);
    arguments.run.directory = directory;
  }
  vsc_problem *problem;
  code = vsc_load_scene(&arguments.scene, &problem);
  if (code != 0) return code;
  if (!arguments.quiet) vsc_check_warnings(problem, false, stderr, "viscera: warning: ");
  double begin[2] = {0, -1};
  if (!arguments.quiet && isatty(STDERR_FILENO)) arguments.run.progress = show_progress;
  arguments.run.progress_context = begin;
  heed_signals(&arguments.run);
  vsc_run_result result;
  vsc_error error;
  code = (int)vsc_run(problem, &arguments.run, &result, &error);
  if (begin[1] >= 0) fputc('\n', stderr);  // behind the progress
  if (!arguments.quiet && result.warning[0] != '\0') fprintf(stderr, "viscera: warning: %s\n", result.warning);
  if (code != 0)
    fprintf(stderr, "viscera: %s\n", error.text);
  else
    report(&result), report_unloaded(problem->unloaded);
  vsc_problem_free(problem);
  return code_of(code, &result);
}
