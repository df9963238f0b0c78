// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/curves.h"

#include <cairo.h>
#include <math.h>
#include <stdio.h>

#include "base/mem.h"
#include "tools/plot/ink.h"
#include "tools/plot/signals.h"

enum { WIDTH = 1000, HEIGHT = 560, LEFT = 90, RIGHT = 270, TOP = 56, BOTTOM = 64, COLOURS = 6 };

typedef struct graph {
  double low[2], high[2];  // time, value
  cairo_t *cairo;
} graph;

static const double colours[COLOURS][3] = {{0.80, 0.25, 0.26}, {0.16, 0.42, 0.70},
                                           {0.20, 0.55, 0.30}, {0.80, 0.55, 0.10},
                                           {0.45, 0.28, 0.62}, {0.25, 0.25, 0.28}};

static double place(const graph *g, int axis, double value)
{
  const double part = (value - g->low[axis]) / (g->high[axis] - g->low[axis]);
  return axis == 0 ? LEFT + part * (WIDTH - LEFT - RIGHT)
                   : HEIGHT - BOTTOM - part * (HEIGHT - TOP - BOTTOM);
}

// The column, changed to percent of its first value where that is wished.
static vsc_status find_column(const vsc_curves *curves, const vsc_signals *signals, size_t k,
                              double *values, vsc_error *error)
{
  const double *found = vsc_signals_find(signals, curves->column);
  if (found == NULL || vsc_signals_find(signals, "time") == NULL || signals->rows == 0)
    return vsc_fail(error, VSC_INPUT, "%s/signals.csv: there is no column '%s'",
                    curves->items[k].source, curves->column);
  if (curves->relative && found[0] == 0)
    return vsc_fail(error, VSC_INPUT,
                    "%s/signals.csv: column '%s' begins with 0: there is no change in percent",
                    curves->items[k].source, curves->column);
  for (size_t r = 0; r < signals->rows; r++)
    values[r] = curves->relative ? 100 * (found[r] / found[0] - 1) : found[r];
  return VSC_OK;
}

static void draw_axes(const graph *g, const char *label)
{
  cairo_t *cairo = g->cairo;
  char text[32];
  cairo_set_line_width(cairo, 1);
  for (int axis = 0; axis < 2; axis++) {
    const double span = g->high[axis] - g->low[axis], step = vsc_tick_step(span);
    const double slack = 1e-6 * span;
    for (double k = ceil((g->low[axis] - slack) / step); k * step <= g->high[axis] + slack; k++) {
      const double at = place(g, axis, k * step);
      snprintf(text, sizeof text, "%g", k == 0 ? 0 : k * step);
      cairo_set_source_rgb(cairo, 0.88, 0.88, 0.9);
      cairo_move_to(cairo, axis == 0 ? at : LEFT, axis == 0 ? TOP : at);
      cairo_line_to(cairo, axis == 0 ? at : WIDTH - RIGHT, axis == 0 ? HEIGHT - BOTTOM : at);
      cairo_stroke(cairo);
      if (axis == 0)
        vsc_write_text(cairo, at, HEIGHT - BOTTOM + 20, 13, VSC_INK, 0.5, text);
      else
        vsc_write_text(cairo, LEFT - 8, at + 5, 13, VSC_INK, 1, text);
    }
  }
  vsc_write_text(cairo, (LEFT + WIDTH - RIGHT) / 2.0, HEIGHT - BOTTOM + 44, 14, VSC_INK, 0.5,
                 "time [s]");
  cairo_save(cairo);
  cairo_translate(cairo, 26, (TOP + HEIGHT - BOTTOM) / 2.0);
  cairo_rotate(cairo, -M_PI / 2);
  vsc_write_text(cairo, 0, 0, 14, VSC_INK, 0.5, label);
  cairo_restore(cairo);
}

