// SPDX-License-Identifier: GPL-3.0-or-later
#include <math.h>

#include "run/job.h"
#include "solve/newton.h"

void vsc_job_count_inverted(vsc_job *job)
{
  const double inverted = job->watch->totals.inverted;
  uint32_t first = 0;
  if (inverted > 0 && job->most_inverted == 0) {
    vsc_smallest_ratio(job->problem->model, job->state->x, &first);
    job->inverted_element = first;
    job->inverted_time = job->state->time;
  }
  job->most_inverted = fmax(job->most_inverted, inverted);
}
