// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/panels.h"

#include <cairo.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "io/vtk.h"
#include "tools/plot/ink.h"
#include "tools/results.h"

enum { WIDTH = 1500, MARGIN = 24, HEAD = 56, CAPTION = 30, FOOT = 84, FINE = 3 };
enum { TALLEST = 560 };  // of a panel's picture, pixels

// A panel's mesh and what is drawn of it.
typedef struct loaded {
  vsc_mesh *mesh;
  double *values;  // node_count, owned
  const double *displacement;
  vsc_camera camera;
} loaded;

// ---- reading

static vsc_status frame_of(const char *folder, double time, char file[2 * VSC_RESULT_PATH],
                           vsc_error *error)
{
  vsc_results results;
  const vsc_status status = vsc_results_open(folder, &results, error);
  if (status != VSC_OK) return status;
  vsc_pvd_frame_path(results.pvd, results.series, vsc_results_nearest(&results, time), file,
                     2 * VSC_RESULT_PATH);
  vsc_results_close(&results);
  return VSC_OK;
}

static double length_of(const vsc_array *array, size_t tuple)
{
  double square = 0;
  const size_t components = (size_t)array->components;
  if (components == 1) return array->values[tuple];
  for (size_t c = 0; c < components; c++)
    square += array->values[components * tuple + c] * array->values[components * tuple + c];
  return sqrt(square);
}

// Values of elements as the mean of those round each node.
static vsc_status from_elements(const vsc_mesh *mesh, const vsc_array *array, double *values,
                                vsc_error *error)
{
  double *lengths;
  if (!VSC_NEW(lengths, mesh->element_count)) return vsc_fail_memory(error, "a picture");
  for (size_t e = 0; e < mesh->element_count; e++) lengths[e] = length_of(array, e);
  const vsc_status status = vsc_to_nodes(mesh, lengths, values, error);
  vsc_free(lengths);
  return status;
}

static vsc_status read_values(const char *file, const char *name, loaded *panel, vsc_error *error)
{
  const vsc_mesh *mesh = panel->mesh;
  if (!VSC_NEW(panel->values, mesh->node_count)) return vsc_fail_memory(error, "a picture");
  const vsc_array *array = vsc_arrays_find(&mesh->node_data, name);
  for (size_t i = 0; i < mesh->node_count && array != NULL; i++)
    panel->values[i] = length_of(array, i);
  if (array != NULL) return VSC_OK;
  array = vsc_arrays_find(&mesh->element_data, name);
  if (array != NULL) return from_elements(mesh, array, panel->values, error);
  return vsc_fail(error, VSC_INPUT, "%s: there is no array '%s'", file, name);
}

static vsc_status load(const vsc_panels *panels, size_t k, loaded *panel, vsc_error *error)
{
  static const double upwards[3] = {0, 0, 1};
  char file[2 * VSC_RESULT_PATH];
  struct stat facts;
  const char *source = panels->items[k].source;
  vsc_status status = VSC_OK;
  if (stat(source, &facts) == 0 && S_ISDIR(facts.st_mode))
    status = frame_of(source, panels->time, file, error);
  else
    snprintf(file, sizeof file, "%s", source);
  if (status == VSC_OK) status = vsc_vtk_read_mesh(file, 1, &panel->mesh, error);
  if (status != VSC_OK) return status;
  const vsc_array *moved = vsc_arrays_find(&panel->mesh->node_data, "displacement");
  if (moved != NULL && moved->components == 3) panel->displacement = moved->values;
  panel->camera = vsc_camera_make(panel->mesh, upwards, panels->from, true);
  if (panels->array == NULL && moved == NULL) return VSC_OK;
  return read_values(file, panels->array != NULL ? panels->array : "displacement", panel, error);
}

// ---- the page

typedef struct layout {
  double low[2], size[2];  // of every picture, mm
  double scale;            // pixels per mm
  int width, height;       // of a panel's picture, pixels
  int columns, rows;
  double value_low, value_high;
} layout;

static layout arrange(const vsc_panels *panels, const loaded *loads)
{
  layout page = {.low = {INFINITY, INFINITY}, .value_low = panels->low, .value_high = panels->high};
  double high[2] = {-INFINITY, -INFINITY}, least = INFINITY, most = -INFINITY;
  for (size_t k = 0; k < panels->count; k++) {
    vsc_camera_extend(&loads[k].camera, loads[k].mesh, NULL, page.low, high);
    vsc_camera_extend(&loads[k].camera, loads[k].mesh, loads[k].displacement, page.low, high);
    for (size_t i = 0; i < loads[k].mesh->node_count && loads[k].values != NULL; i++) {
      least = fmin(least, loads[k].values[i]);
      most = fmax(most, loads[k].values[i]);
    }
  }
  if (isnan(page.value_low)) page.value_low = isfinite(least) ? least : 0;
  if (isnan(page.value_high)) page.value_high = isfinite(most) ? most : page.value_low;
  // what is constant but for rounding has no colours
  const double size = fmax(fabs(page.value_low), fabs(page.value_high));
  if (page.value_high - page.value_low <= 1e-12 * size) page.value_high = page.value_low;
  page.columns = panels->columns < (int)panels->count ? panels->columns : (int)panels->count;
  page.rows = ((int)panels->count + page.columns - 1) / page.columns;
  page.width = (WIDTH - 2 * MARGIN) / page.columns;
  for (int a = 0; a < 2; a++) page.size[a] = fmax(high[a] - page.low[a], 1e-9);
  page.scale = 0.92 * fmin(page.width / page.size[0], TALLEST / page.size[1]);
  page.height = (int)(page.scale * page.size[1] / 0.92);
  page.low[0] -= (page.width / page.scale - page.size[0]) / 2;
  page.low[1] -= (page.height / page.scale - page.size[1]) / 2;
  return page;
}

