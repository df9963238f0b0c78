// SPDX-License-Identifier: GPL-3.0-or-later
#include "fibers/sample.h"

#include <gsl/gsl_sort_double.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/split.h"

enum {
  ENOUGH = 16,  // voxel centres in an element that make a mean
  POINTS = 20,  // of each tet of an element with fewer, where the map is interpolated
};
static const double RIDGE = 0.01;  // added to the voxels' variance, in voxels squared
static const double REACH = 2;     // standard deviations that the mean may be moved by

// The map, its arrays looked up and checked.
typedef struct angle_map {
  const vsc_image *image;
  const vsc_angle_map_def *def;
  const double *azimuth, *elevation, *mask, *weight;  // the last two may be NULL
} angle_map;

// Weighted sums over voxels; y is the voxel's index relative to the centroid of the element.
typedef struct moments {
  double weight;
  double place[3];     // y
  double spread[6];    // y y^T
  double axis[6];      // f f^T
  double slope[3][6];  // y f f^T
} moments;

// A tet in the index coordinates of the image.
typedef struct index_tet {
  double node[4][3];
  double centre[3];
  double gradient[4][3];  // of the barycentric coordinates
  double volume;          // voxels, not negative
} index_tet;

// An element as tets.
typedef struct index_element {
  int count;
  index_tet tets[VSC_MOST_TETS];
  double centre[3];
} index_element;

// ---- Looking up and checking the map

static vsc_status find_array(const vsc_image *image, const char *name, const char *file,
                             const char *key, const double **values, vsc_error *error)
{
  char hint[256];
  const vsc_array *array = vsc_arrays_find(&image->data, name);
  if (array == NULL && vsc_arrays_find(&image->cell_data, name) != NULL)
    return vsc_fail(error, VSC_INPUT,
                    "%s: array '%s' for the map's %s lies on the cells, and others of the map do not: put all on the "
                    "points, or all on the cells",
                    file, name, key);
  if (array == NULL) {
    vsc_arrays_hint(&image->data, name, hint, sizeof hint);
    return vsc_fail(error, VSC_INPUT, "%s: no array '%s' for the map's %s%s", file, name, key,
                    hint);
  }
  const size_t voxels = image->size[0] * image->size[1] * image->size[2];
  if (array->components != 1 || array->tuples != voxels)
    return vsc_fail(error, VSC_INPUT,
                    "%s: array '%s' for the map's %s has %zu values of %d components, "
                    "expected one number for each of %zu voxels",
                    file, name, key, array->tuples, array->components, voxels);
  *values = array->values;
  return VSC_OK;
}

static double weight_of(const angle_map *map, size_t voxel)
{
  if (map->mask != NULL && !(map->mask[voxel] > 0)) return 0;
  return map->weight == NULL ? 1 : map->weight[voxel];
}

static vsc_status check_voxels(const angle_map *map, const char *file, vsc_error *error)
{
  const size_t *size = map->image->size, voxels = size[0] * size[1] * size[2];
  size_t with_data = 0;
  for (size_t v = 0; v < voxels; v++) {
    const double weight = weight_of(map, v);
    if (weight == 0) continue;
    const size_t i = v % size[0], j = v / size[0] % size[1], k = v / size[0] / size[1];
    if (!(isfinite(weight) && weight > 0))
      return vsc_fail(error, VSC_INPUT,
                      "%s: weight '%s' of voxel (%zu, %zu, %zu) is %g, must be finite and "
                      "not negative: correct it or mask the voxel",
                      file, map->def->weight, i, j, k, weight);
    if (!isfinite(map->azimuth[v]) || !isfinite(map->elevation[v]))
      return vsc_fail(error, VSC_INPUT,
                      "%s: angles of voxel (%zu, %zu, %zu) inside the mask are %g and %g, "
                      "must be finite: name a mask array that leaves the voxel out",
                      file, i, j, k, map->azimuth[v], map->elevation[v]);
    with_data++;
  }
  if (with_data == 0)
    return vsc_fail(error, VSC_INPUT,
                    "%s: none of %zu voxels holds data: mask '%s' must be above 0 and weight "
                    "'%s' above 0 somewhere",
                    file, voxels, map->def->mask, map->def->weight);
  return VSC_OK;
}

