// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera generate`: the meshes and angle maps that ship with viscera, and others like them.
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/mem.h"
#include "io/vtk.h"
#include "io/vtk_polydata.h"
#include "mesh/surface.h"
#include "tools/generate_options.h"
#include "tools/shapes_cloud.h"
#include "tools/verbs.h"

static bool is_whole(const vsc_array *array)
{
  for (size_t k = 0; k < array->tuples * (size_t)array->components; k++)
    if (array->values[k] != floor(array->values[k])) return false;
  return true;
}

// Writes a mesh with all its arrays, whole numbers as integers.
static vsc_status write_mesh(const char *file, const vsc_mesh *mesh, vsc_error *error)
{
  const vsc_arrays *lists[] = {&mesh->node_data, &mesh->element_data, &mesh->triangle_data};
  const vsc_vtk_place places[] = {VSC_ON_NODES, VSC_ON_ELEMENTS, VSC_ON_TRIANGLES};
  vsc_vtk_array *arrays;
  size_t count = 0;
  if (!VSC_NEW(arrays, lists[0]->count + lists[1]->count + lists[2]->count))
    return vsc_fail_memory(error, "the mesh's arrays");
  for (int l = 0; l < 3; l++)
    for (size_t a = 0; a < lists[l]->count; a++)
      arrays[count++] = (vsc_vtk_array){.name = lists[l]->items[a].name,
                                        .components = lists[l]->items[a].components,
                                        .values = lists[l]->items[a].values,
                                        .place = places[l],
                                        .integer = is_whole(&lists[l]->items[a])};
  const vsc_status status = vsc_vtk_write_mesh(file, mesh, count, arrays, false, error);
  vsc_free(arrays);
  return status;
}

static double mesh_volume(const vsc_mesh *mesh)
{
  double volume = 0;
  for (size_t e = 0; e < mesh->element_count; e++) volume += vsc_mesh_element_volume(mesh, e);
  return volume;
}

// What the endocardium encloses with its mouth capped, mm^3.
static vsc_status measure_cavity(const vsc_mesh *mesh, double *volume, vsc_error *error)
{
  const vsc_selector endo = {.kind = VSC_SELECT_NODE_ARRAY, .array = "endo", .low = 1, .high = 1};
  vsc_surface boundary = {.count = 0}, inside = {.count = 0};
  vsc_cavity cavity = {.rim_count = 0};
  vsc_status status = vsc_boundary(mesh, &boundary, error);
  if (status == VSC_OK) status = vsc_select_surface(mesh, &boundary, &endo, &inside, error);
  if (status == VSC_OK) status = vsc_cavity_make(&inside, mesh->node_count, &cavity, error);
  if (status == VSC_OK) *volume = vsc_cavity_volume(&cavity, mesh->nodes, 3);
  vsc_cavity_free(&cavity);
  vsc_surface_free(&inside);
  vsc_surface_free(&boundary);
  return status;
}

static vsc_status generate_lv(const vsc_generate_wish *wish, const char *file, vsc_error *error)
{
  vsc_mesh *mesh = NULL;
  double cavity = 0;
  vsc_status status = vsc_lv_mesh(&wish->lv, &mesh, error);
  if (status == VSC_OK) status = measure_cavity(mesh, &cavity, error);
  if (status == VSC_OK) status = write_mesh(file, mesh, error);
  if (status == VSC_OK)
    printf("%s: %zu nodes, %zu elements, wall %.1f ml, cavity %.1f ml\n", file, mesh->node_count,
           mesh->element_count, mesh_volume(mesh) / 1000, cavity / 1000);
  vsc_mesh_free(mesh);
  return status;
}

static vsc_status generate_map(const vsc_generate_wish *wish, const char *file, vsc_error *error)
{
  const double degree = M_PI / 180, wall = wish->lv.epi_radius - wish->lv.endo_radius;
  const double spacing = wish->spacing > 0 ? wish->spacing : wall / 4;
  vsc_image *image = NULL;
  vsc_status status = vsc_lv_map(&wish->lv, wish->endo_angle * degree, wish->epi_angle * degree,
                                 spacing, &image, error);
  if (status == VSC_OK) status = vsc_vtk_write_image(file, image, error);
  if (status == VSC_OK)
    printf("%s: %zu x %zu x %zu voxels of %g mm\n", file, image->size[0], image->size[1],
           image->size[2], spacing);
  vsc_image_free(image);
  return status;
}

static vsc_status finish_solid(const char *file, vsc_status status, vsc_mesh *mesh, vsc_error *error)
{
  if (status == VSC_OK) status = write_mesh(file, mesh, error);
  if (status == VSC_OK)
    printf("%s: %zu nodes, %zu elements, %g mm3\n", file, mesh->node_count, mesh->element_count,
           mesh_volume(mesh));
  vsc_mesh_free(mesh);
  return status;
}

