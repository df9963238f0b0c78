// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/polar.h"

#include <cairo.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/status.h"

enum { ROWS = 400, COLUMNS = 10, SIZE = 420, HEIGHT = 500 };

typedef struct polar_table {
  int rows;
  bool wanted;
  double values[ROWS][COLUMNS];
  double most;
} polar_table;

static bool read_table(const char *file, polar_table *table)
{
  char line[1024];
  FILE *stream = fopen(file, "r");
  if (stream == NULL) return false;
  if (fgets(line, sizeof line, stream) == NULL) line[0] = '\0';
  table->wanted = strstr(line, "wanted") != NULL;
  while (table->rows < ROWS && fgets(line, sizeof line, stream) != NULL) {
    double *v = table->values[table->rows];
    const int found = sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &v[0], &v[1], &v[2],
                             &v[3], &v[4], &v[5], &v[6], &v[7], &v[8], &v[9]);
    if (found != (table->wanted ? 10 : 7)) break;
    for (int c = 1; c < found; c++) table->most = fmax(table->most, v[c]);
    table->rows++;
  }
  fclose(stream);
  return table->rows > 2 && table->most > 0;
}

// A round number not above a quarter of `most`.
static double tick_of(double most)
{
  const double decade = pow(10, floor(log10(most / 4)));
  const double ratio = most / 4 / decade;
  return decade * (ratio >= 5 ? 5 : ratio >= 2 ? 2 : 1);
}

static void draw_grid(cairo_t *cairo, const polar_table *table, int plane, double scale)
{
  static const char *const axes[3][2] = {{"f", "s"}, {"s", "n"}, {"n", "f"}};
  char text[32];
  const double tick = tick_of(table->most);
  cairo_set_line_width(cairo, 1);
  cairo_set_font_size(cairo, 13);
  for (double r = tick; r <= table->most * 1.05; r += tick) {
    cairo_set_source_rgb(cairo, 0.85, 0.85, 0.85);
    cairo_arc(cairo, 0, 0, r * scale, 0, 2 * M_PI);
    cairo_stroke(cairo);
    snprintf(text, sizeof text, "%g", r);
    cairo_set_source_rgb(cairo, 0.5, 0.5, 0.5);
    cairo_move_to(cairo, r * scale * 0.72 + 2, -r * scale * 0.72 - 2);
    cairo_show_text(cairo, text);
  }
  const double end = table->most * 1.08 * scale;
  cairo_set_source_rgb(cairo, 0.3, 0.3, 0.3);
  cairo_move_to(cairo, -end, 0);
  cairo_line_to(cairo, end, 0);
  cairo_move_to(cairo, 0, -end);
  cairo_line_to(cairo, 0, end);
  cairo_stroke(cairo);
  cairo_set_font_size(cairo, 18);
  cairo_move_to(cairo, end + 4, 6);
  cairo_show_text(cairo, axes[plane][0]);
  cairo_move_to(cairo, -4, -end - 6);
  cairo_show_text(cairo, axes[plane][1]);
}

// Column `c` as a line, or as dots on every second row.
static void draw_curve(cairo_t *cairo, const polar_table *table, int c, double scale, bool dots)
{
  cairo_new_path(cairo);  // a text leaves a point
  for (int r = 0; r < table->rows; r++) {
    const double angle = table->values[r][0] * M_PI / 180, size = table->values[r][c] * scale;
    const double x = size * cos(angle), y = -size * sin(angle);
    if (dots && r % 2 == 0) {
      cairo_new_sub_path(cairo);
      cairo_arc(cairo, x, y, 2.6, 0, 2 * M_PI);
    } else if (!dots) {
      cairo_line_to(cairo, x, y);
    }
  }
  if (dots)
    cairo_fill(cairo);
  else
    cairo_stroke(cairo);
}

static void draw_legend(cairo_t *cairo, bool wanted)
{
  cairo_set_font_size(cairo, 15);
  cairo_set_source_rgb(cairo, 0.10, 0.35, 0.65);
  cairo_move_to(cairo, 20, HEIGHT - 18);
  cairo_show_text(cairo, "Young's modulus of the springs, kPa (closed form)");
  cairo_set_source_rgb(cairo, 0.80, 0.25, 0.15);
  cairo_move_to(cairo, 440, HEIGHT - 18);
  cairo_show_text(cairo, "\u2022 measured on a block of irregular tets");
  cairo_set_source_rgb(cairo, 0.15, 0.55, 0.25);
  cairo_move_to(cairo, 800, HEIGHT - 18);
  if (wanted) cairo_show_text(cairo, "- - wanted");
}

int vsc_polar_draw(const char *file, const char *picture)
{
  static polar_table table;
  static const double dash[] = {6, 5};
  if (!read_table(file, &table)) {
    fprintf(stderr, "viscera: plot: %s: is no table of moduli against angles\n", file);
    return VSC_INPUT;
  }
  cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 3 * SIZE, HEIGHT);
  cairo_t *cairo = cairo_create(surface);
  cairo_set_source_rgb(cairo, 1, 1, 1);
  cairo_paint(cairo);
  cairo_select_font_face(cairo, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  const double scale = 0.40 * SIZE / table.most;
  for (int p = 0; p < 3; p++) {
    cairo_save(cairo);
    cairo_translate(cairo, SIZE * (p + 0.5), 0.52 * SIZE);
    draw_grid(cairo, &table, p, scale);
    cairo_set_line_width(cairo, 2.2);
    cairo_set_source_rgb(cairo, 0.10, 0.35, 0.65);
    draw_curve(cairo, &table, 1 + p, scale, false);
    cairo_set_source_rgb(cairo, 0.15, 0.55, 0.25);
    cairo_set_dash(cairo, dash, 2, 0);
    if (table.wanted) draw_curve(cairo, &table, 7 + p, scale, false);
    cairo_set_source_rgb(cairo, 0.80, 0.25, 0.15);
    draw_curve(cairo, &table, 4 + p, scale, true);
    cairo_restore(cairo);
  }
  draw_legend(cairo, table.wanted);
  cairo_destroy(cairo);
  const cairo_status_t status = cairo_surface_write_to_png(surface, picture);
  cairo_surface_destroy(surface);
  if (status == CAIRO_STATUS_SUCCESS) return VSC_OK;
  fprintf(stderr, "viscera: plot: %s: %s\n", picture, cairo_status_to_string(status));
  return VSC_SYSTEM;
}
