// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera generate`: the meshes and angle maps that ship with viscera, and others like them.
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "io/vtk.h"
#include "io/vtk_polydata.h"
#include "mesh/surface.h"
#include "tools/shapes.h"
#include "tools/shapes_block.h"
#include "tools/shapes_cloud.h"
#include "tools/shapes_liver.h"
#include "tools/shapes_sheet.h"
#include "tools/verbs.h"

typedef struct wish {
  const char *shape;
  const char *file;
  vsc_lv_shape lv;
  vsc_block_shape block;           // of a sheet, too: its first two numbers
  int cell_numbers, size_numbers;  // how many were given; 0: none
  vsc_tube_shape tube;
  vsc_block_kind element;
  bool unstructured;
  size_t points;                 // 0: the default
  size_t bricks;  // of a liver, along each side
  vsc_liver_tree tree;
  double endo_angle, epi_angle;  // degrees
  double spacing;                // mm; 0: a quarter of the wall
} wish;

static void print_help(void)
{
  puts(
      "Usage: viscera generate lv|map|block|sheet|tube|liver|vessels [OPTION]...\n"
      "Makes a mesh or an angle map by formulas. Lengths are mm, angles degrees.\n\n"
      "lv: a left ventricle between two half ellipsoids about z, apex at -z, cut by the plane\n"
      "z = base; node arrays endo, epi, base, rim (0 or 1), cell array region. With map: the\n"
      "azimuth/elevation image of its fibre helix; arrays azimuth, elevation, tissue.\n"
      "      --endo-radius=R --endo-length=L  the cavity at the equator, from there to the apex "
      "[26, 66]\n"
      "      --epi-radius=R --epi-length=L    the same for the outside [35.5, 73]\n"
      "      --base=Z                         the base plane above the equator [20]\n"
      "lv:   --around=N --along=N --layers=N  bricks of 5 tets: around (a multiple of 4), from the "
      "apical\n"
      "                                       patch to the base, through the wall [32, 14, 3]\n"
      "map:  --endo-angle=A --epi-angle=A     helix angles, positive is right-handed [60, -60]\n"
      "      --spacing=H                      edge of a voxel [a quarter of the wall]\n\n"
      "block: a box from the origin; node arrays x0 x1 y0 y1 z0 z1 (0 or 1), cell array region.\n"
      "      --cells=NX,NY,NZ                 bricks [4,4,4]\n"
      "      --size=X,Y,Z                     [10,10,10]\n"
      "      --tets=5|6                       tets of a brick [5]\n"
      "      --jitter=PART --seed=N           inner nodes moved by up to PART of a brick, 0 to 0.3 "
      "[0, 1]\n"
      "      --element=tet|hex|wedge|mixed    what becomes of the bricks [tet]\n"
      "      --unstructured                   instead of bricks, scattered points and their "
      "Delaunay "
      "tets\n"
      "      --points=N                       how many of them [400]\n\n"
      "sheet: a rectangle of triangles in the plane z = 0, from the origin; node arrays x0 x1 y0 "
      "y1.\n"
      "      --cells=NX,NY --size=X,Y         cells of two triangles each [20,20, 10,10]\n"
      "      --jitter=PART --seed=N           as above\n\n"
      "tube: the surface of a cylinder about z, from z = 0; node arrays z0 z1.\n"
      "      --radius=R --length=L            [10, 40]\n"
      "      --around=N --along=N             cells of two triangles each [32, 20]\n\n"
      "liver: a liver of human size; node arrays top, bottom, front, back, cell array region. With\n"
      "vessels: the centre lines of its vessels with their radii.\n"
      "      --bricks=N                       bricks of 5 tets along each side [10]\n"
      "      --tree=portal|hepatic            which tree [portal]\n\n"
      "  -o, --output=FILE                    [the shape's name with its ending]\n"
      "  -h, --help                           this text\n\n"
      "Examples:\n"
      "  viscera generate lv -o data/lv.vtu\n"
      "  viscera generate map --spacing 2.4 -o data/lv_angles.vti\n"
      "  viscera generate block --cells 8,4,4 --size 40,20,20 --jitter 0.2 -o block.vtu\n"
      "  viscera generate block --unstructured --points 222 --seed 3 -o scattered.vtu\n"
      "  viscera generate sheet --cells 40,10 --size 80,20 -o strip.vtu");
}

