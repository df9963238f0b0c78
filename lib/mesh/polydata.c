// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/polydata.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/edges.h"

vsc_polydata *vsc_polydata_create(size_t points, size_t triangles, size_t segments)
{
  vsc_polydata *made;
  if (points > UINT32_MAX || !VSC_NEW(made, 1)) return NULL;
  made->point_count = points;
  made->triangle_count = triangles;
  made->segment_count = segments;
  if (VSC_NEW(made->points, 3 * points) && VSC_NEW(made->triangles, 3 * triangles) &&
      VSC_NEW(made->segments, 2 * segments))
    return made;
  vsc_polydata_free(made);
  return NULL;
}

void vsc_polydata_free(vsc_polydata *polydata)
{
  if (polydata == NULL) return;
  vsc_free(polydata->points);
  vsc_free(polydata->triangles);
  vsc_free(polydata->segments);
  vsc_arrays_free(&polydata->point_data);
  vsc_free(polydata);
}

static void widen(const vsc_polydata *polydata, const uint32_t *points, size_t count, double low[3],
                  double high[3])
{
  for (size_t i = 0; i < count; i++)
    for (int k = 0; k < 3; k++) {
      low[k] = fmin(low[k], polydata->points[3 * (size_t)points[i] + (size_t)k]);
      high[k] = fmax(high[k], polydata->points[3 * (size_t)points[i] + (size_t)k]);
    }
}

void vsc_polydata_box(const vsc_polydata *polydata, double low[3], double high[3])
{
  for (int k = 0; k < 3; k++) low[k] = INFINITY, high[k] = -INFINITY;
  widen(polydata, polydata->triangles, 3 * polydata->triangle_count, low, high);
  widen(polydata, polydata->segments, 2 * polydata->segment_count, low, high);
}

// ---- how the triangles hang together

typedef struct placed {
  double x[3];
  uint32_t point;
} placed;

static int by_place(const void *a, const void *b)
{
  const placed *p = a, *q = b;
  for (int k = 0; k < 3; k++)
    if (p->x[k] != q->x[k]) return p->x[k] < q->x[k] ? -1 : 1;
  return (p->point > q->point) - (p->point < q->point);
}

vsc_status vsc_polydata_weld(const vsc_polydata *polydata, uint32_t *first, vsc_error *error)
{
  placed *order;
  if (!VSC_NEW(order, polydata->point_count)) return vsc_fail_memory(error, "the points' order");
  for (size_t i = 0; i < polydata->point_count; i++) {
    memcpy(order[i].x, &polydata->points[3 * i], sizeof order[i].x);
    order[i].point = (uint32_t)i;
  }
  qsort(order, polydata->point_count, sizeof *order, by_place);
  for (size_t i = 0; i < polydata->point_count; i++) {
    const double *x = order[i].x, *former = order[i > 0 ? i - 1 : 0].x;
    const bool same = i > 0 && x[0] == former[0] && x[1] == former[1] && x[2] == former[2];
    first[order[i].point] = same ? first[order[i - 1].point] : order[i].point;
  }
  vsc_free(order);
  return VSC_OK;
}

static void count_edges(const vsc_side *sides, size_t count, vsc_closure *closure)
{
  for (size_t first = 0, end; first < count; first = end) {
    end = vsc_sides_end(sides, count, first);
    if (sides[first].low == sides[first].high) continue;  // of a triangle that is a line
    if (end - first != 2)
      closure->open_edges++;
    else if (sides[first].rising == sides[first + 1].rising)
      closure->turned_edges++;
  }
}

static double enclosed(const vsc_polydata *polydata)
{
  double low[3], high[3], middle[3], volume = 0;
  vsc_polydata_box(polydata, low, high);
  for (int k = 0; k < 3; k++) middle[k] = (low[k] + high[k]) / 2;
  for (size_t t = 0; t < polydata->triangle_count; t++) {
    const uint32_t *corner = &polydata->triangles[3 * t];
    volume += vsc_tet_volume(middle, &polydata->points[3 * (size_t)corner[0]],
                             &polydata->points[3 * (size_t)corner[1]],
                             &polydata->points[3 * (size_t)corner[2]]);
  }
  return volume;
}

vsc_status vsc_polydata_closure(const vsc_polydata *polydata, vsc_closure *closure,
                                vsc_error *error)
{
  const size_t side_count = 3 * polydata->triangle_count;
  uint32_t *first, *welded = NULL;
  vsc_side *sides = NULL;
  vsc_status status = VSC_OK;
  *closure = (vsc_closure){0};
  if (!VSC_NEW(first, polydata->point_count) || !VSC_NEW(welded, side_count))
    status = vsc_fail_memory(error, "the edges of a surface");
  if (status == VSC_OK) status = vsc_polydata_weld(polydata, first, error);
  if (status == VSC_OK) {
    for (size_t k = 0; k < side_count; k++) welded[k] = first[polydata->triangles[k]];
    status = vsc_sides_list(welded, 3, polydata->triangle_count, &sides, error);
  }
  if (status == VSC_OK) {
    count_edges(sides, side_count, closure);
    closure->volume = enclosed(polydata);
  }
  vsc_free(first);
  vsc_free(welded);
  vsc_free(sides);
  return status;
}
