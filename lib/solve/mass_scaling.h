// SPDX-License-Identifier: GPL-3.0-or-later
// Mass that makes explicit steps longer: at the nodes of stiff or small elements, or between neighbours.
#ifndef VSC_SOLVE_MASS_SCALING_H
#define VSC_SOLVE_MASS_SCALING_H

#include "model/model.h"

// Raises the stable step of a model that is just built to `definition->mass_scaling` ms (0: leaves it alone):
// with D_i a bound of node i's stiffness K + 2/dt C (vsc_limit_stiffness), M_i its mass and lambda the eigenvalue that
// this step allows,
//   M_i <- max(M_i, k D_i / lambda),
// k just large enough, found by estimates of the step at rest and at full activation (vsc_start). Inertia alone
// grows: weights stay what they were. Fills model->scaled with what was added. VSC_INPUT when more than
// `definition->most_added_mass` of the body's mass would have to be added.
// Then couples masses (mech/coupled_mass.h) until steps of `definition->selective_mass_scaling` ms are stable (0: not), by
// as few passes as such estimates say. Fills model->coupled. VSC_INPUT for a step that 63 passes do not reach, and with
// obstacles, kept volumes or law PAPER.
vsc_status vsc_scale_masses(vsc_model *model, const vsc_definition *definition, vsc_error *error);

#endif
