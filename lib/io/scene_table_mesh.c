// SPDX-License-Identifier: GPL-3.0-or-later
// The keys of surfaces, node sets and fibres.
#include "io/scene_rows.h"

// ---- surfaces and node sets

static const vsc_row box_rows[] = {
    {"low", VECTOR(vsc_selector, box_low, VSC_LENGTH), .needed = VSC_ALWAYS,
     .text = "[0 mm, 0 mm, 0 mm]", .meaning = "corner of least x, y, z"},
    {"high", VECTOR(vsc_selector, box_high, VSC_LENGTH), .needed = VSC_ALWAYS,
     .text = "[10 mm, 10 mm, 1 mm]", .meaning = "corner of greatest x, y, z"},
};
GROUP(static, box, -1);

static const vsc_row plane_rows[] = {
    {"point", VECTOR(vsc_selector, point, VSC_LENGTH), .needed = VSC_ALWAYS,
     .text = "[0 mm, 0 mm, 0 mm]", .meaning = "any point of the plane"},
    {"normal", VECTOR(vsc_selector, normal, VSC_NUMBER), .needed = VSC_ALWAYS, .text = "[0, 0, 1]",
     .meaning = "of any length"},
    {"tolerance", QUANTITY(vsc_selector, tolerance, VSC_LENGTH), .needed = VSC_ALWAYS,
     .text = "0.1 mm", .meaning = "distance from the plane that still counts"},
};
GROUP(static, plane, -1);

enum { OF_ARRAYS = BIT(VSC_SELECT_NODE_ARRAY) | BIT(VSC_SELECT_TRIANGLE_ARRAY) };

static const vsc_row vsc_node_set_group_rows[] = {
    {"name", NAME(vsc_selector, name), .needed = VSC_ALWAYS, .text = "*",
     .meaning = "what supports, loads and outputs call it"},
    {"node_array", NAME(vsc_selector, array), .selects = 1 + VSC_SELECT_NODE_ARRAY, .text = "*",
     .meaning = "by a point array: the nodes with the value below (order: 2: and between two of them)"},
    {"triangle_array", NAME(vsc_selector, array), .selects = 1 + VSC_SELECT_TRIANGLE_ARRAY,
     .commented = true, .text = "surface",
     .meaning = "or by a cell array: the file's triangles with that value (surfaces: faces of the boundary)"},
    {"value", .kind = VSC_ROW_BOTH, .quantity = VSC_NUMBER, AT(vsc_selector, low),
     .allowed = OF_ARRAYS, .input_only = true, .text = "1", .meaning = "of the array"},
    {"range", .kind = VSC_ROW_VECTOR, .quantity = VSC_NUMBER, AT(vsc_selector, low), .count = 2,
     .allowed = OF_ARRAYS, .commented = true, .text = "[0.5, 1.5]",
     .meaning = "or a range of values, both ends included"},
    {"box", PART(0, box), .selects = 1 + VSC_SELECT_BOX, .commented = true,
     .meaning = "or what lies in a box"},
    {"plane", PART(0, plane), .selects = 1 + VSC_SELECT_PLANE, .commented = true,
     .meaning = "or what lies on a plane"},
    {"boundary", .kind = VSC_ROW_MARK, .selects = 1 + VSC_SELECT_BOUNDARY, .commented = true,
     .text = "true", .meaning = "or the whole boundary"},
    {"surface", NAME(vsc_selector, array), .selects = 1 + VSC_SELECT_SURFACE, .commented = true,
     .text = "endo", .meaning = "or (node sets only) the nodes of a surface"},
};

static void start_selector(void *target)
{
  *(vsc_selector *)target = (vsc_selector){.kind = (vsc_select_kind)-1, .low = NAN, .high = NAN};
}

GROUP(, vsc_node_set_group, offsetof(vsc_selector, kind), .size = sizeof(vsc_selector),
             .start = start_selector, .finish = vsc_selector_finish, .example = "base");

// A surface can be described in all these ways but the last.
static cyaml_schema_field_t surface_fields[LENGTH(vsc_node_set_group_rows)];
const vsc_group vsc_surface_group = {.rows = vsc_node_set_group_rows,
                                     .row_count = LENGTH(vsc_node_set_group_rows) - 1,
                                     .fields = surface_fields,
                                     .kind_offset = offsetof(vsc_selector, kind),
                                     .size = sizeof(vsc_selector),
                                     .start = start_selector,
                                     .finish = vsc_selector_finish,
                                     .example = "endo"};

// ---- fibres

