// SPDX-License-Identifier: GPL-3.0-or-later
// The keys of membranes, obstacles, and of what a material has beside the springs of its frame.
#include "io/scene_rows.h"

// ---- the laws that are there to be compared with

static const vsc_row paper_axial_rows[] = {
    {"f", QUANTITY(vsc_material_def, paper.axial[0], VSC_STIFFNESS), .needed = VSC_ALWAYS,
     .text = "20 N/m", .meaning = "along the fibre"},
    {"s", QUANTITY(vsc_material_def, paper.axial[1], VSC_STIFFNESS), .needed = VSC_ALWAYS,
     .text = "10 N/m", .meaning = "along the sheet"},
    {"n", QUANTITY(vsc_material_def, paper.axial[2], VSC_STIFFNESS), .needed = VSC_ALWAYS,
     .text = "10 N/m", .meaning = "along the normal"},
};
GROUP(static, paper_axial, -1);

static const vsc_row paper_damping_rows[] = {
    {"f", QUANTITY(vsc_material_def, paper.damping[0], VSC_DAMPER), .text = "0.01 N s/m",
     .meaning = "along the fibre; default 0 N s/m"},
    {"s", QUANTITY(vsc_material_def, paper.damping[1], VSC_DAMPER), .text = "0.01 N s/m",
     .meaning = "along the sheet"},
    {"n", QUANTITY(vsc_material_def, paper.damping[2], VSC_DAMPER), .text = "0.01 N s/m",
     .meaning = "along the normal"},
};
GROUP(static, paper_damping, -1);

static const vsc_row paper_angular_rows[] = {
    {"fs", QUANTITY(vsc_material_def, paper.angular[0], VSC_FORCE), .needed = VSC_ALWAYS,
     .text = "20 mN", .meaning = "between fibre and sheet"},
    {"sn", QUANTITY(vsc_material_def, paper.angular[1], VSC_FORCE), .needed = VSC_ALWAYS,
     .text = "20 mN", .meaning = "between sheet and normal"},
    {"nf", QUANTITY(vsc_material_def, paper.angular[2], VSC_FORCE), .needed = VSC_ALWAYS,
     .text = "20 mN", .meaning = "between normal and fibre"},
};
GROUP(static, paper_angular, -1);

static const vsc_row vsc_law_paper_group_rows[] = {
    {"axial", PART(0, paper_axial), .needed = VSC_ALWAYS, .meaning = "k_s of the axial springs"},
    {"angular", PART(0, paper_angular), .needed = VSC_ALWAYS,
     .meaning = "k_s of the angular springs"},
    {"damping", PART(0, paper_damping), .meaning = "k_d of the axial springs"},
    {"volume", QUANTITY(vsc_material_def, paper.volume, VSC_STIFFNESS), .text = "50 N/m",
     .meaning = "k_s of the radial volume forces; default 0 N/m"},
    {"volume_damping", QUANTITY(vsc_material_def, paper.volume_damping, VSC_DAMPER),
     .text = "0.01 N s/m", .meaning = "hexahedra: k_d of their springs to the barycentre"},
    {"active", QUANTITY(vsc_material_def, paper.active, VSC_STIFFNESS), .text = "100 N/m",
     .meaning = "active.kind spring: k_s of the fibre spring at the peak"},
};
GROUP(, vsc_law_paper_group, -1);

static const vsc_row vsc_law_classical_group_rows[] = {
    {"stiffness", QUANTITY(vsc_material_def, classical.stiffness, VSC_STIFFNESS),
     .needed = VSC_ALWAYS, .text = "20 N/m", .meaning = "k_s of every edge"},
    {"damping", QUANTITY(vsc_material_def, classical.damping, VSC_DAMPER), .text = "0.01 N s/m",
     .meaning = "k_d; default 0 N s/m"},
};
GROUP(, vsc_law_classical_group, -1);

// ---- more axes, inclusions

