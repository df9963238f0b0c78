// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/skipping.h"

#include <math.h>
#include <stdio.h>

#include "tools/bench/looking.h"
#include "tools/bench/machine.h"
#include "tools/bench/specimen.h"
#include "tools/bench/step_options.h"

enum { TURNS = 5 };

// ---- features

static void at_rest(vsc_specimen_scene *scene)
{
  scene->material[0].active.curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
  scene->material[0].active.curve.start = 1e6;
}

// The nodes and the boundary where x is between `low` and `high` parts of the block.
static void name_part(vsc_specimen_scene *scene, double low, double high)
{
  vsc_selector part = {.name = "part", .kind = VSC_SELECT_BOX};
  for (int i = 0; i < 3; i++) {
    part.box_low[i] = i == 0 ? low * scene->size[i] - 1e-6 : -1;
    part.box_high[i] = i == 0 ? high * scene->size[i] + 1e-6 : scene->size[i] + 1;
  }
  scene->set = scene->surface = part;
}

static void hold(vsc_specimen_scene *scene, double high)
{
  name_part(scene, 0, high);
  scene->support = vsc_default_support();
  vsc_copy_name(scene->support.set, "part");
  for (int i = 0; i < 3; i++) scene->support.held[i] = 1;
  scene->definition.set_count = scene->definition.support_count = 1;
}

static void half_held(vsc_specimen_scene *scene)
{
  hold(scene, 0.5);
}

static void face_held(vsc_specimen_scene *scene)
{
  hold(scene, 0);
}

static void face_moved(vsc_specimen_scene *scene)
{
  hold(scene, 0);
  scene->support.motion[0] = 1;
  scene->support.curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
  scene->support.curve.start = 1e6;
}

static void no_viscosity(vsc_specimen_scene *scene)
{
  scene->material[0].viscosity = 0;
  for (int a = 0; a < 3; a++) scene->material[0].damping[a] = 0;
}

static void no_angular(vsc_specimen_scene *scene)
{
  for (int a = 0; a < 3; a++) scene->material[0].angular[a] = 0;
}

static void gravity(vsc_specimen_scene *scene)
{
  scene->definition.gravity[2] = -1e-6;
}

static void no_gravity(vsc_specimen_scene *scene)
{
  scene->definition.gravity[2] = 0;
}

static void name_face(vsc_specimen_scene *scene)
{
  name_part(scene, 1, 1);
  scene->definition.surface_count = 1;
}

static void pressed(vsc_specimen_scene *scene)
{
  name_face(scene);
  scene->pressure = (vsc_pressure_def){.surface = "part", .peak = 1e-3, .curve = vsc_default_curve(VSC_CURVE_CONSTANT)};
  scene->definition.pressure_count = 1;
}

static void pressed_later(vsc_specimen_scene *scene)
{
  pressed(scene);
  scene->pressure.curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
  scene->pressure.curve.start = 1e6;
}

static void on_springs(vsc_specimen_scene *scene)
{
  name_face(scene);
  scene->robin = (vsc_robin_def){.surface = "part", .stiffness = 1e-3};
  scene->definition.robin_count = 1;
}

// A table a hundred times as far away as the block is high.
static void far_obstacle(vsc_specimen_scene *scene)
{
  scene->obstacle = vsc_default_obstacle();
  scene->obstacle.point[2] = -100 * scene->size[2];
  scene->obstacle.normal[2] = 1;
  scene->definition.obstacle_count = 1;
}

static void far_obstacle_of_face(vsc_specimen_scene *scene)
{
  far_obstacle(scene);
  name_part(scene, 0, 0);
  vsc_copy_name(scene->obstacle.set, "part");
  scene->definition.set_count = 1;
}

// The second material, of which no element holds anything: array `nothing` of the mesh is 0 everywhere.
static void no_inclusion(vsc_specimen_scene *scene)
{
  vsc_copy_name(scene->material[0].name, "tissue");
  vsc_copy_name(scene->material[1].name, "vessels");
  vsc_copy_name(scene->inclusion.material, "vessels");
  vsc_copy_name(scene->inclusion.fraction_array, "nothing");
  scene->material[0].inclusion_count = 1;
  scene->definition.material_count = 2;
}

static void membrane(vsc_specimen_scene *scene)
{
  name_face(scene);
  scene->membrane = vsc_default_membrane();
  vsc_copy_name(scene->membrane.name, "sheet");
  vsc_copy_name(scene->membrane.surface, "part");
  scene->membrane.thickness = 0.01;
  scene->membrane.axial[0] = scene->membrane.axial[1] = 10;
  scene->definition.membrane_count = 1;
}

// ---- rows

typedef struct row {
  vsc_specimen specimen;
  int over;  // the row that it is compared with, the same without the feature; -1: none
} row;

enum { SPRINGS = 0, DAMPED_NODAL = 3, GUCCIONE = 6, FACE_HELD = 11 };

