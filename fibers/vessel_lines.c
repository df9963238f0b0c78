// SPDX-License-Identifier: GPL-3.0-or-later
// Vessels given by centre lines.
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/sample.h"
#include "fibers/vessel_parts.h"

typedef struct segment {
  double from[3], along[3];  // mm: its start, and the vector to its end
  double square;             // |along|^2
  double radius[2];          // mm, at the two points
  bool free[2];              // no other segment goes on there
} segment;

// How deep a point lies: its distance from the segment over the radius there; above 1 outside.
static double depth(const segment *s, const double point[3])
{
  double offset[3];
  vsc_subtract(point, s->from, offset);
  if (s->square == 0) return INFINITY;
  double t = vsc_dot(offset, s->along) / s->square;
  if ((t < 0 && s->free[0]) || (t > 1 && s->free[1])) return INFINITY;
  t = fmin(fmax(t, 0), 1);
  for (int k = 0; k < 3; k++) offset[k] -= t * s->along[k];
  const double radius = s->radius[0] + t * (s->radius[1] - s->radius[0]);
  return radius > 0 ? vsc_norm(offset) / radius : INFINITY;
}

static void visit(const vsc_vessel_walk *walk, size_t element, vsc_vessel_scratch *scratch)
{
  const segment *segments = walk->own;
  double low[3], high[3], all = 0, inside = 0, matrix[6] = {0};
  vsc_vessel_element_box(walk->mesh, element, low, high);
  const size_t count = vsc_boxes_find(&walk->near, low, high, scratch->found);
  if (count == 0) return;
  vsc_cell_points_place(walk->mesh, element, walk->points[walk->mesh->kinds[element]],
                        scratch->places, scratch->weights);
  for (int p = 0; p < VSC_CELL_POINTS; p++) {
    double least = INFINITY;
    const segment *nearest = NULL;
    for (size_t i = 0; i < count; i++) {
      const double here = depth(&segments[scratch->found[i]], scratch->places[p]);
      if (here < least) least = here, nearest = &segments[scratch->found[i]];
    }
    all += scratch->weights[p];
    if (!(least <= 1)) continue;
    inside += scratch->weights[p];
    vsc_add_square(nearest->along, scratch->weights[p] / nearest->square, matrix);
  }
  if (inside == 0) return;
  walk->fraction[element] = fmin(inside / all, 1);
  vsc_top_axis(matrix, &walk->direction[3 * element], NULL);
}

// ---- the segments

static vsc_status find_radii(const vsc_polydata *polydata, const vsc_vessel_def *definition,
                             const vsc_array **radii, vsc_error *error)
{
  char hint[256];
  const char *name = definition->radius_array;
  *radii = NULL;
  if (name[0] == '\0') return VSC_OK;
  *radii = vsc_arrays_find(&polydata->point_data, name);
  if (*radii == NULL) {
    vsc_arrays_hint(&polydata->point_data, name, hint, sizeof hint);
    return vsc_fail(error, VSC_INPUT, "no array '%s' on its points for the radius%s", name, hint);
  }
  if ((*radii)->components != 1)
    return vsc_fail(error, VSC_INPUT, "array '%s' has %d components: a radius is one number", name,
                    (*radii)->components);
  for (size_t i = 0; i < (*radii)->tuples; i++)
    if (!((*radii)->values[i] >= 0) || !isfinite((*radii)->values[i]))
      return vsc_fail(error, VSC_INPUT,
                      "array '%s' holds the radius %g at point %zu: correct it", name,
                      (*radii)->values[i], i);
  return VSC_OK;
}

// Fills segments, the boxes round what they reach, and their volume.
static void fill_segments(const vsc_polydata *polydata, const vsc_vessel_def *definition,
                          const vsc_array *radii, const uint32_t *first, const uint32_t *uses,
                          segment *segments, double *ends, double *volume)
{
  for (size_t s = 0; s < polydata->segment_count; s++) {
    const uint32_t *point = &polydata->segments[2 * s];
    segment *made = &segments[s];
    for (int i = 0; i < 2; i++) {
      made->radius[i] =
          radii != NULL ? radii->values[point[i]] * definition->unit : definition->radius;
      made->free[i] = uses[first[point[i]]] == 1;
    }
    const double *a = &polydata->points[3 * (size_t)point[0]];
    const double *b = &polydata->points[3 * (size_t)point[1]];
    const double *r = made->radius, reach = fmax(r[0], r[1]);
    memcpy(made->from, a, sizeof made->from);
    vsc_subtract(b, a, made->along);
    made->square = vsc_dot(made->along, made->along);
    *volume += M_PI / 3 * (r[0] * r[0] + r[0] * r[1] + r[1] * r[1]) * sqrt(made->square);
    for (int k = 0; k < 3; k++) {
      ends[6 * s + (size_t)k] = fmin(a[k], b[k]) - reach;
      ends[6 * s + 3 + (size_t)k] = fmax(a[k], b[k]) + reach;
    }
  }
}

vsc_status vsc_vessel_lines(vsc_vessel_walk *walk, const vsc_vessel_def *definition,
                            vsc_vessel_report *report, vsc_error *error)
{
  const vsc_polydata *polydata = walk->polydata;
  const size_t count = polydata->segment_count;
  const vsc_array *radii;
  vsc_status status = find_radii(polydata, definition, &radii, error);
  if (status != VSC_OK) return status;
  segment *segments;
  double *ends = NULL;
  uint32_t *first = NULL, *uses = NULL;
  if (!VSC_NEW(segments, count) || !VSC_NEW(ends, 6 * count) ||
      !VSC_NEW(first, polydata->point_count) || !VSC_NEW(uses, polydata->point_count))
    status = vsc_fail_memory(error, "the centre lines");
  if (status == VSC_OK) status = vsc_polydata_weld(polydata, first, error);
  if (status == VSC_OK) {
    for (size_t s = 0; s < count; s++) {
      const uint32_t a = first[polydata->segments[2 * s]];
      const uint32_t b = first[polydata->segments[2 * s + 1]];
      if (a != b) uses[a]++, uses[b]++;
    }
    fill_segments(polydata, definition, radii, first, uses, segments, ends, &report->own_volume);
    walk->own = segments;
    walk->visit = visit;
    status = vsc_boxes_make(count, ends, &walk->near, error);
  }
  if (status == VSC_OK) status = vsc_vessel_walk_all(walk, error);
  vsc_free(segments);
  vsc_free(ends);
  vsc_free(first);
  vsc_free(uses);
  return status;
}
