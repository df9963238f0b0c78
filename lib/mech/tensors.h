// SPDX-License-Identifier: GPL-3.0-or-later
// Strain and stress of elements, for the fields of frames. Internal to mech.
#ifndef VSC_MECH_TENSORS_H
#define VSC_MECH_TENSORS_H

#include "mech/observe.h"

// Whether the field is made of an element's strain or stress; of stress.
bool vsc_field_is_tensor(vsc_field field);
bool vsc_field_is_stress(vsc_field field);

// Whether the cells of a patch have a stress: their law is a function of strain.
bool vsc_patch_has_stress(const vsc_model *model, const vsc_patch *patch);

// Writes a field of strain or stress (observe.h) in the mesh's own order.
void vsc_read_tensors(const vsc_model *model, vsc_state *state, vsc_field field, double *values);

#endif