enum {
  ENDO_RADIUS = 256,
  ENDO_LENGTH,
  EPI_RADIUS,
  EPI_LENGTH,
  BASE,
  AROUND,
  ALONG,
  LAYERS,
  ENDO_ANGLE,
  EPI_ANGLE,
  SPACING,
  CELLS,
  SIZE,
  TETS,
  JITTER,
  SEED,
  ELEMENT,
  UNSTRUCTURED,
  POINTS,
  RADIUS,
  LENGTH,
  BRICKS,
  TREE,
};

static const struct option options[] = {
    {"endo-radius", required_argument, NULL, ENDO_RADIUS},
    {"endo-length", required_argument, NULL, ENDO_LENGTH},
    {"epi-radius", required_argument, NULL, EPI_RADIUS},
    {"epi-length", required_argument, NULL, EPI_LENGTH},
    {"base", required_argument, NULL, BASE},
    {"around", required_argument, NULL, AROUND},
    {"along", required_argument, NULL, ALONG},
    {"layers", required_argument, NULL, LAYERS},
    {"endo-angle", required_argument, NULL, ENDO_ANGLE},
    {"epi-angle", required_argument, NULL, EPI_ANGLE},
    {"spacing", required_argument, NULL, SPACING},
    {"cells", required_argument, NULL, CELLS},
    {"size", required_argument, NULL, SIZE},
    {"tets", required_argument, NULL, TETS},
    {"jitter", required_argument, NULL, JITTER},
    {"seed", required_argument, NULL, SEED},
    {"element", required_argument, NULL, ELEMENT},
    {"unstructured", no_argument, NULL, UNSTRUCTURED},
    {"points", required_argument, NULL, POINTS},
    {"radius", required_argument, NULL, RADIUS},
    {"length", required_argument, NULL, LENGTH},
    {"bricks", required_argument, NULL, BRICKS},
    {"tree", required_argument, NULL, TREE},
    {"output", required_argument, NULL, 'o'},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

// Reads `count` numbers with commas between them; false when the text holds anything else.
static bool read_numbers(const char *text, double *numbers, int count)
{
  for (int i = 0; i < count; i++) {
    char *end;
    numbers[i] = strtod(text, &end);
    if (end == text || !isfinite(numbers[i]) || *end != (i + 1 < count ? ',' : '\0')) return false;
    text = end + 1;
  }
  return true;
}

static bool read_counts(const char *text, size_t *counts, int count)
{
  double numbers[3];
  if (!read_numbers(text, numbers, count)) return false;
  for (int i = 0; i < count; i++) {
    if (!(numbers[i] >= 0 && numbers[i] < 1e9) || numbers[i] != floor(numbers[i])) return false;
    counts[i] = (size_t)numbers[i];
  }
  return true;
}

static bool read_element(const char *text, vsc_block_kind *kind)
{
  static const char *const words[] = {[VSC_BLOCK_TETS] = "tet",
                                      [VSC_BLOCK_HEXES] = "hex",
                                      [VSC_BLOCK_WEDGES] = "wedge",
                                      [VSC_BLOCK_MIXED] = "mixed"};
  for (size_t k = 0; k < sizeof words / sizeof words[0]; k++) {
    *kind = (vsc_block_kind)k;
    if (strcmp(text, words[k]) == 0) return true;
  }
  return false;
}

static bool read_option(wish *wish, int option, const char *text)
{
  size_t count = 0;
  bool good;
  switch (option) {
    case ENDO_RADIUS:
      return read_numbers(text, &wish->lv.endo_radius, 1);
    case ENDO_LENGTH:
      return read_numbers(text, &wish->lv.endo_length, 1);
    case EPI_RADIUS:
      return read_numbers(text, &wish->lv.epi_radius, 1);
    case EPI_LENGTH:
      return read_numbers(text, &wish->lv.epi_length, 1);
    case BASE:
      return read_numbers(text, &wish->lv.base, 1);
    case AROUND:
      good = read_counts(text, &wish->lv.around, 1);
      wish->tube.around = wish->lv.around;
      return good;
    case ALONG:
      good = read_counts(text, &wish->lv.along, 1);
      wish->tube.along = wish->lv.along;
      return good;
    case RADIUS:
      return read_numbers(text, &wish->tube.radius, 1);
    case LENGTH:
      return read_numbers(text, &wish->tube.length, 1);
    case LAYERS:
      return read_counts(text, &wish->lv.layers, 1);
    case ENDO_ANGLE:
      return read_numbers(text, &wish->endo_angle, 1);
    case EPI_ANGLE:
      return read_numbers(text, &wish->epi_angle, 1);
    case SPACING:
      return read_numbers(text, &wish->spacing, 1) && wish->spacing > 0;
    case CELLS:
      wish->cell_numbers = read_counts(text, wish->block.cells, 3) ? 3 : 2;
      return wish->cell_numbers == 3 || read_counts(text, wish->block.cells, 2);
    case SIZE:
      wish->size_numbers = read_numbers(text, wish->block.size, 3) ? 3 : 2;
      return wish->size_numbers == 3 || read_numbers(text, wish->block.size, 2);
    case JITTER:
      return read_numbers(text, &wish->block.jitter, 1);
    case TETS:
      good = read_counts(text, &count, 1);
      wish->block.tets_per_cell = (int)count;
      return good;
    case BRICKS:
      return read_counts(text, &wish->bricks, 1);
    case TREE:
      wish->tree = strcmp(text, "hepatic") == 0 ? VSC_HEPATIC_TREE : VSC_PORTAL_TREE;
      return wish->tree == VSC_HEPATIC_TREE || strcmp(text, "portal") == 0;
    case ELEMENT:
      return read_element(text, &wish->element);
    case UNSTRUCTURED:
      return wish->unstructured = true;
    case POINTS:
      return read_counts(text, &wish->points, 1) && wish->points > 0;
    default:
      good = read_counts(text, &count, 1);
      wish->block.seed = count;
      return good;
  }
}

// Writes a mesh with all its arrays, as integers.
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
                                        .integer = true};
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

