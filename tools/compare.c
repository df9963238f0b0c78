// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera compare`: how far apart two meshes or two series are, array by array.
#include <getopt.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "io/pvd.h"
#include "io/vtk.h"
#include "tools/verbs.h"

enum { DIFFERENT = 1, PATH = 4096 };
static const double SAME_TIME = 1e-9;  // s

// The differences d = a - b of one array, summed up over all its values and frames:
// RMS = sqrt(sum d^2 / n), relative L2 = sqrt(sum d^2) / sqrt(sum b^2).
typedef struct norms {
  char name[VSC_NAME];
  const char *where;  // "points", "elements" or "triangles"
  double largest;     // max |d|
  double squares;     // sum d^2
  double reference;   // sum b^2
  size_t values;      // n
} norms;

typedef struct comparison {
  size_t count, room;
  norms *arrays;   // room, owned; count used
  char note[512];  // arrays that only one side has
} comparison;

static void print_help(void)
{
  puts(
      "Usage: viscera compare [OPTION]... A B\n"
      "Error norms of the arrays that A and B have in common: two meshes (.vtu, .vtk) or\n"
      "two series (.pvd), of which the frames at equal times are compared.\n\n"
      "  max abs      largest |a - b|\n"
      "  RMS          root of the mean of (a - b)^2\n"
      "  relative L2  |a - b|_2 / |b|_2: B is the reference\n\n"
      "  -t, --tolerance X  exit code 1 when a relative L2 is above X, or when a frame of one\n"
      "                     series is missing in the other; else 0\n"
      "  -h, --help         this text\n\n"
      "Meshes with different counts can't be compared: exit code 2.\n\n"
      "Examples:\n"
      "  viscera compare old/beat.pvd new/beat.pvd\n"
      "  viscera compare --tolerance 1e-6 result.vtu reference.vtu");
}

static norms *find_or_add(comparison *all, const char *name, const char *where)
{
  for (size_t k = 0; k < all->count; k++)
    if (strcmp(all->arrays[k].name, name) == 0 && strcmp(all->arrays[k].where, where) == 0)
      return &all->arrays[k];
  if (all->count == all->room) {
    const size_t more = 2 * all->room + 16;
    if (!vsc_grow((void **)&all->arrays, all->room, more, sizeof *all->arrays)) return NULL;
    all->room = more;
  }
  norms *added = &all->arrays[all->count++];
  *added = (norms){.where = where};
  vsc_copy_name(added->name, name);
  return added;
}

// A value that is not a number on one side only is an infinite difference.
static double difference(double a, double b)
{
  if (a == b || (isnan(a) && isnan(b))) return 0;
  const double d = fabs(a - b);
  return isnan(d) ? INFINITY : d;
}

static vsc_status add(comparison *all, const char *name, const char *where, size_t count,
                      const double *a, const double *b, vsc_error *error)
{
  norms *n = find_or_add(all, name, where);
  if (n == NULL) return vsc_fail_memory(error, "the comparison");
  for (size_t i = 0; i < count; i++) {
    const double d = difference(a[i], b[i]);
    n->largest = fmax(n->largest, d);
    n->squares += d * d;
    if (isfinite(b[i])) n->reference += b[i] * b[i];
  }
  n->values += count;
  return VSC_OK;
}

static void note(comparison *all, const char *name, const char *why)
{
  const size_t used = strlen(all->note);
  char text[2 * VSC_NAME];
  snprintf(text, sizeof text, "%s (%s)", name, why);
  if (strstr(all->note, text) != NULL) return;
  snprintf(all->note + used, sizeof all->note - used, "%s%s", used > 0 ? ", " : "", text);
}

static vsc_status add_arrays(comparison *all, const char *where, const vsc_arrays *a,
                             const vsc_arrays *b, vsc_error *error)
{
  for (size_t k = 0; k < a->count; k++) {
    const vsc_array *first = &a->items[k];
    const vsc_array *second = vsc_arrays_find(b, first->name);
    if (second == NULL) {
      note(all, first->name, "only in A");
    } else if (second->components != first->components) {
      note(all, first->name, "different numbers of components");
    } else {
      const size_t count = first->tuples * (size_t)first->components;
      if (add(all, first->name, where, count, first->values, second->values, error) != VSC_OK)
        return error->status;
    }
  }
  for (size_t k = 0; k < b->count; k++)
    if (vsc_arrays_find(a, b->items[k].name) == NULL) note(all, b->items[k].name, "only in B");
  return VSC_OK;
}

