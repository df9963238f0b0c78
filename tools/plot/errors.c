// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/errors.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "tools/plot/diagram.h"
#include "tools/plot/fields.h"

// What the tables are called in the picture.
static const char *title_of(const char *name)
{
  return strcmp(name, "time") == 0        ? "one mesh, against far shorter steps"
         : strcmp(name, "space") == 0     ? "meshes, against a finer one of curved quadratic tets"
         : strcmp(name, "real_time") == 0 ? "a heart in real time, against short steps"
         : strcmp(name, "slivers") == 0   ? "a bar with slivers, against short steps"
                                          : NULL;
}

static bool keep_line(char *const *field, size_t fields, void *context)
{
  enum { TABLE, SERIES, WHAT, ELEMENTS, COST, ERROR, FIELDS };
  if (fields < FIELDS) return false;
  const double cost = strtod(field[COST], NULL), error = strtod(field[ERROR], NULL);
  if (!(error > 0) || !(cost > 0)) return true;  // a reference
  return vsc_diagram_keep(context, field[TABLE], field[SERIES], cost, error);
}

vsc_status vsc_errors_draw(const char *csv, const char *file, vsc_error *error)
{
  vsc_diagrams *all;
  if (!VSC_NEW(all, 1)) return vsc_fail_memory(error, "the picture");
  all->title = "A beating ventricle: RMS error over the beat, per cent of the stroke";
  all->x_label = "processor seconds for each simulated second";
  all->y_unit = " %";
  bool good;
  vsc_status status = vsc_fields_read(csv, keep_line, all, &good, error);
  for (size_t k = 0; k < all->count; k++) all->items[k].title = title_of(all->items[k].name);
  if (status == VSC_OK && (!good || all->count == 0))
    status = vsc_fail(error, VSC_INPUT, "%s: expected table, series, what, elements, processor seconds, per cent in each "
                      "line, as `viscera bench error` writes them", csv);
  if (status == VSC_OK) status = vsc_diagrams_draw(all, file, error);
  vsc_free(all);
  return status;
}
