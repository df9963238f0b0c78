// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/step_options.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>

static const char help[] =
    "Usage: viscera bench throughput [OPTION]...\n"
    "       viscera bench growth [OPTION]...\n"
    "       viscera bench skipping [OPTION]...\n"
    "throughput: million element updates per second, the best of five timings of whole explicit steps on a\n"
    "block, on one thread by processor time, on all threads by the clock; beside it what the processor could\n"
    "do at most, measured in the same run. growth: how time and memory of a step grow with the number of\n"
    "tets. skipping: what each feature costs while it is used, and while it is there but idle, timed in turns\n"
    "with the block that has nothing of it; with -o also whole runs that points and signals are asked for.\n\n"
    "  -o, --output DIR    the table (SECTION.csv) and a picture of it (SECTION.png) go to DIR\n"
    "      --csv FILE      or the table alone to FILE\n"
    "  -n, --elements N    one block of about N elements; growth: blocks up to N\n"
    "      --large         6 million tets too (needs 6 GB)\n"
    "  -h, --help          this text\n\n"
    "Unstructured tets are read from a file, which lies in TMPDIR (/tmp) until then.\n\n"
    "Example:\n"
    "  viscera bench throughput --elements 100000\n";

static bool keep_elements(const char *text, vsc_step_wish *wish)
{
  char *end;
  wish->elements = strtol(text, &end, 10);
  if (*end == '\0' && wish->elements >= 5 && wish->elements <= 100000000) return true;
  fprintf(stderr, "viscera bench: --elements %s: expected a number from 5 to 100000000\n", text);
  return false;
}

static bool begin(vsc_step_wish *wish, const char *folder, const char *name, const char *csv)
{
  vsc_error error;
  if (folder != NULL && csv != NULL) {
    fprintf(stderr, "viscera bench: --csv %s: --output says already where the table goes; give one of them\n", csv);
    return false;
  }
  if (vsc_bench_output_begin(&wish->output, folder, name, csv, &error) == VSC_OK) return true;
  fprintf(stderr, "viscera bench: %s %s\n", csv != NULL ? "--csv" : "--output", error.text);
  return false;
}

bool vsc_step_options(const char *name, int argc, char **argv, vsc_step_wish *wish, int *code)
{
  static const struct option options[] = {{"output", required_argument, NULL, 'o'},
                                          {"elements", required_argument, NULL, 'n'},
                                          {"large", no_argument, NULL, 'l'},
                                          {"csv", required_argument, NULL, 'c'},
                                          {"help", no_argument, NULL, 'h'},
                                          {0}};
  const char *folder = NULL, *csv = NULL;
  *wish = (vsc_step_wish){0};
  *code = 2;
  for (int c; (c = getopt_long(argc, argv, "o:n:h", options, NULL)) != -1;) {
    if (c == 'o') {
      folder = optarg;
    } else if (c == 'n') {
      if (!keep_elements(optarg, wish)) return false;
    } else if (c == 'l') {
      wish->large = true;
    } else if (c == 'c') {
      csv = optarg;
    } else if (c == 'h') {
      *code = fputs(help, stdout) < 0 ? 4 : 0;
      return false;
    } else {
      return false;
    }
  }
  if (optind < argc) {
    fprintf(stderr, "viscera bench %s: '%s' means nothing here\n", name, argv[optind]);
    return false;
  }
  return begin(wish, folder, name, csv);
}

int vsc_step_finish(vsc_step_wish *wish, vsc_status status, vsc_error *error)
{
  status = vsc_bench_output_end(&wish->output, status, error);
  if (status != VSC_OK) fprintf(stderr, "viscera: %s\n", error->text);
  return (int)status;
}
