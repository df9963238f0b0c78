// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/bars.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "tools/plot/ink.h"

enum { LEFT = 380, LENGTH = 560, RIGHT = 250, TOP = 96, ROW = 22, GROUP = 38, BOTTOM = 24 };

static const double solid[3] = {0.13, 0.40, 0.67}, pale[3] = {0.70, 0.81, 0.92}, mark[3] = {0.70, 0.09, 0.17};

static double largest(const vsc_bars *bars)
{
  double most = 1e-300;
  for (size_t k = 0; k < bars->count; k++) {
    const vsc_bar *bar = &bars->items[k];
    most = fmax(most, fmax(bar->value, fmax(bar->pale, bar->mark)));  // fmax passes over NAN
  }
  return fmax(most, bars->line);
}

static bool begins_group(const vsc_bars *bars, size_t k)
{
  return k == 0 || strcmp(bars->items[k].group, bars->items[k - 1].group) != 0;
}

static int height_of(const vsc_bars *bars)
{
  int height = TOP + BOTTOM;
  for (size_t k = 0; k < bars->count; k++) height += ROW + (begins_group(bars, k) ? GROUP : 0);
  return height;
}

static void fill(cairo_t *cairo, const double colour[3], double x, double y, double width, double height)
{
  cairo_set_source_rgb(cairo, colour[0], colour[1], colour[2]);
  cairo_rectangle(cairo, x, y, width, height);
  cairo_fill(cairo);
}

static void draw_legend(cairo_t *cairo, const vsc_bars *bars)
{
  const char *const names[] = {bars->value_name, bars->pale_name, bars->mark_name};
  const double *const colours[] = {solid, pale, mark};
  double x = 36;
  for (int k = 0; k < 3; k++) {
    if (names[k] == NULL) continue;
    cairo_text_extents_t extents;
    fill(cairo, colours[k], x, 58, k == 2 ? 3 : 16, 16);
    vsc_write_text(cairo, x + 22, 71, 13, VSC_INK, 0, names[k]);
    cairo_text_extents(cairo, names[k], &extents);
    x += 22 + extents.x_advance + 24;
  }
}

static void draw_bar(cairo_t *cairo, const vsc_bar *bar, double y, double scale)
{
  if (isfinite(bar->pale)) fill(cairo, pale, LEFT, y, scale * bar->pale, ROW - 4);
  if (isfinite(bar->value)) fill(cairo, solid, LEFT, y + 3, scale * bar->value, ROW - 10);
  if (isfinite(bar->mark)) fill(cairo, mark, LEFT + scale * bar->mark - 1.5, y - 1, 3, ROW - 2);
  vsc_write_text(cairo, LEFT - 10, y + 13, 13, VSC_INK, 1, bar->name);
  const double end = fmax(bar->value, fmax(bar->pale, bar->mark));
  vsc_write_text(cairo, LEFT + scale * (isfinite(end) ? end : 0) + 10, y + 13, 13, VSC_FAINT, 0, bar->text);
}

static void draw_page(cairo_t *cairo, const void *what)
{
  const vsc_bars *bars = what;
  const double scale = LENGTH / largest(bars);
  double y = TOP;
  draw_legend(cairo, bars);
  if (isfinite(bars->line)) fill(cairo, VSC_FAINT, LEFT + scale * bars->line, TOP, 1, height_of(bars) - TOP - BOTTOM);
  for (size_t k = 0; k < bars->count; k++) {
    if (begins_group(bars, k)) {
      vsc_use_font(cairo, CAIRO_FONT_WEIGHT_BOLD);
      vsc_write_text(cairo, LEFT - 10, y + 26, 15, VSC_INK, 1, bars->items[k].group);
      vsc_use_font(cairo, CAIRO_FONT_WEIGHT_NORMAL);
      y += GROUP;
    }
    draw_bar(cairo, &bars->items[k], y, scale);
    y += ROW;
  }
}

vsc_status vsc_bars_draw(const vsc_bars *bars, const char *file, vsc_error *error)
{
  return vsc_write_page(LEFT + LENGTH + RIGHT, height_of(bars), bars->title, draw_page, bars, file, error);
}
