// SPDX-License-Identifier: GPL-3.0-or-later
// The keys of the scene's outermost level, and how rows and words are looked up.
#include <stdio.h>
#include <string.h>

#include "io/scene_rows.h"

// ---- mesh

static const vsc_row ellipsoid_rows[] = {
    {"centre", VECTOR(vsc_curved_def, centre, VSC_LENGTH), .needed = VSC_ALWAYS,
     .text = "[0 mm, 0 mm, 0 mm]", .meaning = "where its axes cross; they are x, y, z"},
    {"radii", VECTOR(vsc_curved_def, radii, VSC_LENGTH), .needed = VSC_ALWAYS,
     .text = "[7 mm, 7 mm, 17 mm]", .meaning = "along x, y, z"},
};
GROUP(static, ellipsoid, -1);

static const vsc_row curved_rows[] = {
    {"surface", NAME(vsc_curved_def, surface), .needed = VSC_ALWAYS, .text = "endo",
     .meaning = "one of the surfaces below"},
    {"ellipsoid", PART(0, ellipsoid), .needed = VSC_ALWAYS, .meaning = "what it lies on"},
};
GROUP(static, curved, -1, .size = sizeof(vsc_curved_def));

static const vsc_row mesh_rows[] = {
    {"file", .kind = VSC_ROW_PATH, AT(vsc_scene, mesh_file), .needed = VSC_ALWAYS,
     .text = "mesh.vtu", .meaning = "tetrahedra, .vtu or legacy .vtk; relative to this scene's folder"},
    {"unit", UNIT(vsc_scene, mesh_unit, VSC_LENGTH), .needed = VSC_ALWAYS, .text = "mm",
     .meaning = "length of one unit of its coordinates: mm, m, 0.1 mm"},
    {"region_array", NAME(vsc_scene, definition.region_array), .commented = true, .text = "region",
     .meaning = "cell array of region numbers, whole ones; absent: one region, 0"},
    {"order", .kind = VSC_ROW_WHOLE_INT, AT(vsc_scene, mesh_order), .text = "1",
     .meaning = "2: elements become quadratic tetrahedra (other kinds are cut into such), with a node in the middle of each edge"},
    {"curved", PARTS(vsc_scene, curved, curved_count, curved), .commented = true,
     .meaning = "order: 2: surfaces whose edges are bent onto an ellipsoid"},
};
GROUP(static, mesh, -1);

static const vsc_word mesh_shapes[] = {{"unloaded", false}, {"loaded", true}, {NULL, 0}};

static const vsc_row prestress_rows[] = {
    {"mesh", CHOICE(vsc_prestress_def, loaded, mesh_shapes), .text = "loaded",
     .meaning = "the mesh is in equilibrium under the loads (a medical image); default unloaded: it is at rest"},
    {"time", QUANTITY(vsc_prestress_def, time, VSC_TIME), .text = "0 ms",
     .meaning = "under those of this time, at which the simulation begins"},
    {"tolerance", QUANTITY(vsc_prestress_def, tolerance, VSC_LENGTH), .text = "0.01 mm",
     .meaning = "by which nodes may be off the mesh then"},
    {"iterations", .kind = VSC_ROW_WHOLE_INT, AT(vsc_prestress_def, iterations), .text = "20",
     .meaning = "at most, until the shape at rest is found"},
};
GROUP(static, prestress, -1);

// ---- how it is solved

static const vsc_word solve_kinds[] = {{"explicit", VSC_SOLVE_EXPLICIT},
                                       {"equilibrium", VSC_SOLVE_EQUILIBRIUM},
                                       {"implicit", VSC_SOLVE_IMPLICIT},
                                       {NULL, 0}};
static const vsc_word linear_kinds[] = {{"auto", VSC_LINEAR_AUTO},
                                        {"direct", VSC_LINEAR_DIRECT},
                                        {"iterative", VSC_LINEAR_ITERATIVE},
                                        {NULL, 0}};

static const vsc_word schemes[] = {{"generalized_alpha", VSC_SCHEME_GENERALIZED_ALPHA},
                                   {"trapezoid", VSC_SCHEME_TRAPEZOID},
                                   {"bdf2", VSC_SCHEME_BDF2},
                                   {NULL, 0}};

static const vsc_word methods[] = {{"newton", VSC_STATICS_NEWTON},
                                   {"relaxation", VSC_STATICS_RELAXATION},
                                   {NULL, 0}};

