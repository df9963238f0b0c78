// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/job.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

void vsc_job_path(const vsc_job *job, const char *what, char path[VSC_PATH])
{
  const char *name = what[0] == '.' ? job->name : "";
  snprintf(path, VSC_PATH, "%.*s/%.*s%.100s", VSC_LONGEST_DIRECTORY, job->options->directory,
           VSC_NAME, name, what);
}

// How many PVD files the run's folder has, and the name of one of them without its ending.
static size_t count_series(const vsc_job *job, char name[VSC_NAME])
{
  DIR *folder = opendir(job->options->directory);
  size_t count = 0;
  for (const struct dirent *entry; folder != NULL && (entry = readdir(folder)) != NULL;) {
    const size_t length = strlen(entry->d_name);
    if (length < 5 || length - 4 >= VSC_NAME || strcmp(entry->d_name + length - 4, ".pvd") != 0) continue;
    snprintf(name, VSC_NAME, "%.*s", (int)length - 4, entry->d_name);
    count++;
  }
  if (folder != NULL) closedir(folder);
  return count;
}

vsc_status vsc_job_take_name(vsc_job *job, vsc_error *error)
{
  char path[VSC_PATH], first[VSC_NAME + 32], name[VSC_NAME];
  vsc_job_path(job, ".pvd", path);
  if (!job->options->resume || access(path, F_OK) == 0) return VSC_OK;
  snprintf(first, sizeof first, VSC_FRAME_NAME, job->name, (size_t)0);
  vsc_job_path(job, first, path);
  const size_t count = count_series(job, name);
  if (count == 0 || access(path, F_OK) == 0) return VSC_OK;  // its own series is missing
  if (count > 1)
    return vsc_fail(error, VSC_INPUT, "%s: has series of several names (.pvd), and none is called %s: resume with a scene "
                    "file that has the name of the run's series", job->options->directory, job->name);
  vsc_copy_name(job->name, name);
  return VSC_OK;
}
