// SPDX-License-Identifier: GPL-3.0-or-later
// The keys of curves, materials, supports and loads.
#include "io/scene_rows.h"

// ---- curves

static const vsc_word curve_kinds[] = {
    {"constant", VSC_CURVE_CONSTANT},       {"ramp", VSC_CURVE_RAMP},
    {"half_sine", VSC_CURVE_HALF_SINE},     {"double_hill", VSC_CURVE_DOUBLE_HILL},
    {"tanh_pair", VSC_CURVE_TANH_PAIR},     {"table", VSC_CURVE_TABLE},
    {"bestel", VSC_CURVE_BESTEL},           {"bestel_pressure", VSC_CURVE_BESTEL_PRESSURE},
    {NULL, 0},
};

enum {
  DRIVEN = BIT(VSC_CURVE_BESTEL) | BIT(VSC_CURVE_BESTEL_PRESSURE),
  STARTING = BIT(VSC_CURVE_RAMP) | BIT(VSC_CURVE_HALF_SINE) | BIT(VSC_CURVE_DOUBLE_HILL) |
             BIT(VSC_CURVE_TANH_PAIR) | DRIVEN,
  LASTING = BIT(VSC_CURVE_RAMP) | BIT(VSC_CURVE_HALF_SINE) | BIT(VSC_CURVE_TANH_PAIR),
  SMOOTH = BIT(VSC_CURVE_DOUBLE_HILL) | BIT(VSC_CURVE_TANH_PAIR),
  HILL = BIT(VSC_CURVE_DOUBLE_HILL),
  TABLE = BIT(VSC_CURVE_TABLE),
  FILLED = BIT(VSC_CURVE_BESTEL_PRESSURE),
};

static void start_curve(void *target)
{
  vsc_curve_def *curve = target;
  *curve = vsc_default_curve(curve->kind);
}