static const vsc_row solver_rows[] = {
    {"method", CHOICE(vsc_definition, solve.method, methods), .text = "newton",
     .meaning = "equilibrium: or relaxation (damped steps, no matrix)"},
    {"scheme", CHOICE(vsc_definition, solve.scheme, schemes), .text = "generalized_alpha",
     .meaning = "implicit: or trapezoid, bdf2"},
    {"rho", NUMBER(vsc_definition, solve.rho), .text = "0.5",
     .meaning = "generalized_alpha: what the fastest motions keep in a step, 0 to 1"},
    {"accuracy", NUMBER(vsc_definition, solve.accuracy), .text = "1e-4",
     .meaning = "implicit, time.step auto: error of a step, part of the body's size"},
    {"linear", CHOICE(vsc_definition, solve.linear, linear_kinds), .text = "auto",
     .meaning = "systems: auto, direct (a factor, reused), iterative (little memory)"},
    {"incompressible", NUMBER(vsc_definition, solve.incompressible), .text = "0",
     .meaning = "equilibrium: largest |J - 1|, by multipliers (tets: volume: nodal); 0: as K has it"},
    {"tolerance", NUMBER(vsc_definition, solve.tolerance), .text = "0",
     .meaning = "of the residual, part of the forces at work; 0: 1e-6, implicit: as accuracy, at most 1e-4"},
};
GROUP(static, solver, -1);

// ---- time and output

static const vsc_row time_rows[] = {
    {"end", QUANTITY(vsc_definition, end_time, VSC_TIME), .needed = VSC_ALWAYS, .text = "1.6 s",
     .meaning = "simulated time"},
    {"step", QUANTITY(vsc_definition, step, VSC_TIME), .zero_word = "auto", .text = "auto",
     .meaning = "auto: from the stable step (implicit: from errors and loads); or a time, refused above it"},
    {"force", .kind = VSC_ROW_BOOL, AT(vsc_definition, force_step), .text = "false",
     .meaning = "true: takes that time even above the stable step, and says so"},
    {"safety", NUMBER(vsc_definition, safety), .text = "0.8",
     .meaning = "auto: fraction of the stable step that is taken"},
    {"cycle", QUANTITY(vsc_definition, cycle, VSC_TIME), .commented = true, .text = "800 ms",
     .meaning = "the run stops when a cycle of this length, a multiple of the loads' periods, repeats the last; default 0 ms: "
                "at the end only"},
    {"cycle_tolerance", NUMBER(vsc_definition, cycle_tolerance), .commented = true, .text = "1e-3",
     .meaning = "to which it has to, as a part of the stroke and of the speed"},
    {"mass_scaling", QUANTITY(vsc_definition, mass_scaling, VSC_TIME), .commented = true, .text = "0.05 ms",
     .meaning = "mass, but no weight, is added at the stiffest elements until steps may be as long; default 0 ms: none"},
    {"most_added_mass", NUMBER(vsc_definition, most_added_mass), .commented = true, .text = "0.05",
     .meaning = "part of the body's mass that this may add"},
    {"selective_mass_scaling", QUANTITY(vsc_definition, selective_mass_scaling, VSC_TIME), .commented = true, .text = "1 ms",
     .meaning = "neighbours become inert against one another, but not the body as a whole, until steps may be as long; default "
                "0 ms: not"},
};
GROUP(static, time, -1);

static const vsc_word precisions[] = {{"single", false}, {"double", true}, {NULL, 0}};
static const vsc_word frame_arrays[] = {
    {"displacement", 0}, {"velocity", 0},       {"fiber", 0},     {"sheet", 0},
    {"normal", 0},       {"active_tension", 0}, {"stretch_f", 0}, {"volume_ratio", 0},
    {"region", 0},       {"strain_fiber", 0},   {"strain", 0},    {"principal_strains", 0},
    {"principal_strain_axis", 0}, {"stress_fiber", 0},        {"stress", 0},
    {"von_mises", 0},             {"principal_stresses", 0},  {"principal_stress_axis", 0},
    {"helix_angle", 0},           {NULL, 0},
};

static const vsc_row point_rows[] = {
    {"name", NAME(vsc_point_def, name), .needed = VSC_ALWAYS, .text = "p0",
     .meaning = "its signals are point_p0_ux and so on"},
    {"at", VECTOR(vsc_point_def, at, VSC_LENGTH), .needed = VSC_ALWAYS,
     .text = "[25 mm, 30 mm, 0 mm]", .meaning = "where it is at rest"},
    {"reach", QUANTITY(vsc_point_def, reach, VSC_LENGTH), .zero_word = "auto", .text = "auto",
     .meaning = "how far outside the body that may be; auto: a tenth of the elements' size"},
};

static void start_point(void *target)
{
  *(vsc_point_def *)target = (vsc_point_def){.name = ""};
}

GROUP(static, point, -1, .size = sizeof(vsc_point_def), .start = start_point);