static const vsc_row vsc_axis_group_rows[] = {
    {"direction", VECTOR(vsc_axis_def, direction, VSC_NUMBER), .needed = VSC_ALWAYS,
     .text = "[1, 1, 0]", .meaning = "in fibre, sheet, normal; of any length"},
    {"modulus", QUANTITY(vsc_axis_def, modulus, VSC_PRESSURE), .needed = VSC_ALWAYS,
     .text = "5 kPa", .meaning = "of the spring along it"},
    {"damping", QUANTITY(vsc_axis_def, damping, VSC_VISCOSITY), .text = "10 Pa s",
     .meaning = "default 0 Pa s"},
};
GROUP(, vsc_axis_group, -1, .size = sizeof(vsc_axis_def));

static const vsc_row vsc_pair_group_rows[] = {
    {"first", .kind = VSC_ROW_WHOLE_INT, AT(vsc_pair_def, axes[0]), .needed = VSC_ALWAYS,
     .text = "0", .meaning = "axis: 0 fibre, 1 sheet, 2 normal, 3 the first of axes, ..."},
    {"second", .kind = VSC_ROW_WHOLE_INT, AT(vsc_pair_def, axes[1]), .needed = VSC_ALWAYS,
     .text = "3", .meaning = "the other axis"},
    {"modulus", QUANTITY(vsc_pair_def, modulus, VSC_PRESSURE), .needed = VSC_ALWAYS,
     .text = "3 kPa", .meaning = "of the angular spring between them"},
};
GROUP(, vsc_pair_group, -1, .size = sizeof(vsc_pair_def));

static const vsc_row vsc_prony_group_rows[] = {
    {"modulus", NUMBER(vsc_prony_def, modulus), .needed = VSC_ALWAYS, .text = "0.3",
     .meaning = "part of the instantaneous stress; all together below 1"},
    {"time", QUANTITY(vsc_prony_def, time, VSC_TIME), .needed = VSC_ALWAYS, .text = "100 ms",
     .meaning = "in which it falls to 1/e"},
};
GROUP(, vsc_prony_group, -1, .size = sizeof(vsc_prony_def));

static const vsc_row vsc_inclusion_group_rows[] = {
    {"material", NAME(vsc_inclusion_def, material), .needed = VSC_ALWAYS, .text = "vein",
     .meaning = "name of the other material"},
    {"fraction", NAME(vsc_inclusion_def, fraction_array), .needed = VSC_ALWAYS,
     .text = "vein_fraction", .meaning = "cell array of its part of the volume, 0 to 1"},
};
GROUP(, vsc_inclusion_group, -1, .size = sizeof(vsc_inclusion_def));

// ---- membranes

static const vsc_row membrane_axial_rows[] = {
    {"a", QUANTITY(vsc_membrane_def, axial[0], VSC_PRESSURE), .needed = VSC_ALWAYS,
     .text = "100 kPa", .meaning = "along the direction"},
    {"b", QUANTITY(vsc_membrane_def, axial[1], VSC_PRESSURE), .needed = VSC_ALWAYS,
     .text = "100 kPa", .meaning = "across it"},
};
GROUP(static, membrane_axial, -1);

static const vsc_row membrane_damping_rows[] = {
    {"a", QUANTITY(vsc_membrane_def, damping[0], VSC_VISCOSITY), .text = "10 Pa s",
     .meaning = "along the direction; default 0 Pa s"},
    {"b", QUANTITY(vsc_membrane_def, damping[1], VSC_VISCOSITY), .text = "10 Pa s",
     .meaning = "across it"},
};
GROUP(static, membrane_damping, -1);