static vsc_status check_geometry(const vsc_image *image, const char *file, vsc_error *error)
{
  double column[3][3], normal[3];
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) column[c][r] = image->direction[3 * r + c];
  vsc_cross(column[0], column[1], normal);
  const double volume = vsc_dot(normal, column[2]);
  if (!(fabs(volume) > 1e-3 && isfinite(volume)))
    return vsc_fail(error, VSC_INPUT,
                    "%s: the direction matrix has determinant %g, must be 1 or -1: its "
                    "columns are the unit vectors of the image's axes",
                    file, volume);
  for (int a = 0; a < 3; a++)
    if (!(image->spacing[a] > 0 && isfinite(image->spacing[a])) || !isfinite(image->origin[a]))
      return vsc_fail(error, VSC_INPUT,
                      "%s: spacing %g mm and origin %g mm along axis %d, must be finite, the "
                      "spacing above 0",
                      file, image->spacing[a], image->origin[a], a);
  return VSC_OK;
}

static vsc_status open_map(const vsc_image *image, const vsc_angle_map_def *def, angle_map *map,
                           vsc_error *error)
{
  const char *file = def->file[0] != '\0' ? def->file : "angle map";
  *map = (angle_map){.image = image, .def = def};
  vsc_status status = check_geometry(image, file, error);
  if (status == VSC_OK)
    status = find_array(image, def->azimuth, file, "azimuth", &map->azimuth, error);
  if (status == VSC_OK)
    status = find_array(image, def->elevation, file, "elevation", &map->elevation, error);
  if (status == VSC_OK && def->mask[0] != '\0')
    status = find_array(image, def->mask, file, "mask", &map->mask, error);
  if (status == VSC_OK && def->weight[0] != '\0')
    status = find_array(image, def->weight, file, "weight", &map->weight, error);
  if (status == VSC_OK) status = check_voxels(map, file, error);
  return status;
}

// ---- Gathering the voxels of one element

static void add_voxel(const angle_map *map, const size_t at[3], double share,
                      const double centre[3], moments *sum)
{
  static const int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
  const size_t *size = map->image->size;
  const size_t voxel = at[0] + size[0] * (at[1] + size[1] * at[2]);
  const double w = share * weight_of(map, voxel);
  if (w == 0) return;
  const vsc_angle_map_def *def = map->def;
  const double azimuth =
      def->azimuth_sense * (map->azimuth[voxel] * def->scale - def->azimuth_zero);
  const double elevation = def->elevation_sense * map->elevation[voxel] * def->scale;
  const double level = cos(elevation);
  const double f[3] = {level * cos(azimuth), level * sin(azimuth), sin(elevation)};
  double y[3];
  for (int a = 0; a < 3; a++) y[a] = (double)at[a] - centre[a];
  sum->weight += w;
  for (int a = 0; a < 3; a++) sum->place[a] += w * y[a];
  for (int c = 0; c < 6; c++) {
    const double ff = w * f[row[c]] * f[column[c]];
    sum->spread[c] += w * y[row[c]] * y[column[c]];
    sum->axis[c] += ff;
    for (int a = 0; a < 3; a++) sum->slope[a][c] += y[a] * ff;
  }
}

static index_tet make_tet(const vsc_mesh *mesh, const vsc_image *image, const uint32_t corners[4])
{
  index_tet tet = {0};
  double edge[3][3];
  for (int i = 0; i < 4; i++) {
    vsc_image_index(image, &mesh->nodes[3 * (size_t)corners[i]], tet.node[i]);
    for (int a = 0; a < 3; a++) tet.centre[a] += tet.node[i][a] / 4;
  }
  for (int i = 0; i < 3; i++) vsc_subtract(tet.node[i + 1], tet.node[0], edge[i]);
  for (int i = 0; i < 3; i++) vsc_cross(edge[(i + 1) % 3], edge[(i + 2) % 3], tet.gradient[i + 1]);
  const double determinant = vsc_dot(edge[0], tet.gradient[1]);
  for (int a = 0; a < 3; a++)
    for (int i = 1; i < 4; i++) {
      tet.gradient[i][a] /= determinant;
      tet.gradient[0][a] -= tet.gradient[i][a];
    }
  tet.volume = fabs(determinant) / 6;
  return tet;
}

