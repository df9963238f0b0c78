// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/graphs.h"

#include <math.h>
#include <plplot.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"

enum { LINES = 6, GRAPHS = 3 };

// Colours of PLplot's table.
enum { INK = 1, GRID = 2, MARK = 3, FIRST_LINE = 4 };

static const PLINT colours[FIRST_LINE + LINES][3] = {
    {255, 255, 255}, {50, 50, 55},  {226, 226, 230}, {150, 120, 125}, {178, 24, 43},
    {33, 102, 172},  {27, 120, 55}, {118, 42, 131},  {191, 129, 45},  {80, 80, 80}};

// The edges of a graph, as shares of the width.
static const double LEFT = 0.085, RIGHT = 0.97;
static const double HEADING = 0.045;  // above a graph, share of the height

typedef struct line {
  char name[VSC_NAME];
  double *values;  // one per row, owned
} line;

typedef struct graph {
  const char *title;
  bool unnamed;       // its one line needs no legend
  double least_span;  // of the vertical axis: noise is not blown up beyond this
  bool from_zero;     // the vertical axis starts at 0
  size_t count;
  line lines[LINES];
} graph;

static void free_graph(graph *g)
{
  for (size_t k = 0; k < g->count; k++) vsc_free(g->lines[k].values);
}

static vsc_status add_line(graph *g, const char *name, const vsc_signals *signals,
                           const double *values, vsc_error *error)
{
  if (g->count == LINES) return VSC_OK;
  line *l = &g->lines[g->count];
  if (!VSC_NEW(l->values, signals->rows)) return vsc_fail_memory(error, "a graph");
  memcpy(l->values, values, signals->rows * sizeof *values);
  vsc_copy_name(l->name, name);
  g->count++;
  return VSC_OK;
}

static void left_out(const char *title, const char *columns)
{
  fprintf(stderr, "viscera: plot: the signals have no column %s: no graph of the %s\n", columns,
          title);
}

static vsc_status make_cavities(const vsc_signals *signals, graph *g, vsc_error *error)
{
  *g = (graph){.title = "Cavity volume [ml]", .least_span = 1, .from_zero = true};
  const size_t first = vsc_signals_next(signals, "cavity_", 0);
  if (first == signals->columns) left_out("cavity volume", "cavity_<name>");
  for (size_t c = first; c < signals->columns; c = vsc_signals_next(signals, "cavity_", c + 1))
    if (add_line(g, signals->names[c] + strlen("cavity_"), signals,
                 signals->values + c * signals->rows, error) != VSC_OK)
      return error->status;
  return VSC_OK;
}

static vsc_status make_wall(const vsc_signals *signals, graph *g, vsc_error *error)
{
  *g = (graph){.title = "Wall volume, change from rest [%]", .unnamed = true, .least_span = 0.1};
  const double *volume = vsc_signals_find(signals, "wall_volume");
  if (volume == NULL) left_out("wall volume", "wall_volume");
  if (volume == NULL) return VSC_OK;
  if (add_line(g, "wall", signals, volume, error) != VSC_OK) return error->status;
  for (size_t r = 0; r < signals->rows; r++)
    g->lines[0].values[r] = 100 * (volume[r] - volume[0]) / volume[0];
  return VSC_OK;
}

static vsc_status make_tension(const vsc_signals *signals, graph *g, vsc_error *error)
{
  *g = (graph){.title = "Active tension [kPa]", .least_span = 1, .from_zero = true};
  const double *mean = vsc_signals_find(signals, "active_tension_mean");
  const double *largest = vsc_signals_find(signals, "active_tension_max");
  if (mean == NULL && largest == NULL) left_out("active tension", "active_tension_mean");
  if (mean != NULL && add_line(g, "mean", signals, mean, error) != VSC_OK) return error->status;
  if (largest != NULL && add_line(g, "largest", signals, largest, error) != VSC_OK)
    return error->status;
  return VSC_OK;
}

static void find_range(const graph *g, size_t rows, double *low, double *high)
{
  *low = INFINITY;
  *high = -INFINITY;
  for (size_t k = 0; k < g->count; k++)
    for (size_t r = 0; r < rows; r++)
      if (isfinite(g->lines[k].values[r])) {
        *low = fmin(*low, g->lines[k].values[r]);
        *high = fmax(*high, g->lines[k].values[r]);
      }
  if (*low > *high) *low = *high = 0;
  if (g->from_zero) *low = fmin(*low, 0);
  const double lacking = fmax(0, g->least_span - (*high - *low));
  *high += lacking / 2 + 0.08 * (*high - *low);
  if (!g->from_zero || *low < 0) *low -= lacking / 2 + 0.08 * (*high - *low);
}

static void use_colour(cairo_t *cairo, size_t colour)
{
  const PLINT *c = colours[colour];
  cairo_set_source_rgb(cairo, c[0] / 255.0, c[1] / 255.0, c[2] / 255.0);
}

