// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/page.h"

#include <cairo.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tools/plot/graphs.h"
#include "tools/plot/ink.h"

// The page, in pixels: graphs on the left, two pictures on the right, a bar below them.
enum {
  WIDTH = 1760,
  HEIGHT = 1040,
  MARGIN = 36,
  HEAD = 92,  // title
  GRAPHS_RIGHT = 800,
  CAPTION = 56,  // above each picture
  FOOT = 96,     // bar and scale below the pictures
  FINE = 3,      // pictures are drawn this much larger, then shrunk
};

// The first value and the smallest of the first cavity; returns its column or NULL.
static const double *first_cavity(const vsc_signals *signals, double *rest, double *least)
{
  const size_t column = vsc_signals_next(signals, "cavity_", 0);
  if (column == signals->columns || signals->rows == 0) return NULL;
  const double *volume = signals->values + column * signals->rows;
  *rest = *least = volume[0];
  for (size_t r = 0; r < signals->rows; r++) *least = fmin(*least, volume[r]);
  return volume;
}

static void draw_head(const vsc_page *page, cairo_t *cairo)
{
  char text[256];
  double rest, least;
  vsc_use_font(cairo, CAIRO_FONT_WEIGHT_BOLD);
  vsc_write_text(cairo, MARGIN, 46, 27, VSC_INK, 0, page->title);
  vsc_use_font(cairo, CAIRO_FONT_WEIGHT_NORMAL);
  char kinds[128];
  snprintf(text, sizeof text, "%zu nodes, %s", page->mesh->node_count,
           vsc_mesh_kinds_text(page->mesh, kinds, sizeof kinds));
  if (first_cavity(page->signals, &rest, &least) != NULL && rest > 0) {
    const size_t used = strlen(text);
    snprintf(text + used, sizeof text - used,
             "   \u00b7   cavity %.1f ml at rest, %.1f ml contracted: %.0f %% ejected", rest, least,
             100 * (rest - least) / rest);
  }
  vsc_write_text(cairo, MARGIN, 74, 15, VSC_FAINT, 0, text);
}

// ---- pictures

typedef struct frame_box {
  double x, y, width, height;
} frame_box;

// Where two pictures of that extent become largest: side by side or one above the other.
static double place_pictures(const double size[2], frame_box boxes[2])
{
  const double width = WIDTH - GRAPHS_RIGHT - MARGIN, height = HEIGHT - HEAD - FOOT;
  const double beside = fmin(width / 2 / size[0], (height - CAPTION) / size[1]);
  const double above = fmin(width / size[0], (height / 2 - CAPTION) / size[1]);
  for (int k = 0; k < 2; k++) {
    boxes[k] = (frame_box){GRAPHS_RIGHT, HEAD, width, height};
    if (beside >= above) {
      boxes[k].width = width / 2;
      boxes[k].x += k * width / 2;
    } else {
      boxes[k].height = height / 2;
      boxes[k].y += k * height / 2;
    }
  }
  return 0.94 * fmax(beside, above);
}

// One picture as a cairo surface of the box's size below its caption; NULL when memory is short.
static cairo_surface_t *draw_picture(const vsc_page *page, const frame_box *box,
                                     const double low[2], double scale, bool rest, double largest,
                                     vsc_error *error)
{
  const int width = (int)box->width, height = (int)box->height - CAPTION;
  vsc_raster *raster = vsc_raster_create(FINE * width, FINE * height);
  cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height);
  if (raster == NULL || cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS) {
    vsc_fail_memory(error, "a picture");
  } else if (vsc_view_draw(&page->camera, page->mesh, rest ? NULL : page->displacement,
                           rest ? NULL : page->tension, largest, low, FINE * scale, raster,
                           error) == VSC_OK) {
    cairo_surface_flush(surface);
    vsc_raster_shrink(raster, FINE, cairo_image_surface_get_data(surface),
                      cairo_image_surface_get_stride(surface));
    cairo_surface_mark_dirty(surface);
    vsc_raster_free(raster);
    return surface;
  }
  cairo_surface_destroy(surface);
  vsc_raster_free(raster);
  return NULL;
}

static void write_caption(cairo_t *cairo, const frame_box *box, const char *title, const char *text)
{
  const double middle = box->x + box->width / 2;
  vsc_use_font(cairo, CAIRO_FONT_WEIGHT_BOLD);
  vsc_write_text(cairo, middle, box->y + 24, 17, VSC_INK, 0.5, title);
  vsc_use_font(cairo, CAIRO_FONT_WEIGHT_NORMAL);
  vsc_write_text(cairo, middle, box->y + 45, 14, VSC_FAINT, 0.5, text);
}

