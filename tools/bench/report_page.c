// SPDX-License-Identifier: GPL-3.0-or-later
// The page: for each problem a table, pictures, how errors fall with the number of unknowns, and curves.
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "io/replace.h"
#include "tools/bench/report.h"
#include "tools/bench/report_curves.h"

static const char head[] =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>viscera: accuracy</title>\n"
    "<style>body{font:15px/1.4 sans-serif;margin:2em auto;max-width:75em;color:#222}"
    "table{border-collapse:collapse;margin:1em 0;font-size:13px}"
    "td,th{padding:2px 8px;text-align:right;border-bottom:1px solid #ddd}"
    "td:first-child,th:first-child{text-align:left}.met{color:#060}.missed{color:#b00}"
    "svg{margin:0 1em 1em 0}img{max-width:100%}</style></head><body>\n"
    "<h1>Accuracy</h1>\n<p>Written by <code>viscera bench accuracy</code>. CPU seconds are of the whole "
    "process on all its threads, from reading the mesh to the last file; memory is its largest.</p>\n";

static const char *const colours[] = {"#999999", "#e69f00", "#009e73", "#0072b2", "#d55e00", "#cc79a7"};

static void put_text(FILE *page, const char *text)
{
  for (; *text != '\0'; text++) {
    if (*text == '<' || *text == '&')
      fprintf(page, "&#%d;", *text);
    else
      fputc(*text, page);
  }
}

static bool is_of(const vsc_bench_row *row, const vsc_bench_row *other)
{
  return row->of.problem == other->of.problem;
}

// ---- tables

static void put_value(FILE *page, const vsc_bench_row *row)
{
  static const char *const words[] = {"", "met", "missed"};
  const vsc_bench_verdict verdict = vsc_bench_judge(row);
  if (row->failure[0] != '\0') {
    fputs("<td colspan=\"4\" class=\"missed\">", page);
    put_text(page, row->failure);
  } else if (row->skipped) {
    fprintf(page, "<td>%s</td><td colspan=\"3\">no reference curve", row->quantity->name);
  } else {
    fprintf(page, "<td>%s</td><td>%.6g %s</td><td>", row->quantity->name, row->value,
            row->quantity->unit);
    if (!isnan(row->reference)) fprintf(page, "%.6g", row->reference);
    fprintf(page, "</td><td class=\"%s\">", words[verdict]);
    if (row->reference != 0 && !isnan(row->reference))
      fprintf(page, "%+.3f %%", 100 * (row->value / row->reference - 1));
    fprintf(page, " %s", words[verdict]);
  }
  fputs("</td>", page);
}

static void put_table(FILE *page, const vsc_bench_report *report, size_t first)
{
  fputs("<table><tr><th>case</th><th>elements</th><th>nodes</th><th>unknowns</th><th>CPU s</th>"
        "<th>MB</th><th>Newton</th><th>quantity</th><th>value</th><th>reference</th><th>error</th>"
        "<th>order</th></tr>\n", page);
  const char *last = "";
  for (size_t k = first; k < report->count && is_of(&report->rows[k], &report->rows[first]); k++) {
    const vsc_bench_row *row = &report->rows[k];
    if (strcmp(row->of.name, last) != 0)
      fprintf(page, "<tr><td>%s</td><td>%.0f</td><td>%.0f</td><td>%.0f</td><td>%.2f</td><td>%.0f</td>"
              "<td>%.0f</td>", row->of.name, row->elements, row->nodes, row->unknowns, row->cpu_seconds,
              row->megabytes, row->iterations);
    else
      fputs("<tr><td colspan=\"7\"></td>", page);
    last = row->of.name;
    put_value(page, row);
    if (isnan(row->order))
      fputs("<td></td></tr>\n", page);
    else
      fprintf(page, "<td>%.2f</td></tr>\n", row->order);
  }
  fputs("</table>\n", page);
}

// ---- errors against unknowns

enum { WIDTH = 420, HEIGHT = 260, LEFT = 60, TOP = 24, RIGHT = 100, BOTTOM = 36 };

typedef struct graph {
  double x[2], y[2];  // least and most of the logarithms
} graph;

// log10 of unknowns and of the error (percent, or the value itself where the reference is 0); false for
// a row without an error.
static bool point_of(const vsc_bench_row *row, double at[2])
{
  if (row->failure[0] != '\0' || row->skipped || isnan(row->reference)) return false;
  const double scale = row->reference != 0 ? 100 / fabs(row->reference) : 1;
  const double error = scale * fabs(row->value - row->reference);
  at[0] = log10(row->unknowns);
  at[1] = log10(fmax(error, 1e-6));
  return row->unknowns > 0 && isfinite(at[1]);
}

static double across(const graph *g, double x)
{
  return LEFT + (WIDTH - LEFT - RIGHT) * (x - g->x[0]) / (g->x[1] - g->x[0]);
}

static double down(const graph *g, double y)
{
  return TOP + (HEIGHT - TOP - BOTTOM) * (g->y[1] - y) / (g->y[1] - g->y[0]);
}