static const vsc_row vsc_curve_group_rows[] = {
    {"kind", CHOICE(vsc_curve_def, kind, curve_kinds), .needed = VSC_ALWAYS, .after = start_curve,
     .text = "half_sine",
     .meaning = "constant, ramp, half_sine, double_hill, tanh_pair, table, from 0 to 1; or from "
                "equations: bestel (a tension), bestel_pressure"},
    {"start", QUANTITY(vsc_curve_def, start, VSC_TIME), .allowed = STARTING, .text = "100 ms",
     .meaning = "default 0 ms; bestel: 160 ms, bestel_pressure: 170 ms"},
    {"stop", QUANTITY(vsc_curve_def, stop, VSC_TIME), .allowed = DRIVEN, .commented = true,
     .text = "484 ms", .meaning = "bestel, bestel_pressure, also below: end of systole"},
    {"width", QUANTITY(vsc_curve_def, width, VSC_TIME), .allowed = DRIVEN, .commented = true,
     .text = "5 ms", .meaning = "time in which systole begins and ends"},
    {"rate_up", QUANTITY(vsc_curve_def, rate_up, VSC_RATE), .allowed = DRIVEN, .commented = true,
     .text = "5 1/s", .meaning = "in systole"},
    {"rate_down", QUANTITY(vsc_curve_def, rate_down, VSC_RATE), .allowed = DRIVEN,
     .commented = true, .text = "-30 1/s", .meaning = "otherwise"},
    {"rate_pre", QUANTITY(vsc_curve_def, rate_pre, VSC_RATE), .allowed = FILLED, .commented = true,
     .text = "5 1/s", .meaning = "bestel_pressure: before the end of systole, besides"},
    {"rate_mid", QUANTITY(vsc_curve_def, rate_mid, VSC_RATE), .allowed = FILLED, .commented = true,
     .text = "1 1/s", .meaning = "bestel_pressure: always, besides"},
    {"filling", QUANTITY(vsc_curve_def, filling, VSC_RATE), .allowed = FILLED, .commented = true,
     .text = "0.4375 1/s", .meaning = "bestel_pressure: rise by the atrium's pressure"},
    {"duration", QUANTITY(vsc_curve_def, duration, VSC_TIME), .allowed = LASTING, .text = "300 ms",
     .meaning = "ramp, half_sine, tanh_pair"},
    {"rise", QUANTITY(vsc_curve_def, rise, VSC_TIME), .allowed = SMOOTH, .commented = true,
     .text = "100 ms", .meaning = "double_hill: time constant; tanh_pair: default 20 ms (plausible, not published)"},
    {"fall", QUANTITY(vsc_curve_def, fall, VSC_TIME), .allowed = SMOOTH, .commented = true,
     .text = "300 ms", .meaning = "likewise; tanh_pair: default 20 ms"},
    {"rise_power", NUMBER(vsc_curve_def, rise_power), .allowed = HILL, .commented = true,
     .text = "2", .meaning = "double_hill"},
    {"fall_power", NUMBER(vsc_curve_def, fall_power), .allowed = HILL, .commented = true,
     .text = "20", .meaning = "double_hill"},
    {"file", .kind = VSC_ROW_TEXT, .allowed = TABLE, .input_only = true, .commented = true,
     .text = "curve.csv", .meaning = "table: CSV with two columns, time and value; '#' comments"},
    {"time_unit", .kind = VSC_ROW_TEXT, .allowed = TABLE, .input_only = true, .commented = true,
     .text = "ms", .meaning = "of the first column"},
    {"times", .kind = VSC_ROW_SERIES, .quantity = VSC_TIME,
     LIST_AT(vsc_curve_def, times, point_count), .allowed = TABLE, .commented = true,
     .text = "[0 ms, 150 ms, 400 ms]", .meaning = "table without a file: its points,"},
    {"values", .kind = VSC_ROW_SERIES, .quantity = VSC_NUMBER,
     LIST_AT(vsc_curve_def, values, point_count), .allowed = TABLE, .commented = true,
     .text = "[0, 1, 0]", .meaning = "and the values there; between them a monotone spline (Steffen's), no straight lines"},
    {"period", QUANTITY(vsc_curve_def, period, VSC_TIME), .text = "800 ms",
     .meaning = "after which it repeats; default 0 ms: never"},
};
GROUP(, vsc_curve_group, offsetof(vsc_curve_def, kind), .finish = vsc_curve_finish);

// ---- materials

static const vsc_word active_kinds[] = {{"none", VSC_ACTIVE_NONE},
                                        {"spring", VSC_ACTIVE_SPRING},
                                        {"tension", VSC_ACTIVE_TENSION},
                                        {NULL, 0}};
enum {
  OF_SPRING = BIT(VSC_ACTIVE_NONE) | BIT(VSC_ACTIVE_SPRING),
  OF_TENSION = BIT(VSC_ACTIVE_NONE) | BIT(VSC_ACTIVE_TENSION),
};

static const vsc_row active_rows[] = {
    {"kind", CHOICE(vsc_active_def, kind, active_kinds), .needed = VSC_ALWAYS, .text = "tension",
     .meaning = "none, spring (the fibre stiffens and shortens), tension"},
    {"tension", QUANTITY(vsc_active_def, tension, VSC_PRESSURE), .allowed = OF_TENSION,
     .needed = BIT(VSC_ACTIVE_TENSION), .text = "60 kPa", .meaning = "along the fibre at the peak"},
    {"length_factor", NUMBER(vsc_active_def, length_factor), .allowed = OF_TENSION,
     .commented = true, .text = "1.45",
     .meaning = "tension grows by it times (fibre stretch - 1); default 0"},
    {"sheet_fraction", NUMBER(vsc_active_def, sheet_fraction), .allowed = OF_TENSION,
     .commented = true, .text = "0.2", .meaning = "part of the tension along the sheet; default 0"},
    {"normal_fraction", NUMBER(vsc_active_def, normal_fraction), .allowed = OF_TENSION,
     .commented = true, .text = "0.1", .meaning = "part of the tension along the normal; default 0"},
    {"stiffness", QUANTITY(vsc_active_def, stiffness, VSC_PRESSURE), .allowed = OF_SPRING,
     .commented = true, .text = "200 kPa",
     .meaning = "spring: fibre modulus at the peak (law: paper has its own)"},
    {"rest_stretch", NUMBER(vsc_active_def, rest_stretch), .allowed = OF_SPRING, .commented = true,
     .text = "0.8", .meaning = "spring: rest stretch at the peak; default 1"},
    {"delay", QUANTITY(vsc_active_def, delay, VSC_TIME), .text = "0 ms",
     .meaning = "of the curve in this tissue"},
    {"amplitude_array", NAME(vsc_active_def, amplitude_array), .commented = true,
     .text = "amplitude", .meaning = "cell array that multiplies the curve"},
    {"delay_array", NAME(vsc_active_def, delay_array), .commented = true, .text = "delay",
     .meaning = "cell array added to the delay"},
    {"delay_unit", UNIT(vsc_active_def, delay_unit, VSC_TIME), .commented = true, .text = "1 ms",
     .meaning = "of delay_array"},
    {"curve", PART(offsetof(vsc_active_def, curve), vsc_curve_group), .meaning = "of time"},
};
GROUP(static, active, offsetof(vsc_active_def, kind));

