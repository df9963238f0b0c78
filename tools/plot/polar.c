// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/polar.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "tools/plot/ink.h"
#include "tools/plot/signals.h"

enum { WIDTH = 1500, HEIGHT = 610, HEAD = 96, RADIUS = 205, PANEL = WIDTH / 3, CURVES = 3 };

static const char *const curve_names[CURVES] = {"wanted", "springs", "measured"};
static const char *const curve_texts[CURVES] = {"wanted", "springs, closed form",
                                                "measured on a mesh"};
static const double colours[CURVES][3] = {
    {0.45, 0.45, 0.48}, {0.13, 0.40, 0.67}, {0.70, 0.09, 0.17}};
static const char *const axis_names[3] = {"f", "s", "n"};

typedef struct polar {
  const vsc_signals *table;
  const double *plane, *angle, *curve[CURVES];
  bool drawn[CURVES];  // some value is finite
  double outer;        // kPa at the outer circle
} polar;

static vsc_status find_columns(const char *csv, const vsc_signals *table, polar *p,
                               vsc_error *error)
{
  p->table = table;
  p->plane = vsc_signals_find(table, "plane");
  p->angle = vsc_signals_find(table, "angle");
  double largest = 0;
  for (int k = 0; k < CURVES; k++) {
    p->curve[k] = vsc_signals_find(table, curve_names[k]);
    for (size_t r = 0; p->curve[k] != NULL && r < table->rows; r++)
      if (isfinite(p->curve[k][r])) {
        largest = fmax(largest, p->curve[k][r]);
        p->drawn[k] = true;
      }
  }
  if (p->plane == NULL || p->angle == NULL || !(largest > 0))
    return vsc_fail(error, VSC_INPUT,
                    "%s: expected the columns plane, angle, wanted, springs, measured, as `viscera "
                    "calibrate --picture` writes them",
                    csv);
  // the outer circle at 1, 1.2 to 2 in fifths, or 3 and more times a power of ten
  const double power = pow(10, floor(log10(largest)));
  p->outer = power;
  for (double step = 0.2; p->outer < largest; step = p->outer / power < 2 ? 0.2 : 1)
    p->outer += step * power;
  return VSC_OK;
}

static void use_colour(cairo_t *cairo, const double colour[3])
{
  cairo_set_source_rgb(cairo, colour[0], colour[1], colour[2]);
}

// Circles with their moduli, and the two axes of the plane.
static void draw_grid(const polar *p, cairo_t *cairo, int plane)
{
  enum { CIRCLES = 4 };
  static const double grid[3] = {0.87, 0.87, 0.89};
  char text[32];
  cairo_set_line_width(cairo, 1);
  for (int spoke = 0; spoke < 12; spoke++) {
    use_colour(cairo, grid);
    cairo_move_to(cairo, 0, 0);
    cairo_line_to(cairo, RADIUS * cos(spoke * M_PI / 6), RADIUS * sin(spoke * M_PI / 6));
    cairo_stroke(cairo);
  }
  for (int c = 1; c <= CIRCLES; c++) {
    use_colour(cairo, grid);
    cairo_new_sub_path(cairo);
    cairo_arc(cairo, 0, 0, c * RADIUS / (double)CIRCLES, 0, 2 * M_PI);
    cairo_stroke(cairo);
    snprintf(text, sizeof text, c == CIRCLES ? "%g kPa" : "%g", c * p->outer / CIRCLES);
    // beside the spoke of 75 degrees
    const double r = c * RADIUS / (double)CIRCLES;
    vsc_write_text(cairo, r * cos(1.31) + 2, -r * sin(1.31) - 3, 12, VSC_FAINT, 0, text);
  }
  vsc_write_text(cairo, RADIUS + 10, 6, 18, VSC_INK, 0, axis_names[plane]);
  vsc_write_text(cairo, 0, -RADIUS - 10, 18, VSC_INK, 0.5, axis_names[(plane + 1) % 3]);
}

