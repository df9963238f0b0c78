// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/shapes.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/ellipsoid.h"
#include "fibers/helix.h"
#include "fibers/sample.h"
#include "tools/shapes_bricks.h"

static bool all_right_handed(const vsc_mesh *mesh)
{
  for (size_t e = 0; e < mesh->element_count; e++)
    if (!(vsc_mesh_element_volume(mesh, e) > 0)) return false;
  return true;
}

static void set_sources(vsc_mesh *mesh)
{
  mesh->report.file_nodes = mesh->node_count;
  mesh->report.file_cells = mesh->element_count;
}

// ---- The left ventricle

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

static vsc_status check_lv(const vsc_lv_shape *lv, vsc_error *error)
{
  const bool sizes = lv->endo_radius > 0 && lv->endo_length > 0 &&
                     lv->epi_radius > lv->endo_radius && lv->epi_length > lv->endo_length &&
                     isfinite(lv->epi_radius) && isfinite(lv->epi_length);
  if (!sizes)
    return vsc_fail(error, VSC_INPUT,
                    "ventricle: endocardial radius %g and length %g mm must be above 0 and "
                    "below the epicardial ones, %g and %g mm",
                    lv->endo_radius, lv->endo_length, lv->epi_radius, lv->epi_length);
  if (!(fabs(lv->base) < 0.95 * lv->endo_length))
    return vsc_fail(error, VSC_INPUT,
                    "ventricle: the base plane at z = %g mm must cut the endocardium, "
                    "within 95 %% of its half length %g mm",
                    lv->base, lv->endo_length);
  const size_t most = 4096;
  if (lv->around < 4 || lv->around % 4 != 0 || lv->around > most || lv->along < 1 ||
      lv->along > most || lv->layers < 1 || lv->layers > 256)
    return vsc_fail(error, VSC_INPUT,
                    "ventricle: %zu bricks around, %zu along, %zu layers: around must be a "
                    "multiple of 4, all at least 1, at most 4096, 4096 and 256",
                    lv->around, lv->along, lv->layers);
  return VSC_OK;
}

static double radius(const vsc_lv_shape *lv, double t)
{
  return (1 - t) * lv->endo_radius + t * lv->epi_radius;
}

static double length(const vsc_lv_shape *lv, double t)
{
  return (1 - t) * lv->endo_length + t * lv->epi_length;
}

double vsc_lv_volume(const vsc_lv_shape *lv, double depth)
{
  const double rs = radius(lv, depth), rl = length(lv, depth), b = lv->base;
  return M_PI * rs * rs * (b + 2 * rl / 3 - b * b * b / (3 * rl * rl));
}

static const double long_axis[3] = {0, 0, 1};

static double depth_and_normal(const vsc_lv_shape *lv, const double point[3], double outwards[3])
{
  const vsc_ellipsoid_def wall = {.endo_radius = lv->endo_radius,
                                  .endo_length = lv->endo_length,
                                  .epi_radius = lv->epi_radius,
                                  .epi_length = lv->epi_length};
  return vsc_ellipsoid_depth(&wall, long_axis, point, outwards);
}

double vsc_lv_depth(const vsc_lv_shape *lv, const double point[3])
{
  return depth_and_normal(lv, point, NULL);
}

void vsc_lv_frame(const vsc_lv_shape *lv, const double point[3], double endo_angle,
                  double epi_angle, double frame[9])
{
  double outwards[3];
  const double t = depth_and_normal(lv, point, outwards);
  vsc_helix_frame(outwards, long_axis, (1 - t) * endo_angle + t * epi_angle, frame);
}

// The nodes of one layer: a square patch of (side + 1)^2 nodes at the apex, then `along` rings of
// `around` nodes. Along a meridian nodes are equally far apart in the middle of the wall.
enum { MERIDIAN = 1024 };
typedef struct lv_grid {
  const vsc_lv_shape *lv;
  size_t side;                    // bricks along one edge of the patch
  size_t per_layer;               // nodes
  double meridian[MERIDIAN + 1];  // arc length from the apex to u = i / MERIDIAN of the base's u,
                                  // as a part of the whole
} lv_grid;

