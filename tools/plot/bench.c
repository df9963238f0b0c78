// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "tools/plot/bars.h"
#include "tools/plot/diagram.h"
#include "tools/plot/fields.h"

// NAN for a field that is empty.
static double number_in(const char *field)
{
  char *end;
  const double number = strtod(field, &end);
  return end != field ? number : NAN;
}

static vsc_bar *next_bar(vsc_bars *bars, const char *group, const char *name)
{
  if (bars->count == VSC_MOST_BARS) return NULL;
  vsc_bar *bar = &bars->items[bars->count++];
  *bar = (vsc_bar){.pale = NAN, .mark = NAN};
  snprintf(bar->group, sizeof bar->group, "%s", group);
  snprintf(bar->name, sizeof bar->name, "%s", name);
  return bar;
}

#define SOME "about "

static bool keep_throughput(char *const *field, size_t fields, void *context)
{
  enum { ELEMENTS, WHAT, ONE, ALL, BYTES, READ, BUILD, SHARE, FIELDS };
  if (fields < FIELDS) return false;
  const vsc_bars *bars = context;
  const vsc_bar *former = bars->count > 0 ? &bars->items[bars->count - 1] : NULL;
  const double elements = number_in(field[ELEMENTS]);
  char group[VSC_BAR_TEXT];
  // blocks of one size have more or fewer elements, by their kind
  if (former != NULL && fabs(log(elements / strtod(former->group + strlen(SOME), NULL))) < log(2.5))
    snprintf(group, sizeof group, "%s", former->group);
  else
    snprintf(group, sizeof group, SOME "%.0f elements", elements);
  vsc_bar *bar = next_bar(context, group, field[WHAT]);
  if (bar == NULL) return false;
  const double share = number_in(field[SHARE]);
  bar->value = 1e-6 * number_in(field[ONE]);
  bar->pale = 1e-6 * number_in(field[ALL]);
  if (share > 0) bar->mark = bar->value / share;
  snprintf(bar->text, sizeof bar->text, "%.3g, %.3g on all", bar->value, bar->pale);
  if (share > 0) snprintf(bar->text + strlen(bar->text), sizeof bar->text - strlen(bar->text), "; %.0f %%", 100 * share);
  return true;
}

static bool keep_skipping(char *const *field, size_t fields, void *context)
{
  enum { WHAT, EACH, OVER, OF, FIELDS };
  if (fields < FIELDS) return false;
  vsc_bar *bar = next_bar(context, "over the row without", field[WHAT]);
  if (bar == NULL) return false;
  bar->value = number_in(field[OVER]);
  snprintf(bar->text, sizeof bar->text, "%.2f; %.3g ns", bar->value, number_in(field[EACH]));
  return true;
}

static bool keep_start(char *const *field, size_t fields, void *context)
{
  enum { TABLE, WHAT, SECONDS, LEAST, MOST, FIELDS };
  if (fields < FIELDS) return false;
  vsc_bar *bar = next_bar(context, field[TABLE], field[WHAT]);
  if (bar == NULL) return false;
  bar->value = number_in(field[SECONDS]);
  bar->pale = number_in(field[MOST]);
  snprintf(bar->text, sizeof bar->text, "%.3g s", bar->value);
  return true;
}

static bool keep_growth(char *const *field, size_t fields, void *context)
{
  enum { TETS, STEP, BYTES, BUILDING, FIELDS };
  if (fields < FIELDS) return false;
  vsc_diagrams *all = context;
  const double tets = number_in(field[TETS]), step = 1e6 * number_in(field[STEP]), bytes = 1e-6 * number_in(field[BYTES]);
  if (!(tets > 0 && step > 0)) return false;
  if (!vsc_diagram_keep(all, "a step, microseconds", "measured", tets, step)) return false;
  // 0 where the allocator does not tell
  if (bytes > 0 && !vsc_diagram_keep(all, "model and state, MB", "measured", tets, bytes)) return false;
  // as it would be were a tet never to cost more than in the first block
  for (size_t k = 0; k < all->count; k++) {
    const vsc_series *first = &all->items[k].items[0];
    if (!vsc_diagram_keep(all, all->items[k].name, "in proportion to the tets", tets, tets * first->y[0] / first->x[0]))
      return false;
  }
  return true;
}

// What is drawn as bars.
static const struct {
  const char *heading;  // the table's first line begins so
  vsc_fields_line *keep;
  const char *title, *value, *pale, *mark;
  double line;
} tables[] = {
    {"elements,what,updates", keep_throughput, "Million element updates a second", "one thread", "all threads",
     "roofline of one thread", NAN},
    {"what,ns a tet,over", keep_skipping, "What features cost: a step over one without", NULL, NULL, NULL, 1},
    {"table,what,seconds", keep_start, "Where the time goes, seconds", "median", "most", NULL, NAN},
};

static vsc_status not_ours(const char *csv, vsc_error *error)
{
  return vsc_fail(error, VSC_INPUT, "%s: expected a table as `viscera bench throughput`, growth, skipping or start write "
                  "them", csv);
}

static vsc_status draw_bars(size_t which, const char *csv, const char *file, vsc_error *error)
{
  vsc_bars *bars;
  bool good;
  if (!VSC_NEW(bars, 1)) return vsc_fail_memory(error, "the picture");
  bars->title = tables[which].title;
  bars->value_name = tables[which].value;
  bars->pale_name = tables[which].pale;
  bars->mark_name = tables[which].mark;
  bars->line = tables[which].line;
  vsc_status status = vsc_fields_read(csv, tables[which].keep, bars, &good, error);
  if (status == VSC_OK && (!good || bars->count == 0)) status = not_ours(csv, error);
  if (status == VSC_OK) status = vsc_bars_draw(bars, file, error);
  vsc_free(bars);
  return status;
}

static vsc_status draw_growth(const char *csv, const char *file, vsc_error *error)
{
  vsc_diagrams *all;
  bool good;
  if (!VSC_NEW(all, 1)) return vsc_fail_memory(error, "the picture");
  all->title = "How time and memory of a step grow";
  all->x_label = "tets";
  all->y_unit = "";
  vsc_status status = vsc_fields_read(csv, keep_growth, all, &good, error);
  if (status == VSC_OK && (!good || all->count == 0)) status = not_ours(csv, error);
  if (status == VSC_OK) status = vsc_diagrams_draw(all, file, error);
  vsc_free(all);
  return status;
}

vsc_status vsc_bench_picture(const char *csv, const char *file, vsc_error *error)
{
  static const char growth[] = "tets,seconds a step";
  char heading[256] = "";
  FILE *stream = fopen(csv, "r");
  const bool read = stream != NULL && fgets(heading, sizeof heading, stream) != NULL;
  if (stream != NULL) fclose(stream);
  if (!read) return vsc_fail(error, VSC_INPUT, "%s: cannot be read", csv);
  if (strncmp(heading, growth, strlen(growth)) == 0) return draw_growth(csv, file, error);
  for (size_t k = 0; k < sizeof tables / sizeof tables[0]; k++)
    if (strncmp(heading, tables[k].heading, strlen(tables[k].heading)) == 0) return draw_bars(k, csv, file, error);
  return not_ours(csv, error);
}
