// SPDX-License-Identifier: GPL-3.0-or-later
#include "fibers/fibers.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/ellipsoid.h"
#include "fibers/helix.h"
#include "fibers/synthetic.h"
#include "io/vtk.h"

// ---- From a voxel map

// Whether a list has all arrays that a map names.
static bool has_map(const vsc_arrays *arrays, const vsc_angle_map_def *map)
{
  const char *const names[] = {map->azimuth, map->elevation, map->mask, map->weight};
  bool all = true;
  for (int k = 0; k < 4; k++) all = all && (names[k][0] == '\0' || vsc_arrays_find(arrays, names[k]) != NULL);
  return all;
}

static vsc_status from_map(const vsc_mesh *mesh, const vsc_angle_map_def *map, vsc_axes *axes,
                           vsc_fiber_report *report, vsc_error *error)
{
  vsc_image *image = NULL;
  vsc_status status = vsc_vtk_read_image(map->file, map->length_unit, &image, error);
  if (status != VSC_OK) return status;
  if (!has_map(&image->data, map) && has_map(&image->cell_data, map)) vsc_image_take_cells(image);
  status = vsc_fibers_sample(mesh, image, map, axes, report, error);
  vsc_image_free(image);
  return status;
}

// ---- From arrays of the mesh

static vsc_status find_vectors(const vsc_mesh *mesh, const char *name, const char *what,
                               const double **vectors, vsc_error *error)
{
  char hint[256];
  const vsc_array *array = vsc_arrays_find(&mesh->element_data, name);
  if (array == NULL) {
    vsc_arrays_hint(&mesh->element_data, name, hint, sizeof hint);
    return vsc_fail(error, VSC_INPUT, "the mesh has no array '%s' on its cells for the %s%s", name,
                    what, hint);
  }
  if (array->components != 3 || array->tuples != mesh->element_count)
    return vsc_fail(error, VSC_INPUT,
                    "cell array '%s' for the %s has %d components, expected a vector of 3", name,
                    what, array->components);
  *vectors = array->values;
  return VSC_OK;
}

// Counts a sheet vector that is no use, and keeps the largest deviation from a right angle.
static void judge_sheet(const double *fiber, const double *sheet, vsc_fiber_report *report)
{
  const double one_degree = M_PI / 180;
  double f[3], s[3];
  memcpy(f, fiber, sizeof f);
  memcpy(s, sheet, sizeof s);
  vsc_normalize(f);
  const double length = vsc_normalize(s), cosine = fabs(vsc_dot(f, s));
  const bool usable = isfinite(length) && length > 0;
  if (usable) {
    const double deviation = asin(fmin(cosine, 1)) / one_degree;
    report->worst_sheet_angle = fmax(report->worst_sheet_angle, deviation);
  }
  if (!usable || cosine > cos(one_degree)) report->invalid_sheets++;
}

static bool all_parallel(const vsc_axes *axes)
{
  const double *first = NULL;
  size_t others = 0;
  for (size_t e = 0; e < axes->count; e++) {
    if (!axes->known[e]) continue;
    const double *fiber = vsc_axes_frame(axes, e, 0);
    if (first == NULL) {
      first = fiber;
      continue;
    }
    double across[3];
    vsc_cross(first, fiber, across);
    if (vsc_norm(across) > 1e-3) return false;
    others++;
  }
  return others > 0;
}

// The vectors of a node array of that name, or NULL.
static const double *node_vectors(const vsc_mesh *mesh, const char *name)
{
  const vsc_array *array = vsc_arrays_find(&mesh->node_data, name);
  return array != NULL && array->components == 3 ? array->values : NULL;
}

static void add(double part, const double v[3], double sum[3])
{
  for (int a = 0; a < 3; a++) sum[a] += part * v[a];
}

// Vectors on the nodes and their directions.
typedef struct directions {
  const double *vectors;
  double *units;  // node_count x 3: 0 of a vector that is none, infinite of one that is not finite; owned
  bool sense_kept;
} directions;