// The names of the lines, each behind a piece of its line, above the graph on the right.
static void draw_legend(const graph *g, cairo_t *cairo, double right, double bottom)
{
  if (g->unnamed) return;
  cairo_select_font_face(cairo, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo, 14);
  cairo_set_line_width(cairo, 2.5);
  for (size_t k = g->count; k-- > 0;) {
    cairo_text_extents_t extents;
    cairo_text_extents(cairo, g->lines[k].name, &extents);
    right -= extents.x_advance;
    use_colour(cairo, INK);
    cairo_move_to(cairo, right, bottom);
    cairo_show_text(cairo, g->lines[k].name);
    use_colour(cairo, FIRST_LINE + k);
    cairo_move_to(cairo, right - 34, bottom - 5);
    cairo_rel_line_to(cairo, 26, 0);
    cairo_stroke(cairo);
    right -= 58;
  }
}

static void draw_graph(const graph *g, const vsc_signals *signals, const double *seconds,
                       double top, double bottom, double mark, bool last)
{
  const double end = signals->rows > 1 ? seconds[signals->rows - 1] : seconds[0] + 1;
  double low, high;
  find_range(g, signals->rows, &low, &high);
  plvpor(LEFT, RIGHT, bottom, top);
  plwind(seconds[0], end, low, high);
  plwidth(1);
  plcol0(GRID);
  plbox("g", 0, 0, "g", 0, 0);
  if (isfinite(mark)) {
    plcol0(MARK);
    plwidth(1.5);
    pllsty(2);
    pljoin(mark, low, mark, high);
    pllsty(1);
  }
  for (size_t k = g->count; k-- > 0;) {
    plcol0(FIRST_LINE + (PLINT)k);
    plwidth(2.5);
    plline((PLINT)signals->rows, seconds, g->lines[k].values);
  }
  plcol0(INK);
  plwidth(1);
  plsyax(8, 0);  // small numbers are written out, without a power of ten above the axis
  plbox(last ? "bcfnst" : "bcst", 0, 0, "bcfnstv", 0, 0);
  plmtex("t", 0.9, 0.0, 0.0, g->title);
  if (last) plmtex("b", 3.0, 0.5, 0.5, "Time [s]");
}

// PLplot, drawing into a cairo context of ours; it needs no display.
static void open_plplot(cairo_t *cairo, double width, double height)
{
  // Without its cairo driver PLplot would ask on stdin for another one.
  if (freopen("/dev/null", "r", stdin) == NULL) return;
  for (PLINT k = 0; k < FIRST_LINE + LINES; k++)
    plscol0(k, colours[k][0], colours[k][1], colours[k][2]);
  plspage(0, 0, (PLINT)width, (PLINT)height, 0, 0);
  plsdev("extcairo");
  plinit();
  pl_cmd(PLESC_DEVINIT, cairo);
  pladv(0);
  plschr(0, 0.62);
  plsmaj(0, 0.5);
  plsmin(0, 0.5);
}

static double *make_seconds(const vsc_signals *signals, vsc_error *error)
{
  const double *time = vsc_signals_find(signals, "time");
  double *seconds = NULL;
  if (time == NULL || signals->rows == 0) {
    vsc_fail(error, VSC_INPUT, "the signals have no column 'time' or no row: nothing to draw");
    return NULL;
  }
  const size_t column = (size_t)(time - signals->values) / signals->rows;
  if (!VSC_NEW(seconds, signals->rows)) {
    vsc_fail_memory(error, "a graph");
    return NULL;
  }
  const double unit = strcmp(signals->units[column], "ms") == 0 ? 1e-3 : 1;
  for (size_t r = 0; r < signals->rows; r++) seconds[r] = unit * time[r];
  return seconds;
}

vsc_status vsc_graphs_draw(cairo_t *cairo, double width, double height, const vsc_signals *signals,
                           double mark, vsc_error *error)
{
  vsc_error own;
  if (error == NULL) error = &own;
  double *seconds = make_seconds(signals, error);
  if (seconds == NULL) return error->status;
  graph graphs[GRAPHS] = {0};
  vsc_status status = make_cavities(signals, &graphs[0], error);
  if (status == VSC_OK) status = make_wall(signals, &graphs[1], error);
  if (status == VSC_OK) status = make_tension(signals, &graphs[2], error);
  int present = 0, drawn = 0, before = 0;
  for (int g = 0; g < GRAPHS; g++) present += graphs[g].count > 0;
  const double below = 0.06, share = (1 - below) / (present < 2 ? 2 : present);  // of the height
  if (status == VSC_OK && present > 0) {
    cairo_save(cairo);  // PLplot turns it upside down
    open_plplot(cairo, width, height);
    for (int g = 0; g < GRAPHS; g++) {
      if (graphs[g].count == 0) continue;
      drawn++;
      const double floor = 1 - drawn * share;
      draw_graph(&graphs[g], signals, seconds, floor + share - HEADING, floor + 0.012, mark,
                 drawn == present);
    }
    plend();
    cairo_restore(cairo);
  }
  for (int g = 0; g < GRAPHS; g++) {
    if (graphs[g].count == 0) continue;
    draw_legend(&graphs[g], cairo, RIGHT * width, ((before++) * share + HEADING) * height - 9);
  }
  for (int g = 0; g < GRAPHS; g++) free_graph(&graphs[g]);
  vsc_free(seconds);
  return status;
}
