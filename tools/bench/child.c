// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/child.h"

#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

int vsc_child_split(char *text, int count, char *words[VSC_CHILD_WORDS])
{
  for (char *word = strtok(text, " "); word != NULL && count + 1 < VSC_CHILD_WORDS;
       word = strtok(NULL, " "))
    words[count++] = word;
  words[count] = NULL;
  return count;
}

// What the forked process does; never returns.
static void be_child(int (*verb)(int argc, char **argv), char **words, const char *log, double limit)
{
  const int file = open(log, O_WRONLY | O_CREAT | O_APPEND, 0666);
  if (file < 0 || dup2(file, STDOUT_FILENO) < 0 || dup2(file, STDERR_FILENO) < 0) _exit(VSC_SYSTEM);
  const struct rlimit most = {(rlim_t)ceil(limit), (rlim_t)ceil(limit) + 1};
  setrlimit(RLIMIT_CPU, &most);
  int count = 0;
  while (words[count] != NULL) count++;
  optind = 0;  // so that getopt begins again
  const int code = verb(count, words);
  fflush(NULL);
  _exit(code);
}

// The last line of a file into `line`, without its end.
static void last_line(const char *file, char *line, size_t size)
{
  line[0] = '\0';
  FILE *stream = fopen(file, "r");
  if (stream == NULL) return;
  char next[VSC_ERROR_TEXT];
  while (fgets(next, sizeof next, stream) != NULL) {
    next[strcspn(next, "\n")] = '\0';
    if (next[0] != '\0') snprintf(line, size, "%s", next);
  }
  fclose(stream);
}

vsc_status vsc_child(int (*verb)(int argc, char **argv), char **words, const char *log, double limit,
                     vsc_child_cost *cost, vsc_error *error)
{
  fflush(NULL);
  const pid_t child = fork();
  if (child < 0) return vsc_fail(error, VSC_SYSTEM, "no further process: %s", strerror(errno));
  if (child == 0) be_child(verb, words, log, limit);
  int state = 0;
  struct rusage used = {0};
  while (wait4(child, &state, 0, &used) < 0)
    if (errno != EINTR) return vsc_fail(error, VSC_SYSTEM, "waiting: %s", strerror(errno));
  cost->cpu_seconds = (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                      1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  cost->megabytes = 1024e-6 * (double)used.ru_maxrss;
  if (WIFEXITED(state) && WEXITSTATUS(state) == VSC_OK) return VSC_OK;
  if (WIFSIGNALED(state) && (WTERMSIG(state) == SIGXCPU || WTERMSIG(state) == SIGKILL))
    return vsc_fail(error, VSC_NUMERICAL, "%s: stopped after %.0f s of CPU; give a larger --limit",
                    words[0], cost->cpu_seconds);
  if (WIFSIGNALED(state))
    return vsc_fail(error, VSC_SYSTEM, "%s: ended by signal %d", words[0], WTERMSIG(state));
  char line[VSC_ERROR_TEXT];
  last_line(log, line, sizeof line);
  return vsc_fail(error, (vsc_status)WEXITSTATUS(state), "%s", line);
}