static const vsc_word azimuth_senses[] = {{"counterclockwise", 1}, {"clockwise", -1}, {NULL, 0}};
static const vsc_word elevation_senses[] = {{"up", 1}, {"down", -1}, {NULL, 0}};
static const vsc_word axes_words[] = {{"image", true}, {"world", false}, {NULL, 0}};
static const vsc_word sources[] = {
    {"none", VSC_FIBER_NONE},           {"map", VSC_FIBER_MAP},
    {"arrays", VSC_FIBER_ARRAYS},       {"constant", VSC_FIBER_CONSTANT},
    {"helix", VSC_FIBER_HELIX},         {"horizontal", VSC_FIBER_HORIZONTAL},
    {"diagonal", VSC_FIBER_DIAGONAL},   {"hemicircular", VSC_FIBER_HEMICIRCULAR},
    {"helicoidal", VSC_FIBER_HELICOIDAL}, {"random", VSC_FIBER_RANDOM},
    {"ellipsoid", VSC_FIBER_ELLIPSOID},
    {NULL, 0},
};

static const vsc_row map_rows[] = {
    {"file", .kind = VSC_ROW_PATH, AT(vsc_angle_map_def, file), .text = "angles.vti",
     .meaning = "image of the two angles, on its points or its cells; relative to this scene's folder"},
    {"length_unit", UNIT(vsc_angle_map_def, length_unit, VSC_LENGTH), .text = "mm",
     .meaning = "of its origin and spacing"},
    {"azimuth", NAME(vsc_angle_map_def, azimuth), .text = "azimuth",
     .meaning = "array: angle in the section plane"},
    {"elevation", NAME(vsc_angle_map_def, elevation), .text = "elevation",
     .meaning = "array: angle out of the section plane"},
    {"angle_unit", UNIT(vsc_angle_map_def, scale, VSC_ANGLE), .text = "1 deg",
     .meaning = "of both arrays: 1 deg, 0.1 deg, 1 rad"},
    {"azimuth_zero", QUANTITY(vsc_angle_map_def, azimuth_zero, VSC_ANGLE), .text = "0 deg",
     .meaning = "azimuth of the first axis"},
    {"azimuth_sense", CHOICE(vsc_angle_map_def, azimuth_sense, azimuth_senses),
     .text = "counterclockwise", .meaning = "from the first axis to the second; or clockwise"},
    {"elevation_sense", CHOICE(vsc_angle_map_def, elevation_sense, elevation_senses), .text = "up",
     .meaning = "towards the third axis; or down"},
    {"axes", CHOICE(vsc_angle_map_def, image_axes, axes_words), .text = "image",
     .meaning = "angles count in the image's own axes; or world"},
    {"mask", NAME(vsc_angle_map_def, mask), .text = "\"\"",
     .meaning = "array that is above 0 in tissue; empty: all is tissue"},
    {"weight", NAME(vsc_angle_map_def, weight), .text = "\"\"",
     .meaning = "array of weights; empty: 1"},
};
GROUP(static, map, -1);

static const vsc_word sense_words[] = {{"ignored", 0}, {"kept", 1}, {NULL, 0}};

static const vsc_row array_rows[] = {
    {"fiber", NAME(vsc_fiber_def, fiber_array), .text = "fiber",
     .meaning = "cell or point array of vectors"},
    {"sheet", NAME(vsc_fiber_def, sheet_array), .text = "sheet",
     .meaning = "likewise; empty: by rule"},
    {"sense", CHOICE(vsc_fiber_def, sense_kept, sense_words), .text = "ignored",
     .meaning = "of vectors on points, whose lengths mean nothing, between which they turn: by less than 90 degrees, or kept: as they are"},
};
GROUP(static, array, -1);

static const vsc_row constant_rows[] = {
    {"fiber", VECTOR(vsc_fiber_def, direction, VSC_NUMBER), .text = "[1, 0, 0]",
     .meaning = "of any length"},
    {"sheet", VECTOR(vsc_fiber_def, sheet_direction, VSC_NUMBER), .text = "[0, 0, 0]",
     .meaning = "[0, 0, 0]: by rule"},
};
GROUP(static, constant, -1);

static const vsc_row helix_rows[] = {
    {"endo", NAME(vsc_fiber_def, endo), .text = "endo", .meaning = "surface where the wall begins"},
    {"epi", NAME(vsc_fiber_def, epi), .text = "epi",
     .meaning = "surface where it ends, without the base; boundary: all but endo"},
    {"endo_angle", QUANTITY(vsc_fiber_def, endo_angle, VSC_ANGLE), .text = "60 deg",
     .meaning = "helix angle at endo, from the circumference towards the base"},
    {"epi_angle", QUANTITY(vsc_fiber_def, epi_angle, VSC_ANGLE), .text = "-60 deg",
     .meaning = "at epi"},
    {"long_axis", VECTOR(vsc_fiber_def, long_axis, VSC_NUMBER), .text = "[0, 0, 1]",
     .meaning = "from apex to base, of any length"},
};
GROUP(static, helix, -1);

static const vsc_word sheet_words[] = {{"across", 1}, {"along", 0}, {NULL, 0}};