static double base_angle(const vsc_lv_shape *lv, double t)
{
  return acos(-lv->base / length(lv, t));
}

static lv_grid make_grid(const vsc_lv_shape *lv)
{
  lv_grid grid = {.lv = lv, .side = lv->around / 4};
  grid.per_layer = (grid.side + 1) * (grid.side + 1) + lv->around * lv->along;
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
    double *x = &mesh->nodes[3 * (layer * grid->per_layer + node)];
    x[0] = radius(lv, t) * sin(u) * cos(azimuth);
    x[1] = radius(lv, t) * sin(u) * sin(azimuth);
    x[2] = base ? lv->base : -length(lv, t) * cos(u);
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

// The bricks over one quadrilateral of a layer, from endocardium to epicardium.
static void cut_column(const lv_grid *grid, vsc_mesh *mesh, size_t column, const uint32_t quad[4],
                       size_t parity)
{
  for (size_t layer = 0; layer < grid->lv->layers; layer++) {
    uint32_t corner[8];
    for (int c = 0; c < 4; c++) {
      corner[c] = (uint32_t)(layer * grid->per_layer) + quad[c];
      corner[c + 4] = corner[c] + (uint32_t)grid->per_layer;
    }
    vsc_brick_cut(corner, 5, (parity + layer) % 2 == 1,
                  &mesh->corners[20 * (column * grid->lv->layers + layer)]);
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
      cut_column(grid, mesh, column++, quad, i + j);
    }
  for (size_t k = 0; k < grid->lv->around; k++)
    for (size_t row = 0; row < grid->lv->along; row++) {
      const uint32_t quad[4] = {ring_node(grid, k, row), ring_node(grid, k + 1, row),
                                ring_node(grid, k + 1, row + 1), ring_node(grid, k, row + 1)};
      size_t i, j;
      patch_edge(grid, k, &i, &j);
      cut_column(grid, mesh, column++, quad, i + j + row);
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
  const size_t last = grid->lv->layers, first_of_base = grid->per_layer - grid->lv->around;
  for (size_t layer = 0; layer <= last; layer++)
    for (size_t i = 0; i < grid->per_layer; i++) {
      const size_t node = layer * grid->per_layer + i;
      const bool base = i >= first_of_base;
      mark[0][node] = layer == 0;
      mark[1][node] = layer == last;
      mark[2][node] = base;
      mark[3][node] = base && layer == last;
    }
  return vsc_region_add(mesh);
}

vsc_status vsc_lv_mesh(const vsc_lv_shape *lv, vsc_mesh **result, vsc_error *error)
{
  const vsc_status status = check_lv(lv, error);
  if (status != VSC_OK) return status;
  const lv_grid grid = make_grid(lv);
  const size_t columns = grid.side * grid.side + lv->around * lv->along;
  vsc_mesh *mesh = vsc_mesh_create((lv->layers + 1) * grid.per_layer, 5 * columns * lv->layers, 0);
  if (mesh == NULL) return vsc_fail_memory(error, "the ventricle's mesh");
  place_nodes(&grid, mesh);
  cut_wall(&grid, mesh);
  set_sources(mesh);
  if (!mark_lv(&grid, mesh)) {
    vsc_mesh_free(mesh);
    return vsc_fail_memory(error, "the ventricle's arrays");
  }
  if (!all_right_handed(mesh)) {
    vsc_mesh_free(mesh);
    return vsc_fail(error, VSC_INPUT,
                    "ventricle: %zu bricks around and %zu along are too few for its shape: "
                    "tets would be turned inside out, use more",
                    lv->around, lv->along);
  }
  *result = mesh;
  return VSC_OK;
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

// ---- The block

vsc_block_shape vsc_block_default(void)
{
  return (vsc_block_shape){.cells = {4, 4, 4}, .size = {10, 10, 10}, .tets_per_cell = 5, .seed = 1};
}

static vsc_status check_block(const vsc_block_shape *block, vsc_error *error)
{
  for (int a = 0; a < 3; a++) {
    if (block->cells[a] < 1 || block->cells[a] > 1000)
      return vsc_fail(error, VSC_INPUT, "block: %zu bricks along %c, must be 1 to 1000",
                      block->cells[a], 'x' + a);
    if (!(block->size[a] > 0 && isfinite(block->size[a])))
      return vsc_fail(error, VSC_INPUT, "block: size %g mm along %c, must be above 0",
                      block->size[a], 'x' + a);
  }
  if (block->tets_per_cell != 5 && block->tets_per_cell != 6)
    return vsc_fail(error, VSC_INPUT, "block: %d tets per brick, must be 5 or 6",
                    block->tets_per_cell);
  if (!(block->jitter >= 0 && block->jitter <= 0.3))
    return vsc_fail(error, VSC_INPUT, "block: jitter %g, must be 0 to 0.3 of a brick",
                    block->jitter);
  return VSC_OK;
}

double vsc_scatter(unsigned long seed, size_t number)
{
  uint64_t z = (seed * UINT64_C(0x100000001B3) + number + 1) * UINT64_C(0x9E3779B97F4A7C15);
  z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
  z ^= z >> 31;
  return ldexp((double)(z >> 11), -52) - 1;
}

static void place_block_node(const vsc_block_shape *block, vsc_mesh *mesh, size_t node)
{
  const size_t across = block->cells[0] + 1, deep = block->cells[1] + 1;
  const size_t index[3] = {node % across, node / across % deep, node / across / deep};
  bool inner = true;
  for (int a = 0; a < 3; a++) {
    const bool low = index[a] == 0, high = index[a] == block->cells[a];
    mesh->node_data.items[2 * a].values[node] = low;
    mesh->node_data.items[2 * a + 1].values[node] = high;
    if (low || high) inner = false;
  }
  for (int a = 0; a < 3; a++) {
    const double cells = (double)block->cells[a];
    double part = (double)index[a] / cells;
    if (inner)
      part += block->jitter * vsc_scatter(block->seed, 3 * node + (size_t)a) / cells;
    mesh->nodes[3 * node + (size_t)a] = block->size[a] * part;
  }
}

static void cut_block(const vsc_block_shape *block, vsc_mesh *mesh)
{
  const size_t *cells = block->cells, tets = (size_t)block->tets_per_cell;
  for (size_t b = 0; b < cells[0] * cells[1] * cells[2]; b++) {
    uint32_t corner[8];
    const bool mirrored = vsc_brick_corners(cells, b, corner);
    vsc_brick_cut(corner, block->tets_per_cell, mirrored, &mesh->corners[4 * tets * b]);
  }
}

vsc_status vsc_block_mesh(const vsc_block_shape *block, vsc_mesh **result, vsc_error *error)
{
  const vsc_status status = check_block(block, error);
  if (status != VSC_OK) return status;
  const size_t *cells = block->cells;
  const size_t nodes = (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1);
  vsc_mesh *mesh =
      vsc_mesh_create(nodes, cells[0] * cells[1] * cells[2] * (size_t)block->tets_per_cell, 0);
  if (mesh == NULL) return vsc_fail_memory(error, "the block's mesh");
  static const char *const names[6] = {"x0", "x1", "y0", "y1", "z0", "z1"};
  bool complete = true;
  for (int a = 0; a < 6 && complete; a++)
    complete = vsc_arrays_add(&mesh->node_data, names[a], 1, nodes) != NULL;
  cut_block(block, mesh);
  if (!complete || !vsc_region_add(mesh)) {
    vsc_mesh_free(mesh);
    return vsc_fail_memory(error, "the block's arrays");
  }
  for (size_t n = 0; n < nodes; n++) place_block_node(block, mesh, n);
  set_sources(mesh);
  if (!all_right_handed(mesh)) {
    vsc_mesh_free(mesh);
    return vsc_fail(error, VSC_INPUT, "block: a jitter of %g turns tets inside out, use less",
                    block->jitter);
  }
  *result = mesh;
  return VSC_OK;
}