static vsc_status generate_block(const vsc_generate_wish *wish, const char *file, vsc_error *error)
{
  vsc_mesh *mesh = NULL;
  vsc_cloud_shape cloud = vsc_cloud_default();
  memcpy(cloud.size, wish->block.size, sizeof cloud.size);
  cloud.seed = wish->block.seed;
  if (wish->points > 0) cloud.points = wish->points;
  const vsc_status status = wish->unstructured
                                ? vsc_cloud_mesh(&cloud, &mesh, error)
                                : vsc_block_of(&wish->block, wish->lv.element, &mesh, error);
  return finish_solid(file, status, mesh, error);
}

static double mesh_area(const vsc_mesh *mesh)
{
  const vsc_surface all = {.count = mesh->triangle_count, .triangles = mesh->triangles};
  return vsc_surface_area(&all, mesh->nodes, 3);
}

static vsc_status finish_surface(const char *file, vsc_status status, vsc_mesh *mesh,
                                 vsc_error *error)
{
  if (status == VSC_OK) status = write_mesh(file, mesh, error);
  if (status == VSC_OK)
    printf("%s: %zu nodes, %zu triangles, %g mm2\n", file, mesh->node_count, mesh->triangle_count,
           mesh_area(mesh));
  vsc_mesh_free(mesh);
  return status;
}

static vsc_status generate_sheet(const vsc_generate_wish *wish, const char *file, vsc_error *error)
{
  vsc_sheet_shape sheet = vsc_sheet_default();
  vsc_mesh *mesh = NULL;
  for (int a = 0; a < 2; a++) {
    if (wish->cell_numbers > 0) sheet.cells[a] = wish->block.cells[a];
    if (wish->size_numbers > 0) sheet.size[a] = wish->block.size[a];
  }
  sheet.jitter = wish->block.jitter;
  sheet.seed = wish->block.seed;
  const vsc_status status = vsc_sheet_mesh(&sheet, &mesh, error);
  return finish_surface(file, status, mesh, error);
}

static vsc_status generate_tube(const vsc_generate_wish *wish, const char *file, vsc_error *error)
{
  vsc_mesh *mesh = NULL;
  const vsc_status status = vsc_tube_mesh(&wish->tube, &mesh, error);
  return finish_surface(file, status, mesh, error);
}

static vsc_status generate_liver(const vsc_generate_wish *wish, const char *file, vsc_error *error)
{
  vsc_mesh *mesh = NULL;
  vsc_status status = vsc_liver_mesh(wish->bricks, &mesh, error);
  if (status == VSC_OK) status = write_mesh(file, mesh, error);
  if (status == VSC_OK)
    printf("%s: %zu nodes, %zu tets, %.1f ml\n", file, mesh->node_count, mesh->element_count,
           mesh_volume(mesh) / 1000);
  vsc_mesh_free(mesh);
  return status;
}

static vsc_status generate_cook(const vsc_generate_wish *wish, const char *file, vsc_error *error)
{
  vsc_panel_shape panel = vsc_panel_default();
  vsc_mesh *mesh = NULL;
  if (wish->cell_numbers > 0) memcpy(panel.cells, wish->block.cells, sizeof panel.cells);
  if (wish->thickness > 0) panel.thickness = wish->thickness;
  panel.tets_per_cell = wish->block.tets_per_cell;
  panel.element = wish->lv.element;
  const vsc_status status = vsc_panel_mesh(&panel, &mesh, error);
  return finish_solid(file, status, mesh, error);
}

static vsc_status generate_column(const vsc_generate_wish *wish, const char *file, vsc_error *error)
{
  vsc_column_shape column = vsc_column_default();
  vsc_mesh *mesh = NULL;
  if (wish->cell_numbers > 0) memcpy(column.block.cells, wish->block.cells, sizeof column.block.cells);
  if (wish->size_numbers > 0) memcpy(column.block.size, wish->block.size, sizeof column.block.size);
  column.block.tets_per_cell = wish->block.tets_per_cell;
  column.element = wish->lv.element;
  column.bend = wish->bend;
  column.twist = wish->twist;
  const vsc_status status = vsc_column_mesh(&column, &mesh, error);
  return finish_solid(file, status, mesh, error);
}

static vsc_status generate_cylinder(const vsc_generate_wish *wish, const char *file, vsc_error *error)
{
  vsc_mesh *mesh = NULL;
  const vsc_status status = vsc_cylinder_mesh(&wish->shell, &mesh, error);
  return finish_solid(file, status, mesh, error);
}

static vsc_status generate_octant(const vsc_generate_wish *wish, const char *file, vsc_error *error)
{
  vsc_mesh *mesh = NULL;
  const vsc_status status = vsc_octant_mesh(&wish->shell, &mesh, error);
  return finish_solid(file, status, mesh, error);
}

