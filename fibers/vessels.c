// SPDX-License-Identifier: GPL-3.0-or-later
#include "fibers/vessels.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "base/vec3.h"
#include "fibers/vessel_parts.h"
#include "io/vtk_polydata.h"

// ---- the walk over the elements

void vsc_vessel_element_box(const vsc_mesh *mesh, size_t element, double low[3], double high[3])
{
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  for (int k = 0; k < 3; k++) low[k] = INFINITY, high[k] = -INFINITY;
  for (int i = 0; i < vsc_mesh_kind(mesh, element)->corners; i++)
    for (size_t k = 0; k < 3; k++) {
      low[k] = fmin(low[k], mesh->nodes[3 * (size_t)corner[i] + k]);
      high[k] = fmax(high[k], mesh->nodes[3 * (size_t)corner[i] + k]);
    }
}

enum { PIECE = 64 };  // elements

static void visit_piece(void *context, size_t piece, int thread)
{
  const vsc_vessel_walk *walk = context;
  const size_t end = PIECE * (piece + 1);
  for (size_t e = PIECE * piece; e < end && e < walk->mesh->element_count; e++)
    walk->visit(walk, e, &walk->scratch[thread]);
}

static bool make_room(vsc_vessel_walk *walk, int threads)
{
  const vsc_mesh *mesh = walk->mesh;
  if (!VSC_NEW(walk->scratch, (size_t)threads)) return false;
  for (int t = 0; t < threads; t++)
    if (!VSC_NEW(walk->scratch[t].found, walk->near.count)) return false;
  for (size_t e = 0; e < mesh->element_count; e++) {
    vsc_cell_points **points = &walk->points[mesh->kinds[e]];
    if (*points != NULL) continue;
    if (!VSC_NEW(*points, 1)) return false;
    vsc_cell_points_fill(mesh->kinds[e], *points);
  }
  return true;
}

vsc_status vsc_vessel_walk_all(vsc_vessel_walk *walk, vsc_error *error)
{
  const int threads = vsc_parallel_threads();
  const bool room = make_room(walk, threads);
  if (room)
    vsc_parallel_for((walk->mesh->element_count + PIECE - 1) / PIECE, visit_piece, walk);
  for (int t = 0; walk->scratch != NULL && t < threads; t++) vsc_free(walk->scratch[t].found);
  vsc_free(walk->scratch);
  for (int k = 0; k < VSC_CELLS; k++) vsc_free(walk->points[k]);
  return room ? VSC_OK : vsc_fail_memory(error, "the sample points of a vessel");
}

// ---- one vessel

vsc_status vsc_vessel_sample(const vsc_mesh *mesh, const vsc_polydata *polydata,
                             const vsc_vessel_def *definition, double *fraction, double *direction,
                             vsc_vessel_report *report, vsc_error *error)
{
  const bool lines = definition->radius > 0 || definition->radius_array[0] != '\0';
  vsc_vessel_walk walk = {.mesh = mesh, .polydata = polydata};
  walk.fraction = fraction;
  walk.direction = direction;
  *report = (vsc_vessel_report){.surface = !lines};
  report->pieces = lines ? polydata->segment_count : polydata->triangle_count;
  if (report->pieces == 0)
    return vsc_fail(error, VSC_INPUT, "holds no %s: %s", lines ? "lines" : "triangles",
                    lines ? "a surface takes neither radius nor radius_array"
                          : "centre lines need a radius or a radius_array");
  memset(fraction, 0, mesh->element_count * sizeof *fraction);
  memset(direction, 0, 3 * mesh->element_count * sizeof *direction);
  const vsc_status status = lines ? vsc_vessel_lines(&walk, definition, report, error)
                                  : vsc_vessel_surface(&walk, report, error);
  vsc_boxes_free(&walk.near);
  for (size_t e = 0; status == VSC_OK && e < mesh->element_count; e++) {
    report->elements += fraction[e] > 0;
    report->volume += fraction[e] * vsc_mesh_element_volume(mesh, e);
  }
  return status;
}

// ---- all vessels

// Room of vsc_vessels_make, for each element.
typedef struct room {
  double *direction;  // of the vessel at hand, x 3
  double *taken;      // the part that former vessels have
  double *largest;    // the largest fraction of one vessel that has given its direction
  uint32_t *owner;    // the number of that vessel, from 1; 0: none
} room;

static void share(vsc_mesh *mesh, const vsc_vessel_def *vessel, uint32_t number, const room *room,
                  double *fraction, vsc_axes *axes, vsc_vessel_report *report)
{
  for (size_t e = 0; e < mesh->element_count; e++) {
    const double left = 1 - room->taken[e];
    if (fraction[e] > left) {
      const double lost = (fraction[e] - left) * vsc_mesh_element_volume(mesh, e);
      report->shared += lost;
      report->volume -= lost;
      fraction[e] = left;
    }
    room->taken[e] += fraction[e];
    if (fraction[e] < vessel->threshold || fraction[e] <= room->largest[e]) continue;
    if (!vsc_axes_set(axes, e, &room->direction[3 * e], NULL)) continue;
    room->largest[e] = fraction[e];
    room->owner[e] = number;
  }
}

static vsc_status make_one(vsc_mesh *mesh, const vsc_vessel_def *vessel, uint32_t number,
                           const room *room, vsc_axes *axes, vsc_vessel_report *report,
                           vsc_error *error)
{
  char name[VSC_NAME];
  vsc_error bare;
  vsc_polydata *polydata = NULL;
  const int length = snprintf(name, sizeof name, "%s_fraction", vessel->name);
  if (length >= VSC_NAME || vsc_arrays_find(&mesh->element_data, name) != NULL)
    return vsc_fail(error, VSC_INPUT,
                    "vessel %s: the name %s is too long or taken by a cell array of the mesh: choose "
                    "another",
                    vessel->name, name);
  vsc_status status = vsc_vtk_read_polydata(vessel->file, vessel->unit, &polydata, error);
  if (status != VSC_OK) return status;
  vsc_array *array = vsc_arrays_add(&mesh->element_data, name, 1, mesh->element_count);
  if (array == NULL) {
    status = vsc_fail_memory(error, "the fractions of a vessel");
  } else {
    status =
        vsc_vessel_sample(mesh, polydata, vessel, array->values, room->direction, report, &bare);
    if (status != VSC_OK) vsc_fail(error, status, "%s: %s", vessel->file, bare.text);
  }
  if (status == VSC_OK) share(mesh, vessel, number, room, array->values, axes, report);
  vsc_polydata_free(polydata);
  return status;
}

vsc_status vsc_vessels_make(vsc_mesh *mesh, const vsc_vessel_def *vessels, size_t count,
                            vsc_axes *axes, vsc_vessel_report *reports, vsc_error *error)
{
  room room = {0};
  vsc_status status = VSC_OK;
  if (!VSC_NEW(room.direction, 3 * mesh->element_count) ||
      !VSC_NEW(room.taken, mesh->element_count) || !VSC_NEW(room.largest, mesh->element_count) ||
      !VSC_NEW(room.owner, mesh->element_count))
    status = vsc_fail_memory(error, "the vessels");
  for (size_t v = 0; v < count && status == VSC_OK; v++)
    status = make_one(mesh, &vessels[v], (uint32_t)v + 1, &room, axes, &reports[v], error);
  for (size_t e = 0; status == VSC_OK && e < mesh->element_count; e++)
    if (room.owner[e] > 0) reports[room.owner[e] - 1].directed++;
  vsc_free(room.direction);
  vsc_free(room.taken);
  vsc_free(room.largest);
  vsc_free(room.owner);
  return status;
}