static const vsc_row ellipsoid_rows[] = {
    {"centre", VECTOR(vsc_fiber_def, ellipsoid.centre, VSC_LENGTH), .text = "[0 mm, 0 mm, 0 mm]",
     .meaning = "of both ellipsoids"},
    {"endo", NAME(vsc_fiber_def, endo), .commented = true, .text = "endo",
     .meaning = "depth by Laplace's equation from this surface; absent: the ellipsoids' own"},
    {"epi", NAME(vsc_fiber_def, epi), .commented = true, .text = "epi", .meaning = "to this one"},
    {"long_axis", VECTOR(vsc_fiber_def, long_axis, VSC_NUMBER), .text = "[0, 0, 1]",
     .meaning = "from apex to base, of any length"},
    {"endo_radius", QUANTITY(vsc_fiber_def, ellipsoid.endo_radius, VSC_LENGTH),
     .needed = VSC_ALWAYS, .text = "7 mm", .meaning = "of the cavity, across the long axis"},
    {"endo_length", QUANTITY(vsc_fiber_def, ellipsoid.endo_length, VSC_LENGTH),
     .needed = VSC_ALWAYS, .text = "17 mm", .meaning = "from the centre to its apex"},
    {"epi_radius", QUANTITY(vsc_fiber_def, ellipsoid.epi_radius, VSC_LENGTH), .needed = VSC_ALWAYS,
     .text = "10 mm", .meaning = "the same of the outside"},
    {"epi_length", QUANTITY(vsc_fiber_def, ellipsoid.epi_length, VSC_LENGTH), .needed = VSC_ALWAYS,
     .text = "20 mm", .meaning = "likewise"},
    {"endo_angle", QUANTITY(vsc_fiber_def, endo_angle, VSC_ANGLE), .text = "60 deg",
     .meaning = "helix angle inside, from the circumference towards the base"},
    {"epi_angle", QUANTITY(vsc_fiber_def, epi_angle, VSC_ANGLE), .text = "-60 deg",
     .meaning = "outside"},
    {"sheets", CHOICE(vsc_fiber_def, sheets_across, sheet_words), .text = "across",
     .meaning = "across the wall, or along it (the normal then goes across)"},
};
GROUP(static, ellipsoid, -1);

static const vsc_row vsc_fiber_group_rows[] = {
    {"source", CHOICE(vsc_fiber_def, source, sources), .text = "constant",
     .meaning = "none, map, arrays, constant, helix, horizontal, diagonal, hemicircular, "
                "helicoidal, random, ellipsoid"},
    {"fill", .kind = VSC_ROW_BOOL, AT(vsc_fiber_def, fill), .text = "false",
     .meaning = "map, arrays: elements without data take their neighbours' mean axis"},
    {"map", PART(offsetof(vsc_fiber_def, map), map), .meaning = "for source: map"},
    {"arrays", PART(0, array), .meaning = "for source: arrays"},
    {"constant", PART(0, constant), .meaning = "for source: constant"},
    {"helix", PART(0, helix), .meaning = "for source: helix"},
    {"ellipsoid", PART(0, ellipsoid), .commented = true,
     .meaning = "for source: ellipsoid: a helix between two ellipsoids"},
    {"pitch", QUANTITY(vsc_fiber_def, pitch, VSC_ANGLE), .text = "30 deg",
     .meaning = "helicoidal: above the horizontal"},
    {"seed", .kind = VSC_ROW_WHOLE, AT(vsc_fiber_def, seed), .text = "1", .meaning = "random"},
};
GROUP(, vsc_fiber_group, -1);

// ---- vessels

static const vsc_row vsc_vessel_group_rows[] = {
    {"name", NAME(vsc_vessel_def, name), .needed = VSC_ALWAYS, .text = "vein",
     .meaning = "its part of each element becomes the cell array <name>_fraction"},
    {"file", .kind = VSC_ROW_PATH, AT(vsc_vessel_def, file), .needed = VSC_ALWAYS,
     .text = "vein.vtp", .meaning = "closed surface or centre lines, .vtp or legacy .vtk"},
    {"unit", UNIT(vsc_vessel_def, unit, VSC_LENGTH), .needed = VSC_ALWAYS, .text = "mm",
     .meaning = "of its coordinates and radii"},
    {"material", NAME(vsc_vessel_def, material), .needed = VSC_ALWAYS, .text = "vessel",
     .meaning = "its own; mixed by volume into the tissues that list no inclusions"},
    {"radius_array", NAME(vsc_vessel_def, radius_array), .text = "radius",
     .meaning = "centre lines: point array of radii"},
    {"radius", QUANTITY(vsc_vessel_def, radius, VSC_LENGTH), .commented = true, .text = "2 mm",
     .meaning = "or one radius; with neither the file is a surface"},
    {"threshold", NUMBER(vsc_vessel_def, threshold), .text = "0.05",
     .meaning = "elements with at least this part take its direction as their fibre"},
};

static void start_vessel(void *target)
{
  *(vsc_vessel_def *)target = vsc_default_vessel();
}

GROUP(, vsc_vessel_group, -1, .size = sizeof(vsc_vessel_def), .start = start_vessel);