static cairo_surface_t *draw_picture(const vsc_panels *panels, const layout *page,
                                     const loaded *panel, bool rest, vsc_error *error)
{
  vsc_solid solid = {.mesh = panel->mesh,
                     .displacement = rest ? NULL : panel->displacement,
                     .values = rest ? NULL : panel->values,
                     .low = page->value_low,
                     .high = page->value_high,
                     .sphere_count = rest ? 0 : panels->sphere_count};
  memcpy(solid.spheres, panels->spheres, sizeof solid.spheres);
  vsc_raster *raster = vsc_raster_create(FINE * page->width, FINE * page->height);
  cairo_surface_t *surface =
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, page->width, page->height);
  vsc_status status = VSC_OK;
  if (raster == NULL || cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS)
    status = vsc_fail_memory(error, "a picture");
  if (status == VSC_OK)
    status = vsc_solid_draw(&panel->camera, &solid, page->low, FINE * page->scale, raster, error);
  if (status == VSC_OK) {
    cairo_surface_flush(surface);
    vsc_raster_shrink(raster, FINE, cairo_image_surface_get_data(surface),
                      cairo_image_surface_get_stride(surface));
    cairo_surface_mark_dirty(surface);
  }
  vsc_raster_free(raster);
  if (status == VSC_OK) return surface;
  cairo_surface_destroy(surface);
  return NULL;
}

static vsc_status draw_panel(const vsc_panels *panels, const layout *page, const loaded *panel,
                             size_t k, cairo_t *cairo, vsc_error *error)
{
  const int column = (int)k % page->columns, row = (int)k / page->columns;
  const double x = MARGIN + column * page->width, y = HEAD + row * (page->height + CAPTION);
  cairo_surface_t *rest = draw_picture(panels, page, panel, true, error);
  if (rest == NULL) return error->status;
  cairo_surface_t *moved = draw_picture(panels, page, panel, false, error);
  if (moved != NULL) {
    cairo_set_source_rgba(cairo, 0.45, 0.45, 0.5, 0.17);
    cairo_mask_surface(cairo, rest, x, y);
    cairo_set_source_surface(cairo, moved, x, y);
    cairo_paint(cairo);
    cairo_surface_destroy(moved);
    vsc_write_text(cairo, x + page->width / 2.0, y + page->height + 18, 15, VSC_INK, 0.5,
                   panels->items[k].caption);
  }
  cairo_surface_destroy(rest);
  return moved != NULL ? VSC_OK : error->status;
}

static vsc_status draw_page(const vsc_panels *panels, const layout *page, const loaded *loads,
                            const char *file, vsc_error *error)
{
  const int height = HEAD + page->rows * (page->height + CAPTION) + FOOT;
  cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, WIDTH, height);
  cairo_t *cairo = cairo_create(surface);
  vsc_status status = VSC_OK;
  if (cairo_status(cairo) != CAIRO_STATUS_SUCCESS) status = vsc_fail_memory(error, "the page");
  cairo_set_source_rgb(cairo, 1, 1, 1);
  cairo_paint(cairo);
  vsc_use_font(cairo, CAIRO_FONT_WEIGHT_BOLD);
  vsc_write_text(cairo, MARGIN, 34, 20, VSC_INK, 0, panels->title);
  vsc_use_font(cairo, CAIRO_FONT_WEIGHT_NORMAL);
  for (size_t k = 0; k < panels->count && status == VSC_OK; k++)
    status = draw_panel(panels, page, &loads[k], k, cairo, error);
  char name[128];
  snprintf(name, sizeof name, "%s%s", panels->array == NULL ? "displacement" : panels->array,
           panels->unit);
  vsc_draw_scale(cairo, MARGIN + 20, height - FOOT + 36, page->scale);
  if (page->value_high > page->value_low)
    vsc_draw_bar(cairo, WIDTH - 660, height - FOOT + 28, 600, page->value_low, page->value_high,
                 name);
  if (status == VSC_OK) status = vsc_write_png(surface, file, error);
  cairo_destroy(cairo);
  cairo_surface_destroy(surface);
  return status;
}

vsc_status vsc_panels_draw(const vsc_panels *panels, const char *file, vsc_error *error)
{
  loaded *loads;
  if (!VSC_NEW(loads, panels->count)) return vsc_fail_memory(error, "the panels");
  vsc_status status = VSC_OK;
  for (size_t k = 0; k < panels->count && status == VSC_OK; k++)
    status = load(panels, k, &loads[k], error);
  if (status == VSC_OK) {
    const layout page = arrange(panels, loads);
    status = draw_page(panels, &page, loads, file, error);
  }
  for (size_t k = 0; k < panels->count; k++) {
    vsc_mesh_free(loads[k].mesh);
    vsc_free(loads[k].values);
  }
  vsc_free(loads);
  return status;
}
