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

typedef struct line {
  char name[VSC_NAME];
  double *values;  // one per row, owned
} line;

typedef struct graph {
  const char *title;
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
  *g = (graph){.title = "Wall volume, change from rest [%]", .least_span = 0.1};
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

// Text that PLplot prints as it is.
static void escape(const char *text, char escaped[2 * VSC_NAME])
{
  size_t n = 0;
  for (; *text != '\0' && n + 3 < 2 * VSC_NAME; text++) {
    if (*text == '#') escaped[n++] = '#';
    escaped[n++] = *text;
  }
  escaped[n] = '\0';
}

// The names of the lines, each behind a piece of its line, above the graph on the right.
static void draw_legend(const graph *g)
{
  if (g->count < 2 && strcmp(g->lines[0].name, "wall") == 0) return;
  char texts[LINES][2 * VSC_NAME];
  const char *names[LINES];
  PLINT options[LINES], inks[LINES], colours[LINES], styles[LINES];
  PLFLT widths[LINES], legend_width, legend_height;
  for (size_t k = 0; k < g->count; k++) {
    escape(g->lines[k].name, texts[k]);
    names[k] = texts[k];
    options[k] = PL_LEGEND_LINE;
    inks[k] = INK;
    colours[k] = FIRST_LINE + (PLINT)k;
    styles[k] = 1;
    widths[k] = 2.5;
  }
  pllegend(&legend_width, &legend_height, PL_LEGEND_ROW_MAJOR,
           PL_POSITION_TOP | PL_POSITION_RIGHT | PL_POSITION_OUTSIDE, 0.0, 0.005, 0.03, 0, INK, 1,
           1, (PLINT)g->count, (PLINT)g->count, options, 0.6, 0.9, 2.0, 0.0, inks, names, NULL,
           NULL, NULL, NULL, colours, styles, widths, NULL, NULL, NULL, NULL);
}

static void draw_graph(const graph *g, const vsc_signals *signals, const double *seconds,
                       double top, double bottom, double mark, bool last)
{
  const double end = signals->rows > 1 ? seconds[signals->rows - 1] : seconds[0] + 1;
  double low, high;
  find_range(g, signals->rows, &low, &high);
  plvpor(0.085, 0.985, bottom, top);
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
  plbox(last ? "bcnst" : "bcst", 0, 0, "bcnstv", 0, 0);
  plmtex("t", 0.9, 0.0, 0.0, g->title);
  if (last) plmtex("b", 3.0, 0.5, 0.5, "Time [s]");
  draw_legend(g);
}

// PLplot, drawing into a cairo context of ours; it needs no display.
static void open_plplot(cairo_t *cairo, double width, double height)
{
  static const PLINT table[FIRST_LINE + LINES][3] = {
      {255, 255, 255}, {50, 50, 55},  {226, 226, 230}, {150, 120, 125}, {178, 24, 43},
      {33, 102, 172},  {27, 120, 55}, {118, 42, 131},  {191, 129, 45},  {80, 80, 80}};
  // Without its cairo driver PLplot would ask on stdin for another one.
  if (freopen("/dev/null", "r", stdin) == NULL) return;
  for (PLINT k = 0; k < FIRST_LINE + LINES; k++) plscol0(k, table[k][0], table[k][1], table[k][2]);
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
  int present = 0, drawn = 0;
  for (int g = 0; g < GRAPHS; g++) present += graphs[g].count > 0;
  if (status == VSC_OK && present > 0) {
    open_plplot(cairo, width, height);
    const double below = 0.06, share = (1 - below) / present;
    for (int g = 0; g < GRAPHS; g++) {
      if (graphs[g].count == 0) continue;
      const double floor = 1 - (drawn + 1) * share;
      drawn++;
      draw_graph(&graphs[g], signals, seconds, floor + share - 0.045, floor + 0.012, mark,
                 drawn == present);
    }
    plend();
  }
  for (int g = 0; g < GRAPHS; g++) free_graph(&graphs[g]);
  vsc_free(seconds);
  return status;
}