static vsc_status generate_vessels(const vsc_generate_wish *wish, const char *file, vsc_error *error)
{
  vsc_polydata *tree = NULL;
  vsc_status status = vsc_liver_vessels(wish->tree, &tree, error);
  if (status == VSC_OK) status = vsc_vtk_write_polydata(file, tree, error);
  if (status == VSC_OK)
    printf("%s: %zu points, %zu segments\n", file, tree->point_count, tree->segment_count);
  vsc_polydata_free(tree);
  return status;
}

// Refuses a name whose ending is not that of `usual`: readers go by it.
static vsc_status check_ending(const char *shape, const char *file, const char *usual, vsc_error *error)
{
  const char *right = strrchr(usual, '.'), *name = strrchr(file, '/'), *dot = strrchr(file, '.');
  if (dot == NULL || (name != NULL && dot < name)) dot = file + strlen(file);
  if (strcasecmp(dot, right) == 0) return VSC_OK;
  return vsc_fail(error, VSC_INPUT, "-o %s: what %s makes is a %s: call it %.*s%s", file, shape, right,
                  (int)(dot - file), file, right);
}

static vsc_status generate(const vsc_generate_wish *wish, vsc_error *error)
{
  static const struct {
    const char *name, *file;
    vsc_status (*make)(const vsc_generate_wish *wish, const char *file, vsc_error *error);
  } shapes[] = {{"lv", "lv.vtu", generate_lv},
                {"map", "lv_angles.vti", generate_map},
                {"block", "block.vtu", generate_block},
                {"sheet", "sheet.vtu", generate_sheet},
                {"tube", "tube.vtu", generate_tube},
                {"cook", "cook.vtu", generate_cook},
                {"column", "column.vtu", generate_column},
                {"cylinder", "cylinder.vtu", generate_cylinder},
                {"octant", "octant.vtu", generate_octant},
                {"liver", "liver.vtu", generate_liver},
                {"vessels", "vessels.vtp", generate_vessels}};
  const int numbers = strcmp(wish->shape, "sheet") == 0 ? 2 : 3;
  if ((wish->cell_numbers > 0 && wish->cell_numbers != numbers) ||
      (wish->size_numbers > 0 && wish->size_numbers != numbers))
    return vsc_fail(error, VSC_INPUT, "--cells and --size of a %s want %d numbers", wish->shape,
                    numbers);
  if (vsc_generate_check(wish, error) != VSC_OK) return error->status;
  for (size_t k = 0; k < sizeof shapes / sizeof shapes[0]; k++) {
    if (strcmp(wish->shape, shapes[k].name) != 0) continue;
    const char *file = wish->file != NULL ? wish->file : shapes[k].file;
    if (check_ending(wish->shape, file, shapes[k].file, error) != VSC_OK) return error->status;
    return shapes[k].make(wish, file, error);
  }
  return vsc_fail(error, VSC_INPUT, "unknown shape '%s', must be lv, map, block, sheet, tube, cook, "
                  "column, cylinder, octant, liver or vessels",
                  wish->shape);
}

// Takes in --like alone, or the other options, which change it wherever they stand. False, with a message, for what does
// not fit.
static bool read_options(int argc, char **argv, bool like, vsc_generate_wish *wish, bool *help)
{
  int option, index = 0;
  optind = 0;
  while (!*help && (option = getopt_long(argc, argv, "o:h", vsc_generate_options, &index)) != -1) {
    if (option == '?') return false;
    if (option == 'h') *help = true;
    if (option == 'o') wish->file = optarg;
    if (option == 'h' || option == 'o' || like != (strcmp(vsc_generate_options[index].name, "like") == 0)) continue;
    if (vsc_generate_option(wish, option, optarg)) continue;
    fprintf(stderr, "viscera generate: --%s '%s' does not fit, see `viscera generate --help`\n",
            vsc_generate_options[index].name, optarg);
    return false;
  }
  return true;
}

int vsc_verb_generate(int argc, char **argv)
{
  vsc_generate_wish wish = {.lv = vsc_lv_default(),
                            .block = vsc_block_default(),
                            .tube = vsc_tube_default(),
                            .shell = vsc_shell_default(),
                            .endo_angle = 60,
                            .epi_angle = -60,
                            .bricks = 10};
  bool help = false;
  if (!read_options(argc, argv, true, &wish, &help) || !read_options(argc, argv, false, &wish, &help)) return VSC_INPUT;
  if (help) {
    vsc_generate_help();
    return VSC_OK;
  }
  if (optind + 1 != argc) {
    fprintf(stderr,
            "viscera generate: say one shape: lv, map, block, sheet, tube, cook, column, cylinder, "
            "octant, liver or vessels, see `viscera generate --help`\n");
    return VSC_INPUT;
  }
  wish.shape = argv[optind];
  vsc_error error;
  const vsc_status status = generate(&wish, &error);
  if (status != VSC_OK) fprintf(stderr, "viscera generate: %s\n", error.text);
  return status;
}
