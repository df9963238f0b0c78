// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/check_mesh.h"

#include "mesh/coincident.h"
#include "mesh/quality.h"
#include "model/free_motions.h"

static void say_mesh(const vsc_problem *problem, FILE *out)
{
  const vsc_mesh *mesh = problem->mesh;
  const vsc_mesh_report *report = &mesh->report;
  double low[3], high[3];
  vsc_mesh_box(mesh, low, high);
  char kinds[128];
  fprintf(out, "mesh       %s: %zu nodes, %s, %zu triangles; 1 unit = %g mm\n",
          problem->scene->mesh_file, mesh->node_count,
          vsc_mesh_kinds_text(mesh, kinds, sizeof kinds), mesh->triangle_count,
          problem->scene->mesh_unit);
  fprintf(out, "size       %.4g x %.4g x %.4g mm from (%.4g, %.4g, %.4g); tissue %.4g ml, %.4g g\n",
          high[0] - low[0], high[1] - low[1], high[2] - low[2], low[0], low[1], low[2],
          1e-3 * problem->model->total_volume, 1e-3 * problem->model->total_mass);
  if (report->turned_elements + report->unused_nodes + report->ignored_cells + report->loose_triangles >
      0)
    fprintf(out,
            "set right  %zu left-handed elements turned, %zu unused nodes dropped, %zu loose triangles "
            "dropped, "
            "%zu other cells ignored%s%s\n",
            report->turned_elements, report->unused_nodes, report->loose_triangles,
            report->ignored_cells, report->ignored_kinds[0] ? ": " : "", report->ignored_kinds);
}

static vsc_status say_quality(const vsc_problem *problem, FILE *out, vsc_error *error)
{
  vsc_quality_summary q;
  const vsc_status status = vsc_mesh_quality(problem->mesh, &q, error);
  if (status != VSC_OK) return status;
  fprintf(out,
          "quality    shape %.2f (5 %% below %.2f, %zu poor); dihedral %.1f to %.1f deg; "
          "edges %.3g to %.3g mm\n",
          q.shape_mean, q.shape_p5, q.poor, q.min_dihedral, q.max_dihedral,
          q.shortest_edge, q.longest_edge);
  fprintf(out, "worst     ");
  for (size_t k = 0; k < q.worst_count && k < 3; k++)
    fprintf(out, " element %u (%.2f) at (%.4g, %.4g, %.4g)%s", q.worst_source[k],
            q.worst[k].shape, q.worst_centre[k][0], q.worst_centre[k][1], q.worst_centre[k][2],
            k + 1 < q.worst_count && k < 2 ? "," : "\n");
  return VSC_OK;
}

static vsc_status say_parts(const vsc_problem *problem, FILE *out, vsc_error *error)
{
  char where[VSC_FREE_TEXT];
  size_t parts, coincident;
  const vsc_status status = vsc_mesh_coincident(problem->mesh, &coincident, error);
  vsc_loose_parts(problem->model, &parts, where, sizeof where);
  if (status != VSC_OK || (parts < 2 && coincident == 0)) return status;
  fprintf(out, "parts      %zu separate; %zu nodes lie where another one does, not joined to it\n", parts, coincident);
  return VSC_OK;
}

vsc_status vsc_check_mesh(const vsc_problem *problem, FILE *stream, vsc_error *error)
{
  say_mesh(problem, stream);
  const vsc_status status = problem->mesh->element_count > 0 ? say_quality(problem, stream, error) : VSC_OK;
  return status == VSC_OK ? say_parts(problem, stream, error) : status;
}
