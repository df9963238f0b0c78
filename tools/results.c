// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

bool vsc_is_series(const char *name)
{
  const size_t length = strlen(name);
  return length > 4 && strcmp(name + length - 4, ".pvd") == 0;
}

// How many series the folder has; the name of one of them.
static size_t count_series(const char *folder, char name[VSC_RESULT_PATH])
{
  size_t count = 0;
  DIR *stream = opendir(folder);
  if (stream == NULL) return 0;
  for (const struct dirent *entry; (entry = readdir(stream)) != NULL;)
    if (entry->d_name[0] != '.' && vsc_is_series(entry->d_name) && count++ == 0)
      snprintf(name, VSC_RESULT_PATH, "%s", entry->d_name);
  closedir(stream);
  return count;
}

static vsc_status find_series(const char *folder, char pvd[VSC_RESULT_PATH], vsc_error *error)
{
  char name[VSC_RESULT_PATH];
  size_t length = strlen(folder);
  while (length > 1 && folder[length - 1] == '/') length--;
  const size_t count = count_series(folder, name);
  if (count == 0)
    return vsc_fail(error, VSC_INPUT,
                    "%s: there is no series (*.pvd); is this a folder that `viscera run` made?",
                    folder);
  if (count > 1)
    return vsc_fail(error, VSC_INPUT, "%s: there are %zu series (*.pvd), expected one", folder, count);
  const int used = snprintf(pvd, VSC_RESULT_PATH, "%.*s/%s", (int)length, folder, name);
  if (used < VSC_RESULT_PATH) return VSC_OK;
  return vsc_fail(error, VSC_INPUT, "the folder's name is too long");
}

vsc_status vsc_results_open(const char *folder, vsc_results *results, vsc_error *error)
{
  results->series = NULL;
  vsc_status status = find_series(folder, results->pvd, error);
  if (status == VSC_OK) status = vsc_pvd_open(results->pvd, HUGE_VAL, &results->series, error);
  if (status == VSC_OK && vsc_pvd_count(results->series) == 0) {
    status = vsc_fail(error, VSC_INPUT, "%s: the series has no frames", results->pvd);
    vsc_results_close(results);
  }
  return status;
}

size_t vsc_results_nearest(const vsc_results *results, double time)
{
  const vsc_pvd *series = results->series;
  const size_t count = vsc_pvd_count(series);
  if (isnan(time)) return count - 1;
  size_t nearest = 0;
  for (size_t f = 1; f < count; f++)
    if (fabs(vsc_pvd_time(series, f) - time) < fabs(vsc_pvd_time(series, nearest) - time))
      nearest = f;
  return nearest;
}

void vsc_results_close(vsc_results *results)
{
  vsc_pvd_free(results->series);
  results->series = NULL;
}

double vsc_results_number(const char *folder, const char *key)
{
  char file[VSC_RESULT_PATH + 32], line[512], quoted[64];
  double value = NAN;
  snprintf(file, sizeof file, "%.4095s/summary.json", folder);
  snprintf(quoted, sizeof quoted, "\"%s\": %%lf", key);
  FILE *summary = fopen(file, "r");
  while (summary != NULL && fgets(line, sizeof line, summary) != NULL)
    if (sscanf(line + strspn(line, " "), quoted, &value) == 1) break;
  if (summary != NULL) fclose(summary);
  return value;
}
