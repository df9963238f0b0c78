// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/errors.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "tools/plot/ink.h"

enum { MOST_TABLES = 4, MOST_SERIES = 10, MOST_POINTS = 16, NAME = 96 };
enum { PANEL = 640, LEFT = 78, TOP = 96, SIDE = 430, LINE = 22 };

typedef struct series {
  char name[NAME];
  size_t count;
  double cost[MOST_POINTS], error[MOST_POINTS];
} series;

typedef struct table {
  char name[NAME];
  size_t count;
  series items[MOST_SERIES];
} table;

typedef struct diagram {
  size_t count;
  table tables[MOST_TABLES];
} diagram;

typedef struct axis {
  double low, high;  // powers of ten at its ends
} axis;

static const double colours[MOST_SERIES][3] = {{0.13, 0.40, 0.67}, {0.70, 0.09, 0.17}, {0.20, 0.60, 0.35},
                                               {0.85, 0.50, 0.10}, {0.45, 0.30, 0.60}, {0.35, 0.35, 0.38},
                                               {0.10, 0.62, 0.66}, {0.75, 0.35, 0.60}, {0.55, 0.55, 0.10},
                                               {0.40, 0.20, 0.10}};

// What the tables are called in the picture.
static const char *title_of(const table *of)
{
  return strcmp(of->name, "time") == 0    ? "one mesh, against far shorter steps"
         : strcmp(of->name, "space") == 0 ? "meshes, against the finest of the first kind"
         : strcmp(of->name, "real_time") == 0 ? "a heart in real time, against short steps"
         : strcmp(of->name, "slivers") == 0   ? "a bar with slivers, against short steps"
                                              : of->name;
}

// ---- the table

// The next field of a CSV line, which may stand in quotes; NULL behind the last.
static char *next_field(char **line)
{
  char *field = *line;
  if (field == NULL) return NULL;
  if (*field == '"') {
    char *end = strchr(++field, '"');
    if (end == NULL) return NULL;
    *end = '\0';
    *line = end[1] == ',' ? end + 2 : NULL;
    return field;
  }
  return strsep(line, ",");
}

static table *table_of(diagram *all, const char *name)
{
  for (size_t t = 0; t < all->count; t++)
    if (strcmp(all->tables[t].name, name) == 0) return &all->tables[t];
  if (all->count == MOST_TABLES) return NULL;
  snprintf(all->tables[all->count].name, NAME, "%s", name);
  return &all->tables[all->count++];
}

static series *series_of(table *of, const char *name)
{
  for (size_t s = 0; s < of->count; s++)
    if (strcmp(of->items[s].name, name) == 0) return &of->items[s];
  if (of->count == MOST_SERIES) return NULL;
  snprintf(of->items[of->count].name, NAME, "%s", name);
  return &of->items[of->count++];
}

static bool keep_line(char *line, diagram *all)
{
  enum { TABLE, SERIES, WHAT, ELEMENTS, COST, ERROR, FIELDS };
  char *field[FIELDS];
  line[strcspn(line, "\r\n")] = '\0';
  for (int k = 0; k < FIELDS; k++)
    if ((field[k] = next_field(&line)) == NULL) return false;
  const double cost = strtod(field[COST], NULL), error = strtod(field[ERROR], NULL);
  if (!(error > 0) || !(cost > 0)) return true;  // a reference
  table *of = table_of(all, field[TABLE]);
  series *to = of != NULL ? series_of(of, field[SERIES]) : NULL;
  if (to == NULL || to->count == MOST_POINTS) return false;
  to->cost[to->count] = cost;
  to->error[to->count++] = error;
  return true;
}

static vsc_status read_errors(const char *csv, diagram *all, vsc_error *error)
{
  FILE *stream = fopen(csv, "r");
  if (stream == NULL) return vsc_fail(error, VSC_INPUT, "%s: cannot be read: %s", csv, strerror(errno));
  char *line = NULL;
  size_t room = 0;
  bool good = getline(&line, &room, stream) > 0;
  while (good && getline(&line, &room, stream) > 0) good = keep_line(line, all);
  free(line);
  fclose(stream);
  if (good && all->count > 0) return VSC_OK;
  return vsc_fail(error, VSC_INPUT, "%s: expected table, series, what, elements, processor seconds, per cent in each "
                  "line, as `viscera bench error` writes them", csv);
}

// ---- the diagram

static void widen(axis *a, double value)
{
  a->low = fmin(a->low, floor(log10(value)));
  a->high = fmax(a->high, ceil(log10(value)));
}

static double place(const axis *a, double value)
{
  return (log10(value) - a->low) / (a->high - a->low) * SIDE;
}