static index_element make_element(const vsc_mesh *mesh, const vsc_image *image, size_t e)
{
  index_element element = {0};
  uint32_t tets[VSC_MOST_TETS][4];
  double volume = 0;
  element.count = vsc_mesh_split(mesh, e, tets);
  for (int t = 0; t < element.count; t++) {
    element.tets[t] = make_tet(mesh, image, tets[t]);
    volume += element.tets[t].volume;
  }
  for (int t = 0; t < element.count; t++) {
    const double share = element.count == 1 ? 1 : element.tets[t].volume / volume;
    for (int a = 0; a < 3; a++) element.centre[a] += share * element.tets[t].centre[a];
  }
  return element;
}

// First and last whole number in [low, high] and [0, size); first > last when there is none.
static void whole_range(double low, double high, size_t size, long *first, long *last)
{
  const double end = (double)size - 1;
  *first = (long)ceil(fmin(fmax(low, 0), end + 1));
  *last = (long)floor(fmax(fmin(high, end), -1));
}

static void box_range(const index_tet *tet, int axis, size_t size, long *first, long *last)
{
  double low = tet->node[0][axis], high = low;
  for (int i = 1; i < 4; i++) {
    low = fmin(low, tet->node[i][axis]);
    high = fmax(high, tet->node[i][axis]);
  }
  whole_range(low, high, size, first, last);
}

// The voxels of the row (j, k) whose centres lie in the tet: all four barycentric coordinates,
// 1/4 + gradient . (p - centre), not below 0.
static void row_range(const index_tet *tet, long j, long k, size_t size, long *first, long *last)
{
  double low = -INFINITY, high = INFINITY;
  const double y = (double)j - tet->centre[1], z = (double)k - tet->centre[2];
  for (int i = 0; i < 4; i++) {
    const double *g = tet->gradient[i];
    const double value = 0.25 + 1e-12 + g[1] * y + g[2] * z;
    if (g[0] > 0) low = fmax(low, -value / g[0]);
    if (g[0] < 0) high = fmin(high, -value / g[0]);
    if (g[0] == 0 && value < 0) high = -INFINITY;
  }
  whole_range(low + tet->centre[0], high + tet->centre[0], size, first, last);
}

// Whether a voxel's centre lies in the tet, as row_range has it.
static bool holds(const index_tet *tet, const size_t at[3])
{
  for (int i = 0; i < 4; i++) {
    double value = 0.25 + 1e-12;
    for (int a = 0; a < 3; a++) value += tet->gradient[i][a] * ((double)at[a] - tet->centre[a]);
    if (value < 0) return false;
  }
  return true;
}

// Adds the voxels whose centres lie in tet `t` of the element and in none before it; returns how many
// there are, with data or without.
static size_t gather_inside(const angle_map *map, const index_element *element, int t, moments *sum)
{
  const index_tet *tet = &element->tets[t];
  const size_t *size = map->image->size;
  size_t inside = 0;
  long k, k_last, j_first, j_last;
  box_range(tet, 1, size[1], &j_first, &j_last);
  box_range(tet, 2, size[2], &k, &k_last);
  for (; k <= k_last; k++)
    for (long j = j_first; j <= j_last; j++) {
      long i, i_last;
      row_range(tet, j, k, size[0], &i, &i_last);
      for (; i <= i_last; i++) {
        const size_t at[3] = {(size_t)i, (size_t)j, (size_t)k};
        bool counted = false;
        for (int former = 0; former < t; former++)
          counted = counted || holds(&element->tets[former], at);
        if (counted) continue;
        add_voxel(map, at, 1, element->centre, sum);
        inside++;
      }
    }
  return inside;
}