static const vsc_row output_rows[] = {
    {"frames", QUANTITY(vsc_output_def, frame_interval, VSC_TIME), .text = "10 ms",
     .meaning = "between VTU frames; default of equilibria: the end"},
    {"precision", CHOICE(vsc_output_def, double_precision, precisions), .text = "single",
     .meaning = "of the frames; or double"},
    {"arrays", .kind = VSC_ROW_NAMES, LIST_AT(vsc_output_def, arrays, array_count),
     .count = VSC_OUTPUT_ARRAYS, .words = frame_arrays,
     .text = "[displacement, velocity, fiber, sheet, normal, active_tension, stretch_f, "
             "volume_ratio, region]",
     .meaning = "of the frames; []: the usual ones; also strain, strain_fiber, principal_strains, "
                "principal_strain_axis, stress, stress_fiber, von_mises, principal_stresses, "
                "principal_stress_axis, helix_angle"},
    {"axis", VECTOR(vsc_output_def, axis, VSC_NUMBER), .text = "[0, 0, 0]",
     .meaning = "helix_angle: from apex to base; [0, 0, 0]: that of fibers.helix"},
    {"centre", VECTOR(vsc_output_def, centre, VSC_LENGTH), .text = "[0 mm, 0 mm, 0 mm]",
     .meaning = "helix_angle: a point that this axis goes through"},
    {"signals", QUANTITY(vsc_output_def, signal_interval, VSC_TIME), .text = "1 ms",
     .meaning = "between rows of signals.csv, over which reactions of obstacles and supports are means (equilibria: the "
                "force now); default of implicit steps and equilibria: as the frames"},
    {"cavities", .kind = VSC_ROW_NAMES, LIST_AT(vsc_output_def, cavities, cavity_count),
     .count = VSC_OUTPUT_ARRAYS, .text = "[endo]",
     .meaning = "surfaces whose (capped) volume is a signal"},
    {"points", PARTS(vsc_output_def, points, point_count, point), .commented = true,
     .meaning = "of the tissue, whose displacement and position are signals"},
    {"checkpoint", QUANTITY(vsc_output_def, checkpoint_interval, VSC_TIME), .text = "0 ms",
     .meaning = "between checkpoints; 0 ms: only at the end"},
};
GROUP(static, output, -1);

// ---- the scene

static const vsc_word volumes[] = {{"nodal", VSC_VOLUME_NODAL},
                                   {"element", VSC_VOLUME_ELEMENT},
                                   {NULL, 0}};

static const vsc_word tets_kinds[] = {
    {"plain", VSC_TETS_PLAIN}, {"smoothed", VSC_TETS_SMOOTHED}, {NULL, 0}};

static const vsc_word mass_kinds[] = {{"lumped", VSC_MASS_LUMPED},
                                      {"voronoi", VSC_MASS_VORONOI},
                                      {"equal", VSC_MASS_EQUAL},
                                      {"consistent", VSC_MASS_CONSISTENT},
                                      {NULL, 0}};
static const vsc_word kept_volumes[] = {
    {"none", VSC_KEEP_NONE}, {"total", VSC_KEEP_TOTAL},     {"region", VSC_KEEP_REGION},
    {"node", VSC_KEEP_NODE}, {"element", VSC_KEEP_ELEMENT}, {NULL, 0}};

#define SCENE_PARTS(items, counter, group_) \
  PARTS(vsc_scene, definition.items, definition.counter, group_)

