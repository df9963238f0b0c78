// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the model beside its elements: their materials, masses, volume groups, activation, named
// sets, supports and loads. Internal to the model room; called by vsc_model_build.
#ifndef VSC_MODEL_TERMS_H
#define VSC_MODEL_TERMS_H

#include "mesh/mesh.h"
#include "mesh/topology.h"
#include "model/model.h"

// The numbers of the cell array `name`, or NULL for an empty name. A missing array, or one of vectors, is
// VSC_INPUT with the `key` that names it.
vsc_status vsc_terms_element_values(const vsc_mesh *mesh, const char *name, const char *key,
                                const double **values, vsc_error *error);

// material_of[e], for each of the mesh's elements: the material that names its region, or the one that takes the rest.
// VSC_INPUT for a region that no material takes and for numbers that are no region: not whole, or beyond an int.
vsc_status vsc_terms_materials(const vsc_mesh *mesh, const vsc_definition *definition, uint32_t *material_of,
                               vsc_error *error);

// amplitude and delay of each slot, where a material names cell arrays or is active in elements
// without a known fibre (amplitude 0: passive); then the curves of active materials, as far as the least delay lets the
// run see them. VSC_INPUT and VSC_NUMERICAL as vsc_curve_build.
vsc_status vsc_terms_activation(const vsc_mesh *mesh, const vsc_definition *definition,
                                vsc_model *model, vsc_error *error);

// Rest positions, masses of the model's kind, and their inverses (masses.c).
vsc_status vsc_terms_masses(const vsc_mesh *mesh, const vsc_definition *definition,
                            const uint32_t *material_of, vsc_model *model, vsc_error *error);

// V_n = sum_e V_e / 4 and K_n = sum_e K_e V_e / 4 / V_n over the tets e of law SPRINGS round node n.
// VSC_INPUT for solver.incompressible and tets that share no volume, which have no multiplier.
vsc_status vsc_terms_volume_groups(vsc_model *model, vsc_error *error);

// The edge frames of smoothed tets (smoothing.c), after activation. VSC_INPUT where they are wanted and no element is
// a linear tet.
vsc_status vsc_terms_smoothing(vsc_model *model, vsc_error *error);

// The named surfaces and node sets.
vsc_status vsc_terms_selections(const vsc_mesh *mesh, const vsc_definition *definition,
                                vsc_model *model, vsc_error *error);

// 1 for each of the mesh's nodes that supports without motion hold in all directions, else 0; after the selections.
// A set that is not there is left for vsc_terms_supports to tell. The caller owns *still.
vsc_status vsc_terms_still(const vsc_mesh *mesh, const vsc_definition *definition, const vsc_model *model,
                           uint8_t **still, vsc_error *error);

// Held directions: inverse mass 0; supports that move. VSC_INPUT for a direction of a node that is moved
// by one support and held by another, and for more than VSC_MOST_MOVED of them.
vsc_status vsc_terms_supports(const vsc_definition *definition, vsc_model *model, vsc_error *error);

// Volumes to be kept (kept_volume.c), after supports: those that cannot change are left out. VSC_INPUT
// for more of them than ways to move, and for a mesh without elements.
vsc_status vsc_terms_kept_volumes(const vsc_mesh *mesh, const vsc_definition *definition,
                                  const uint32_t *material_of, vsc_model *model, vsc_error *error);

// Obstacles (obstacles.c). VSC_INPUT for a node that begins inside one.
vsc_status vsc_terms_obstacles(const vsc_mesh *mesh, const vsc_definition *definition,
                               vsc_model *model, vsc_error *error);

// Pressures, weights, springs and dashpots on surfaces.
vsc_status vsc_terms_loads(const vsc_mesh *mesh, const vsc_definition *definition, const uint32_t *material_of,
                           vsc_model *model, vsc_error *error);

// The initial velocity (initial_velocity.c), after supports, which take it from the directions that they hold.
// VSC_INPUT for a node array that is missing, has not three numbers a node, or a number that is not finite.
vsc_status vsc_terms_velocity(const vsc_mesh *mesh, const vsc_definition *definition,
                              vsc_model *model, vsc_error *error);

#endif
