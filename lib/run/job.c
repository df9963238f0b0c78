// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/job.h"

#include <stdio.h>

void vsc_job_path(const vsc_job *job, const char *what, char path[VSC_PATH])
{
  const char *name = what[0] == '.' ? job->name : "";
  snprintf(path, VSC_PATH, "%.*s/%.*s%.100s", VSC_LONGEST_DIRECTORY, job->options->directory,
           VSC_NAME, name, what);
}