static vsc_status find_directions(const vsc_mesh *mesh, const double *vectors, bool sense_kept, directions *d,
                                  vsc_error *error)
{
  *d = (directions){.vectors = vectors, .sense_kept = sense_kept};
  if (!VSC_NEW(d->units, 3 * mesh->node_count)) return vsc_fail_memory(error, "fibres on nodes");
  for (size_t n = 0; n < mesh->node_count; n++) {
    double frame[9] = {0};
    const double *v = vectors + 3 * n;
    vsc_axes_complete(v, NULL, frame);
    if (!isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2])) frame[0] = INFINITY;
    memcpy(d->units + 3 * n, frame, 3 * sizeof *frame);
  }
  return VSC_OK;
}

// Whether v is the mean of a and b, as raising the order of a mesh makes it.
static bool is_mean(const double v[3], const double a[3], const double b[3])
{
  double off = 0;
  for (int k = 0; k < 3; k++) off = fmax(off, fabs(v[k] - 0.5 * (a[k] + b[k])));
  return off <= 1e-12 * (vsc_norm(a) + vsc_norm(b));
}

// Whether two vectors are between 90 and 170 degrees apart: as axes they turn the other way round, by 10 and more.
static bool are_opposed(const double a[3], const double b[3])
{
  static const double TANGENT_OF_10_DEGREES = 0.17632698070846498;
  double across[3];
  const double along = vsc_dot(a, b);
  vsc_cross(a, b, across);
  return along < 0 && vsc_norm(across) > TANGENT_OF_10_DEGREES * -along;
}

// Whether the directions at some two vertices of an element are opposed.
static bool has_opposed(const vsc_mesh *mesh, size_t element, const directions *d)
{
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  bool opposed = false;
  for (int i = 0; i < vsc_mesh_kind(mesh, element)->vertices; i++)
    for (int j = 0; j < i; j++)
      opposed |= are_opposed(d->units + 3 * (size_t)corner[i], d->units + 3 * (size_t)corner[j]);
  return opposed;
}

// sum_i N_i u_i of the directions on an element's nodes, as they are; or, of axes, the top eigenvector of
// sum_i N_i u_i u_i^T, on the first one's side. In the middle of an edge the mean of its ends' vectors stands for the
// mean of what the ends add. Returns false where a vector is not finite.
static bool interpolate(const vsc_mesh *mesh, size_t element, const double *N, const directions *d, double v[3])
{
  const vsc_cell_kind *kind = vsc_mesh_kind(mesh, element);
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  double sum[3] = {0}, square[6] = {0};
  for (int i = 0; i < kind->corners; i++) {
    const size_t own = corner[i];
    if (isinf(d->units[3 * own])) return false;
    size_t from[2] = {own, own};
    if (i >= kind->vertices) {
      const int *edge = kind->edges[i - kind->vertices];
      const size_t ends[2] = {corner[edge[0]], corner[edge[1]]};
      if (is_mean(d->vectors + 3 * own, d->vectors + 3 * ends[0], d->vectors + 3 * ends[1]))
        memcpy(from, ends, sizeof from);
    }
    for (int k = 0; k < 2; k++) {
      add(0.5 * N[i], d->units + 3 * from[k], sum);
      vsc_add_square(d->units + 3 * from[k], 0.5 * N[i], square);
    }
  }
  memcpy(v, sum, sizeof sum);
  if (d->sense_kept) return true;
  memset(v, 0, sizeof sum);
  if (vsc_top_axis(square, v, NULL) && vsc_dot(v, d->units + 3 * (size_t)corner[0]) < 0)
    for (int a = 0; a < 3; a++) v[a] = -v[a];
  return true;
}

// Fibres from vectors on the nodes: at each point of quadratic tets, the mean of other elements.
static void set_from_nodes(const vsc_mesh *mesh, const directions *fibers, const directions *sheets, vsc_axes *axes,
                           vsc_fiber_report *report)
{
  const vsc_cell_rule rule = vsc_cell_rule_of(VSC_TET10);
  double ones[VSC_MOST_CORNERS];
  for (int i = 0; i < VSC_MOST_CORNERS; i++) ones[i] = 1;
  for (size_t e = 0; e < mesh->element_count; e++) {
    bool known = true;
    for (int q = 0; q < axes->points && known; q++) {
      const double *N = axes->points > 1 ? rule.N[q] : ones;
      double fiber[3], sheet[3];
      const bool sheeted = sheets->units != NULL && interpolate(mesh, e, N, sheets, sheet);
      known = interpolate(mesh, e, N, fibers, fiber) &&
              vsc_axes_complete(fiber, sheeted ? sheet : NULL, vsc_axes_frame(axes, e, q));
      if (known && sheeted && q == 0) judge_sheet(fiber, sheet, report);
      if (known && sheets->units != NULL && !sheeted && q == 0) report->invalid_sheets++;
    }
    vsc_axes_finish(axes, e, known);
    report->invalid += !known;
    report->opposed += known && has_opposed(mesh, e, fibers);
  }
  report->constant = all_parallel(axes);
}

