// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/diagram.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tools/plot/ink.h"

enum { PANEL = 640, LEFT = 78, TOP = 96, SIDE = 430, LINE = 22 };

typedef struct axis {
  double low, high;  // powers of ten at its ends
} axis;

static const double colours[VSC_MOST_SERIES][3] = {{0.13, 0.40, 0.67}, {0.70, 0.09, 0.17}, {0.20, 0.60, 0.35},
                                               {0.85, 0.50, 0.10}, {0.45, 0.30, 0.60}, {0.35, 0.35, 0.38},
                                               {0.10, 0.62, 0.66}, {0.75, 0.35, 0.60}, {0.55, 0.55, 0.10},
                                               {0.40, 0.20, 0.10}};

static vsc_diagram *diagram_of(vsc_diagrams *all, const char *name)
{
  for (size_t t = 0; t < all->count; t++)
    if (strcmp(all->items[t].name, name) == 0) return &all->items[t];
  if (all->count == VSC_MOST_DIAGRAMS) return NULL;
  snprintf(all->items[all->count].name, VSC_DIAGRAM_TEXT, "%s", name);
  return &all->items[all->count++];
}

static vsc_series *series_of(vsc_diagram *of, const char *name)
{
  for (size_t s = 0; s < of->count; s++)
    if (strcmp(of->items[s].name, name) == 0) return &of->items[s];
  if (of->count == VSC_MOST_SERIES) return NULL;
  snprintf(of->items[of->count].name, VSC_DIAGRAM_TEXT, "%s", name);
  return &of->items[of->count++];
}

bool vsc_diagram_keep(vsc_diagrams *all, const char *diagram, const char *series, double x, double y)
{
  vsc_diagram *of = diagram_of(all, diagram);
  vsc_series *to = of != NULL ? series_of(of, series) : NULL;
  if (to == NULL || to->count == VSC_MOST_POINTS) return false;
  to->x[to->count] = x;
  to->y[to->count++] = y;
  return true;
}

static void widen(axis *a, double value)
{
  a->low = fmin(a->low, floor(log10(value)));
  a->high = fmax(a->high, ceil(log10(value)));
}

static double place(const axis *a, double value)
{
  return (log10(value) - a->low) / (a->high - a->low) * SIDE;
}

static void draw_grid(cairo_t *cairo, const vsc_diagrams *all, const axis *x, const axis *y)
{
  const axis *axes[2] = {x, y};
  char text[32];
  cairo_set_line_width(cairo, 1);
  for (int k = 0; k < 2; k++)
    for (double power = axes[k]->low; power <= axes[k]->high; power++) {
      const double at = place(axes[k], pow(10, power));
      cairo_set_source_rgb(cairo, 0.87, 0.87, 0.89);
      cairo_move_to(cairo, k == 0 ? at : 0, k == 0 ? 0 : SIDE - at);
      cairo_line_to(cairo, k == 0 ? at : SIDE, k == 0 ? SIDE : SIDE - at);
      cairo_stroke(cairo);
      snprintf(text, sizeof text, "%g%s", pow(10, power), k == 0 ? "" : all->y_unit);
      if (k == 0)
        vsc_write_text(cairo, at, SIDE + 20, 13, VSC_FAINT, 0.5, text);
      else
        vsc_write_text(cairo, -8, SIDE - at + 5, 13, VSC_FAINT, 1, text);
    }
  vsc_write_text(cairo, SIDE / 2.0, SIDE + 44, 14, VSC_INK, 0.5, all->x_label);
}

static void draw_series(cairo_t *cairo, const vsc_series *s, size_t number, const axis *x, const axis *y)
{
  const double *colour = colours[number];
  cairo_set_source_rgb(cairo, colour[0], colour[1], colour[2]);
  cairo_set_line_width(cairo, 2);
  cairo_new_path(cairo);
  for (size_t p = 0; p < s->count; p++)
    cairo_line_to(cairo, place(x, s->x[p]), SIDE - place(y, s->y[p]));
  cairo_stroke(cairo);
  for (size_t p = 0; p < s->count; p++) {
    cairo_arc(cairo, place(x, s->x[p]), SIDE - place(y, s->y[p]), 5, 0, 2 * M_PI);
    cairo_fill(cairo);
  }
  const double line = SIDE + 74 + LINE * (double)number;
  cairo_rectangle(cairo, 0, line - 11, 14, 14);
  cairo_fill(cairo);
  vsc_write_text(cairo, 22, line, 14, VSC_INK, 0, s->name);
}

static void draw_diagram(cairo_t *cairo, const vsc_diagrams *all, const vsc_diagram *of)
{
  axis x = {INFINITY, -INFINITY}, y = x;
  for (size_t s = 0; s < of->count; s++)
    for (size_t p = 0; p < of->items[s].count; p++) {
      widen(&x, of->items[s].x[p]);
      widen(&y, of->items[s].y[p]);
    }
  if (x.high <= x.low) x.high = x.low + 1;
  if (y.high <= y.low) y.high = y.low + 1;
  vsc_use_font(cairo, CAIRO_FONT_WEIGHT_BOLD);
  vsc_write_text(cairo, 0, -16, 16, VSC_INK, 0, of->title != NULL ? of->title : of->name);
  vsc_use_font(cairo, CAIRO_FONT_WEIGHT_NORMAL);
  draw_grid(cairo, all, &x, &y);
  for (size_t s = 0; s < of->count; s++) draw_series(cairo, &of->items[s], s, &x, &y);
}

static int height_of(const vsc_diagrams *all)
{
  size_t most = 0;
  for (size_t t = 0; t < all->count; t++)
    if (all->items[t].count > most) most = all->items[t].count;
  return TOP + SIDE + 80 + LINE * (int)most;
}

static void draw_all(cairo_t *cairo, const void *what)
{
  const vsc_diagrams *all = what;
  for (size_t t = 0; t < all->count; t++) {
    cairo_save(cairo);
    cairo_translate(cairo, LEFT + (double)t * PANEL, TOP);
    draw_diagram(cairo, all, &all->items[t]);
    cairo_restore(cairo);
  }
}

vsc_status vsc_diagrams_draw(const vsc_diagrams *all, const char *file, vsc_error *error)
{
  const int width = PANEL * ((int)all->count - 1) + LEFT + SIDE + 60;
  return vsc_write_page(width, height_of(all), all->title, draw_all, all, file, error);
}
