// SPDX-License-Identifier: GPL-3.0-or-later
// Shorthands in which the tables of the scene's keys are written; only for scene_table*.c.
#ifndef VSC_IO_SCENE_ROWS_H
#define VSC_IO_SCENE_ROWS_H

#include <math.h>
#include <stddef.h>

#include "io/scene_reading.h"

#define LENGTH(array) (sizeof(array) / sizeof(array)[0])
#define AT(type, field) .offset = offsetof(type, field), .size = sizeof(((type *)NULL)->field)
#define VECTOR(type, field, what) \
  .kind = VSC_ROW_VECTOR, .quantity = what, AT(type, field), \
  .count = sizeof(((type *)NULL)->field) / sizeof(double)
#define QUANTITY(type, field, what) .kind = VSC_ROW_QUANTITY, .quantity = what, AT(type, field)
#define UNIT(type, field, what) .kind = VSC_ROW_UNIT, .quantity = what, AT(type, field)
#define NUMBER(type, field) QUANTITY(type, field, VSC_NUMBER)
#define NAME(type, field) .kind = VSC_ROW_NAME, AT(type, field)
#define CHOICE(type, field, list) .kind = VSC_ROW_CHOICE, AT(type, field), .words = list
#define LIST_AT(type, field, counter) \
  .offset = offsetof(type, field), .count_offset = offsetof(type, counter)
#define PART(offset_, group_) .kind = VSC_ROW_GROUP, .offset = offset_, .group = &group_
#define PARTS(type, field, counter, group_) \
  .kind = VSC_ROW_GROUPS, LIST_AT(type, field, counter), .group = &group_
// The group `name` of the rows `name`_rows; `scope` is static or nothing.
#define GROUP(scope, name, kind_, ...) \
  static cyaml_schema_field_t name##_fields[LENGTH(name##_rows) + 1]; \
  scope const vsc_group name = {.rows = name##_rows, .row_count = LENGTH(name##_rows), \
                          .fields = name##_fields, .kind_offset = kind_, __VA_ARGS__}
#define BIT(kind) (1u << (kind))

extern const vsc_group vsc_surface_group;   // an item of surfaces; vsc_selector
extern const vsc_group vsc_node_set_group;  // an item of node_sets; vsc_selector
extern const vsc_group vsc_fiber_group;     // vsc_fiber_def
extern const vsc_group vsc_vessel_group;    // an item of vessels; vsc_vessel_def
extern const vsc_group vsc_material_group;  // an item of materials; vsc_material_def
extern const vsc_group vsc_support_group;   // an item of supports; vsc_support_def
extern const vsc_group vsc_robin_group;     // an item of robin; vsc_robin_def
extern const vsc_group vsc_pressure_group;  // an item of pressures; vsc_pressure_def
extern const vsc_group vsc_velocity_group;  // vsc_velocity_def
extern const vsc_group vsc_membrane_group;  // an item of membranes; vsc_membrane_def
extern const vsc_group vsc_obstacle_group;  // an item of obstacles; vsc_obstacle_def
extern const vsc_group vsc_law_paper_group;      // vsc_material_def
extern const vsc_group vsc_law_classical_group;  // vsc_material_def
extern const vsc_group vsc_law_neo_hookean_group, vsc_law_guccione_group, vsc_law_fung_group;
extern const vsc_group vsc_law_holzapfel_ogden_group, vsc_law_mooney_rivlin_group;
extern const vsc_group vsc_law_veronda_westmann_group;  // all vsc_material_def
extern const vsc_group vsc_axis_group;       // an item of a material's axes; vsc_axis_def
extern const vsc_group vsc_pair_group;       // an item of a material's pairs; vsc_pair_def
extern const vsc_group vsc_prony_group;      // an item of a material's prony; vsc_prony_def
extern const vsc_group vsc_inclusion_group;  // an item of a material's inclusions; vsc_inclusion_def

#endif