// Adds the 8 voxels round a point with their trilinear weights times `weight`.
static void gather_round(const angle_map *map, const double point[3], double weight,
                         const double home[3], moments *sum)
{
  const size_t *size = map->image->size;
  double low[3], part[3];
  for (int a = 0; a < 3; a++) {
    if (!(point[a] > -1 && point[a] < (double)size[a])) return;
    low[a] = floor(point[a]);
    part[a] = point[a] - low[a];
  }
  for (int corner = 0; corner < 8; corner++) {
    size_t at[3];
    double share = weight;
    bool within = true;
    for (int a = 0; a < 3; a++) {
      const int up = corner >> a & 1;
      const double index = low[a] + up;
      share *= up ? part[a] : 1 - part[a];
      within = within && index >= 0 && index < (double)size[a];
      at[a] = within ? (size_t)index : 0;
    }
    if (within && share > 0) add_voxel(map, at, share, home, sum);
  }
}

// The points' barycentric coordinates are (i + d) / (3 + 4 d) for all i >= 0 of sum 3; this d makes
// their plain mean exact for quadratic functions.
static void gather_interpolated(const angle_map *map, const index_tet *tet, double weight,
                                const double home[3], moments *sum)
{
  const double d = (sqrt(1.89) - 0.9) / 1.2;
  for (int i = 0; i <= 3; i++)
    for (int j = 0; i + j <= 3; j++)
      for (int k = 0; i + j + k <= 3; k++) {
        const double share[4] = {i + d, j + d, k + d, 3 - i - j - k + d};
        double point[3] = {0};
        for (int n = 0; n < 4; n++)
          for (int a = 0; a < 3; a++) point[a] += share[n] / (3 + 4 * d) * tet->node[n][a];
        gather_round(map, point, weight, home, sum);
      }
}

// ---- From the sums to the axis

// x of the symmetric positive definite system (xx, xy, xz, yy, yz, zz) x = b, by Cramer's rule.
static void solve_three(const double s[6], const double b[3], double x[3])
{
  const double row[3][3] = {{s[0], s[1], s[2]}, {s[1], s[3], s[4]}, {s[2], s[4], s[5]}};
  double inverse[3][3];
  for (int i = 0; i < 3; i++) vsc_cross(row[(i + 1) % 3], row[(i + 2) % 3], inverse[i]);
  const double determinant = vsc_dot(row[0], inverse[0]);
  for (int a = 0; a < 3; a++) {
    x[a] = 0;
    for (int i = 0; i < 3; i++) x[a] += inverse[i][a] * b[i] / determinant;
  }
}

// The weighted mean of f f^T, plain and moved to `at` (from the centroid of the element).
static void mean_axes(const moments *sum, const double at[3], double plain[6], double moved[6])
{
  static const int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
  double place[3], variance[6], along[3], way[3];
  for (int a = 0; a < 3; a++) place[a] = sum->place[a] / sum->weight;
  for (int c = 0; c < 6; c++) {
    plain[c] = sum->axis[c] / sum->weight;
    variance[c] = sum->spread[c] / sum->weight - place[row[c]] * place[column[c]];
    if (row[c] == column[c]) variance[c] = fmax(variance[c], 0) + RIDGE;
  }
  vsc_subtract(place, at, way);
  solve_three(variance, way, along);
  const double deviations = sqrt(fmax(vsc_dot(along, way), 0));
  const double part = deviations > REACH ? REACH / deviations : 1;
  for (int c = 0; c < 6; c++) {
    moved[c] = plain[c];
    for (int a = 0; a < 3; a++)
      moved[c] -= part * along[a] * (sum->slope[a][c] / sum->weight - place[a] * plain[c]);
  }
}

static void turn(const double direction[9], double axis[3])
{
  double turned[3];
  for (int r = 0; r < 3; r++) turned[r] = vsc_dot(&direction[3 * r], axis);
  memcpy(axis, turned, sizeof turned);
}

// Samples one element, whose frames lie at `at` from its centroid; returns false when it finds no voxel
// with data.
static bool sample_element(const angle_map *map, const index_element *element, const double (*at)[3],
                           int points, double *frames, double *coherence, bool *fallback)
{
  moments sum = {0};
  double plain[6], moved[6], axis[3], values[3];
  size_t inside = 0;
  for (int t = 0; t < element->count; t++)
    inside += gather_inside(map, element, t, &sum);
  *fallback = inside < ENOUGH;
  if (*fallback) {
    sum = (moments){0};
    for (int t = 0; t < element->count; t++) {
      const double weight = element->tets[t].volume / element->tets[0].volume;
      gather_interpolated(map, &element->tets[t], weight, element->centre, &sum);
    }
  }
  if (!(sum.weight > 0)) return false;
  for (int q = 0; q < points; q++) {
    mean_axes(&sum, at[q], plain, moved);
    if (!vsc_top_axis(plain, axis, values)) return false;
    *coherence = fmin(fmax((values[0] - values[1]) / values[0], 0), 1);
    if (!vsc_top_axis(moved, axis, NULL)) return false;
    if (map->def->image_axes) turn(map->image->direction, axis);
    if (!vsc_axes_complete(axis, NULL, frames + 9 * q)) return false;
  }
  return true;
}