static double largest_tension(const vsc_page *page)
{
  const double *signal = vsc_signals_find(page->signals, "active_tension_max");
  double largest = 0;
  for (size_t r = 0; signal != NULL && r < page->signals->rows; r++)
    largest = fmax(largest, signal[r]);
  for (size_t t = 0; page->tension != NULL && t < page->mesh->element_count; t++)
    largest = fmax(largest, page->tension[t]);
  return largest;
}

static void put_picture(cairo_t *cairo, cairo_surface_t *picture, const frame_box *box,
                        cairo_surface_t *ghost)
{
  if (ghost != NULL) {  // what the tissue filled at rest
    cairo_set_source_rgba(cairo, 0.45, 0.45, 0.5, 0.17);
    cairo_mask_surface(cairo, ghost, floor(box->x), box->y + CAPTION);
  }
  cairo_set_source_surface(cairo, picture, floor(box->x), box->y + CAPTION);
  cairo_paint(cairo);
}

static vsc_status draw_pictures(const vsc_page *page, cairo_t *cairo, vsc_error *error)
{
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, size[2];
  vsc_camera_extend(&page->camera, page->mesh, NULL, low, high);
  vsc_camera_extend(&page->camera, page->mesh, page->displacement, low, high);
  frame_box boxes[2];
  for (int k = 0; k < 2; k++) size[k] = fmax(high[k] - low[k], 1e-9);
  const double scale = place_pictures(size, boxes), largest = largest_tension(page);
  low[0] -= (boxes[0].width / scale - size[0]) / 2;
  low[1] -= ((boxes[0].height - CAPTION) / scale - size[1]) / 2;
  cairo_surface_t *rest = draw_picture(page, &boxes[0], low, scale, true, largest, error);
  if (rest == NULL) return error->status;
  cairo_surface_t *moved = draw_picture(page, &boxes[1], low, scale, false, largest, error);
  if (moved != NULL) {
    char text[96];
    snprintf(text, sizeof text, "%.3g s; in grey: at rest", page->time);
    put_picture(cairo, rest, &boxes[0], NULL);
    put_picture(cairo, moved, &boxes[1], rest);
    write_caption(cairo, &boxes[0], "At rest",
                  page->camera.whole ? "" : "cut open along the long axis");
    write_caption(cairo, &boxes[1], page->chosen ? "Moved" : "Most contracted", text);
    vsc_draw_scale(cairo, GRAPHS_RIGHT + 40, HEIGHT - FOOT + 42, scale);
    if (largest > 0)
      vsc_draw_bar(cairo, GRAPHS_RIGHT + 300, HEIGHT - FOOT + 34, WIDTH - GRAPHS_RIGHT - MARGIN - 340,
               0, largest, "Active tension [kPa]");
  }
  cairo_surface_destroy(rest);
  if (moved == NULL) return error->status;
  cairo_surface_destroy(moved);
  return VSC_OK;
}

// ---- the page

vsc_status vsc_page_draw(const vsc_page *page, const char *file, vsc_error *error)
{
  vsc_error own;
  if (error == NULL) error = &own;
  cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, WIDTH, HEIGHT);
  cairo_surface_t *left =
      cairo_surface_create_for_rectangle(surface, 0, HEAD, GRAPHS_RIGHT, HEIGHT - HEAD);
  cairo_t *cairo = cairo_create(surface), *graphs = cairo_create(left);
  vsc_status status = VSC_OK;
  if (cairo_status(cairo) != CAIRO_STATUS_SUCCESS || cairo_status(graphs) != CAIRO_STATUS_SUCCESS)
    status = vsc_fail_memory(error, "the page");
  if (status == VSC_OK) {
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    status = vsc_graphs_draw(graphs, GRAPHS_RIGHT, HEIGHT - HEAD, page->signals, page->time, error);
  }
  if (status == VSC_OK) draw_head(page, cairo);
  if (status == VSC_OK) status = draw_pictures(page, cairo, error);
  if (status == VSC_OK) status = vsc_write_png(surface, file, error);
  cairo_destroy(graphs);
  cairo_destroy(cairo);
  cairo_surface_destroy(left);
  cairo_surface_destroy(surface);
  return status;
}