static const vsc_row vsc_membrane_group_rows[] = {
    {"name", NAME(vsc_membrane_def, name), .needed = VSC_ALWAYS, .text = "capsule",
     .meaning = "for reports"},
    {"surface", NAME(vsc_membrane_def, surface), .needed = VSC_ALWAYS, .text = "boundary",
     .meaning = "one of surfaces, boundary, or triangles: all that the file has"},
    {"thickness", QUANTITY(vsc_membrane_def, thickness, VSC_LENGTH), .needed = VSC_ALWAYS,
     .text = "0.1 mm", .meaning = "moduli count per volume"},
    {"density", QUANTITY(vsc_membrane_def, density, VSC_DENSITY), .text = "1.06 g/cm3",
     .meaning = "at rest"},
    {"axial", PART(0, membrane_axial), .needed = VSC_ALWAYS,
     .meaning = "springs along the two axes in its plane"},
    {"angular", QUANTITY(vsc_membrane_def, angular, VSC_PRESSURE), .needed = VSC_ALWAYS,
     .text = "50 kPa", .meaning = "spring between them"},
    {"area_modulus", QUANTITY(vsc_membrane_def, area_modulus, VSC_PRESSURE), .text = "0 kPa",
     .meaning = "against a change of area"},
    {"damping", PART(0, membrane_damping), .meaning = "axial viscosity"},
    {"bending", QUANTITY(vsc_membrane_def, bending, VSC_RIGIDITY), .text = "0 mN mm",
     .meaning = "flexural rigidity D"},
    {"direction", VECTOR(vsc_membrane_def, direction, VSC_NUMBER), .text = "[1, 0, 0]",
     .meaning = "axis a is its part within the triangle"},
};

static void start_membrane(void *target)
{
  *(vsc_membrane_def *)target = vsc_default_membrane();
}

GROUP(, vsc_membrane_group, -1, .size = sizeof(vsc_membrane_def), .start = start_membrane);

// ---- obstacles

static const vsc_word obstacle_kinds[] = {
    {"plane", VSC_OBSTACLE_PLANE}, {"sphere", VSC_OBSTACLE_SPHERE}, {NULL, 0}};

static const vsc_row vsc_obstacle_group_rows[] = {
    {"kind", CHOICE(vsc_obstacle_def, kind, obstacle_kinds), .needed = VSC_ALWAYS, .text = "plane",
     .meaning = "plane or sphere"},
    {"point", VECTOR(vsc_obstacle_def, point, VSC_LENGTH), .needed = VSC_ALWAYS,
     .text = "[0 mm, 0 mm, 0 mm]", .meaning = "of the plane; the sphere's centre"},
    {"normal", VECTOR(vsc_obstacle_def, normal, VSC_NUMBER), .allowed = BIT(VSC_OBSTACLE_PLANE),
     .needed = BIT(VSC_OBSTACLE_PLANE), .text = "[0, 0, 1]", .meaning = "towards the free side"},
    {"radius", QUANTITY(vsc_obstacle_def, radius, VSC_LENGTH), .allowed = BIT(VSC_OBSTACLE_SPHERE),
     .needed = BIT(VSC_OBSTACLE_SPHERE), .commented = true, .text = "10 mm",
     .meaning = "of the sphere"},
    {"friction", NUMBER(vsc_obstacle_def, friction), .text = "0.3",
     .meaning = "Coulomb's coefficient; default 0; above that solve: explicit"},
    {"motion", VECTOR(vsc_obstacle_def, motion, VSC_LENGTH), .text = "[0 mm, 0 mm, 0 mm]",
     .meaning = "how far it has moved where the curve is 1"},
    {"curve", PART(offsetof(vsc_obstacle_def, curve), vsc_curve_group), .commented = true,
     .meaning = "of time"},
    {"set", NAME(vsc_obstacle_def, set), .commented = true, .text = "base",
     .meaning = "node set that it stops; absent: all nodes"},
};

static void start_obstacle(void *target)
{
  *(vsc_obstacle_def *)target = vsc_default_obstacle();
}

GROUP(, vsc_obstacle_group, offsetof(vsc_obstacle_def, kind), .size = sizeof(vsc_obstacle_def),
      .start = start_obstacle);