// One curve: a line, dashed what is wanted; dots what is measured.
static void draw_curve(const polar *p, cairo_t *cairo, int plane, int k)
{
  const double dash[2] = {9, 6};
  use_colour(cairo, colours[k]);
  cairo_set_line_width(cairo, k == 0 ? 5 : 2.5);
  cairo_set_dash(cairo, dash, k == 0 ? 2 : 0, 0);
  cairo_new_path(cairo);
  for (size_t r = 0; r < p->table->rows; r++) {
    const double modulus = p->curve[k][r], angle = p->angle[r] * M_PI / 180;
    if ((int)p->plane[r] != plane || !isfinite(modulus)) continue;
    const double x = modulus / p->outer * RADIUS * cos(angle);
    const double y = -modulus / p->outer * RADIUS * sin(angle);
    if (k < 2) {
      cairo_line_to(cairo, x, y);
    } else {
      cairo_new_sub_path(cairo);
      cairo_arc(cairo, x, y, 4, 0, 2 * M_PI);
      cairo_fill(cairo);
    }
  }
  cairo_stroke(cairo);
  cairo_set_dash(cairo, dash, 0, 0);
}

static void draw_legend(const polar *p, cairo_t *cairo)
{
  const double dash[2] = {9, 6};
  double x = 36;
  for (int k = 0; k < CURVES; k++) {
    if (!p->drawn[k]) continue;
    cairo_text_extents_t extents;
    use_colour(cairo, colours[k]);
    if (k < 2) {
      cairo_set_line_width(cairo, k == 0 ? 5 : 2.5);
      cairo_set_dash(cairo, dash, k == 0 ? 2 : 0, 0);
      cairo_move_to(cairo, x, 69);
      cairo_rel_line_to(cairo, 34, 0);
      cairo_stroke(cairo);
      cairo_set_dash(cairo, dash, 0, 0);
    } else {
      cairo_arc(cairo, x + 17, 69, 4, 0, 2 * M_PI);
      cairo_fill(cairo);
    }
    vsc_write_text(cairo, x + 44, 74, 15, VSC_INK, 0, curve_texts[k]);
    cairo_text_extents(cairo, curve_texts[k], &extents);
    x += 44 + extents.x_advance + 36;
  }
}

static void draw_page(const polar *p, const char *title, cairo_t *cairo)
{
  char text[256];
  cairo_set_source_rgb(cairo, 1, 1, 1);
  cairo_paint(cairo);
  vsc_use_font(cairo, CAIRO_FONT_WEIGHT_BOLD);
  snprintf(text, sizeof text, "Young's modulus by direction%s%s", title[0] != '\0' ? ": " : "",
           title);
  vsc_write_text(cairo, 36, 42, 24, VSC_INK, 0, text);
  vsc_use_font(cairo, CAIRO_FONT_WEIGHT_NORMAL);
  draw_legend(p, cairo);
  for (int plane = 0; plane < 3; plane++) {
    cairo_save(cairo);
    cairo_translate(cairo, PANEL * plane + PANEL / 2, HEAD + (HEIGHT - HEAD) / 2 + 12);
    draw_grid(p, cairo, plane);
    for (int k = 0; k < CURVES; k++)
      if (p->drawn[k]) draw_curve(p, cairo, plane, k);
    cairo_restore(cairo);
  }
}

vsc_status vsc_polar_draw(const char *csv, const char *title, const char *file, vsc_error *error)
{
  vsc_signals *table = NULL;
  polar p = {0};
  vsc_status status = vsc_signals_read(csv, &table, error);
  if (status == VSC_OK) status = find_columns(csv, table, &p, error);
  if (status == VSC_OK) {
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, WIDTH, HEIGHT);
    cairo_t *cairo = cairo_create(surface);
    if (cairo_status(cairo) != CAIRO_STATUS_SUCCESS) {
      status = vsc_fail_memory(error, "the picture");
    } else {
      draw_page(&p, title, cairo);
      status = vsc_write_png(surface, file, error);
    }
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
  }
  vsc_signals_free(table);
  return status;
}
