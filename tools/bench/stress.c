// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/stress.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/vtk.h"
#include "tools/shapes_block.h"

#define SHEAR 5.0         // kPa, of every law at rest, roughly
#define FLATTEST 1.7e-3   // tan 0.1 degree
#define SMALLEST 1e-3

const vsc_stress vsc_stresses[] = {
    {.name = "nothing", .what = "nothing out of the ordinary"},
    {.name = "axes", .what = "the fibre 10^4 times as stiff as what lies across", .axes = 1e4},
    {.name = "regions", .what = "one half 10^4 times as stiff as the other", .regions = 1e4},
    {.name = "volume", .what = "volume modulus 10^4 times the shear modulus", .volume = 1e4},
    {.name = "flat", .what = "a layer of elements of 0.1 degree", .shape = VSC_STRESS_FLAT, .end = 4},
    {.name = "sliver", .what = "slivers of 0.1 degree", .shape = VSC_STRESS_SLIVER, .end = 4},
    {.name = "small", .what = "an element a thousandth as large as its neighbours", .shape = VSC_STRESS_SMALL, .end = 4},
    {.name = "steps", .what = "activation on and off in a microsecond",
     .curve = "{kind: table, times: [0 ms, 2 ms, 2.001 ms, 5 ms, 5.001 ms, 8 ms, 8.001 ms], values: [0, 0, 1, 1, 0, 0, 1]}"},
    {.name = "delays", .what = "every element contracts at a random time", .delays = true,
     .curve = "{kind: half_sine, duration: 1 ms}"},
    {.name = "periods", .what = "periods far shorter than the response",
     .curve = "{kind: half_sine, duration: 0.1 ms, period: 0.2 ms}"},
    {.name = "tension", .what = "a tension of 1 MPa", .tension = 1000},
    {.name = "pressure", .what = "a pressure of 10 MPa", .pressure = 1e4},
    {.name = "gravity", .what = "gravity times 100", .gravity = 981},
    {.name = "masses", .what = "one half 10^6 times as heavy as the other", .masses = 1e6},
    {.name = "viscosity", .what = "a viscosity of 100 Pa s", .viscosity = 100, .end = 4},
    {.name = "crush", .what = "the far end pushed through the near one", .motion = 6},
    {.name = "all", .what = "stiff half, heavy half, slivers, steps, delays at once", .shape = VSC_STRESS_FLAT,
     .regions = 100, .masses = 100, .delays = true, .tension = 50, .end = 2,
     .curve = "{kind: table, times: [0 ms, 0.5 ms, 0.501 ms, 1 ms, 1.001 ms], values: [0, 0, 1, 1, 0]}"},
};
const size_t vsc_stress_count = sizeof vsc_stresses / sizeof vsc_stresses[0];

// ---- laws, kinds, methods

enum { SPRINGS, NEO_HOOKEAN, MOONEY_RIVLIN, VERONDA_WESTMANN, GUCCIONE, FUNG, HOLZAPFEL_OGDEN, PAPER, CLASSICAL, LAWS };
const char *const vsc_stress_laws[] = {"springs",  "neo_hookean", "mooney_rivlin",   "veronda_westmann",
                                       "guccione", "fung",        "holzapfel_ogden", "paper", "classical"};
const size_t vsc_stress_law_count = LAWS;

static bool has_fibres(size_t law)
{
  return law != NEO_HOOKEAN && law != MOONEY_RIVLIN && law != VERONDA_WESTMANN && law != CLASSICAL;
}