static vsc_status from_nodes(const vsc_mesh *mesh, const double *fibers, const double *sheets, bool sense_kept,
                             vsc_axes *axes, vsc_fiber_report *report, vsc_error *error)
{
  directions f = {0}, s = {0};
  vsc_status status = find_directions(mesh, fibers, sense_kept, &f, error);
  if (status == VSC_OK && sheets != NULL) status = find_directions(mesh, sheets, sense_kept, &s, error);
  if (status == VSC_OK) set_from_nodes(mesh, &f, &s, axes, report);
  vsc_free(f.units);
  vsc_free(s.units);
  return status;
}

static vsc_status from_arrays(const vsc_mesh *mesh, const vsc_fiber_def *definition, vsc_axes *axes,
                              vsc_fiber_report *report, vsc_error *error)
{
  const double *fibers, *sheets = NULL;
  const char *name = definition->sheet_array;
  const double *on_nodes = node_vectors(mesh, definition->fiber_array);
  if (on_nodes != NULL && vsc_arrays_find(&mesh->element_data, definition->fiber_array) == NULL) {
    sheets = name[0] != '\0' ? node_vectors(mesh, name) : NULL;
    if (sheets == NULL && name[0] != '\0' && strcmp(name, "sheet") != 0)
      return vsc_fail(error, VSC_INPUT,
                      "the mesh has no vectors '%s' on its nodes for the sheet, as '%s' for the fibre",
                      name, definition->fiber_array);
    return from_nodes(mesh, on_nodes, sheets, definition->sense_kept, axes, report, error);
  }
  vsc_status status = find_vectors(mesh, definition->fiber_array, "fibre", &fibers, error);
  if (status != VSC_OK) return status;
  const bool optional =
      strcmp(name, "sheet") == 0 && vsc_arrays_find(&mesh->element_data, name) == NULL;
  if (name[0] != '\0' && !optional) status = find_vectors(mesh, name, "sheet", &sheets, error);
  if (status != VSC_OK) return status;
  for (size_t e = 0; e < mesh->element_count; e++) {
    const double *sheet = sheets == NULL ? NULL : &sheets[3 * e];
    vsc_axes_set(axes, e, &fibers[3 * e], sheet);
    if (!axes->known[e])
      report->invalid++;
    else if (sheet != NULL)
      judge_sheet(&fibers[3 * e], sheet, report);
  }
  report->constant = all_parallel(axes);
  return VSC_OK;
}

// ---- From the depth in a wall

static const vsc_surface *find_surface(const vsc_surface *surfaces, size_t count, const char *name,
                                       const char *what, vsc_error *error)
{
  char known[256] = "";
  size_t used = 0;
  for (size_t k = 0; k < count; k++) {
    if (strcmp(surfaces[k].name, name) == 0) return &surfaces[k];
    if (used < sizeof known)
      used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", k == 0 ? "" : ", ",
                               surfaces[k].name);
  }
  vsc_fail(error, VSC_INPUT, "helix: no surface '%s' for the %s, known surfaces: %s", name, what,
           count == 0 ? "none" : known);
  return NULL;
}

// How many nodes two surfaces share.
static vsc_status count_shared(const vsc_mesh *mesh, const vsc_surface *a, const vsc_surface *b, size_t *count,
                               vsc_error *error)
{
  uint8_t *on;
  if (!VSC_NEW(on, mesh->node_count)) return vsc_fail_memory(error, "the rim of the wall");
  for (size_t k = 0; k < 3 * a->count; k++) on[a->triangles[k]] = 1;
  for (size_t k = 0; k < 3 * b->count; k++) {
    *count += on[b->triangles[k]];
    on[b->triangles[k]] = 0;
  }
  vsc_free(on);
  return VSC_OK;
}