static const vsc_row vsc_scene_group_rows[] = {
    {"mesh", PART(0, mesh), .needed = VSC_ALWAYS, .meaning = "what is simulated"},
    {"surfaces", SCENE_PARTS(surfaces, surface_count, vsc_surface_group),
     .meaning = "parts of the boundary, by name; \"boundary\" is all of it"},
    {"node_sets", SCENE_PARTS(sets, set_count, vsc_node_set_group),
     .meaning = "sets of nodes, by name"},
    {"fibers", PART(offsetof(vsc_scene, fibers), vsc_fiber_group),
     .meaning = "where the fibre axes come from; absent: no fibres"},
    {"materials", SCENE_PARTS(materials, material_count, vsc_material_group),
     .meaning = "tissues"},
    {"vessels", SCENE_PARTS(vessels, vessel_count, vsc_vessel_group), .commented = true,
     .meaning = "vessels that the mesh does not resolve"},
    {"volume", CHOICE(vsc_scene, definition.volume, volumes), .text = "nodal",
     .meaning = "linear tets that share a volume ratio: all round a node; or element: each alone"},
    {"tets", CHOICE(vsc_scene, definition.tets, tets_kinds), .text = "plain",
     .meaning = "linear tets alone; or smoothed: laws see the mean strain round each edge (walls of two "
                "layers and more)"},
    {"keep_volume", CHOICE(vsc_scene, definition.kept_volume, kept_volumes), .text = "none",
     .meaning = "to rounding, by multipliers: total, region (each material); node, element (explicit)"},
    {"masses", CHOICE(vsc_scene, definition.masses, mass_kinds), .text = "lumped",
     .meaning = "of the nodes, and their weights but in equilibria (the elements'); or voronoi: of what is nearest; "
                "equal: all alike; consistent (solve: implicit)"},
    {"membranes", SCENE_PARTS(membranes, membrane_count, vsc_membrane_group), .commented = true,
     .meaning = "sheets on surfaces: capsule, valve, cloth"},
    {"obstacles", SCENE_PARTS(obstacles, obstacle_count, vsc_obstacle_group), .commented = true,
     .meaning = "rigid things that no node enters; their reaction, a signal, is its mean since the row before (equilibria: "
                "the force now)"},
    {"supports", SCENE_PARTS(supports, support_count, vsc_support_group),
     .meaning = "what holds the tissue"},
    {"robin", SCENE_PARTS(robins, robin_count, vsc_robin_group), .commented = true,
     .meaning = "springs and dashpots per area, between a surface and its place at rest"},
    {"gravity", VECTOR(vsc_scene, definition.gravity, VSC_ACCELERATION),
     .text = "[0 m/s2, 0 m/s2, 0 m/s2]", .meaning = "default none"},
    {"pressures", SCENE_PARTS(pressures, pressure_count, vsc_pressure_group),
     .meaning = "that follow their surface"},
    {"initial_velocity", PART(offsetof(vsc_scene, definition.velocity), vsc_velocity_group),
     .commented = true, .meaning = "of the nodes at the start; absent: at rest"},
    {"prestress", PART(offsetof(vsc_scene, prestress), prestress), .commented = true,
     .meaning = "where the mesh is not the body at rest"},
    {"solve", CHOICE(vsc_scene, definition.solve.kind, solve_kinds), .text = "explicit",
     .meaning = "explicit or implicit (motion), or equilibrium (forces balance, no inertia)"},
    {"solver", PART(offsetof(vsc_scene, definition), solver), .commented = true,
     .meaning = "solve: implicit or equilibrium: how"},
    {"time", PART(offsetof(vsc_scene, definition), time), .needed = VSC_ALWAYS,
     .meaning = "how long"},
    {"output", PART(offsetof(vsc_scene, output), output), .meaning = "what is written"},
};
GROUP(, vsc_scene_group, -1, .size = sizeof(vsc_scene));

// ---- looking up

const vsc_row *vsc_group_find(const vsc_group *group, const char *key)
{
  for (size_t i = 0; i < group->row_count; i++)
    if (strcmp(group->rows[i].key, key) == 0) return &group->rows[i];
  return NULL;
}

const void *vsc_slot_value(const vsc_group *group, const vsc_slot *slots, const char *key)
{
  return slots[vsc_group_find(group, key) - group->rows].value;
}

enum { MOST_WORDS = 32 };

// "<head>a, b, c" and the nearest of `words` to `word`.
static void list_words(const char *word, const char *const *words, size_t count, const char *head,
                       char *text, size_t size)
{
  size_t used = (size_t)snprintf(text, size, "%s", head);
  for (size_t i = 0; i < count && used < size; i++)
    used += (size_t)snprintf(text + used, size - used, i == 0 ? "%s" : ", %s", words[i]);
  const char *nearest = vsc_nearest(word, words, count);
  if (nearest != NULL && used < size)
    snprintf(text + used, size - used, "; did you mean %s?", nearest);
}

void vsc_group_hint(const vsc_group *group, const char *key, char *text, size_t size)
{
  const char *keys[MOST_WORDS] = {NULL};
  size_t count = 0;
  for (; count < group->row_count && count < MOST_WORDS; count++)
    keys[count] = group->rows[count].key;
  list_words(key, keys, count, "known here: ", text, size);
}

void vsc_words_hint(const vsc_word *words, const char *word, char *text, size_t size)
{
  const char *list[MOST_WORDS] = {NULL};
  size_t count = 0;
  for (; words[count].word != NULL && count < MOST_WORDS; count++) list[count] = words[count].word;
  list_words(word, list, count, "expected one of ", text, size);
}

int vsc_group_kind(const vsc_group *group, const void *target)
{
  int kind = -1;
  if (group->kind_offset >= 0)
    memcpy(&kind, (const char *)target + group->kind_offset, sizeof kind);
  return kind;
}

bool vsc_row_allowed(const vsc_row *row, int kind)
{
  return row->allowed == 0 || (kind >= 0 && (row->allowed >> kind & 1) != 0);
}

const char *vsc_row_text(const vsc_group *group, const vsc_row *row)
{
  return strcmp(row->text, "*") == 0 ? group->example : row->text;
}

const char *vsc_word_of(const vsc_word *words, int value)
{
  for (; words->word != NULL; words++)
    if (words->value == value) return words->word;
  return "?";
}
