// SPDX-License-Identifier: GPL-3.0-or-later
// What Newton's method did, as DIRECTORY/convergence.csv: one row for each iteration.
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "run/job.h"

vsc_status vsc_job_write_convergence(vsc_job *job, vsc_error *error)
{
  vsc_newton *newton = vsc_solve_newton(job->problem->model, job->state);
  if (newton == NULL || newton->row_count == 0) return VSC_OK;
  char path[VSC_PATH];
  vsc_job_path(job, "convergence.csv", path);
  FILE *file = fopen(path, job->converged_rows > 0 || job->options->resume ? "a" : "w");
  if (file == NULL)
    return vsc_fail(error, VSC_SYSTEM, "%s: cannot be written: %s", path, strerror(errno));
  if (ftell(file) == 0)
    fputs("time [s],load [1],iteration,residual [1],linear_iterations,factorizations\n", file);
  for (size_t k = 0; k < newton->row_count; k++) {
    const vsc_newton_row *row = &newton->rows[k];
    fprintf(file, "%.12g,%.6g,%.0f,%.6e,%.0f,%.0f\n", 1e-3 * row->time, row->load, row->iteration,
            row->residual, row->linear, row->factorized);
  }
  job->converged_rows += (double)newton->row_count;
  newton->row_count = 0;
  const bool failed = ferror(file) != 0;
  if (fclose(file) != 0 || failed)
    return vsc_fail(error, VSC_SYSTEM, "%s: cannot be written: %s", path, strerror(errno));
  return VSC_OK;
}

vsc_status vsc_job_trim_convergence(const vsc_job *job, vsc_error *error)
{
  char path[VSC_PATH];
  vsc_job_path(job, "convergence.csv", path);
  return vsc_watch_trim(path, job->state->time, error);
}
