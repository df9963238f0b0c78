// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/ink.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "io/replace.h"
#include "tools/plot/view.h"

const double VSC_INK[3] = {0.20, 0.20, 0.22}, VSC_FAINT[3] = {0.45, 0.45, 0.48};

void vsc_write_text(cairo_t *cairo, double x, double y, double size, const double colour[3],
                    double align, const char *text)
{
  cairo_text_extents_t extents;
  cairo_set_font_size(cairo, size);
  cairo_text_extents(cairo, text, &extents);
  cairo_set_source_rgb(cairo, colour[0], colour[1], colour[2]);
  cairo_move_to(cairo, x - align * extents.x_advance, y);
  cairo_show_text(cairo, text);
}

void vsc_use_font(cairo_t *cairo, cairo_font_weight_t weight)
{
  cairo_select_font_face(cairo, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, weight);
}

void vsc_draw_scale(cairo_t *cairo, double x, double y, double scale)
{
  char text[32];
  double length = 1;
  for (int k = 0; length * scale < 60; k++) length *= k % 3 == 1 ? 2.5 : 2;
  snprintf(text, sizeof text, "%g mm", length);
  cairo_set_source_rgb(cairo, VSC_INK[0], VSC_INK[1], VSC_INK[2]);
  cairo_set_line_width(cairo, 3);
  cairo_move_to(cairo, x, y);
  cairo_rel_line_to(cairo, length * scale, 0);
  cairo_stroke(cairo);
  vsc_write_text(cairo, x + length * scale / 2, y + 24, 14, VSC_INK, 0.5, text);
}

double vsc_tick_step(double span)
{
  const double power = pow(10, floor(log10(span / 5)));
  const double share = span / 5 / power;
  return power * (share <= 1 ? 1 : share <= 2 ? 2 : share <= 5 ? 5 : 10);
}

void vsc_draw_bar(cairo_t *cairo, double x, double y, double width, double low, double high,
                  const char *title)
{
  const int steps = 200;
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_NONE);
  for (int k = 0; k < steps; k++) {
    double colour[3];
    vsc_view_colour((k + 0.5) / steps, colour);
    cairo_set_source_rgb(cairo, colour[0], colour[1], colour[2]);
    cairo_rectangle(cairo, x + k * width / steps, y, width / steps + 0.5, 16);
    cairo_fill(cairo);
  }
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_DEFAULT);
  cairo_set_source_rgb(cairo, VSC_INK[0], VSC_INK[1], VSC_INK[2]);
  cairo_set_line_width(cairo, 1);
  cairo_rectangle(cairo, x - 0.5, y - 0.5, width + 1, 17);
  cairo_stroke(cairo);
  const double step = vsc_tick_step(high - low), slack = 1e-6 * (high - low);
  for (double k = ceil((low - slack) / step); k * step <= high + slack; k++) {
    char text[32];
    snprintf(text, sizeof text, "%g", k == 0 ? 0 : k * step);
    vsc_write_text(cairo, x + (k * step - low) / (high - low) * width, y + 34, 13, VSC_INK, 0.5,
                   text);
  }
  vsc_write_text(cairo, x + width / 2, y - 9, 14, VSC_INK, 0.5, title);
}

vsc_status vsc_check_png(const char *file, vsc_error *error)
{
  const size_t length = strlen(file);
  if (length > 4 && strcasecmp(file + length - 4, ".png") == 0) return VSC_OK;
  return vsc_fail(error, VSC_INPUT, "--output %s: pictures are PNG: give a name that ends in .png", file);
}

static cairo_status_t write_bytes(void *stream, const unsigned char *bytes, unsigned int count)
{
  return fwrite(bytes, 1, count, stream) == count ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

vsc_status vsc_write_png(cairo_surface_t *surface, const char *file, vsc_error *error)
{
  vsc_replacement picture;
  const vsc_status begun = vsc_replace_begin(file, &picture, error);
  if (begun != VSC_OK) return begun;
  const cairo_status_t status = cairo_surface_write_to_png_stream(surface, write_bytes, picture.stream);
  if (status == CAIRO_STATUS_SUCCESS || status == CAIRO_STATUS_WRITE_ERROR) return vsc_replace_end(&picture, false, error);
  vsc_replace_cancel(&picture);
  return vsc_fail(error, VSC_SYSTEM, "%s: %s", file, cairo_status_to_string(status));
}

vsc_status vsc_write_page(int width, int height, const char *title, vsc_page_part *draw, const void *what,
                          const char *file, vsc_error *error)
{
  cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
  cairo_t *cairo = cairo_create(surface);
  vsc_status status = VSC_OK;
  if (cairo_status(cairo) == CAIRO_STATUS_SUCCESS) {
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    vsc_use_font(cairo, CAIRO_FONT_WEIGHT_BOLD);
    vsc_write_text(cairo, 36, 38, 22, VSC_INK, 0, title);
    vsc_use_font(cairo, CAIRO_FONT_WEIGHT_NORMAL);
    draw(cairo, what);
    status = vsc_write_png(surface, file, error);
  } else {
    status = vsc_fail_memory(error, "the picture");
  }
  cairo_destroy(cairo);
  cairo_surface_destroy(surface);
  return status;
}
