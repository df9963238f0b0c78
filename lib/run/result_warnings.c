// SPDX-License-Identifier: GPL-3.0-or-later
// What is told of a run at its end beside its numbers.
#include <stdarg.h>
#include <string.h>

#include "model/law_constants.h"
#include "model/law_exponential.h"
#include "run/job.h"

// Adds a sentence to the warning of the result.
__attribute__((format(printf, 2, 3))) static void warn(vsc_run_result *result, const char *format, ...)
{
  const size_t begun = strlen(result->warning);
  va_list arguments;
  va_start(arguments, format);
  if (begun > 0 && begun + 3 < sizeof result->warning) strcpy(result->warning + begun, "; ");
  vsnprintf(result->warning + strlen(result->warning), sizeof result->warning - strlen(result->warning), format, arguments);
  va_end(arguments);
}

// Nobody goes back where implicit steps make energy, as looks let explicit ones do: it is told.
static void warn_of_energy(const vsc_job *job, vsc_run_result *result)
{
  const double made = vsc_watch_energy_made(job->watch);
  if (job->problem->model->solve.kind != VSC_SOLVE_IMPLICIT || made <= VSC_MOST_ENERGY_MADE) return;
  warn(result,
       "by the energy balance implicit steps have made %.0f %% of the largest energy or work: take shorter steps "
       "(time.step, solver.accuracy), or scheme: generalized_alpha with a smaller rho; where loads act between rare "
       "rows, which the balance does not see, closer rows (output.signals)", 100 * made);
}

// Stresses that the law as it is written does not have.
static void warn_of_exponents(const vsc_job *job, vsc_run_result *result)
{
  const vsc_model *model = job->problem->model;
  char names[160] = "";
  if (job->most_continued == 0) return;
  for (size_t m = 0; m < model->material_count; m++) {
    const size_t length = strlen(names);
    if (model->materials[m].element_count > 0 && vsc_law_has_exponent(model->materials[m].law))
      snprintf(names + length, sizeof names - length, "%s%s", length > 0 ? ", " : "", model->materials[m].name);
  }
  warn(result,
       "material %s: %.0f frames of elements at once were strained beyond exponent %g of the law, from where it goes on as a "
       "polynomial: stresses there are too low; take smaller loads, or constants that are meant for such strains",
       names, job->most_continued, VSC_LARGEST_EXPONENT);
}

static void warn_of_inverted(const vsc_job *job, vsc_run_result *result)
{
  const vsc_mesh *mesh = job->problem->mesh;
  if (job->most_inverted == 0) return;
  const size_t first = (size_t)job->inverted_element;
  double at[3];
  vsc_mesh_element_centre(mesh, first, at);
  warn(result,
       "up to %.0f elements at a time were inside out, %.0f are in the end: the first was element %u at (%.4g, %.4g, %.4g) "
       "mm, at %.6g ms; take %sa smaller load, a larger volume_modulus, or a finer mesh there",
       job->most_inverted, job->watch->totals.inverted, mesh->element_source[first], at[0], at[1], at[2],
       job->inverted_time, job->problem->model->step > 0 ? "a shorter time.step, " : "");
}

// Frames lie within elements, whose corners they do not see.
static void warn_of_folded(const vsc_job *job, vsc_run_result *result)
{
  const vsc_mesh *mesh = job->problem->mesh;
  const vsc_wound *wound = &job->wound;
  double at[3];
  if (wound->folded == 0) return;
  vsc_mesh_element_centre(mesh, wound->element, at);
  warn(result,
       "%zu element%s inside out at a corner in the end: the first is element %u, a %s, at (%.4g, %.4g, %.4g) mm; take a "
       "smaller load, a larger stabilization, or a finer mesh there",
       wound->folded, wound->folded == 1 ? " is" : "s are", mesh->element_source[wound->element],
       vsc_mesh_kind(mesh, wound->element)->name, at[0], at[1], at[2]);
}

// Each of its elements may be the right way out and near its volume.
static void warn_of_wound(const vsc_job *job, vsc_run_result *result)
{
  const vsc_mesh *mesh = job->problem->mesh;
  const vsc_wound *wound = &job->wound;
  double at[3];
  if (wound->count == 0) return;
  for (int i = 0; i < 3; i++)
    at[i] = (mesh->nodes[3 * (size_t)wound->ends[0] + i] + mesh->nodes[3 * (size_t)wound->ends[1] + i]) / 2;
  warn(result,
       "the body ends wound: round %zu edge%s its elements lie more than once, the first is that between nodes %u and %u at "
       "(%.4g, %.4g, %.4g) mm; take a smaller load, a larger volume_modulus, or a finer mesh there",
       wound->count, wound->count == 1 ? "" : "s", mesh->node_source[wound->ends[0]], mesh->node_source[wound->ends[1]],
       at[0], at[1], at[2]);
}

void vsc_job_warn(const vsc_job *job, vsc_run_result *result)
{
  warn_of_energy(job, result);
  warn_of_exponents(job, result);
  warn_of_inverted(job, result);
  warn_of_folded(job, result);
  warn_of_wound(job, result);
}