// The law's constants with the fibre `axes` times and all moduli `stiff` times what they are.
static void write_law(FILE *file, size_t law, double axes, double stiff)
{
  const double s = stiff, f = stiff * axes;
  fprintf(file, "    law: %s\n", vsc_stress_laws[law]);
  switch (law) {
    case SPRINGS:
      fprintf(file, "    axial: {f: %g kPa, s: %g kPa, n: %g kPa}\n    angular: {fs: %g kPa, sn: %g kPa, nf: %g kPa}\n",
              20 * f, 10 * s, 10 * s, SHEAR * s, SHEAR * s, SHEAR * s);
      break;
    case NEO_HOOKEAN:
      fprintf(file, "    neo_hookean: {shear: %g kPa}\n", SHEAR * s);
      break;
    case MOONEY_RIVLIN:
      fprintf(file, "    mooney_rivlin: {c1: %g kPa, c2: %g kPa}\n", 2 * s, 0.5 * s);
      break;
    case VERONDA_WESTMANN:
      fprintf(file, "    veronda_westmann: {c1: %g kPa, c2: 4}\n", 1.25 * s);
      break;
    case GUCCIONE:
      fprintf(file, "    guccione: {C: %g kPa, bf: %g, bt: 3, bfs: 5}\n", 2 * s, 8 * axes);
      break;
    case FUNG:
      fprintf(file, "    fung: {C: %g kPa, bff: %g, bss: 4, bnn: 3, bfs: 5, bsn: 5, bnf: 6}\n", 2 * s, 9 * axes);
      break;
    case HOLZAPFEL_OGDEN:
      fprintf(file, "    holzapfel_ogden: {a: %g kPa, b: 3, af: %g kPa, bf: 6, as: %g kPa, bs: 4, afs: %g kPa, bfs: 5}\n",
              SHEAR * s, 5 * f, 2 * s, 0.6 * s);
      break;
    case PAPER:
      fprintf(file, "    paper: {axial: {f: %g N/m, s: %g N/m, n: %g N/m}, angular: {fs: %g mN, sn: %g mN, nf: %g mN},\n"
              "      volume: %g N/m, active: %g N/m}\n", 10 * f, 5 * s, 5 * s, 2 * s, 2 * s, 2 * s, 10 * s, 20 * f);
      break;
    default:
      fprintf(file, "    classical: {stiffness: %g N/m}\n", SHEAR * s);
  }
}

typedef struct element_kind {
  vsc_block_kind block;
  const char *settings;  // lines of the scene
  bool raised;           // to quadratic tets
} element_kind;

const char *const vsc_stress_kinds[] = {"tets", "nodal", "smoothed", "kept", "quadratic", "hexes", "mixed"};
static const element_kind kinds[] = {
    {VSC_BLOCK_TETS, "volume: element\n", false},
    {VSC_BLOCK_TETS, "volume: nodal\n", false},
    {VSC_BLOCK_TETS, "volume: nodal\ntets: smoothed\n", false},
    {VSC_BLOCK_TETS, "volume: element\nkeep_volume: node\n", false},
    {VSC_BLOCK_TETS, "volume: nodal\n", true},
    {VSC_BLOCK_HEXES, "volume: nodal\n", false},
    {VSC_BLOCK_MIXED, "volume: nodal\n", false},
};
enum { SMOOTHED = 2, KEPT = 3, KINDS = sizeof kinds / sizeof kinds[0] };
const size_t vsc_stress_kind_count = KINDS;

const char *const vsc_stress_methods[VSC_STRESS_METHODS] = {"explicit", "coupled", "implicit", "equilibrium"};

// ---- cases

static bool means_something(const vsc_stress_case *at)
{
  const vsc_stress *stress = &vsc_stresses[at->stress];
  const bool of_edges = at->law == PAPER || at->law == CLASSICAL, explicit = at->method <= VSC_STRESS_COUPLED;
  if (stress->axes > 0 && !has_fibres(at->law)) return false;
  if (stress->volume > 0 && of_edges) return false;
  if (stress->viscosity > 0 && of_edges) return false;
  if (at->law == CLASSICAL && (stress->tension > 0 || stress->curve != NULL || stress->delays)) return false;
  if (of_edges && (!explicit || kinds[at->kind].raised || at->kind == SMOOTHED)) return false;
  if (at->kind == KEPT && (!explicit || stress->motion > 0)) return false;
  if (at->method == VSC_STRESS_COUPLED && (at->kind == KEPT || at->law == PAPER)) return false;
  if (stress->shape == VSC_STRESS_SLIVER && kinds[at->kind].block != VSC_BLOCK_TETS) return false;
  return at->method != VSC_STRESS_EQUILIBRIUM || stress->masses == 0 || stress->regions > 0;
}

// Without `whole` a law has one kind of its own for each stress, and a kind one law.
static bool is_chosen(const vsc_stress_case *at)
{
  return at->kind == (at->law + at->stress) % KINDS || at->law == (at->kind + at->stress) % LAWS ||
         at->law == SPRINGS;
}

bool vsc_stress_next(vsc_stress_case *at, bool whole)
{
  bool fresh = at->name[0] == '\0';
  for (; at->stress < vsc_stress_count; fresh = true) {
    if (fresh && means_something(at) && (whole || is_chosen(at))) {
      snprintf(at->name, sizeof at->name, "%s-%s-%s-%s", vsc_stresses[at->stress].name, vsc_stress_laws[at->law],
               vsc_stress_kinds[at->kind], vsc_stress_methods[at->method]);
      return true;
    }
    if (++at->method < VSC_STRESS_METHODS) continue;
    at->method = 0;
    if (++at->kind < KINDS) continue;
    at->kind = 0;
    if (++at->law < LAWS) continue;
    at->law = 0;
    at->stress++;
  }
  return false;
}

