// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/outcome.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/vtk.h"
#include "tools/results.h"

enum { SUMMARY = 1 << 16 };

// The number behind "key": in the summary; 0 when it is not there.
static double summary_number(const char *text, const char *key)
{
  char quoted[VSC_NAME];
  snprintf(quoted, sizeof quoted, "\"%s\": ", key);
  const char *found = strstr(text, quoted);
  return found != NULL ? strtod(found + strlen(quoted), NULL) : 0;
}

static vsc_status read_summary(const char *folder, vsc_outcome *outcome, vsc_error *error)
{
  char file[VSC_RESULT_PATH];
  static char text[SUMMARY];
  snprintf(file, sizeof file, "%s/summary.json", folder);
  FILE *stream = fopen(file, "rb");
  if (stream == NULL) return vsc_fail(error, VSC_INPUT, "%s: can't be read", file);
  text[fread(text, 1, sizeof text - 1, stream)] = '\0';
  fclose(stream);
  outcome->nodes = summary_number(text, "nodes");
  outcome->elements = summary_number(text, "elements");
  outcome->unknowns = 3 * (outcome->nodes - summary_number(text, "held_nodes"));
  outcome->iterations = summary_number(text, "newton_iterations_this_run");
  outcome->steps = summary_number(text, "steps");
  return VSC_OK;
}

static vsc_status read_frame(const char *folder, vsc_outcome *outcome, vsc_error *error)
{
  vsc_results results;
  vsc_status status = vsc_results_open(folder, &results, error);
  if (status != VSC_OK) return status;
  char file[2 * VSC_RESULT_PATH];
  vsc_pvd_frame_path(results.pvd, results.series, vsc_results_nearest(&results, NAN), file,
                     sizeof file);
  status = vsc_vtk_read_mesh(file, 1, &outcome->mesh, error);
  vsc_results_close(&results);
  if (status != VSC_OK) return status;
  const vsc_array *moved = vsc_arrays_find(&outcome->mesh->node_data, "displacement");
  if (moved == NULL || moved->components != 3)
    return vsc_fail(error, VSC_INPUT, "%s: there is no point array 'displacement'", file);
  outcome->moved = moved->values;
  return VSC_OK;
}

vsc_status vsc_outcome_open(const char *folder, vsc_outcome *outcome, vsc_error *error)
{
  char file[VSC_RESULT_PATH];
  snprintf(file, sizeof file, "%s/signals.csv", folder);
  outcome->folder = folder;
  outcome->mesh = NULL;
  outcome->signals = NULL;
  vsc_status status = read_summary(folder, outcome, error);
  if (status == VSC_OK) status = vsc_signals_read(file, &outcome->signals, error);
  if (status == VSC_OK) status = read_frame(folder, outcome, error);
  if (status != VSC_OK) vsc_outcome_close(outcome);
  return status;
}

void vsc_outcome_close(vsc_outcome *outcome)
{
  vsc_mesh_free(outcome->mesh);
  vsc_signals_free(outcome->signals);
  outcome->mesh = NULL;
  outcome->signals = NULL;
}
