// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/generate_options.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void vsc_generate_help(void)
{
  puts(
      "Usage: viscera generate lv|map|block|sheet|tube|cook|column|cylinder|octant|liver|\n"
      "                        vessels [OPTION]...\n"
      "Makes a mesh or an angle map by formulas. Lengths are mm, angles degrees. An option of\n"
      "another shape is refused.\n\n"
      "lv: a left ventricle between two half ellipsoids about z, apex at -z, cut by the plane\n"
      "z = base; node arrays endo, epi, base, rim (0 or 1), cell array region. With map: the\n"
      "azimuth/elevation image of its fibre helix; arrays azimuth, elevation, tissue.\n"
      "      --endo-radius=R --endo-length=L  the cavity at the equator, from there to the apex "
      "[26, 66]\n"
      "      --epi-radius=R --epi-length=L    the same for the outside [35.5, 73]\n"
      "      --base=Z                         the base plane above the equator [20]\n"
      "      --like=human|land|arostica       an adult's, or that of a benchmark, but for what other\n"
      "                                       options say\n"
      "lv:   --around=N --along=N --layers=N  bricks around (a multiple of 4), from the apical patch to "
      "the\n"
      "                                       base, through the wall [32, 14, 3]\n"
      "      --element=tet|hex|wedge          what becomes of the bricks [tet, 5 of each]\n"
      "      --base-rise=H                    by how much the base is higher outside: a cone [0]\n"
      "      --along-x                        the long axis is x, the apex at -x\n"
      "      --surfaces                       the boundary's triangles, array surface: 1 inside, 2 "
      "outside,\n"
      "                                       3 base\n"
      "map:  --endo-angle=A --epi-angle=A     helix angles, positive is right-handed [60, -60]\n"
      "      --spacing=H                      edge of a voxel [a quarter of the wall]\n\n"
      "block: a box from the origin; node arrays x0 x1 y0 y1 z0 z1 (0 or 1), cell array region.\n"
      "      --cells=NX,NY,NZ                 bricks [4,4,4]\n"
      "      --size=X,Y,Z                     [10,10,10]\n"
      "      --tets=5|6                       tets of a brick [5]\n"
      "      --jitter=PART --seed=N           inner nodes moved by up to PART of a brick, 0 to 0.3 "
      "[0, 1]\n"
      "      --slivers=N                      inner nodes moved to a hundredth of a brick from the next [0]\n"
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
      "cook: Cook's membrane, a panel from 44 to 16 mm high, 48 mm long; node arrays left, right, bottom,\n"
      "top, back, front.\n"
      "      --cells=NX,NY,NZ --thickness=T   bricks, mm [8,8,1, 1]\n"
      "      --element=tet|hex|wedge|mixed --tets=5|6\n\n"
      "column: a box about z, from z = 0, that is set in motion; node arrays x0 x1 y0 y1 z0 z1, and velocity\n"
      "in m/s, for initial_velocity.\n"
      "      --bend=V --twist=W               of its top in m/s, rad/s: along x growing with z, about z\n"
      "                                       with sin(pi z / 2 H) [0, 0]\n"
      "      --cells=NX,NY,NZ --size=X,Y,Z    bricks, mm [4,4,24, 1000,1000,6000]\n"
      "      --element=tet|hex|wedge|mixed --tets=5|6\n\n"
      "cylinder, octant: a quarter of a thick cylinder about z, an eighth of a thick sphere; node arrays\n"
      "inner, outer, x0, y0, z0 (the cuts), of the cylinder z1.\n"
      "      --inner=R --outer=R --length=L   [1, 2, 1]\n"
      "      --layers=N --around=N --along=N  bricks through the wall, round the quarter (octant: along\n"
      "                                       each side of its three patches), along z [4, 4, 1]\n"
      "      --element=tet|hex|wedge          [tet]\n\n"
      "liver: a liver of human size; node arrays top, bottom, front, back, cell array region. With\n"
      "vessels: the centre lines of its vessels with their radii.\n"
      "      --bricks=N                       bricks of 5 tets along each side [10]\n"
      "      --tree=portal|hepatic            which tree [portal]\n\n"
      "  -o, --output=FILE                    .vtu, of a map .vti, of vessels .vtp [the shape's name]\n"
      "  -h, --help                           this text\n\n"
      "Examples:\n"
      "  viscera generate lv -o data/lv.vtu\n"
      "  viscera generate lv --like land --around 24 --along 18 -o land.vtu\n"
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
  SLIVERS,
  ELEMENT,
  UNSTRUCTURED,
  POINTS,
  RADIUS,
  LENGTH,
  BRICKS,
  TREE,
  LIKE,
  BASE_RISE,
  ALONG_X,
  SURFACES,
  THICKNESS,
  INNER,
  OUTER,
  BEND,
  TWIST,
};

const struct option vsc_generate_options[] = {
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
    {"slivers", required_argument, NULL, SLIVERS},
    {"element", required_argument, NULL, ELEMENT},
    {"unstructured", no_argument, NULL, UNSTRUCTURED},
    {"points", required_argument, NULL, POINTS},
    {"radius", required_argument, NULL, RADIUS},
    {"length", required_argument, NULL, LENGTH},
    {"bricks", required_argument, NULL, BRICKS},
    {"tree", required_argument, NULL, TREE},
    {"like", required_argument, NULL, LIKE},
    {"base-rise", required_argument, NULL, BASE_RISE},
    {"along-x", no_argument, NULL, ALONG_X},
    {"surfaces", no_argument, NULL, SURFACES},
    {"thickness", required_argument, NULL, THICKNESS},
    {"inner", required_argument, NULL, INNER},
    {"outer", required_argument, NULL, OUTER},
    {"bend", required_argument, NULL, BEND},
    {"twist", required_argument, NULL, TWIST},
    {"output", required_argument, NULL, 'o'},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

#define WALL "endo-radius endo-length epi-radius epi-length base like "

// Their options by name; a block of scattered points has others than one of bricks.
static const struct {
  const char *shape, *options;
} shapes[] = {{"lv", WALL "around along layers element base-rise along-x surfaces"},
              {"map", WALL "endo-angle epi-angle spacing"},
              {"block", "cells size tets jitter seed slivers element"},
              {"block --unstructured", "unstructured size points seed"},
              {"sheet", "cells size jitter seed"},
              {"tube", "radius length around along"},
              {"cook", "cells thickness element tets"},
              {"column", "bend twist cells size element tets"},
              {"cylinder", "inner outer length layers around along element"},
              {"octant", "inner outer layers around element"},
              {"liver", "bricks"},
              {"vessels", "tree"}};
enum { SHAPES = sizeof shapes / sizeof shapes[0] };

static bool has_option(size_t shape, const char *name)
{
  const size_t length = strlen(name);
  const char *at = shapes[shape].options;
  while (*at != '\0') {
    const size_t word = strcspn(at, " ");
    if (word == length && strncmp(at, name, length) == 0) return true;
    at += word + (at[word] == ' ');
  }
  return false;
}

static vsc_status refuse(const char *shape, const char *option, vsc_error *error)
{
  char others[256] = "";
  for (size_t k = 0; k < SHAPES; k++) {
    const size_t used = strlen(others);
    if (has_option(k, option))
      snprintf(others + used, sizeof others - used, "%s%s", used > 0 ? ", " : "", shapes[k].shape);
  }
  return vsc_fail(error, VSC_INPUT, "%s has no --%s, which is an option of %s: leave it out", shape,
                  option, others);
}

vsc_status vsc_generate_check(const vsc_generate_wish *wish, vsc_error *error)
{
  const bool scattered = wish->unstructured && strcmp(wish->shape, "block") == 0;
  const char *shape = scattered ? "block --unstructured" : wish->shape;
  size_t k = 0;
  while (k < SHAPES && strcmp(shapes[k].shape, shape) != 0) k++;
  for (const struct option *o = vsc_generate_options; k < SHAPES && o->name != NULL; o++)
    if (o->val >= ENDO_RADIUS && (wish->given >> (o->val - ENDO_RADIUS) & 1) != 0 &&
        !has_option(k, o->name))
      return refuse(shape, o->name, error);
  return VSC_OK;
}

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

static bool read_like(const char *text, vsc_lv_shape *lv)
{
  const bool land = strcmp(text, "land") == 0, arostica = strcmp(text, "arostica") == 0;
  *lv = land ? vsc_lv_land() : arostica ? vsc_lv_arostica() : vsc_lv_default();
  return land || arostica || strcmp(text, "human") == 0;
}

// Counts that several shapes have.
static bool read_bricks(vsc_generate_wish *wish, int option, const char *text)
{
  size_t count = 0;
  if (!read_counts(text, &count, 1)) return false;
  if (option == AROUND) wish->lv.around = wish->tube.around = wish->shell.around = count;
  if (option == ALONG) wish->lv.along = wish->tube.along = wish->shell.along = count;
  if (option == LAYERS) wish->lv.layers = wish->shell.layers = count;
  return true;
}

// Options of any one number, and where it goes.
static const struct {
  int option;
  size_t offset;
} numbers[] = {
    {ENDO_RADIUS, offsetof(vsc_generate_wish, lv.endo_radius)},
    {ENDO_LENGTH, offsetof(vsc_generate_wish, lv.endo_length)},
    {EPI_RADIUS, offsetof(vsc_generate_wish, lv.epi_radius)},
    {EPI_LENGTH, offsetof(vsc_generate_wish, lv.epi_length)},
    {BASE, offsetof(vsc_generate_wish, lv.base)},
    {BASE_RISE, offsetof(vsc_generate_wish, lv.base_rise)},
    {BEND, offsetof(vsc_generate_wish, bend)},
    {TWIST, offsetof(vsc_generate_wish, twist)},
    {INNER, offsetof(vsc_generate_wish, shell.inner)},
    {OUTER, offsetof(vsc_generate_wish, shell.outer)},
    {RADIUS, offsetof(vsc_generate_wish, tube.radius)},
    {ENDO_ANGLE, offsetof(vsc_generate_wish, endo_angle)},
    {EPI_ANGLE, offsetof(vsc_generate_wish, epi_angle)},
    {JITTER, offsetof(vsc_generate_wish, block.jitter)},
};

bool vsc_generate_option(vsc_generate_wish *wish, int option, const char *text)
{
  size_t count = 0;
  bool good;
  wish->given |= UINT64_C(1) << (option - ENDO_RADIUS);
  for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++)
    if (numbers[k].option == option) return read_numbers(text, (double *)((char *)wish + numbers[k].offset), 1);
  switch (option) {
    case AROUND:
    case ALONG:
    case LAYERS:
      return read_bricks(wish, option, text);
    case LIKE:
      return read_like(text, &wish->lv);
    case ALONG_X:
      return wish->lv.along_x = true;
    case SURFACES:
      return wish->lv.surfaces = true;
    case THICKNESS:
      return read_numbers(text, &wish->thickness, 1) && wish->thickness > 0;
    case LENGTH:
      good = read_numbers(text, &wish->tube.length, 1);
      wish->shell.length = wish->tube.length;
      return good;
    case SPACING:
      return read_numbers(text, &wish->spacing, 1) && wish->spacing > 0;
    case CELLS:
      wish->cell_numbers = read_counts(text, wish->block.cells, 3) ? 3 : 2;
      return wish->cell_numbers == 3 || read_counts(text, wish->block.cells, 2);
    case SIZE:
      wish->size_numbers = read_numbers(text, wish->block.size, 3) ? 3 : 2;
      return wish->size_numbers == 3 || read_numbers(text, wish->block.size, 2);
    case TETS:
      good = read_counts(text, &count, 1);
      wish->block.tets_per_cell = (int)count;
      return good;
    case SLIVERS:
      return read_counts(text, &wish->block.slivers, 1);
    case BRICKS:
      return read_counts(text, &wish->bricks, 1);
    case TREE:
      wish->tree = strcmp(text, "hepatic") == 0 ? VSC_HEPATIC_TREE : VSC_PORTAL_TREE;
      return wish->tree == VSC_HEPATIC_TREE || strcmp(text, "portal") == 0;
    case ELEMENT:
      good = read_element(text, &wish->lv.element);
      wish->shell.element = wish->lv.element;
      return good;
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