bool vsc_stress_rests(const vsc_stress_case *at)
{
  const vsc_stress *s = &vsc_stresses[at->stress];
  const bool loaded = s->tension > 0 || s->curve != NULL || s->pressure > 0 || s->gravity > 0 || s->motion > 0;
  return !loaded || s->regions > 0;
}

// ---- meshes

// Where the plane of nodes that lay at x (mm) goes.
static double squeeze(double x, double plane, double thickness)
{
  return x <= plane ? x : x <= plane + 1 ? plane + (x - plane) * thickness : x - 1 + thickness;
}

// The inner node nearest to the block's middle goes upwards until the flattest element at it has FLATTEST of
// its height left: volumes of tets are linear in the way.
static void push_node(vsc_mesh *mesh)
{
  static const double middle[3] = {2, 1, 1};
  size_t node = 0;
  double nearest = INFINITY, way = 1;
  for (size_t n = 0; n < mesh->node_count; n++) {
    const double *x = mesh->nodes + 3 * n;
    const double off = hypot(hypot(x[0] - middle[0], x[1] - middle[1]), x[2] - middle[2]);
    if (off < nearest) node = n;
    nearest = fmin(nearest, off);
  }
  double *height = mesh->nodes + 3 * node + 2;
  const double from = *height;
  for (size_t e = 0; e < mesh->element_count; e++) {
    *height = from;
    const double before = vsc_mesh_element_volume(mesh, e);
    *height = from + 1;
    const double after = vsc_mesh_element_volume(mesh, e);
    if (after < before) way = fmin(way, before / (before - after));
  }
  *height = from + (1 - FLATTEST) * way;
}

static void spoil(vsc_mesh *mesh, vsc_stress_shape shape)
{
  for (size_t n = 0; n < mesh->node_count; n++) {
    double *x = mesh->nodes + 3 * n;
    if (shape == VSC_STRESS_FLAT) x[2] = squeeze(x[2], 1, FLATTEST);
    for (int i = 0; i < 3 && shape == VSC_STRESS_SMALL; i++) x[i] = squeeze(x[i], i == 0 ? 2 : 1, SMALLEST);
  }
  if (shape == VSC_STRESS_SLIVER) push_node(mesh);
}

static vsc_status write_mesh(const vsc_stress_case *at, const char *folder, vsc_error *error)
{
  static const char *const names[] = {"x0", "x1"};
  enum { MOST = 4096 };
  const vsc_stress *stress = &vsc_stresses[at->stress];
  static double region[MOST], delay[MOST];
  const vsc_block_shape shape = {.cells = {4, 2, 2}, .size = {4, 2, 2}, .tets_per_cell = 5, .seed = 7,
                                 .jitter = stress->shape == VSC_STRESS_GOOD ? 0.15 : 0};
  vsc_mesh *mesh;
  vsc_status status = vsc_block_of(&shape, kinds[at->kind].block, &mesh, error);
  if (status != VSC_OK) return status;
  for (size_t e = 0; e < mesh->element_count && e < MOST; e++) {
    double x = 0;
    const int corners = vsc_mesh_kind(mesh, e)->corners;
    for (int c = 0; c < corners; c++) x += mesh->nodes[3 * vsc_mesh_corners(mesh, e)[c]] / corners;
    region[e] = x < 2 ? 1 : 2;
    delay[e] = 0.3 * (stress->end > 0 ? stress->end : 10) * (1 + vsc_scatter(5, e));
  }
  spoil(mesh, stress->shape);
  vsc_vtk_array arrays[] = {{"region", 1, region, VSC_ON_ELEMENTS, true}, {"delay", 1, delay, VSC_ON_ELEMENTS, false},
                            {names[0], 1, NULL, VSC_ON_NODES, true}, {names[1], 1, NULL, VSC_ON_NODES, true}};
  for (int k = 0; k < 2; k++) arrays[2 + k].values = vsc_arrays_find(&mesh->node_data, names[k])->values;
  char file[PATH_MAX];
  snprintf(file, sizeof file, "%s/mesh.vtu", folder);
  status = vsc_vtk_write_mesh(file, mesh, 4, arrays, true, error);
  vsc_mesh_free(mesh);
  return status;
}

// ---- scenes

static double or_default(double value, double otherwise)
{
  return value > 0 ? value : otherwise;
}

