// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/shapes.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/ellipsoid.h"
#include "fibers/sample.h"
#include "mesh/select.h"
#include "tools/shapes_bricks.h"

vsc_lv_shape vsc_lv_default(void)
{
  return (vsc_lv_shape){.endo_radius = 26,
                        .endo_length = 66,
                        .epi_radius = 35.5,
                        .epi_length = 73,
                        .base = 20,
                        .around = 32,
                        .along = 14,
                        .layers = 3};
}

vsc_lv_shape vsc_lv_land(void)
{
  return (vsc_lv_shape){.endo_radius = 7,
                        .endo_length = 17,
                        .epi_radius = 10,
                        .epi_length = 20,
                        .base = 5,
                        .around = 16,
                        .along = 12,
                        .layers = 2};
}

vsc_lv_shape vsc_lv_arostica(void)
{
  return (vsc_lv_shape){.endo_radius = 25,
                        .endo_length = 90,
                        .epi_radius = 35,
                        .epi_length = 97,
                        .base = 90 * 5. / 17,
                        .base_rise = 97 * 5. / 20 - 90 * 5. / 17,
                        .around = 32,
                        .along = 20,
                        .layers = 2,
                        .along_x = true,
                        .surfaces = true};
}

static double radius(const vsc_lv_shape *lv, double t)
{
  return (1 - t) * lv->endo_radius + t * lv->epi_radius;
}

static double length(const vsc_lv_shape *lv, double t)
{
  return (1 - t) * lv->endo_length + t * lv->epi_length;
}

// Radius of the ellipsoid of depth t at the height z.
static double radius_at(const vsc_lv_shape *lv, double t, double z)
{
  const double part = z / length(lv, t);
  return radius(lv, t) * sqrt(1 - part * part);
}

static vsc_status check_base(const vsc_lv_shape *lv, vsc_error *error)
{
  const double epi_base = lv->base + lv->base_rise;
  if (!(fabs(lv->base) < 0.95 * lv->endo_length) || !(fabs(epi_base) < 0.95 * lv->epi_length))
    return vsc_fail(error, VSC_INPUT,
                    "ventricle: the base plane at z = %g mm (%g mm at the epicardium) must cut the wall, "
                    "within 95 %% of its half lengths %g and %g mm",
                    lv->base, epi_base, lv->endo_length, lv->epi_length);
  const double inner = radius_at(lv, 0, lv->base), outer = radius_at(lv, 1, epi_base);
  if (!(outer > inner))
    return vsc_fail(error, VSC_INPUT,
                    "ventricle: a base that rises by %g mm has radii of %g mm inside and %g mm outside, "
                    "use a smaller rise",
                    lv->base_rise, inner, outer);
  return VSC_OK;
}

static vsc_status check_lv(const vsc_lv_shape *lv, vsc_error *error)
{
  const bool sizes = isfinite(lv->epi_radius) && isfinite(lv->epi_length) && lv->endo_radius > 0 &&
                     lv->endo_length > 0 && lv->epi_radius > lv->endo_radius &&
                     lv->epi_length > lv->endo_length;
  if (!sizes)
    return vsc_fail(error, VSC_INPUT,
                    "ventricle: endocardial radius %g and length %g mm must be above 0 and "
                    "below the epicardial ones, %g and %g mm",
                    lv->endo_radius, lv->endo_length, lv->epi_radius, lv->epi_length);
  const vsc_status status = check_base(lv, error);
  if (status != VSC_OK) return status;
  if (lv->element == VSC_BLOCK_MIXED)
    return vsc_fail(error, VSC_INPUT, "ventricle: no mixed elements, use tets, hexes or wedges");
  const size_t most = 4096;
  if (lv->around < 4 || lv->around % 4 != 0 || lv->around > most || lv->along < 1 ||
      lv->along > most || lv->layers < 1 || lv->layers > 256)
    return vsc_fail(error, VSC_INPUT,
                    "ventricle: %zu bricks around, %zu along, %zu layers: around must be a "
                    "multiple of 4, all at least 1, at most 4096, 4096 and 256",
                    lv->around, lv->along, lv->layers);
  return VSC_OK;
}

// Height of the base's ring on the ellipsoid of depth t: where the line from the endocardial ring to the
// epicardial one meets it, at the part s of the line that solves
// ((r0 + s dr)/rs)^2 + ((z0 + s dz)/rl)^2 = 1.
static double base_height(const vsc_lv_shape *lv, double t)
{
  const double rs = radius(lv, t), rl = length(lv, t);
  const double r0 = radius_at(lv, 0, lv->base) / rs, z0 = lv->base / rl;
  const double dr = radius_at(lv, 1, lv->base + lv->base_rise) / rs - r0, dz = lv->base_rise / rl;
  const double a = dr * dr + dz * dz, b = r0 * dr + z0 * dz, c = r0 * r0 + z0 * z0 - 1;
  return lv->base - lv->base_rise * c / (b + sqrt(b * b - a * c));
}