static vsc_status from_depth(const vsc_mesh *mesh, const vsc_fiber_def *definition,
                             const vsc_surface *surfaces, size_t count, vsc_axes *axes,
                             vsc_fiber_report *report, vsc_error *error)
{
  if (definition->source == VSC_FIBER_ELLIPSOID) {
    const vsc_status status = vsc_ellipsoid_check(definition, error);
    if (status != VSC_OK) return status;
  }
  const vsc_surface *endo = find_surface(surfaces, count, definition->endo, "endocardium", error);
  if (endo == NULL) return VSC_INPUT;
  const vsc_surface *epi = find_surface(surfaces, count, definition->epi, "epicardium", error);
  if (epi == NULL) return VSC_INPUT;
  vsc_surface outside;
  vsc_status status = vsc_surface_without(epi, endo, &outside, error);
  if (status == VSC_OK && outside.count == 0)
    status = vsc_fail(error, VSC_INPUT,
                      "helix: every triangle of epi, '%s', is one of endo, '%s', too: let epi name the outside of "
                      "the wall",
                      epi->name, endo->name);
  if (status == VSC_OK) status = count_shared(mesh, endo, &outside, &report->meeting, error);
  for (int k = 0; k < 2 && status == VSC_OK && definition->source == VSC_FIBER_ELLIPSOID; k++)
    vsc_ellipsoid_judge(definition, mesh, k == 0 ? endo : &outside, &report->wall_faces, &report->off_faces);
  if (status == VSC_OK) status = vsc_fibers_helix(mesh, definition, endo, &outside, axes, error);
  vsc_surface_free(&outside);
  return status;
}

static vsc_status from_ellipsoid(const vsc_mesh *mesh, const vsc_fiber_def *definition, vsc_axes *axes,
                                 vsc_fiber_report *report, vsc_error *error)
{
  vsc_surface boundary = {0};
  vsc_status status = vsc_fibers_synthetic(mesh, definition, axes, error);
  if (status == VSC_OK) status = vsc_boundary(mesh, &boundary, error);
  if (status == VSC_OK) vsc_ellipsoid_judge(definition, mesh, &boundary, &report->wall_faces, &report->off_faces);
  vsc_surface_free(&boundary);
  return status;
}

static vsc_status from_source(const vsc_mesh *mesh, const vsc_fiber_def *definition,
                              const vsc_surface *surfaces, size_t count, vsc_axes *axes,
                              vsc_fiber_report *report, vsc_error *error)
{
  if (vsc_fiber_needs_surfaces(definition))
    return from_depth(mesh, definition, surfaces, count, axes, report, error);
  switch (definition->source) {
    case VSC_FIBER_NONE: return VSC_OK;
    case VSC_FIBER_MAP: return from_map(mesh, &definition->map, axes, report, error);
    case VSC_FIBER_ARRAYS: return from_arrays(mesh, definition, axes, report, error);
    case VSC_FIBER_ELLIPSOID: return from_ellipsoid(mesh, definition, axes, report, error);
    default: return vsc_fibers_synthetic(mesh, definition, axes, error);
  }
}

vsc_status vsc_fibers_make(const vsc_mesh *mesh, const vsc_fiber_def *definition,
                           const vsc_surface *surfaces, size_t surface_count, vsc_axes **result,
                           vsc_fiber_report *report, vsc_error *error)
{
  *report = (vsc_fiber_report){0};
  vsc_axes *axes = vsc_axes_create_for(mesh);
  if (axes == NULL) return vsc_fail_memory(error, "the fibre axes");
  vsc_status status = from_source(mesh, definition, surfaces, surface_count, axes, report, error);
  const bool fills = definition->source == VSC_FIBER_MAP || definition->source == VSC_FIBER_ARRAYS;
  if (status == VSC_OK && fills && definition->fill)
    status = vsc_fibers_fill(mesh, axes, &report->filled, error);
  if (status == VSC_OK) status = vsc_fiber_describe(axes, report, error);
  if (status == VSC_OK)
    *result = axes;
  else
    vsc_axes_free(axes);
  return status;
}
