// SPDX-License-Identifier: GPL-3.0-or-later
// The stiffness of a material as a block of irregular tets shows it.
#ifndef VSC_TOOLS_CALIBRATE_MEASURE_H
#define VSC_TOOLS_CALIBRATE_MEASURE_H

#include "model/definition.h"

typedef struct vsc_sample vsc_sample;  // opaque: a block of the material, its stiffness factorised

// A block of 3 x 3 x 3 jittered bricks of 1 mm whose elements all have f, s, n along x, y, z. Its
// stiffness at rest is taken from the forces of the simulation itself, by central differences. The
// caller owns *sample. VSC_NUMERICAL when some deformation meets no resistance.
vsc_status vsc_sample_open(const vsc_material_def *material, vsc_volume_kind volume,
                           vsc_sample **sample, vsc_error *error);

// Young's modulus along the unit vector `d`, kPa: tractions d (d . n) on the whole boundary, the mean
// strain d . e d from the boundary's displacements.
double vsc_sample_young(const vsc_sample *sample, const double d[3]);

void vsc_sample_close(vsc_sample *sample);  // NULL is fine

#endif