static const double z_axis[3] = {0, 0, 1}, x_axis[3] = {1, 0, 0};

static vsc_ellipsoid_def wall_of(const vsc_lv_shape *lv)
{
  return (vsc_ellipsoid_def){.endo_radius = lv->endo_radius,
                             .endo_length = lv->endo_length,
                             .epi_radius = lv->epi_radius,
                             .epi_length = lv->epi_length};
}

double vsc_lv_depth(const vsc_lv_shape *lv, const double point[3])
{
  const vsc_ellipsoid_def wall = wall_of(lv);
  return vsc_ellipsoid_depth(&wall, lv->along_x ? x_axis : z_axis, point);
}

void vsc_lv_frame(const vsc_lv_shape *lv, const double point[3], double endo_angle,
                  double epi_angle, double frame[9])
{
  const double *axis = lv->along_x ? x_axis : z_axis;
  const vsc_fiber_def fibers = {.ellipsoid = wall_of(lv),
                                .sheets_across = 1,
                                .long_axis = {axis[0], axis[1], axis[2]},
                                .endo_angle = endo_angle,
                                .epi_angle = epi_angle};
  vsc_ellipsoid_frame_at(&fibers, point, vsc_lv_depth(lv, point), frame);
}

// The nodes of one layer: a square patch of (side + 1)^2 nodes at the apex, then `along` rings of
// `around` nodes. Along a meridian nodes are equally far apart in the middle of the wall.
enum { MERIDIAN = 1024 };
typedef struct lv_grid {
  const vsc_lv_shape *lv;
  size_t side;                    // bricks along one edge of the patch
  vsc_wall wall;
  double meridian[MERIDIAN + 1];  // arc length from the apex to u = i / MERIDIAN of the base's u,
                                  // as a part of the whole
} lv_grid;

static double base_angle(const vsc_lv_shape *lv, double t)
{
  return acos(-base_height(lv, t) / length(lv, t));
}

static lv_grid make_grid(const vsc_lv_shape *lv)
{
  lv_grid grid = {.lv = lv, .side = lv->around / 4};
  const size_t n = grid.side, sides = lv->around * lv->along;
  grid.wall = (vsc_wall){(n + 1) * (n + 1) + sides, n * n + sides, lv->layers, lv->element};
  const double rs = radius(lv, 0.5), rl = length(lv, 0.5), step = base_angle(lv, 0.5) / MERIDIAN;
  for (int i = 0; i < MERIDIAN; i++) {
    const double u = (i + 0.5) * step;
    grid.meridian[i + 1] = grid.meridian[i] + hypot(rs * cos(u), rl * sin(u)) * step;
  }
  for (int i = 1; i <= MERIDIAN; i++) grid.meridian[i] /= grid.meridian[MERIDIAN];
  return grid;
}

// The part of the base's u at which `part` of the meridian's arc length is reached.
static double part_of_angle(const lv_grid *grid, double part)
{
  int i = 0;
  while (i < MERIDIAN - 1 && grid->meridian[i + 1] < part) i++;
  const double low = grid->meridian[i], high = grid->meridian[i + 1];
  return fmin((i + (part - low) / (high - low)) / MERIDIAN, 1);
}

// Node of the patch at `k` steps round its edge, starting in the corner of azimuth -45 degrees.
static void patch_edge(const lv_grid *grid, size_t k, size_t *i, size_t *j)
{
  const size_t n = grid->side, along = k % n;
  switch (k / n % 4) {
    case 0:
      *i = n;
      *j = along;
      break;
    case 1:
      *i = n - along;
      *j = n;
      break;
    case 2:
      *i = 0;
      *j = n - along;
      break;
    default:
      *i = along;
      *j = 0;
      break;
  }
}

static uint32_t ring_node(const lv_grid *grid, size_t k, size_t row)
{
  size_t i, j;
  const size_t n = grid->side + 1;
  patch_edge(grid, k, &i, &j);
  if (row == 0) return (uint32_t)(j * n + i);
  return (uint32_t)(n * n + (row - 1) * grid->lv->around + k % grid->lv->around);
}