static const vsc_row axial_rows[] = {
    {"f", QUANTITY(vsc_material_def, axial[0], VSC_PRESSURE), .needed = VSC_ALWAYS,
     .text = "10 kPa", .meaning = "along the fibre"},
    {"s", QUANTITY(vsc_material_def, axial[1], VSC_PRESSURE), .needed = VSC_ALWAYS,
     .text = "5 kPa", .meaning = "along the sheet"},
    {"n", QUANTITY(vsc_material_def, axial[2], VSC_PRESSURE), .needed = VSC_ALWAYS,
     .text = "5 kPa", .meaning = "along the normal"},
};
GROUP(static, axial, -1);

static const vsc_row angular_rows[] = {
    {"fs", QUANTITY(vsc_material_def, angular[0], VSC_PRESSURE), .needed = VSC_ALWAYS,
     .text = "3 kPa", .meaning = "between fibre and sheet"},
    {"sn", QUANTITY(vsc_material_def, angular[1], VSC_PRESSURE), .needed = VSC_ALWAYS,
     .text = "3 kPa", .meaning = "between sheet and normal"},
    {"nf", QUANTITY(vsc_material_def, angular[2], VSC_PRESSURE), .needed = VSC_ALWAYS,
     .text = "3 kPa", .meaning = "between normal and fibre"},
};
GROUP(static, angular, -1);

static const vsc_row coupling_rows[] = {
    {"fs", QUANTITY(vsc_material_def, coupling[0], VSC_PRESSURE), .text = "1 kPa",
     .meaning = "of fibre and sheet; default 0 kPa"},
    {"sn", QUANTITY(vsc_material_def, coupling[1], VSC_PRESSURE), .text = "1 kPa",
     .meaning = "of sheet and normal"},
    {"nf", QUANTITY(vsc_material_def, coupling[2], VSC_PRESSURE), .text = "1 kPa",
     .meaning = "of normal and fibre"},
};
GROUP(static, coupling, -1);

static const vsc_row damping_rows[] = {
    {"f", QUANTITY(vsc_material_def, damping[0], VSC_VISCOSITY), .text = "10 Pa s",
     .meaning = "along the fibre; default 0 Pa s"},
    {"s", QUANTITY(vsc_material_def, damping[1], VSC_VISCOSITY), .text = "10 Pa s",
     .meaning = "along the sheet"},
    {"n", QUANTITY(vsc_material_def, damping[2], VSC_VISCOSITY), .text = "10 Pa s",
     .meaning = "along the normal"},
};
GROUP(static, damping, -1);