// Elements of the same kinds on the same points, or else the mesh is another one.
static bool same_corners(const vsc_mesh *a, const vsc_mesh *b)
{
  const size_t elements = a->element_count;
  return memcmp(a->kinds, b->kinds, elements * sizeof *a->kinds) == 0 &&
         memcmp(a->corners, b->corners, a->start[elements] * sizeof *a->corners) == 0;
}

static bool same_triangles(const vsc_mesh *a, const vsc_mesh *b)
{
  return a->triangle_count == b->triangle_count &&
         memcmp(a->triangles, b->triangles, 3 * a->triangle_count * sizeof *a->triangles) == 0;
}

static vsc_status add_meshes(comparison *all, const char *file_a, const char *file_b,
                             vsc_error *error)
{
  vsc_mesh *a = NULL, *b = NULL;
  vsc_status status = vsc_vtk_read_mesh(file_a, 1, &a, error);
  if (status == VSC_OK) status = vsc_vtk_read_mesh(file_b, 1, &b, error);
  if (status == VSC_OK && (a->node_count != b->node_count || a->element_count != b->element_count))
    status =
        vsc_fail(error, VSC_INPUT,
                 "%s has %zu points and %zu elements, %s has %zu and %zu: only results on the same "
                 "mesh can be compared",
                 file_a, a->node_count, a->element_count, file_b, b->node_count, b->element_count);
  if (status == VSC_OK && !same_corners(a, b))
    note(all, "elements", "joined to other points or in another order");
  const bool triangles = status == VSC_OK && same_triangles(a, b);
  if (status == VSC_OK && !triangles) note(all, "triangles", "not the same");
  if (status == VSC_OK)
    status = add(all, "(positions)", "points", 3 * a->node_count, a->nodes, b->nodes, error);
  if (status == VSC_OK) status = add_arrays(all, "points", &a->node_data, &b->node_data, error);
  if (status == VSC_OK && a->element_count > 0)
    status = add_arrays(all, "elements", &a->element_data, &b->element_data, error);
  if (status == VSC_OK && triangles)
    status = add_arrays(all, "triangles", &a->triangle_data, &b->triangle_data, error);
  vsc_mesh_free(a);
  vsc_mesh_free(b);
  return status;
}

static vsc_status open_series(const char *file, vsc_pvd **series, vsc_error *error)
{
  if (access(file, R_OK) != 0) return vsc_fail(error, VSC_INPUT, "%s: no such file", file);
  const vsc_status status = vsc_pvd_open(file, HUGE_VAL, series, error);
  if (status == VSC_OK && vsc_pvd_count(*series) == 0)
    return vsc_fail(error, VSC_INPUT, "%s: the series has no frames", file);
  return status;
}

// The frame of `series` at that time, or its number of frames.
static size_t frame_at(const vsc_pvd *series, double time)
{
  size_t frame = 0;
  while (frame < vsc_pvd_count(series) && fabs(vsc_pvd_time(series, frame) - time) > SAME_TIME)
    frame++;
  return frame;
}

static size_t print_missing(const vsc_pvd *have, const vsc_pvd *lack, const char *file)
{
  size_t missing = 0;
  for (size_t f = 0; f < vsc_pvd_count(have); f++) {
    if (frame_at(lack, vsc_pvd_time(have, f)) < vsc_pvd_count(lack)) continue;
    if (missing == 0) printf("times missing in %s [s]:", file);
    if (missing++ < 10) printf(" %g", vsc_pvd_time(have, f));
  }
  if (missing > 10) printf(" and %zu more", missing - 10);
  if (missing > 0) putchar('\n');
  return missing;
}

