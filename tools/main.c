// SPDX-License-Identifier: GPL-3.0-or-later
// The program: `viscera VERB ...` goes to the verb's own file.
#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/status.h"
#include "base/text.h"
#include "tools/run_plot.h"
#include "tools/verbs.h"

typedef struct verb {
  const char *name;
  int (*run)(int argc, char **argv);
  const char *help;  // what it does, in one line
} verb;

static int run_plot(int argc, char **argv);

static const verb verbs[] = {
    {"run", vsc_verb_run, "simulate a scene; leaves frames, signals, a summary"},
    {"check", vsc_verb_check, "say what a scene would do, what it would cost, what looks odd"},
    {"info", vsc_verb_info, "say what meshes, images, series, checkpoints or scenes hold"},
    {"compare", vsc_verb_compare, "error norms between results, orders of convergence, curves"},
    {"measure", vsc_verb_measure, "how a slice of the tissue has moved, turned, changed size"},
    {"schema", vsc_verb_schema, "print a commented template of everything a scene can say"},
    {"generate", vsc_verb_generate, "make the meshes and angle maps that ship with viscera"},
    {"bench", vsc_verb_bench, "this machine's element updates a second; accuracy against known answers"},
    {"calibrate", vsc_verb_calibrate, "stiffness in every direction; springs for wanted moduli"},
    {"plot", run_plot, "draw the graphs and pictures of a simulation's results"},
};

enum { VERBS = sizeof verbs / sizeof verbs[0] };

static void print_help(FILE *stream)
{
  fputs(
      "Usage: viscera VERB [OPTION]... [FILE]...\n"
      "Heart and liver tissue on element frames.\n\n",
      stream);
  for (int i = 0; i < VERBS; i++) fprintf(stream, "  %-10s%s\n", verbs[i].name, verbs[i].help);
  fputs(
      "\n"
      "  -h, --help      this text; `viscera VERB --help` tells more, with examples\n"
      "      --version   the version\n\n"
      "Examples:\n"
      "  viscera check data/beat.yaml           ask before running\n"
      "  viscera run data/beat.yaml -o beat     simulate into the folder beat/\n"
      "  viscera plot beat                      draw beat/beat.png\n\n"
      "Results go to stdout, messages to stderr. Exit codes: 0 good, 2 the user's input,\n"
      "3 numerical failure, 4 system.\n",
      stream);
}

// Graphs need PLplot and cairo, which a simulation should not load: `plot` is a program of its own.
static int run_plot(int argc, char **argv)
{
  (void)argc;
  return vsc_become_plot(argv);
}

static const verb *find_verb(const char *name)
{
  for (int i = 0; i < VERBS; i++)
    if (strcmp(name, verbs[i].name) == 0) return &verbs[i];
  const char *names[VERBS];
  for (int i = 0; i < VERBS; i++) names[i] = verbs[i].name;
  const char *near = vsc_nearest(name, names, VERBS);
  if (near != NULL)
    fprintf(stderr, "viscera: unknown verb '%s', did you mean '%s'?\n", name, near);
  else
    fprintf(stderr, "viscera: unknown verb '%s', `viscera --help` lists them\n", name);
  return NULL;
}

// getopt begins its messages with argv[0]: let them read like ours.
static int run_verb(const verb *verb, int argc, char **argv)
{
  static char name[64];
  snprintf(name, sizeof name, "viscera: %s", verb->name);
  argv[0] = name;
  return verb->run(argc, argv);
}

// A full disk shows only when the last of stdout is written.
static int finish(int code)
{
  if (fflush(stdout) == 0 && !ferror(stdout)) return code;
  fprintf(stderr, "viscera: writing the output failed: %s\n", strerror(errno));
  return code != VSC_OK ? code : VSC_SYSTEM;
}

int main(int argc, char **argv)
{
  signal(SIGXFSZ, SIG_IGN);  // a limit of file sizes then is an error of writing like a full disk
  if (argc < 2) {
    print_help(stderr);
    return VSC_INPUT;
  }
  const char *word = argv[1];
  if (strcmp(word, "--version") == 0) {
    puts("viscera " VISCERA_VERSION);
    return finish(VSC_OK);
  }
  if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0 ||
      (strcmp(word, "help") == 0 && argc == 2)) {
    print_help(stdout);
    return finish(VSC_OK);
  }
  char *help_argv[] = {argv[1], "--help", NULL};
  const bool help = strcmp(word, "help") == 0;  // `viscera help run` is `viscera run --help`
  const verb *verb = find_verb(help ? argv[2] : word);
  if (verb == NULL) return VSC_INPUT;
  if (help) return finish(run_verb(verb, 2, help_argv));
  return finish(run_verb(verb, argc - 1, argv + 1));
}