static vsc_status generate_lv(const wish *wish, const char *file, vsc_error *error)
{
  vsc_mesh *mesh = NULL;
  vsc_status status = vsc_lv_mesh(&wish->lv, &mesh, error);
  if (status == VSC_OK) status = write_mesh(file, mesh, error);
  if (status == VSC_OK)
    printf("%s: %zu nodes, %zu tets, wall %.1f ml, cavity %.1f ml\n", file, mesh->node_count,
           mesh->element_count, mesh_volume(mesh) / 1000, vsc_lv_volume(&wish->lv, 0) / 1000);
  vsc_mesh_free(mesh);
  return status;
}

static vsc_status generate_map(const wish *wish, const char *file, vsc_error *error)
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

static vsc_status generate_block(const wish *wish, const char *file, vsc_error *error)
{
  vsc_mesh *mesh = NULL;
  vsc_cloud_shape cloud = vsc_cloud_default();
  memcpy(cloud.size, wish->block.size, sizeof cloud.size);
  cloud.seed = wish->block.seed;
  if (wish->points > 0) cloud.points = wish->points;
  vsc_status status = wish->unstructured ? vsc_cloud_mesh(&cloud, &mesh, error)
                                         : vsc_block_of(&wish->block, wish->element, &mesh, error);
  if (status == VSC_OK) status = write_mesh(file, mesh, error);
  if (status == VSC_OK)
    printf("%s: %zu nodes, %zu elements, %g mm3\n", file, mesh->node_count, mesh->element_count,
           mesh_volume(mesh));
  vsc_mesh_free(mesh);
  return status;
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

static vsc_status generate_sheet(const wish *wish, const char *file, vsc_error *error)
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

static vsc_status generate_tube(const wish *wish, const char *file, vsc_error *error)
{
  vsc_mesh *mesh = NULL;
  const vsc_status status = vsc_tube_mesh(&wish->tube, &mesh, error);
  return finish_surface(file, status, mesh, error);
}

static vsc_status generate_liver(const wish *wish, const char *file, vsc_error *error)
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

static vsc_status generate_vessels(const wish *wish, const char *file, vsc_error *error)
{
  vsc_polydata *tree = NULL;
  vsc_status status = vsc_liver_vessels(wish->tree, &tree, error);
  if (status == VSC_OK) status = vsc_vtk_write_polydata(file, tree, error);
  if (status == VSC_OK)
    printf("%s: %zu points, %zu segments\n", file, tree->point_count, tree->segment_count);
  vsc_polydata_free(tree);
  return status;
}

static vsc_status generate(const wish *wish, vsc_error *error)
{
  static const struct {
    const char *name, *file;
    vsc_status (*make)(const struct wish *wish, const char *file, vsc_error *error);
  } shapes[] = {{"lv", "lv.vtu", generate_lv},
                {"map", "lv_angles.vti", generate_map},
                {"block", "block.vtu", generate_block},
                {"sheet", "sheet.vtu", generate_sheet},
                {"tube", "tube.vtu", generate_tube},
                {"liver", "liver.vtu", generate_liver},
                {"vessels", "vessels.vtp", generate_vessels}};
  const int numbers = strcmp(wish->shape, "sheet") == 0 ? 2 : 3;
  if ((wish->cell_numbers > 0 && wish->cell_numbers != numbers) ||
      (wish->size_numbers > 0 && wish->size_numbers != numbers))
    return vsc_fail(error, VSC_INPUT, "--cells and --size of a %s want %d numbers", wish->shape,
                    numbers);
  for (size_t k = 0; k < sizeof shapes / sizeof shapes[0]; k++)
    if (strcmp(wish->shape, shapes[k].name) == 0)
      return shapes[k].make(wish, wish->file != NULL ? wish->file : shapes[k].file, error);
  return vsc_fail(error, VSC_INPUT, "unknown shape '%s', must be lv, map, block, sheet, tube, liver or "
                  "vessels",
                  wish->shape);
}

int vsc_verb_generate(int argc, char **argv)
{
  wish wish = {.lv = vsc_lv_default(),
               .block = vsc_block_default(),
               .tube = vsc_tube_default(),
               .endo_angle = 60,
               .epi_angle = -60,
               .bricks = 10};
  optind = 0;
  int option, index = 0;
  while ((option = getopt_long(argc, argv, "o:h", options, &index)) != -1) {
    if (option == 'h') {
      print_help();
      return VSC_OK;
    }
    if (option == '?') return VSC_INPUT;
    if (option == 'o') {
      wish.file = optarg;
    } else if (!read_option(&wish, option, optarg)) {
      fprintf(stderr, "viscera generate: --%s '%s' does not fit, see `viscera generate --help`\n",
              options[index].name, optarg);
      return VSC_INPUT;
    }
  }
  if (optind + 1 != argc) {
    fprintf(stderr,
            "viscera generate: say one shape: lv, map, block, sheet, tube, liver or vessels, see `viscera generate "
            "--help`\n");
    return VSC_INPUT;
  }
  wish.shape = argv[optind];
  vsc_error error;
  const vsc_status status = generate(&wish, &error);
  if (status != VSC_OK) fprintf(stderr, "viscera generate: %s\n", error.text);
  return status;
}