static void draw_grid(cairo_t *cairo, const axis *cost, const axis *error)
{
  const axis *axes[2] = {cost, error};
  char text[32];
  cairo_set_line_width(cairo, 1);
  for (int k = 0; k < 2; k++)
    for (double power = axes[k]->low; power <= axes[k]->high; power++) {
      const double at = place(axes[k], pow(10, power));
      cairo_set_source_rgb(cairo, 0.87, 0.87, 0.89);
      cairo_move_to(cairo, k == 0 ? at : 0, k == 0 ? 0 : SIDE - at);
      cairo_line_to(cairo, k == 0 ? at : SIDE, k == 0 ? SIDE : SIDE - at);
      cairo_stroke(cairo);
      snprintf(text, sizeof text, k == 0 ? "%g" : "%g %%", pow(10, power));
      if (k == 0)
        vsc_write_text(cairo, at, SIDE + 20, 13, VSC_FAINT, 0.5, text);
      else
        vsc_write_text(cairo, -8, SIDE - at + 5, 13, VSC_FAINT, 1, text);
    }
  vsc_write_text(cairo, SIDE / 2.0, SIDE + 44, 14, VSC_INK, 0.5, "processor seconds for each simulated second");
}

static void draw_series(cairo_t *cairo, const series *s, size_t number, const axis *cost, const axis *error)
{
  const double *colour = colours[number];
  cairo_set_source_rgb(cairo, colour[0], colour[1], colour[2]);
  cairo_set_line_width(cairo, 2);
  cairo_new_path(cairo);
  for (size_t p = 0; p < s->count; p++)
    cairo_line_to(cairo, place(cost, s->cost[p]), SIDE - place(error, s->error[p]));
  cairo_stroke(cairo);
  for (size_t p = 0; p < s->count; p++) {
    cairo_arc(cairo, place(cost, s->cost[p]), SIDE - place(error, s->error[p]), 5, 0, 2 * M_PI);
    cairo_fill(cairo);
  }
  const double y = SIDE + 74 + LINE * (double)number;
  cairo_rectangle(cairo, 0, y - 11, 14, 14);
  cairo_fill(cairo);
  vsc_write_text(cairo, 22, y, 14, VSC_INK, 0, s->name);
}

static void draw_table(cairo_t *cairo, const table *of)
{
  axis cost = {INFINITY, -INFINITY}, error = cost;
  for (size_t s = 0; s < of->count; s++)
    for (size_t p = 0; p < of->items[s].count; p++) {
      widen(&cost, of->items[s].cost[p]);
      widen(&error, of->items[s].error[p]);
    }
  if (cost.high <= cost.low) cost.high = cost.low + 1;
  if (error.high <= error.low) error.high = error.low + 1;
  vsc_use_font(cairo, CAIRO_FONT_WEIGHT_BOLD);
  vsc_write_text(cairo, 0, -16, 16, VSC_INK, 0, title_of(of));
  vsc_use_font(cairo, CAIRO_FONT_WEIGHT_NORMAL);
  draw_grid(cairo, &cost, &error);
  for (size_t s = 0; s < of->count; s++) draw_series(cairo, &of->items[s], s, &cost, &error);
}

static int height_of(const diagram *all)
{
  size_t most = 0;
  for (size_t t = 0; t < all->count; t++)
    if (all->tables[t].count > most) most = all->tables[t].count;
  return TOP + SIDE + 80 + LINE * (int)most;
}

static void draw_all(cairo_t *cairo, const diagram *all)
{
  cairo_set_source_rgb(cairo, 1, 1, 1);
  cairo_paint(cairo);
  vsc_use_font(cairo, CAIRO_FONT_WEIGHT_BOLD);
  vsc_write_text(cairo, 36, 38, 22, VSC_INK, 0, "A beating ventricle: RMS error over the beat, per cent of the stroke");
  for (size_t t = 0; t < all->count; t++) {
    cairo_save(cairo);
    cairo_translate(cairo, LEFT + (double)t * PANEL, TOP);
    draw_table(cairo, &all->tables[t]);
    cairo_restore(cairo);
  }
}

vsc_status vsc_errors_draw(const char *csv, const char *file, vsc_error *error)
{
  diagram *all;
  if (!VSC_NEW(all, 1)) return vsc_fail_memory(error, "the picture");
  vsc_status status = read_errors(csv, all, error);
  if (status == VSC_OK) {
    cairo_surface_t *surface =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, PANEL * (int)all->count - PANEL + LEFT + SIDE + 60, height_of(all));
    cairo_t *cairo = cairo_create(surface);
    if (cairo_status(cairo) == CAIRO_STATUS_SUCCESS) {
      draw_all(cairo, all);
      status = vsc_write_png(surface, file, error);
    } else {
      status = vsc_fail_memory(error, "the picture");
    }
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
  }
  vsc_free(all);
  return status;
}
