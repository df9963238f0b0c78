// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera info`: what a file holds, in some twenty lines.
#include <getopt.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "io/hdf5.h"
#include "io/pvd.h"
#include "io/scene.h"
#include "io/vtk.h"
#include "mesh/quality.h"
#include "mesh/select.h"
#include "model/law_constants.h"
#include "tools/verbs.h"

static void print_help(void)
{
  puts(
      "Usage: viscera info FILE...\n"
      "Says what each file holds: counts, box, arrays with their ranges, quality.\n\n"
      "  .vtu .vtk   an unstructured grid      .vti   an image\n"
      "  .pvd        a series of frames        .h5    a checkpoint\n"
      "  .yaml .yml  a scene\n\n"
      "Lengths are in the file's own unit.\n\n"
      "  -h, --help  this text\n\n"
      "Examples:\n"
      "  viscera info heart.vtu\n"
      "  viscera info beat/beat.pvd beat/checkpoint.h5");
}

static const char *extension(const char *file)
{
  const char *dot = strrchr(file, '.');
  return dot == NULL ? "" : dot + 1;
}

static void print_range(const vsc_array *array)
{
  double low = INFINITY, high = -INFINITY;
  size_t strange = 0;
  for (size_t t = 0; t < array->tuples; t++) {
    const double *tuple = array->values + t * (size_t)array->components;
    double value = tuple[0];
    if (array->components == 3) value = vsc_norm(tuple);
    if (!isfinite(value)) {
      strange++;
      continue;
    }
    low = fmin(low, value);
    high = fmax(high, value);
  }
  printf("    %-20s", array->name);
  if (array->tuples == 0)
    printf(" empty");
  else if (strange == array->tuples)
    printf(" no finite number");
  else if (array->components == 1)
    printf(" %g to %g", low, high);
  else if (array->components == 3)
    printf(" 3 components, length %g to %g", low, high);
  else
    printf(" %d components, the first %g to %g", array->components, low, high);
  if (strange > 0 && strange < array->tuples) printf(", %zu NOT FINITE", strange);
  putchar('\n');
}

static void print_arrays(const char *where, const vsc_arrays *arrays)
{
  if (arrays->count == 0) return;
  printf("  arrays on %s\n", where);
  for (size_t a = 0; a < arrays->count; a++) print_range(&arrays->items[a]);
}

static void print_box(const double low[3], const double high[3])
{
  printf("  box                    (%g, %g, %g) to (%g, %g, %g), size %g x %g x %g\n", low[0],
         low[1], low[2], high[0], high[1], high[2], high[0] - low[0], high[1] - low[1],
         high[2] - low[2]);
}

static void print_quality(const vsc_mesh *mesh)
{
  vsc_quality_summary q;
  if (vsc_mesh_quality(mesh, &q, NULL) != VSC_OK) return;
  const double *at = q.worst_centre[0];
  printf("  volume                 %g\n", q.volume);
  printf("  edges                  %g to %g\n", q.shortest_edge, q.longest_edge);
  printf("  quality of shape       mean %.3f, worst %.3f (cell %u at %g, %g, %g), %zu below 0.2\n",
         q.shape_mean, q.worst[0].shape, q.worst_source[0], at[0], at[1], at[2], q.poor);
  printf("  angles between faces   %.1f to %.1f degrees\n", q.min_dihedral, q.max_dihedral);
}

static void print_mesh(const vsc_mesh *mesh)
{
  const vsc_mesh_report *report = &mesh->report;
  printf("  points                 %zu", report->file_nodes);
  if (report->unused_nodes > 0) printf(", %zu of them on no element", report->unused_nodes);
  char kinds[128];
  printf("\n  cells                  %zu: %s, %zu triangles", report->file_cells,
         vsc_mesh_kinds_text(mesh, kinds, sizeof kinds),
         mesh->triangle_count + report->loose_triangles);
  if (report->ignored_cells > 0)
    printf(", %zu others (%s)", report->ignored_cells, report->ignored_kinds);
  putchar('\n');
  if (report->turned_elements > 0)
    printf("  left-handed elements   %zu, turned when read\n", report->turned_elements);
  if (report->loose_triangles > 0)
    printf("  loose triangles        %zu\n", report->loose_triangles);
  double low[3], high[3];
  vsc_mesh_box(mesh, low, high);
  print_box(low, high);
  vsc_surface boundary = {0};
  if (vsc_boundary(mesh, &boundary, NULL) == VSC_OK) {
    printf("  boundary triangles     %zu\n", boundary.count);
    vsc_surface_free(&boundary);
  }
  if (mesh->element_count > 0) print_quality(mesh);
  print_arrays("points", &mesh->node_data);
  if (mesh->element_count > 0) print_arrays("elements", &mesh->element_data);
  print_arrays("triangles", &mesh->triangle_data);
}