static const vsc_word laws[] = {{"springs", VSC_LAW_SPRINGS},
                                {"paper", VSC_LAW_PAPER},
                                {"classical", VSC_LAW_CLASSICAL},
                                {"neo_hookean", VSC_LAW_NEO_HOOKEAN},
                                {"guccione", VSC_LAW_GUCCIONE},
                                {"fung", VSC_LAW_FUNG},
                                {"usyk", VSC_LAW_FUNG},
                                {"holzapfel_ogden", VSC_LAW_HOLZAPFEL_OGDEN},
                                {"mooney_rivlin", VSC_LAW_MOONEY_RIVLIN},
                                {"veronda_westmann", VSC_LAW_VERONDA_WESTMANN},
                                {NULL, 0}};
enum {
  OF_SPRINGS = BIT(VSC_LAW_SPRINGS),
  OF_PAPER = BIT(VSC_LAW_PAPER),
  OF_CLASSICAL = BIT(VSC_LAW_CLASSICAL),
  OF_NEO_HOOKEAN = BIT(VSC_LAW_NEO_HOOKEAN),
  OF_GUCCIONE = BIT(VSC_LAW_GUCCIONE),
  OF_FUNG = BIT(VSC_LAW_FUNG),
  OF_HOLZAPFEL_OGDEN = BIT(VSC_LAW_HOLZAPFEL_OGDEN),
  OF_MOONEY_RIVLIN = BIT(VSC_LAW_MOONEY_RIVLIN),
  OF_VERONDA_WESTMANN = BIT(VSC_LAW_VERONDA_WESTMANN),
  OF_TISSUES = OF_NEO_HOOKEAN | OF_GUCCIONE | OF_FUNG | OF_HOLZAPFEL_OGDEN | OF_MOONEY_RIVLIN |
               OF_VERONDA_WESTMANN,
  OF_STRAIN = OF_SPRINGS | OF_TISSUES,
};

