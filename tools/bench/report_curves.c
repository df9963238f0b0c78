// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/report_curves.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>

#include "base/mem.h"
#include "tools/bench/measures.h"
#include "tools/results.h"

enum { WIDTH = 520, HEIGHT = 260, LEFT = 52, TOP = 24, RIGHT = 190, BOTTOM = 36, MOST = 16 };

typedef struct line {
  const char *name;
  size_t rows;
  const double *x, *y;
  vsc_signals *table;  // owned, may be NULL
  double *points;      // likewise
} line;

typedef struct graph {
  const char *title;      // behind which `part` comes
  char part[VSC_NAME];
  const char *x_title;
  double x[2], y[2];      // least and most
  const double *low, *high;  // band about the first line, at its abscissae; NULL: none
  size_t count;
  line lines[MOST];  // the first is the reference
} graph;

static const char *const colours[] = {"#000000", "#d55e00", "#0072b2", "#009e73", "#e69f00", "#cc79a7", "#666666"};

// ---- drawing

static double across(const graph *g, double x)
{
  return LEFT + (WIDTH - LEFT - RIGHT) * (x - g->x[0]) / (g->x[1] - g->x[0]);
}

static double down(const graph *g, double y)
{
  return TOP + (HEIGHT - TOP - BOTTOM) * (g->y[1] - y) / (g->y[1] - g->y[0]);
}

static void widen(double range[2], size_t rows, const double *values)
{
  range[0] = fmin(range[0], gsl_stats_min(values, 1, rows));
  range[1] = fmax(range[1], gsl_stats_max(values, 1, rows));
}

// Four steps or a few more of 1, 2 or 5 times a power of ten across a range.
static double step_of(const double range[2])
{
  const double rough = (range[1] - range[0]) / 4, power = pow(10, floor(log10(rough)));
  return power * (rough < 2 * power ? 1 : rough < 5 * power ? 2 : 5);
}

static void put_axes(FILE *page, const graph *g)
{
  fprintf(page, "<svg width=\"%d\" height=\"%d\" font-size=\"11\"><text x=\"%d\" y=\"14\">%s %s</text>\n", WIDTH, HEIGHT,
          LEFT, g->title, g->part);
  const double dx = step_of(g->x), dy = step_of(g->y);
  for (double k = ceil(g->x[0] / dx); k * dx <= g->x[1]; k++)
    fprintf(page, "<path d=\"M%.1f %d V%d\" stroke=\"#ddd\"/><text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%g</text>\n",
            across(g, k * dx), TOP, HEIGHT - BOTTOM, across(g, k * dx), HEIGHT - BOTTOM + 14, k * dx + 0.0);  // not -0
  for (double k = ceil(g->y[0] / dy); k * dy <= g->y[1]; k++)
    fprintf(page, "<path d=\"M%d %.1f H%d\" stroke=\"#ddd\"/><text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n",
            LEFT, down(g, k * dy), WIDTH - RIGHT, LEFT - 4, down(g, k * dy) + 4, k * dy + 0.0);
  fprintf(page, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">%s</text>\n", (LEFT + WIDTH - RIGHT) / 2, HEIGHT - 4,
          g->x_title);
}

static void put_band(FILE *page, const graph *g)
{
  const line *mean = &g->lines[0];
  fputs("<polygon fill=\"#ccc\" points=\"", page);
  for (size_t r = 0; r < mean->rows; r++) fprintf(page, "%.1f,%.1f ", across(g, mean->x[r]), down(g, g->high[r]));
  for (size_t r = mean->rows; r-- > 0;) fprintf(page, "%.1f,%.1f ", across(g, mean->x[r]), down(g, g->low[r]));
  fputs("\"/>\n", page);
}

static void put_line(FILE *page, const graph *g, size_t number)
{
  const line *drawn = &g->lines[number];
  const char *const colour = colours[number % (sizeof colours / sizeof colours[0])];
  const char *const dashes = number == 0 ? " stroke-dasharray=\"4 2\"" : "";
  fprintf(page, "<polyline fill=\"none\" stroke=\"%s\"%s points=\"", colour, dashes);
  for (size_t r = 0; r < drawn->rows; r++)
    fprintf(page, "%.1f,%.1f ", across(g, drawn->x[r]), down(g, drawn->y[r]));
  fprintf(page, "\"/><text x=\"%d\" y=\"%zu\" fill=\"%s\">%s</text>\n", WIDTH - RIGHT + 6, TOP + 10 + 14 * number, colour,
          drawn->name);
}

// Nothing where only the reference is there, or it is a flat line.
static void put_graph(FILE *page, graph *g)
{
  g->x[0] = g->y[0] = INFINITY;
  g->x[1] = g->y[1] = -INFINITY;
  if (g->count < 2) return;
  for (size_t k = 0; k < g->count; k++) {
    widen(g->x, g->lines[k].rows, g->lines[k].x);
    widen(g->y, g->lines[k].rows, g->lines[k].y);
  }
  const line *mean = &g->lines[0];
  if (g->low != NULL) widen(g->y, mean->rows, g->low);
  if (g->high != NULL) widen(g->y, mean->rows, g->high);
  if (!(g->x[1] > g->x[0]) || gsl_stats_max(mean->y, 1, mean->rows) == gsl_stats_min(mean->y, 1, mean->rows)) return;
  put_axes(page, g);
  if (g->low != NULL && g->high != NULL) put_band(page, g);
  for (size_t k = 0; k < g->count; k++) put_line(page, g, k);
  fputs("</svg>\n", page);
}