static vsc_status info_mesh(const char *file, vsc_error *error)
{
  vsc_mesh *mesh = NULL;
  const vsc_status status = vsc_vtk_read_mesh(file, 1, &mesh, error);
  if (status != VSC_OK) return status;
  printf("%s: an unstructured grid\n", file);
  print_mesh(mesh);
  vsc_mesh_free(mesh);
  return VSC_OK;
}

static vsc_status info_image(const char *file, vsc_error *error)
{
  vsc_image *image = NULL;
  const vsc_status status = vsc_vtk_read_image(file, 1, &image, error);
  if (status != VSC_OK) return status;
  const double *d = image->direction;
  printf("%s: an image\n", file);
  printf("  points                 %zu x %zu x %zu\n", image->size[0], image->size[1],
         image->size[2]);
  printf("  origin                 %g, %g, %g\n", image->origin[0], image->origin[1],
         image->origin[2]);
  printf("  spacing                %g, %g, %g\n", image->spacing[0], image->spacing[1],
         image->spacing[2]);
  printf("  i, j, k run along      (%g, %g, %g), (%g, %g, %g), (%g, %g, %g)\n", d[0], d[3], d[6],
         d[1], d[4], d[7], d[2], d[5], d[8]);
  print_arrays("points", &image->data);
  print_arrays("cells", &image->cell_data);
  vsc_image_free(image);
  return VSC_OK;
}

static vsc_status info_series(const char *file, vsc_error *error)
{
  if (access(file, R_OK) != 0) return vsc_fail(error, VSC_INPUT, "%s: no such file", file);
  vsc_pvd *series = NULL;
  vsc_status status = vsc_pvd_open(file, INFINITY, &series, error);
  if (status != VSC_OK) return status;
  const size_t frames = vsc_pvd_count(series);
  char path[2 * VSC_PATH];
  printf("%s: a series\n", file);
  printf("  frames                 %zu\n", frames);
  if (frames > 0) {
    printf("  times                  %g s to %g s\n", vsc_pvd_time(series, 0),
           vsc_pvd_time(series, frames - 1));
    printf("  frame files            %s to %s\n", vsc_pvd_frame(series, 0),
           vsc_pvd_frame(series, frames - 1));
  }
  size_t missing = 0;
  for (size_t f = 0; f < frames; f++) {
    vsc_pvd_frame_path(file, series, f, path, sizeof path);
    if (access(path, R_OK) == 0) continue;
    if (missing++ < 5) printf("  MISSING                %s\n", vsc_pvd_frame(series, f));
  }
  if (missing > 5) printf("  MISSING                %zu more\n", missing - 5);
  if (frames > missing) {
    vsc_pvd_frame_path(file, series, frames - 1, path, sizeof path);
    printf("the last frame, ");
    status = info_mesh(path, error);
  }
  vsc_pvd_free(series);
  return status;
}

static vsc_status info_checkpoint(const char *file, vsc_error *error)
{
  if (access(file, R_OK) != 0) return vsc_fail(error, VSC_INPUT, "%s: no such file", file);
  printf("%s: an HDF5 file\n", file);
  return vsc_hdf5_contents(file, stdout, error);
}

static const char *fiber_source_text(const vsc_fiber_def *fibers)
{
  switch (fibers->source) {
    case VSC_FIBER_NONE:
      return "none: all tissue is passive";
    case VSC_FIBER_MAP:
      return "the voxel map";
    case VSC_FIBER_CONSTANT:
      return "one direction everywhere";
    case VSC_FIBER_ARRAYS:
      return "arrays of the mesh";
    case VSC_FIBER_HELIX:
      return "a transmural helix";
    case VSC_FIBER_ELLIPSOID:
      return "a transmural helix between ellipsoids";
    default:
      return "a synthetic field";
  }
}

