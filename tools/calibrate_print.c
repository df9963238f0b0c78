// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/calibrate_print.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <string.h>

#include "base/vec3.h"
#include "io/replace.h"

// ---- the table

typedef struct table {
  FILE *stream;
  const char *prefix;
  const vsc_answer *answer;
} table;

// A line of the table. `absolute`: differences as they are, not in percent.
static void print_line(const table *t, const char *name, const double value[3], bool absolute)
{
  const bool wanted = t->answer->wanted != NULL;
  const double from = value[wanted ? 0 : 1], to = value[wanted ? 1 : 2];
  fprintf(t->stream, "%s  %-30s", t->prefix, name);
  for (int k = wanted ? 0 : 1; k < 3; k++) fprintf(t->stream, " %10.5g", value[k]);
  if (absolute)
    fprintf(t->stream, "  %+12.2g\n", to - from);
  else
    fprintf(t->stream, "  %+12.2g %%\n", 100 * (to - from) / from);
}

static const double *compliance(const table *t, int column)
{
  return column == 0 ? t->answer->wanted : column == 1 ? t->answer->springs : t->answer->measured;
}

static void print_young(table *t, const char *name, const double d[3])
{
  char line[64];
  double value[3] = {0};
  for (int k = t->answer->wanted == NULL; k < 3; k++) value[k] = vsc_young(compliance(t, k), d);
  snprintf(line, sizeof line, "Young %s", name);
  print_line(t, line, value, false);
}

// Shear moduli and Poisson's ratios of the axes a and b.
static void print_pair(const table *t, int a, int b, bool shear)
{
  const vsc_named_direction d = vsc_direction(a), e = vsc_direction(b);
  char line[64];
  double value[3] = {0};
  for (int k = t->answer->wanted == NULL; k < 3; k++)
    value[k] =
        shear ? vsc_shear(compliance(t, k), d.d, e.d) : vsc_poisson(compliance(t, k), d.d, e.d);
  snprintf(line, sizeof line, "%s %s%s", shear ? "shear" : "Poisson", d.name, e.name);
  print_line(t, line, value, !shear);
}

static void print_head(const table *t)
{
  const bool wanted = t->answer->wanted != NULL;
  fprintf(t->stream, "%s  %-30s", t->prefix, "moduli in kPa");
  if (wanted) fprintf(t->stream, " %10s", "wanted");
  fprintf(t->stream, " %10s %10s  %s\n", "springs", "measured",
          wanted ? "springs - wanted" : "measured - springs");
}

static void print_random(table *t, int count)
{
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  for (int k = 0; random != NULL && k < count; k++) {
    char name[48];
    double d[3];
    gsl_ran_dir_3d(random, &d[0], &d[1], &d[2]);
    snprintf(name, sizeof name, "%.3f,%.3f,%.3f", d[0], d[1], d[2]);
    print_young(t, name, d);
  }
  gsl_rng_free(random);
}

// A direction without sign: its largest component is positive.
static void print_direction(const table *t, const double d[3])
{
  int largest = 0;
  for (int i = 1; i < 3; i++)
    if (fabs(d[i]) > 1.001 * fabs(d[largest])) largest = i;
  const double sign = d[largest] < 0 ? -1 : 1;
  for (int i = 0; i < 3; i++)
    fprintf(t->stream, "%s%.2f", i == 0 ? "(" : ", ", fabs(d[i]) < 0.005 ? 0.0 : sign * d[i]);
  fputc(')', t->stream);
}

static void print_range(const table *t)
{
  vsc_young_range range[3] = {0};
  for (int k = t->answer->wanted == NULL; k < 3; k++)
    range[k] = vsc_young_over_sphere(compliance(t, k));
  print_line(t, "Young, least", (double[]){range[0].low, range[1].low, range[2].low}, false);
  print_line(t, "Young, mean", (double[]){range[0].mean, range[1].mean, range[2].mean}, false);
  print_line(t, "Young, largest", (double[]){range[0].high, range[1].high, range[2].high}, false);
  const double ratio = range[1].high / range[1].low;
  if (ratio < 1 + 1e-9) {
    fprintf(t->stream, "%s  the springs are alike in all directions\n", t->prefix);
    return;
  }
  fprintf(t->stream, "%s  the springs are %.3g times as stiff along ", t->prefix, ratio);
  print_direction(t, range[1].high_direction);
  fputs(" as along ", t->stream);
  print_direction(t, range[1].low_direction);
  fputc('\n', t->stream);
}

void vsc_print_table(FILE *stream, const char *prefix, const vsc_answer *answer, int random)
{
  table t = {.stream = stream, .prefix = prefix, .answer = answer};
  print_head(&t);
  for (int k = 0; k < VSC_DIRECTIONS; k++) {
    const vsc_named_direction direction = vsc_direction(k);
    print_young(&t, direction.name, direction.d);
  }
  print_random(&t, random);
  for (int a = 0; a < 3; a++) print_pair(&t, a, (a + 1) % 3, true);
  for (int a = 0; a < 3; a++) {
    print_pair(&t, a, (a + 1) % 3, false);
    print_pair(&t, (a + 1) % 3, a, false);
  }
  print_range(&t);
}

// ---- the material

void vsc_print_material(FILE *stream, const vsc_material_def *material)
{
  const double *E = material->axial, *G = material->angular;
  fprintf(stream,
          "  - name: tissue\n"
          "    axial: {f: %.7g kPa, s: %.7g kPa, n: %.7g kPa}\n"
          "    angular: {fs: %.7g kPa, sn: %.7g kPa, nf: %.7g kPa}\n"
          "    volume_modulus: %.7g kPa\n",
          E[0], E[1], E[2], G[0], G[1], G[2], material->volume_modulus);
  if (material->axis_count > 0) fputs("    axes:\n", stream);
  for (size_t k = 0; k < material->axis_count; k++) {
    const vsc_axis_def *axis = &material->axes[k];
    fprintf(stream, "      - {direction: [%g, %g, %g], modulus: %.7g kPa}\n", axis->direction[0],
            axis->direction[1], axis->direction[2], axis->modulus);
  }
}

// ---- the curves

static void write_point(FILE *stream, const vsc_answer *answer, int plane, int degrees)
{
  enum { MEASURED_EVERY = 15 };
  double d[3] = {0};
  d[plane] = cos(degrees * M_PI / 180);
  d[(plane + 1) % 3] = sin(degrees * M_PI / 180);
  fprintf(stream, "%d,%d,%.9g,%.9g,%.9g\n", plane, degrees,
          answer->wanted != NULL ? vsc_young(answer->wanted, d) : NAN,
          vsc_young(answer->springs, d),
          degrees % MEASURED_EVERY == 0 ? vsc_young(answer->measured, d) : NAN);
}

vsc_status vsc_write_polar(const char *file, const vsc_answer *answer, vsc_error *error)
{
  vsc_replacement table;
  const vsc_status status = vsc_replace_begin(file, &table, error);
  if (status != VSC_OK) return status;
  fputs("plane,angle [degrees],wanted [kPa],springs [kPa],measured [kPa]\n", table.stream);
  for (int plane = 0; plane < 3; plane++)
    for (int degrees = 0; degrees <= 360; degrees++) write_point(table.stream, answer, plane, degrees);
  return vsc_replace_end(&table, false, error);
}