// What the program refuses instead of letting it idle has no row: a volume modulus, a Prony part, and springs and
// dashpots on a surface (both together) of 0.
static const row rows[] = {
    {{.name = "springs, volume of each tet"}, -1},
    {{.name = "+ damping", .damping = true}, SPRINGS},
    {{.name = "+ node-averaged volume", .nodal = true}, SPRINGS},
    [DAMPED_NODAL] = {{.name = "+ damping, node-averaged volume", .damping = true, .nodal = true}, SPRINGS},
    {{.name = "+ active tension, at work", .active = VSC_ACTIVE_TENSION}, SPRINGS},
    {{.name = "+ active tension, at rest", .active = VSC_ACTIVE_TENSION, .feature = at_rest}, SPRINGS},
    [GUCCIONE] = {{.name = "law Guccione", .law = VSC_LAW_GUCCIONE}, SPRINGS},
    {{.name = "law Guccione, active tension at work", .law = VSC_LAW_GUCCIONE, .active = VSC_ACTIVE_TENSION}, GUCCIONE},
    {{.name = "law Guccione, active tension at rest", .law = VSC_LAW_GUCCIONE, .active = VSC_ACTIVE_TENSION,
      .feature = at_rest}, GUCCIONE},
    {{.name = "half of it held", .feature = half_held}, SPRINGS},
    {{.name = "half of it held, damping, node-averaged", .damping = true, .nodal = true, .feature = half_held},
     DAMPED_NODAL},
    [FACE_HELD] = {{.name = "a face held", .feature = face_held}, SPRINGS},
    {{.name = "a face held and moved, by a curve of 0", .feature = face_moved}, FACE_HELD},
    {{.name = "damping and viscosity of 0", .feature = no_viscosity}, SPRINGS},
    {{.name = "angular springs of 0", .feature = no_angular}, SPRINGS},
    {{.name = "gravity", .feature = gravity}, SPRINGS},
    {{.name = "gravity of 0", .feature = no_gravity}, SPRINGS},
    {{.name = "a pressure on a face", .feature = pressed}, SPRINGS},
    {{.name = "a pressure on a face, its curve 0", .feature = pressed_later}, SPRINGS},
    {{.name = "springs on a face", .feature = on_springs}, SPRINGS},
    {{.name = "an obstacle far away", .feature = far_obstacle}, SPRINGS},
    {{.name = "an obstacle far away, for a face", .feature = far_obstacle_of_face}, SPRINGS},
    {{.name = "an inclusion of fraction 0", .feature = no_inclusion}, SPRINGS},
    {{.name = "a membrane on a face", .feature = membrane}, SPRINGS},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

// Times the row and, in turns with it, the one that it is compared with; without any that is the row itself.
static vsc_status time_row(const row *it, const vsc_mesh *mesh, double *each, double *over, vsc_error *error)
{
  vsc_specimen_run run, other = {0};
  vsc_specimen_cost cost, without;
  vsc_status status = vsc_specimen_open(&it->specimen, mesh, &run, &cost, error);
  if (status == VSC_OK && it->over >= 0)
    status = vsc_specimen_open(&rows[it->over].specimen, mesh, &other, &without, error);
  for (int turn = 0; turn < TURNS && status == VSC_OK; turn++) {
    status = vsc_specimen_step(&run, &cost.one, error);
    if (status == VSC_OK && it->over >= 0) status = vsc_specimen_step(&other, &without.one, error);
  }
  vsc_specimen_close(&run);
  vsc_specimen_close(&other);
  if (status != VSC_OK) return status;
  *each = 1e9 * cost.one / (double)cost.elements;
  *over = it->over >= 0 ? cost.one / without.one : 1;
  return VSC_OK;
}

static vsc_status time_rows(const vsc_step_wish *wish, const vsc_mesh *mesh, vsc_error *error)
{
  for (int k = 0; k < ROWS; k++) {
    double each, over;
    const vsc_status status = time_row(&rows[k], mesh, &each, &over, error);
    if (status != VSC_OK) return status;
    const char *name = rows[k].specimen.name, *without = rows[k].over >= 0 ? rows[rows[k].over].specimen.name : "";
    printf("%-44s %6.1f %6.2f  %s\n", name, each, over, without);
    fflush(stdout);
    if (wish->output.csv != NULL)
      fprintf(wish->output.csv, "\"%s\",%.4g,%.4g,\"%s\"\n", name, each, over, without);
  }
  return VSC_OK;
}

int vsc_bench_skipping(int argc, char **argv)
{
  vsc_step_wish wish;
  int code;
  if (!vsc_step_options("skipping", argc, argv, &wish, &code)) return code;
  const size_t tets = wish.elements > 0 ? (size_t)wish.elements : 100000;
  vsc_mesh *mesh = NULL;
  vsc_error error;
  double read;
  vsc_status status = vsc_specimen_mesh(VSC_SPECIMEN_TETS, tets, &mesh, &read, &error);
  if (status == VSC_OK && vsc_arrays_add(&mesh->element_data, "nothing", 1, mesh->element_count) == NULL)
    status = vsc_fail_memory(&error, "the block");
  vsc_machine_say(stdout);
  puts("what a step costs, ns a tet on one thread, and over the row that it is timed in turns with");
  if (wish.output.csv != NULL) fprintf(wish.output.csv, "what,ns a tet,over,of\n");
  if (status == VSC_OK) status = time_rows(&wish, mesh, &error);
  vsc_mesh_free(mesh);
  if (status == VSC_OK && wish.output.folder != NULL)
    status = vsc_bench_looking(wish.output.csv, wish.output.folder, tets, &error);
  return vsc_step_finish(&wish, status, &error);
}