static void write_active(FILE *file, const vsc_stress_case *at, double end)
{
  const vsc_stress *stress = &vsc_stresses[at->stress];
  if (at->law == CLASSICAL) return;
  fputs("    active:\n", file);
  if (at->law == PAPER)
    fputs("      kind: spring\n      rest_stretch: 0.9\n", file);
  else
    fprintf(file, "      kind: tension\n      tension: %g kPa\n", or_default(stress->tension, 5));
  if (stress->delays) fputs("      delay_array: delay\n", file);
  if (stress->curve != NULL)
    fprintf(file, "      curve: %s\n", stress->curve);
  else
    fprintf(file, "      curve: {kind: half_sine, duration: %g ms}\n", end);
}

static void write_material(FILE *file, const vsc_stress_case *at, int half, double end, bool rests)
{
  const vsc_stress *stress = &vsc_stresses[at->stress];
  const double stiff = half == 0 ? 1 : or_default(stress->regions, 1);
  // equally far from water on both sides
  const double heavy = sqrt(or_default(stress->masses, 1));
  fprintf(file, "  - name: half%d\n    regions: [%d]\n    density: %g g/cm3\n", half + 1, half + 1,
          half == 0 ? 1 / heavy : heavy);
  write_law(file, at->law, or_default(stress->axes, 1), stiff);
  if (at->law < PAPER) {
    fprintf(file, "    volume_modulus: %g kPa\n    stabilization: %g kPa\n",
            or_default(stress->volume, 20) * SHEAR * stiff, SHEAR * stiff);
    if (stress->viscosity > 0) fprintf(file, "    viscosity: %g Pa s\n", stress->viscosity);
  }
  if (!rests) write_active(file, at, end);
}

static void write_loads(FILE *file, const vsc_stress *stress, double end, bool rests)
{
  fputs("supports:\n  - {set: near, held: [x, y, z]}\n", file);
  if (rests) return;
  if (stress->motion > 0)
    fprintf(file, "  - {set: far, held: [x, y, z], motion: [%g mm, 0 mm, 0 mm], curve: {kind: ramp, duration: %g ms}}\n",
            -stress->motion, end);
  else
    fprintf(file, "pressures:\n  - {surface: end, peak: %g kPa, curve: {kind: ramp, duration: %g ms}}\n",
            or_default(stress->pressure, 1), 0.5 * end);
  if (stress->gravity > 0) fprintf(file, "gravity: [0 m/s2, 0 m/s2, %g m/s2]\n", -stress->gravity);
}

static vsc_status write_scene(const vsc_stress_case *at, const char *folder, bool rests, vsc_error *error)
{
  const vsc_stress *stress = &vsc_stresses[at->stress];
  const double end = or_default(stress->end, 10);
  char name[PATH_MAX];
  snprintf(name, sizeof name, "%s/%s.yaml", folder, rests ? "rest" : "scene");
  FILE *file = fopen(name, "w");
  if (file == NULL) return vsc_fail(error, VSC_SYSTEM, "%s: cannot be written: %s", name, strerror(errno));
  fprintf(file, "# %s\nmesh: {file: mesh.vtu, unit: mm, region_array: region%s}\n", at->name,
          kinds[at->kind].raised ? ", order: 2" : "");
  fputs("surfaces: [{name: end, node_array: x1, value: 1}]\n"
        "node_sets: [{name: near, node_array: x0, value: 1}, {name: far, node_array: x1, value: 1}]\n"
        "fibers: {source: constant, constant: {fiber: [3, 1, 0.5]}}\nmaterials:\n", file);
  for (int half = 0; half < 2; half++) write_material(file, at, half, end, rests);
  fputs(kinds[at->kind].settings, file);
  write_loads(file, stress, end, rests);
  // the ledger sees loads at its looks only
  const double look = stress->curve != NULL || stress->pressure > 0 ? 0.02 : 0.1;
  fprintf(file, "solve: %s\ntime: {end: %g ms}\noutput: {frames: %g ms, signals: %g ms}\n",
          vsc_stress_methods[at->method == VSC_STRESS_COUPLED ? VSC_STRESS_EXPLICIT : at->method], end, end,
          at->method == VSC_STRESS_EQUILIBRIUM ? end / 10 : look);
  if (fclose(file) == 0) return VSC_OK;
  return vsc_fail(error, VSC_SYSTEM, "%s: cannot be written: %s", name, strerror(errno));
}

vsc_status vsc_stress_write(const vsc_stress_case *at, const char *folder, vsc_error *error)
{
  vsc_status status = write_mesh(at, folder, error);
  if (status == VSC_OK) status = write_scene(at, folder, false, error);
  return status == VSC_OK ? write_scene(at, folder, true, error) : status;
}