static void draw_curve(const graph *g, const vsc_signals *signals, const double *values, size_t k,
                       const char *caption)
{
  const double *time = vsc_signals_find(signals, "time"), *colour = colours[k % COLOURS];
  cairo_new_path(g->cairo);
  for (size_t r = 0; r < signals->rows; r++)
    cairo_line_to(g->cairo, place(g, 0, time[r]), place(g, 1, values[r]));
  cairo_set_source_rgb(g->cairo, colour[0], colour[1], colour[2]);
  cairo_set_line_width(g->cairo, 2);
  cairo_stroke(g->cairo);
  vsc_write_text(g->cairo, WIDTH - RIGHT + 16, TOP + 20 + 26 * (double)k, 14, colour, 0, caption);
}

static void widen(graph *g, const vsc_signals *signals, const double *values)
{
  const double *time = vsc_signals_find(signals, "time");
  for (size_t r = 0; r < signals->rows; r++) {
    g->low[0] = fmin(g->low[0], time[r]);
    g->high[0] = fmax(g->high[0], time[r]);
    g->low[1] = fmin(g->low[1], values[r]);
    g->high[1] = fmax(g->high[1], values[r]);
  }
}

static vsc_status draw_graph(const vsc_curves *curves, vsc_signals *const *signals,
                             double *const *values, graph *g, const char *file, vsc_error *error)
{
  char label[128];
  cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, WIDTH, HEIGHT);
  g->cairo = cairo_create(surface);
  cairo_set_source_rgb(g->cairo, 1, 1, 1);
  cairo_paint(g->cairo);
  for (int axis = 0; axis < 2; axis++)
    if (!(g->high[axis] - g->low[axis] > 1e-12 * fmax(fabs(g->low[axis]), fabs(g->high[axis]))))
      g->high[axis] = g->low[axis] + fmax(1, fabs(g->low[axis]));
  vsc_use_font(g->cairo, CAIRO_FONT_WEIGHT_BOLD);
  vsc_write_text(g->cairo, 24, 34, 18, VSC_INK, 0, curves->title);
  vsc_use_font(g->cairo, CAIRO_FONT_WEIGHT_NORMAL);
  snprintf(label, sizeof label, curves->relative ? "change of %s [%%]" : "%s", curves->column);
  draw_axes(g, label);
  for (size_t k = 0; k < curves->count; k++)
    draw_curve(g, signals[k], values[k], k, curves->items[k].caption);
  const vsc_status status = cairo_status(g->cairo) == CAIRO_STATUS_SUCCESS
                                ? vsc_write_png(surface, file, error)
                                : vsc_fail_memory(error, "a graph");
  cairo_destroy(g->cairo);
  cairo_surface_destroy(surface);
  return status;
}

vsc_status vsc_curves_draw(const vsc_curves *curves, const char *file, vsc_error *error)
{
  vsc_signals **signals = NULL;
  double **values = NULL;
  graph g = {.low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
  vsc_status status = VSC_OK;
  if (!VSC_NEW(signals, curves->count) || !VSC_NEW(values, curves->count))
    status = vsc_fail_memory(error, "a graph");
  for (size_t k = 0; k < curves->count && status == VSC_OK; k++) {
    char name[4096];
    snprintf(name, sizeof name, "%s/signals.csv", curves->items[k].source);
    status = vsc_signals_read(name, &signals[k], error);
    if (status == VSC_OK && !VSC_NEW(values[k], signals[k]->rows + 1))
      status = vsc_fail_memory(error, "a graph");
    if (status == VSC_OK) status = find_column(curves, signals[k], k, values[k], error);
    if (status == VSC_OK) widen(&g, signals[k], values[k]);
  }
  if (status == VSC_OK) status = draw_graph(curves, signals, values, &g, file, error);
  for (size_t k = 0; k < curves->count && signals != NULL && values != NULL; k++) {
    vsc_signals_free(signals[k]);
    vsc_free(values[k]);
  }
  vsc_free(signals);
  vsc_free(values);
  return status;
}