// Part of the meridian and azimuth of a node of the patch: equal angles of a cube's face.
static void patch_place(const lv_grid *grid, size_t i, size_t j, double *part, double *azimuth)
{
  const double n = (double)grid->side;
  const double x = tan((2 * (double)i / n - 1) * M_PI / 4),
               y = tan((2 * (double)j / n - 1) * M_PI / 4);
  const double edge = n / 2 / (n / 2 + (double)grid->lv->along);
  *part = edge * atan(hypot(x, y)) / (M_PI / 4);
  *azimuth = atan2(y, x);
}

static void place_column(const lv_grid *grid, vsc_mesh *mesh, size_t node, double part,
                         double azimuth, bool base)
{
  const vsc_lv_shape *lv = grid->lv;
  const double angle = base ? 1 : part_of_angle(grid, part);
  for (size_t layer = 0; layer <= lv->layers; layer++) {
    const double t = (double)layer / (double)lv->layers, u = angle * base_angle(lv, t);
    double *x = &mesh->nodes[3 * (layer * grid->wall.per_layer + node)];
    const size_t across = lv->along_x ? 1 : 0;
    x[across] = radius(lv, t) * sin(u) * cos(azimuth);
    x[across + 1] = radius(lv, t) * sin(u) * sin(azimuth);
    x[(across + 2) % 3] = base ? base_height(lv, t) : -length(lv, t) * cos(u);
  }
}

static void place_nodes(const lv_grid *grid, vsc_mesh *mesh)
{
  double part, azimuth;
  for (size_t j = 0; j <= grid->side; j++)
    for (size_t i = 0; i <= grid->side; i++) {
      patch_place(grid, i, j, &part, &azimuth);
      place_column(grid, mesh, j * (grid->side + 1) + i, part, azimuth, false);
    }
  const size_t rows = grid->lv->along;
  for (size_t k = 0; k < grid->lv->around; k++) {
    size_t i, j;
    patch_edge(grid, k, &i, &j);
    patch_place(grid, i, j, &part, &azimuth);
    for (size_t row = 1; row <= rows; row++)
      place_column(grid, mesh, ring_node(grid, k, row),
                   part + (1 - part) * (double)row / (double)rows, azimuth, row == rows);
  }
}

// Quadrilaterals turn anti-clockwise seen from outside the wall, so that bricks are right-handed.
static void cut_wall(const lv_grid *grid, vsc_mesh *mesh)
{
  const size_t n = grid->side;
  size_t column = 0;
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n; i++) {
      const uint32_t first = (uint32_t)(j * (n + 1) + i), above = first + (uint32_t)n + 1;
      const uint32_t quad[4] = {first, above, above + 1, first + 1};
      vsc_wall_cut(&grid->wall, mesh, column++, quad, i + j);
    }
  for (size_t k = 0; k < grid->lv->around; k++)
    for (size_t row = 0; row < grid->lv->along; row++) {
      const uint32_t quad[4] = {ring_node(grid, k, row), ring_node(grid, k + 1, row),
                                ring_node(grid, k + 1, row + 1), ring_node(grid, k, row + 1)};
      size_t i, j;
      patch_edge(grid, k, &i, &j);
      vsc_wall_cut(&grid->wall, mesh, column++, quad, i + j + row);
    }
}

static bool mark_lv(const lv_grid *grid, vsc_mesh *mesh)
{
  static const char *const names[4] = {"endo", "epi", "base", "rim"};
  double *mark[4];
  for (int a = 0; a < 4; a++) {
    vsc_array *array = vsc_arrays_add(&mesh->node_data, names[a], 1, mesh->node_count);
    if (array == NULL) return false;
    mark[a] = array->values;
  }
  const size_t last = grid->lv->layers, first_of_base = grid->wall.per_layer - grid->lv->around;
  for (size_t layer = 0; layer <= last; layer++)
    for (size_t i = 0; i < grid->wall.per_layer; i++) {
      const size_t node = layer * grid->wall.per_layer + i;
      const bool base = i >= first_of_base;
      mark[0][node] = layer == 0;
      mark[1][node] = layer == last;
      mark[2][node] = base;
      mark[3][node] = base && layer == last;
    }
  return vsc_region_add(mesh);
}

// The triangles of the boundary and the parts of it that they belong to.
static vsc_status add_surfaces(const lv_grid *grid, vsc_mesh *mesh, vsc_error *error)
{
  vsc_surface boundary = {.count = 0};
  const vsc_status status = vsc_boundary(mesh, &boundary, error);
  if (status != VSC_OK) return status;
  vsc_array *part = vsc_arrays_add(&mesh->triangle_data, "surface", 1, mesh->triangle_count);
  for (size_t k = 0; part != NULL && k < mesh->triangle_count; k++) {
    size_t inner = 0, outer = 0;
    for (size_t i = 3 * k; i < 3 * k + 3; i++) {
      const size_t layer = boundary.triangles[i] / grid->wall.per_layer;
      mesh->triangles[i] = boundary.triangles[i];
      inner += layer == 0;
      outer += layer == grid->lv->layers;
    }
    part->values[k] = inner == 3 ? 1 : outer == 3 ? 2 : 3;
  }
  vsc_surface_free(&boundary);
  return part != NULL ? VSC_OK : vsc_fail_memory(error, "the ventricle's surfaces");
}