// The constants of a tissue law under its own name.
#define CONSTANTS(name, of, what) \
  {#name, PART(0, vsc_law_##name##_group), .allowed = of, .needed = of, .commented = true, .meaning = what}

static const vsc_row vsc_material_group_rows[] = {
    {"name", NAME(vsc_material_def, name), .needed = VSC_ALWAYS, .text = "myocardium",
     .meaning = "for reports"},
    {"regions", .kind = VSC_ROW_INTEGERS, LIST_AT(vsc_material_def, regions, region_count),
     .count = LENGTH(((vsc_material_def *)NULL)->regions), .commented = true, .text = "[1, 2]",
     .meaning = "values of mesh.region_array; absent: every element no other material names"},
    {"density", QUANTITY(vsc_material_def, density, VSC_DENSITY), .text = "1.06 g/cm3",
     .meaning = "at rest"},
    {"law", CHOICE(vsc_material_def, law, laws), .text = "springs",
     .meaning = "springs, neo_hookean, guccione, fung (usyk), holzapfel_ogden, mooney_rivlin, "
                "veronda_westmann; to compare: paper (the printed formulas), classical (springs on "
                "edges)"},
    {"axial", PART(0, axial), .allowed = OF_SPRINGS, .needed = OF_SPRINGS,
     .meaning = "springs along the frame's axes"},
    {"angular", PART(0, angular), .allowed = OF_SPRINGS, .needed = OF_SPRINGS,
     .meaning = "springs between the axes"},
    {"coupling", PART(0, coupling), .allowed = OF_SPRINGS, .commented = true,
     .meaning = "between the stretches of two axes"},
    {"damping", PART(0, damping), .allowed = OF_SPRINGS, .meaning = "axial viscosity"},
    {"viscosity", QUANTITY(vsc_material_def, viscosity, VSC_VISCOSITY), .allowed = OF_STRAIN,
     .commented = true, .text = "100 Pa s", .meaning = "Kelvin-Voigt, of all strain; default 0 Pa s"},
    {"prony", PARTS(vsc_material_def, prony, prony_count, vsc_prony_group), .allowed = OF_STRAIN,
     .commented = true,
     .meaning = "parts of the law's passive stress that relax; the law's constants are instantaneous; in "
                "equilibria all has relaxed"},
    {"volume_modulus", QUANTITY(vsc_material_def, volume_modulus, VSC_PRESSURE),
     .allowed = OF_STRAIN, .needed = OF_STRAIN, .text = "1 MPa",
     .meaning = "against a change of volume"},
    {"stabilization", QUANTITY(vsc_material_def, stabilization, VSC_PRESSURE),
     .allowed = OF_STRAIN, .text = "10 kPa",
     .meaning = "the same of each frame, beside a shared volume (volume: nodal; other cells than linear tets in any case); "
                "0, default: springs none, else the shear modulus out of volume_modulus"},
    {"axes", PARTS(vsc_material_def, axes, axis_count, vsc_axis_group), .allowed = OF_SPRINGS,
     .commented = true, .meaning = "more axes than f, s, n"},
    {"pairs", PARTS(vsc_material_def, pairs, pair_count, vsc_pair_group), .allowed = OF_SPRINGS,
     .commented = true, .meaning = "more angular springs"},
    {"inclusions", PARTS(vsc_material_def, inclusions, inclusion_count, vsc_inclusion_group),
     .allowed = OF_SPRINGS, .commented = true, .meaning = "materials that take a part of each element"},
    {"isochoric", .kind = VSC_ROW_BOOL, AT(vsc_material_def, isochoric), .allowed = OF_TISSUES,
     .commented = true, .text = "false",
     .meaning = "true: the law without volume change (holzapfel_ogden: its ground alone)"},
    CONSTANTS(neo_hookean, OF_NEO_HOOKEAN, "law: neo_hookean: rubber"),
    CONSTANTS(guccione, OF_GUCCIONE, "law: guccione: myocardium, transversely isotropic"),
    CONSTANTS(fung, OF_FUNG, "law: fung or usyk: orthotropic exponential"),
    CONSTANTS(holzapfel_ogden, OF_HOLZAPFEL_OGDEN, "law: holzapfel_ogden: myocardium"),
    CONSTANTS(mooney_rivlin, OF_MOONEY_RIVLIN, "law: mooney_rivlin: rubber"),
    CONSTANTS(veronda_westmann, OF_VERONDA_WESTMANN, "law: veronda_westmann: soft organs"),
    {"paper", PART(0, vsc_law_paper_group), .allowed = OF_PAPER, .needed = OF_PAPER,
     .commented = true, .meaning = "law: paper: constants of every element, whatever its size"},
    {"classical", PART(0, vsc_law_classical_group), .allowed = OF_CLASSICAL,
     .needed = OF_CLASSICAL, .commented = true, .meaning = "law: classical: constants of every edge"},
    {"active", PART(offsetof(vsc_material_def, active), active), .meaning = "contraction"},
};

static void start_material(void *target)
{
  *(vsc_material_def *)target = vsc_default_material();
}

// The modulus of an active spring has its place in `active`, unless the law has constants of its own.
static vsc_status finish_material(vsc_reading *reading, const vsc_slot *slots, void *target)
{
  const vsc_material_def *material = target;
  if (material->active.kind != VSC_ACTIVE_SPRING || (BIT(material->law) & OF_TISSUES)) return VSC_OK;
  const vsc_slot *given_active = vsc_slot_value(&vsc_material_group, slots, "active");
  const bool given = vsc_slot_value(&active, given_active, "stiffness") != NULL;
  if (given == (material->law == VSC_LAW_SPRINGS)) return VSC_OK;
  vsc_enter(reading, "active.stiffness");
  if (given)
    return vsc_reading_fail(reading, "means nothing for this law; law: paper has paper.active");
  return vsc_reading_fail(reading,
                          "missing; write such as \"stiffness: 200 kPa\" (fibre modulus at the peak)");
}

GROUP(, vsc_material_group, offsetof(vsc_material_def, law), .size = sizeof(vsc_material_def), .start = start_material,
      .finish = finish_material);

// ---- supports and loads

static const vsc_word directions[] = {{"x", 0}, {"y", 1}, {"z", 2}, {NULL, 0}};

static const vsc_row vsc_support_group_rows[] = {
    {"set", NAME(vsc_support_def, set), .needed = VSC_ALWAYS, .text = "base",
     .meaning = "one of node_sets"},
    {"held", .kind = VSC_ROW_FLAGS, AT(vsc_support_def, held), .words = directions,
     .needed = VSC_ALWAYS, .text = "[x, y, z]", .meaning = "directions that cannot move freely"},
    {"motion", VECTOR(vsc_support_def, motion, VSC_LENGTH), .text = "[0 mm, 0 mm, 0 mm]",
     .meaning = "how far held directions have moved where the curve is 1; the force that this takes is a signal, the mean "
                "since the row before (equilibria: the force now)"},
    {"curve", PART(offsetof(vsc_support_def, curve), vsc_curve_group), .commented = true,
     .meaning = "of time, for motion"},
};

static void start_support(void *target)
{
  *(vsc_support_def *)target = vsc_default_support();
}

GROUP(, vsc_support_group, -1, .size = sizeof(vsc_support_def), .start = start_support);

static const vsc_word robin_directions[] = {{"full", false}, {"normal", true}, {NULL, 0}};

static const vsc_row vsc_robin_group_rows[] = {
    {"surface", NAME(vsc_robin_def, surface), .needed = VSC_ALWAYS, .text = "epi",
     .meaning = "one of surfaces, or boundary"},
    {"stiffness", QUANTITY(vsc_robin_def, stiffness, VSC_BED_STIFFNESS), .text = "1e5 Pa/m",
     .meaning = "of the springs, per area at rest; default 0 Pa/m"},
    {"damping", QUANTITY(vsc_robin_def, damping, VSC_BED_DAMPING), .text = "5e3 Pa s/m",
     .meaning = "of the dashpots; default 0 Pa s/m"},
    {"direction", CHOICE(vsc_robin_def, normal, robin_directions), .text = "full",
     .meaning = "full, or normal: only what moves along the normal at rest is resisted"},
};
GROUP(, vsc_robin_group, -1, .size = sizeof(vsc_robin_def));

static const vsc_row vsc_pressure_group_rows[] = {
    {"surface", NAME(vsc_pressure_def, surface), .needed = VSC_ALWAYS, .text = "endo",
     .meaning = "one of surfaces, or boundary; pushed against its outward normal"},
    {"peak", QUANTITY(vsc_pressure_def, peak, VSC_PRESSURE), .needed = VSC_ALWAYS,
     .text = "16 kPa", .meaning = "where the curve is 1"},
    {"direction", VECTOR(vsc_pressure_def, direction, VSC_NUMBER), .commented = true, .text = "[0, 1, 0]",
     .meaning = "a dead traction instead: keeps this direction, per area at rest; absent: along the moving normal"},
    {"curve", PART(offsetof(vsc_pressure_def, curve), vsc_curve_group),
     .meaning = "of time; absent: constant"},
};

static void start_pressure(void *target)
{
  ((vsc_pressure_def *)target)->curve = vsc_default_curve(VSC_CURVE_CONSTANT);
}

GROUP(, vsc_pressure_group, -1, .size = sizeof(vsc_pressure_def), .start = start_pressure);

static const vsc_row vsc_velocity_group_rows[] = {
    {"node_array", NAME(vsc_velocity_def, array), .text = "velocity",
     .meaning = "node array of the mesh with three numbers a node"},
    {"unit", UNIT(vsc_velocity_def, unit, VSC_VELOCITY), .text = "1 m/s", .meaning = "of its numbers"},
};

// A scene as understood has an empty name where the body starts at rest.
static vsc_status finish_velocity(vsc_reading *reading, const vsc_slot *slots, void *target)
{
  (void)target;
  if (vsc_slot_value(&vsc_velocity_group, slots, "node_array") != NULL ||
      vsc_slot_value(&vsc_velocity_group, slots, "unit") == NULL)
    return VSC_OK;
  vsc_enter(reading, "node_array");
  return vsc_reading_fail(reading, "missing; write such as \"node_array: velocity\"");
}

GROUP(, vsc_velocity_group, -1, .size = sizeof(vsc_velocity_def), .finish = finish_velocity);