static void close_lines(graph *g)
{
  for (size_t k = 0; k < g->count; k++) {
    vsc_signals_free(g->lines[k].table);
    vsc_free(g->lines[k].points);
  }
  g->count = 0;
}

// ---- what is drawn

static bool has_value(const vsc_bench_row *row, const vsc_bench_quantity *quantity)
{
  return row->quantity == quantity && row->failure[0] == '\0' && !row->skipped;
}

// Adds a line whose numbers are columns of a table, which then is the graph's; a table without them is freed.
static const line *add_columns(graph *g, const char *name, vsc_signals *table, const char *x, const char *y)
{
  const line added = {name, table->rows, vsc_signals_find(table, x), vsc_signals_find(table, y), table, NULL};
  if (added.x == NULL || added.y == NULL || added.rows == 0 || g->count == MOST) {
    vsc_signals_free(table);
    return NULL;
  }
  g->lines[g->count] = added;
  return &g->lines[g->count++];
}

static vsc_signals *read_table(const char *folder, const char *file)
{
  char path[VSC_RESULT_PATH];
  vsc_signals *table;
  vsc_error error;
  snprintf(path, sizeof path, "%s/%s", folder, file);
  return vsc_signals_read(path, &table, &error) == VSC_OK ? table : NULL;
}

// Component `axis` of the history of every case over time.
static void put_history(FILE *page, const vsc_bench_report *report, const vsc_bench_quantity *q, int axis,
                        const char *folder, const char *reference)
{
  graph g = {.title = q->file_column, .x_title = "time, s"};
  char name[VSC_NAME];
  snprintf(g.part, sizeof g.part, "%c, mm", "xyz"[axis]);
  vsc_signals *table = read_table(reference, q->file);
  if (table == NULL) return;
  snprintf(name, sizeof name, "%s_u%c_mean_mm", q->file_column, "xyz"[axis]);
  if (add_columns(&g, "teams: mean, all", table, "time_s", name) == NULL) return;
  snprintf(name, sizeof name, "%s_u%c_min_mm", q->file_column, "xyz"[axis]);
  g.low = vsc_signals_find(table, name);
  snprintf(name, sizeof name, "%s_u%c_max_mm", q->file_column, "xyz"[axis]);
  g.high = vsc_signals_find(table, name);
  for (size_t k = 0; k < report->count; k++) {
    char file[VSC_BENCH_TEXT + 32];
    if (!has_value(&report->rows[k], q)) continue;
    snprintf(file, sizeof file, "runs/%s/signals.csv", report->rows[k].of.name);
    snprintf(name, sizeof name, "%s%c", q->column, "xyz"[axis]);
    table = read_table(folder, file);
    if (table != NULL) add_columns(&g, report->rows[k].of.name, table, "time", name);
  }
  put_graph(page, &g);
  close_lines(&g);
}

// Adds the line of a finished case at the places `s`.
static void add_midline(graph *g, const vsc_bench_row *row, size_t rows, const double *s, int axis, const char *folder)
{
  char runs[VSC_RESULT_PATH];
  double *points;
  vsc_error error;
  vsc_outcome outcome = {.of = &row->of};
  snprintf(runs, sizeof runs, "%s/runs/%s", folder, row->of.name);
  if (g->count == MOST || vsc_outcome_open(runs, &outcome, &error) != VSC_OK) return;
  bool made = VSC_NEW(points, 2 * rows);
  for (size_t r = 0; r < rows && made; r++) {
    double now[3];
    made = vsc_midline_point(&outcome, s[r], now, &error) == VSC_OK;
    if (!made) break;
    points[r] = now[2];
    points[rows + r] = now[axis];
  }
  vsc_outcome_close(&outcome);
  if (made)
    g->lines[g->count++] = (line){row->of.name, rows, points, points + rows, NULL, points};
  else
    vsc_free(points);
}

static void put_midline(FILE *page, const vsc_bench_report *report, const vsc_bench_quantity *q, int axis,
                        const char *folder, const char *reference)
{
  graph g = {.title = "mid-wall line:", .x_title = "z, mm"};
  snprintf(g.part, sizeof g.part, "%c, mm", "xyz"[axis]);
  vsc_signals *table = read_table(reference, q->file);
  if (table == NULL) return;
  const double *const s = vsc_signals_find(table, "s");
  if (add_columns(&g, "reference", table, "z_mm", axis == 0 ? "x_mm" : "y_mm") == NULL) return;
  for (size_t k = 0; k < report->count && s != NULL; k++) {
    const vsc_bench_row *row = &report->rows[k];
    bool finest = has_value(row, q);
    for (size_t j = k + 1; j < report->count && finest; j++)
      finest = !(has_value(&report->rows[j], q) && report->rows[j].of.kind == row->of.kind);
    if (finest) add_midline(&g, row, g.lines[0].rows, s, axis, folder);
  }
  put_graph(page, &g);
  close_lines(&g);
}

void vsc_bench_put_curves(FILE *page, const vsc_bench_report *report, size_t first, const char *folder,
                          const char *reference)
{
  const vsc_bench_problem *problem = report->rows[first].of.problem;
  for (size_t k = 0; k < problem->quantity_count && reference != NULL; k++) {
    const vsc_bench_quantity *q = &problem->quantities[k];
    for (int axis = 0; axis < 3 && q->measure == vsc_measure_history; axis++)
      put_history(page, report, q, axis, folder, reference);
    for (int axis = 0; axis < 2 && q->measure == vsc_measure_midline; axis++)
      put_midline(page, report, q, axis, folder, reference);
  }
}