// Where the frames of an element lie, in voxels from its centroid; a single one there.
static void place_frames(const vsc_mesh *mesh, const angle_map *map, const vsc_axes *axes,
                         const vsc_cell_rule *rule, size_t e, const double centre[3],
                         double at[VSC_MOST_POINTS][3])
{
  for (int a = 0; a < 3; a++) at[0][a] = 0;
  for (int q = 0; q < axes->points && axes->points > 1; q++) {
    double place[3];
    vsc_axes_place(axes, mesh, rule, e, q, place);
    vsc_image_index(map->image, place, at[q]);
    vsc_subtract(at[q], centre, at[q]);
  }
}

static vsc_status no_overlap(const vsc_mesh *mesh, const angle_map *map, vsc_error *error)
{
  double low[3], high[3], image_low[3] = {INFINITY, INFINITY, INFINITY};
  double image_high[3] = {-INFINITY, -INFINITY, -INFINITY};
  vsc_mesh_box(mesh, low, high);
  for (int corner = 0; corner < 8; corner++) {
    double index[3], at[3];
    for (int a = 0; a < 3; a++) index[a] = corner >> a & 1 ? (double)map->image->size[a] - 1 : 0;
    vsc_image_position(map->image, index, at);
    for (int a = 0; a < 3; a++) {
      image_low[a] = fmin(image_low[a], at[a]);
      image_high[a] = fmax(image_high[a], at[a]);
    }
  }
  return vsc_fail(
      error, VSC_INPUT,
      "%s: no element of the mesh, in (%g, %g, %g) to (%g, %g, %g) mm, meets a voxel "
      "with data; the image covers (%g, %g, %g) to (%g, %g, %g) mm: check the length units",
      map->def->file[0] != '\0' ? map->def->file : "angle map", low[0], low[1], low[2], high[0],
      high[1], high[2], image_low[0], image_low[1], image_low[2], image_high[0], image_high[1],
      image_high[2]);
}

vsc_status vsc_fibers_sample(const vsc_mesh *mesh, const vsc_image *image,
                             const vsc_angle_map_def *def, vsc_axes *axes, vsc_fiber_report *report,
                             vsc_error *error)
{
  angle_map map;
  vsc_status status = open_map(image, def, &map, error);
  if (status != VSC_OK) return status;
  double *coherence;
  if (!VSC_NEW(coherence, mesh->element_count)) return vsc_fail_memory(error, "the sampled fibres");
  *report = (vsc_fiber_report){0};
  size_t found = 0;
  const vsc_cell_rule rule = vsc_cell_rule_of(VSC_TET10);  // read where there are several points
  for (size_t e = 0; e < mesh->element_count; e++) {
    bool fallback;
    double at[VSC_MOST_POINTS][3];
    const index_element element = make_element(mesh, image, e);
    place_frames(mesh, &map, axes, &rule, e, element.centre, at);
    const bool known = sample_element(&map, &element, (const double(*)[3])at, axes->points,
                                      vsc_axes_frame(axes, e, 0), &coherence[found], &fallback);
    vsc_axes_finish(axes, e, known);
    if (!known) continue;
    if (fallback) report->fallback++;
    found++;
  }
  static const double parts[3] = {0.1, 0.5, 0.9};
  gsl_sort(coherence, 1, found);
  for (int i = 0; i < 3 && found > 0; i++)
    report->coherence[i] = gsl_stats_quantile_from_sorted_data(coherence, 1, found, parts[i]);
  vsc_free(coherence);
  if (found == 0) return no_overlap(mesh, &map, error);
  return vsc_fiber_describe(axes, report, error);
}