static vsc_status add_frames(comparison *all, const char *file_a, const vsc_pvd *a,
                             const char *file_b, const vsc_pvd *b, size_t *missing,
                             vsc_error *error)
{
  size_t common = 0;
  for (size_t f = 0; f < vsc_pvd_count(a); f++) {
    char path_a[PATH], path_b[PATH];
    const size_t other = frame_at(b, vsc_pvd_time(a, f));
    if (other == vsc_pvd_count(b)) continue;
    vsc_pvd_frame_path(file_a, a, f, path_a, sizeof path_a);
    vsc_pvd_frame_path(file_b, b, other, path_b, sizeof path_b);
    if (add_meshes(all, path_a, path_b, error) != VSC_OK) return error->status;
    common++;
  }
  if (common == 0)
    return vsc_fail(error, VSC_INPUT, "%s and %s have no frame at the same time", file_a, file_b);
  printf("frames at equal times: %zu\n", common);
  *missing = print_missing(b, a, file_a) + print_missing(a, b, file_b);
  return VSC_OK;
}

static vsc_status add_series(comparison *all, const char *file_a, const char *file_b,
                             size_t *missing, vsc_error *error)
{
  vsc_pvd *a = NULL, *b = NULL;
  vsc_status status = open_series(file_a, &a, error);
  if (status == VSC_OK) status = open_series(file_b, &b, error);
  if (status == VSC_OK) status = add_frames(all, file_a, a, file_b, b, missing, error);
  vsc_pvd_free(a);
  vsc_pvd_free(b);
  return status;
}

static double relative(const norms *n)
{
  if (n->squares == 0) return 0;
  return n->reference > 0 ? sqrt(n->squares / n->reference) : INFINITY;
}

static bool print_norms(const comparison *all, double tolerance)
{
  bool within = true;
  printf("%-24s %-7s %13s %13s %13s\n", "array", "on", "max abs", "RMS", "relative L2");
  for (size_t k = 0; k < all->count; k++) {
    const norms *n = &all->arrays[k];
    const double rms = n->values > 0 ? sqrt(n->squares / (double)n->values) : 0;
    const bool above = !(relative(n) <= tolerance);
    printf("%-24s %-7s %13.6g %13.6g %13.6g%s\n", n->name, n->where, n->largest, rms, relative(n),
           above ? "  above the tolerance" : "");
    within = within && !above;
  }
  if (all->note[0] != '\0') printf("not compared: %s\n", all->note);
  return within;
}

static bool is_series(const char *file)
{
  const size_t length = strlen(file);
  return length > 4 && strcmp(file + length - 4, ".pvd") == 0;
}

static int compare(const char *a, const char *b, double tolerance)
{
  vsc_error error;
  comparison all = {0};
  size_t missing = 0;
  vsc_status status;
  if (is_series(a) != is_series(b))
    status =
        vsc_fail(&error, VSC_INPUT, "%s is a series and %s is not: give two series or two meshes",
                 is_series(a) ? a : b, is_series(a) ? b : a);
  else if (is_series(a))
    status = add_series(&all, a, b, &missing, &error);
  else
    status = add_meshes(&all, a, b, &error);
  int code = status;
  if (status == VSC_OK) {
    const bool within = print_norms(&all, tolerance);
    if (!within || (missing > 0 && isfinite(tolerance))) code = DIFFERENT;
  } else {
    fflush(stdout);
    fprintf(stderr, "viscera: %s\n", error.text);
  }
  vsc_free(all.arrays);
  return code;
}

int vsc_verb_compare(int argc, char **argv)
{
  static const struct option options[] = {
      {"help", no_argument, NULL, 'h'}, {"tolerance", required_argument, NULL, 't'}, {0}};
  double tolerance = INFINITY;
  for (int option; (option = getopt_long(argc, argv, "ht:", options, NULL)) != -1;) {
    if (option == 'h') {
      print_help();
      return VSC_OK;
    }
    char *end = NULL;
    if (option == 't') tolerance = strtod(optarg, &end);
    if (option == 't' && end != optarg && *end == '\0' && tolerance >= 0) continue;
    if (option == 't')
      fprintf(stderr, "viscera: compare: --tolerance %s: expected a number >= 0\n", optarg);
    return VSC_INPUT;
  }
  if (argc - optind != 2) {
    fputs("viscera: compare: give two files, A and B; `viscera compare --help` tells more\n",
          stderr);
    return VSC_INPUT;
  }
  return compare(argv[optind], argv[optind + 1], tolerance);
}