static vsc_status fill_lv(const lv_grid *grid, vsc_mesh *mesh, vsc_error *error)
{
  place_nodes(grid, mesh);
  cut_wall(grid, mesh);
  if (!mark_lv(grid, mesh)) return vsc_fail_memory(error, "the ventricle's arrays");
  if (!vsc_shape_finish(mesh))
    return vsc_fail(error, VSC_INPUT,
                    "ventricle: %zu bricks around and %zu along are too few for its shape: "
                    "elements would be turned inside out, use more",
                    grid->lv->around, grid->lv->along);
  return grid->lv->surfaces ? add_surfaces(grid, mesh, error) : VSC_OK;
}

vsc_status vsc_lv_mesh(const vsc_lv_shape *lv, vsc_mesh **result, vsc_error *error)
{
  vsc_status status = check_lv(lv, error);
  if (status != VSC_OK) return status;
  const lv_grid grid = make_grid(lv);
  // two on each brick of the inner and the outer surface and of the base
  const size_t triangles = lv->surfaces ? 4 * grid.wall.columns + 2 * lv->around * lv->layers : 0;
  vsc_mesh *mesh = vsc_wall_create(&grid.wall, triangles);
  if (mesh == NULL) return vsc_fail_memory(error, "the ventricle's mesh");
  status = fill_lv(&grid, mesh, error);
  if (status == VSC_OK)
    *result = mesh;
  else
    vsc_mesh_free(mesh);
  return status;
}

static void map_voxel(const vsc_lv_shape *lv, double endo_angle, double epi_angle, vsc_image *image,
                      size_t voxel)
{
  const size_t *size = image->size;
  const double index[3] = {(double)(voxel % size[0]), (double)(voxel / size[0] % size[1]),
                           (double)(voxel / size[0] / size[1])};
  double point[3], frame[9];
  vsc_image_position(image, index, point);
  const double depth = vsc_lv_depth(lv, point);
  if (depth < 0 || depth > 1 || point[2] > lv->base) return;
  vsc_lv_frame(lv, point, endo_angle, epi_angle, frame);
  vsc_fiber_angles(frame, &image->data.items[0].values[voxel], &image->data.items[1].values[voxel]);
  image->data.items[2].values[voxel] = 1;
}

vsc_status vsc_lv_map(const vsc_lv_shape *lv, double endo_angle, double epi_angle, double spacing,
                      vsc_image **result, vsc_error *error)
{
  const vsc_status status = check_lv(lv, error);
  if (status != VSC_OK) return status;
  if (lv->along_x || lv->base_rise != 0)
    return vsc_fail(error, VSC_INPUT, "map: a ventricle about z with a flat base only");
  if (!(spacing > lv->epi_radius / 500 && spacing < lv->epi_radius))
    return vsc_fail(error, VSC_INPUT,
                    "map: a voxel of %g mm does not suit a ventricle of %g mm radius, use "
                    "about a quarter of the wall, %.2g mm",
                    spacing, lv->epi_radius, (lv->epi_radius - lv->endo_radius) / 4);
  const size_t across = 2 * (size_t)ceil(lv->epi_radius / spacing) + 3;
  const size_t high = (size_t)ceil((lv->epi_length + lv->base) / spacing) + 3;
  const size_t size[3] = {across, across, high};
  vsc_image *image = vsc_image_create(size);
  if (image == NULL) return vsc_fail_memory(error, "the angle map");
  for (int a = 0; a < 3; a++) image->spacing[a] = spacing;
  image->origin[0] = image->origin[1] = -spacing * (double)(across - 1) / 2;
  image->origin[2] = -lv->epi_length - spacing;
  static const char *const names[3] = {"azimuth", "elevation", "tissue"};
  const size_t voxels = across * across * high;
  for (int a = 0; a < 3; a++)
    if (vsc_arrays_add(&image->data, names[a], 1, voxels) == NULL) {
      vsc_image_free(image);
      return vsc_fail_memory(error, "the angle map's arrays");
    }
  for (size_t v = 0; v < voxels; v++) map_voxel(lv, endo_angle, epi_angle, image, v);
  *result = image;
  return VSC_OK;
}