// The law's constants in a line.
static void print_law(const vsc_material_def *m)
{
  vsc_law_constant constants[VSC_MOST_CONSTANTS];
  const size_t count = vsc_law_constants(m, constants);
  const vsc_paper_def *p = &m->paper;
  if (m->law == VSC_LAW_SPRINGS)
    printf("springs, axial %g, %g, %g, angular %g, %g, %g kPa", m->axial[0], m->axial[1], m->axial[2],
           m->angular[0], m->angular[1], m->angular[2]);
  else if (m->law == VSC_LAW_PAPER)
    printf("law paper, axial %g, %g, %g mN/mm, angular %g, %g, %g mN", p->axial[0], p->axial[1],
           p->axial[2], p->angular[0], p->angular[1], p->angular[2]);
  else if (m->law == VSC_LAW_CLASSICAL)
    printf("law classical, %g mN/mm", m->classical.stiffness);
  const int law = count > 0 ? (int)strcspn(constants[0].key, ".") : 0;
  if (count > 0) printf("law %.*s", law, constants[0].key);
  for (size_t k = 0; k < count; k++)
    printf(", %s %g%s%s", constants[k].key + law + 1, constants[k].value,
           constants[k].unit[0] != '\0' ? " " : "", constants[k].unit);
}

static vsc_status info_scene(const char *file, vsc_error *error)
{
  vsc_scene *scene = NULL;
  const vsc_status status = vsc_scene_read(file, NULL, 0, &scene, error);
  if (status != VSC_OK) return status;
  const vsc_definition *definition = &scene->definition;
  printf("%s: a scene\n", file);
  printf("  mesh                   %s, %g mm per unit\n", scene->mesh_file, scene->mesh_unit);
  const bool map = scene->fibers.source == VSC_FIBER_MAP;
  printf("  fibres                 %s%s%s\n", fiber_source_text(&scene->fibers), map ? " " : "",
         map ? scene->fibers.map.file : "");
  for (size_t m = 0; m < definition->material_count; m++) {
    const vsc_material_def *material = &definition->materials[m];
    printf("  material               %s: ", material->name);
    print_law(material);
    puts(material->active.kind == VSC_ACTIVE_NONE ? "; passive" : "; active");
  }
  for (size_t s = 0; s < definition->surface_count; s++)
    printf("  surface                %s\n", definition->surfaces[s].name);
  for (size_t s = 0; s < definition->set_count; s++)
    printf("  node set               %s\n", definition->sets[s].name);
  for (size_t s = 0; s < definition->support_count; s++)
    printf("  support                %s\n", definition->supports[s].set);
  for (size_t r = 0; r < definition->robin_count; r++)
    printf("  springs on             %s, %g kPa/mm, %g kPa ms/mm\n", definition->robins[r].surface,
           definition->robins[r].stiffness, definition->robins[r].damping);
  for (size_t p = 0; p < definition->pressure_count; p++)
    printf("  pressure               %s, peak %g kPa\n", definition->pressures[p].surface,
           definition->pressures[p].peak);
  printf("  simulated time         %g s, a frame every %g ms\n", definition->end_time / 1000,
         scene->output.frame_interval);
  puts("  `viscera check` says what it would do");
  vsc_scene_free(scene);
  return VSC_OK;
}

typedef struct file_kind {
  const char *extension;
  vsc_status (*print)(const char *file, vsc_error *error);
} file_kind;

static vsc_status info(const char *file, vsc_error *error)
{
  static const file_kind kinds[] = {{"vtu", info_mesh},      {"vtk", info_mesh},
                                    {"vti", info_image},     {"pvd", info_series},
                                    {"h5", info_checkpoint}, {"hdf5", info_checkpoint},
                                    {"yaml", info_scene},    {"yml", info_scene}};
  for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++)
    if (strcasecmp(extension(file), kinds[k].extension) == 0) return kinds[k].print(file, error);
  return vsc_fail(error, VSC_INPUT, "%s: known kinds of files end in .vtu .vtk .vti .pvd .h5 .yaml",
                  file);
}

int vsc_verb_info(int argc, char **argv)
{
  static const struct option options[] = {{"help", no_argument, NULL, 'h'}, {0}};
  for (int option; (option = getopt_long(argc, argv, "h", options, NULL)) != -1;) {
    if (option != 'h') return VSC_INPUT;
    print_help();
    return VSC_OK;
  }
  if (optind == argc) {
    fputs("viscera: info: which file? `viscera info --help` tells more\n", stderr);
    return VSC_INPUT;
  }
  int code = VSC_OK;
  for (int a = optind; a < argc; a++) {
    vsc_error error;
    if (a > optind) putchar('\n');
    const vsc_status status = info(argv[a], &error);
    if (status == VSC_OK) continue;
    fflush(stdout);
    fprintf(stderr, "viscera: %s\n", error.text);
    code = status;
  }
  return code;
}
