// SPDX-License-Identifier: GPL-3.0-or-later
// The elasticity of a material as a block of it answers to loads: the force code put to the test.
#ifndef VSC_TOOLS_CALIBRATE_MEASURE_H
#define VSC_TOOLS_CALIBRATE_MEASURE_H

#include "model/definition.h"

// Measures the compliance S (1/kPa; as in model/elasticity.h) of a passive `material` with shared
// (`volume` NODAL) or own volumes of its elements on an irregular block of 320 tets whose fibre
// frame lies askew to all edges. The stiffness matrix at rest is built by central differences of
// vsc_force; for each of six unit stresses the tractions stress . n act on the whole boundary, GSL
// solves for the displacements u (dense, rigid motions fixed), and the mean strain is
//   e = 1/V sum over boundary triangles of sym(mean u (x) n) area.
// Accurate to some 1e-8, times the volume modulus over the others. The material's regions,
// inclusions and activation are left out. VSC_NUMERICAL when the block has free mechanisms.
vsc_status vsc_measure_compliance(const vsc_material_def *material, vsc_volume_kind volume,
                                  double S[36], vsc_error *error);

#endif
