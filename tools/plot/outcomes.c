// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/outcomes.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "tools/plot/ink.h"

enum { MOST_NAMES = 32, LEFT = 150, TOP = 170, CELL = 46, ROW = 30, GAP = 26, BOTTOM = 30 };

// Names in the order in which they are met.
typedef struct names {
  size_t count;
  char text[MOST_NAMES][VSC_NAME];
} names;

enum { SURVIVES, INSIDE_OUT, REFUSED, STOPS, UNENDED, WRONG, OUTCOMES };
static const char *const outcome_names[OUTCOMES] = {"survives", "inside out", "refused", "stops", "unended", "wrong"};
static const char *const outcome_texts[OUTCOMES] = {"survives, energy balances", "survives, elements inside out", "refused at once", "stops with a message",
                                                    "still running at the limit", "silently wrong"};
static const double colours[OUTCOMES][3] = {
    {0.55, 0.80, 0.60}, {0.36, 0.58, 0.62}, {0.72, 0.78, 0.90}, {0.97, 0.84, 0.47}, {0.75, 0.75, 0.78}, {0.84, 0.19, 0.22}};

typedef struct outcomes {
  names stresses, kinds, methods;
  unsigned of[MOST_NAMES][MOST_NAMES][MOST_NAMES][OUTCOMES];  // stress, method, kind
  unsigned all[OUTCOMES];
} outcomes;

static size_t number_of(names *list, const char *name)
{
  size_t k = 0;
  while (k < list->count && strcmp(list->text[k], name) != 0) k++;
  if (k == list->count && k < MOST_NAMES - 1) snprintf(list->text[list->count++], VSC_NAME, "%s", name);
  return k;
}

static vsc_status read_line(char *line, const char *csv, outcomes *table, vsc_error *error)
{
  enum { STRESS, LAW, KIND, METHOD, OUTCOME, FIELDS };
  line[strcspn(line, "\r\n")] = '\0';
  char *field[FIELDS] = {0}, *rest = line;
  for (int k = 0; k < FIELDS && rest != NULL; k++) field[k] = strsep(&rest, ",");
  int outcome = 0;
  while (field[OUTCOME] != NULL && outcome < OUTCOMES && strcmp(outcome_names[outcome], field[OUTCOME]) != 0) outcome++;
  if (field[OUTCOME] == NULL || outcome == OUTCOMES)
    return vsc_fail(error, VSC_INPUT, "%s: expected stress, law, element, method, outcome in each line, as "
                    "`viscera bench stability` writes them", csv);
  const size_t stress = number_of(&table->stresses, field[STRESS]), kind = number_of(&table->kinds, field[KIND]);
  table->of[stress][number_of(&table->methods, field[METHOD])][kind][outcome]++;
  table->all[outcome]++;
  return VSC_OK;
}

static vsc_status read_table(const char *csv, outcomes *table, vsc_error *error)
{
  FILE *stream = fopen(csv, "r");
  if (stream == NULL) return vsc_fail(error, VSC_INPUT, "%s: cannot be read: %s", csv, strerror(errno));
  char *line = NULL;
  size_t room = 0;
  vsc_status status = VSC_OK;
  for (size_t row = 0; status == VSC_OK && getline(&line, &room, stream) > 0; row++)
    if (row > 0) status = read_line(line, csv, table, error);
  free(line);
  fclose(stream);
  if (status == VSC_OK && table->stresses.count == 0) status = vsc_fail(error, VSC_INPUT, "%s: there are no cases", csv);
  return status;
}

static void draw_field(cairo_t *cairo, double x, double y, const unsigned of[OUTCOMES])
{
  unsigned all = 0;
  for (int k = 0; k < OUTCOMES; k++) all += of[k];
  double from = x;
  for (int k = 0; k < OUTCOMES && all > 0; k++) {
    const double width = (CELL - 2.0) * of[k] / all;
    cairo_set_source_rgb(cairo, colours[k][0], colours[k][1], colours[k][2]);
    cairo_rectangle(cairo, from, y, width, ROW - 2);
    cairo_fill(cairo);
    from += width;
  }
  char text[16];
  snprintf(text, sizeof text, "%u", all);
  if (all > 0) vsc_write_text(cairo, x + CELL / 2.0 - 1, y + 19, 12, VSC_INK, 0.5, text);
}

static void draw_legend(cairo_t *cairo, const outcomes *table)
{
  double x = 36;
  for (int k = 0; k < OUTCOMES; k++) {
    char text[64];
    cairo_text_extents_t extents;
    snprintf(text, sizeof text, "%u %s", table->all[k], outcome_texts[k]);
    cairo_set_source_rgb(cairo, colours[k][0], colours[k][1], colours[k][2]);
    cairo_rectangle(cairo, x, 58, 16, 16);
    cairo_fill(cairo);
    vsc_write_text(cairo, x + 22, 71, 13, VSC_INK, 0, text);
    cairo_text_extents(cairo, text, &extents);
    x += 22 + extents.x_advance + 22;
  }
}

static void draw_column(cairo_t *cairo, const outcomes *table, size_t method, size_t kind, double x)
{
  cairo_save(cairo);
  cairo_translate(cairo, x + CELL / 2.0 + 4, TOP - 8);
  cairo_rotate(cairo, -0.7);
  vsc_write_text(cairo, 0, 0, 12, VSC_INK, 0, table->kinds.text[kind]);
  cairo_restore(cairo);
  for (size_t s = 0; s < table->stresses.count; s++)
    draw_field(cairo, x, TOP + (double)s * ROW, table->of[s][method][kind]);
}

static void draw_page(cairo_t *cairo, const void *what)
{
  const outcomes *table = what;
  draw_legend(cairo, table);
  for (size_t s = 0; s < table->stresses.count; s++)
    vsc_write_text(cairo, LEFT - 12, TOP + (double)s * ROW + 19, 14, VSC_INK, 1, table->stresses.text[s]);
  for (size_t m = 0; m < table->methods.count; m++) {
    const double left = LEFT + (double)m * ((double)table->kinds.count * CELL + GAP);
    vsc_write_text(cairo, left + (double)table->kinds.count * CELL / 2, 100, 15, VSC_INK, 0.5, table->methods.text[m]);
    for (size_t k = 0; k < table->kinds.count; k++) draw_column(cairo, table, m, k, left + (double)k * CELL);
  }
}

vsc_status vsc_outcomes_draw(const char *csv, const char *file, vsc_error *error)
{
  outcomes *table = calloc(1, sizeof *table);
  if (table == NULL) return vsc_fail_memory(error, "the picture");
  vsc_status status = read_table(csv, table, error);
  if (status == VSC_OK) {
    const int width = LEFT + (int)table->methods.count * ((int)table->kinds.count * CELL + GAP) + 20;
    const int height = TOP + (int)table->stresses.count * ROW + BOTTOM;
    status = vsc_write_page(width, height, "What tissue survives: cases by stress, method and kind of element",
                            draw_page, table, file, error);
  }
  free(table);
  return status;
}