static void put_axes(FILE *page, const graph *g, const vsc_bench_row *row)
{
  fprintf(page, "<svg width=\"%d\" height=\"%d\" font-size=\"11\"><text x=\"%d\" y=\"14\">%s %s: "
          "error%s</text>\n", WIDTH, HEIGHT, LEFT, row->quantity->name, row->of.variant->name,
          row->reference != 0 ? ", %" : "");
  for (double x = g->x[0]; x <= g->x[1]; x++)
    fprintf(page, "<path d=\"M%.1f %d V%d\" stroke=\"#ddd\"/><text x=\"%.1f\" y=\"%d\" "
            "text-anchor=\"middle\">1e%.0f</text>\n", across(g, x), TOP, HEIGHT - BOTTOM, across(g, x),
            HEIGHT - BOTTOM + 14, x);
  for (double y = g->y[0]; y <= g->y[1]; y++)
    fprintf(page, "<path d=\"M%d %.1f H%d\" stroke=\"#ddd\"/><text x=\"%d\" y=\"%.1f\" "
            "text-anchor=\"end\">%g</text>\n", LEFT, down(g, y), WIDTH - RIGHT, LEFT - 4, down(g, y) + 4,
            pow(10, y));
  fprintf(page, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">unknowns</text>\n",
          (LEFT + WIDTH - RIGHT) / 2, HEIGHT - 4);
}

// The line of one kind of element.
static void put_line(FILE *page, const vsc_bench_report *report, const graph *g,
                     const vsc_bench_row *of, size_t kind)
{
  double at[2], last[2] = {NAN, NAN};
  for (size_t k = 0; k < report->count; k++) {
    const vsc_bench_row *row = &report->rows[k];
    if (row->quantity != of->quantity || row->of.variant != of->of.variant ||
        row->of.kind != &vsc_bench_kinds[kind] || !point_of(row, at))
      continue;
    const char *const colour = colours[kind % (sizeof colours / sizeof colours[0])];
    if (!isnan(last[0]))
      fprintf(page, "<path d=\"M%.1f %.1f L%.1f %.1f\" stroke=\"%s\"/>", across(g, last[0]),
              down(g, last[1]), across(g, at[0]), down(g, at[1]), colour);
    fprintf(page, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n", across(g, at[0]),
            down(g, at[1]), colour);
    memcpy(last, at, sizeof last);
  }
  if (!isnan(last[0]))
    fprintf(page, "<text x=\"%.1f\" y=\"%.1f\" fill=\"%s\">%s</text>\n", across(g, last[0]) + 6,
            down(g, last[1]) + 4, colours[kind % (sizeof colours / sizeof colours[0])],
            vsc_bench_kinds[kind].name);
}

// The graph of a row's quantity; nothing where there are fewer than two errors.
static void put_graph(FILE *page, const vsc_bench_report *report, const vsc_bench_row *of)
{
  graph g = {{INFINITY, -INFINITY}, {INFINITY, -INFINITY}};
  double at[2];
  int points = 0;
  for (size_t k = 0; k < report->count; k++) {
    const vsc_bench_row *row = &report->rows[k];
    if (row->quantity != of->quantity || row->of.variant != of->of.variant || !point_of(row, at))
      continue;
    g.x[0] = fmin(g.x[0], floor(at[0]));
    g.x[1] = fmax(g.x[1], floor(at[0]) + 1);
    g.y[0] = fmin(g.y[0], floor(at[1]));
    g.y[1] = fmax(g.y[1], floor(at[1]) + 1);
    points++;
  }
  if (points < 2) return;
  put_axes(page, &g, of);
  for (size_t kind = 0; kind < vsc_bench_kind_count; kind++) put_line(page, report, &g, of, kind);
  fputs("</svg>\n", page);
}

// One graph for each quantity and variant of the problem that begins at row `first`.
static void put_graphs(FILE *page, const vsc_bench_report *report, size_t first)
{
  for (size_t k = first; k < report->count && is_of(&report->rows[k], &report->rows[first]); k++) {
    const vsc_bench_row *row = &report->rows[k];
    bool drawn = row->quantity == NULL;
    for (size_t j = first; j < k && !drawn; j++)
      drawn = report->rows[j].quantity == row->quantity && report->rows[j].of.variant == row->of.variant;
    if (!drawn) put_graph(page, report, row);
  }
}

vsc_status vsc_bench_write_page(const vsc_bench_report *report, const char *folder, const char *reference,
                                vsc_error *error)
{
  char file[VSC_FILE_NAME], picture[VSC_FILE_NAME];
  vsc_replacement written;
  snprintf(file, sizeof file, "%s/index.html", folder);
  const vsc_status status = vsc_replace_begin(file, &written, error);
  if (status != VSC_OK) return status;
  FILE *page = written.stream;
  fputs(head, page);
  for (size_t k = 0; k < report->count; k++) {
    if (k > 0 && is_of(&report->rows[k], &report->rows[k - 1])) continue;
    const vsc_bench_problem *problem = report->rows[k].of.problem;
    fprintf(page, "<h2>%s</h2>\n", problem->title);
    put_table(page, report, k);
    put_graphs(page, report, k);
    vsc_bench_put_curves(page, report, k, folder, reference);
    snprintf(picture, sizeof picture, "%s/%s.png", folder, problem->name);
    if (access(picture, R_OK) == 0)
      fprintf(page, "<p><img src=\"%s.png\" alt=\"%s\"></p>\n", problem->name, problem->title);
  }
  fputs("</body></html>\n", page);
  return vsc_replace_end(&written, false, error);
}
