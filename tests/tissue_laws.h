// SPDX-License-Identifier: GPL-3.0-or-later
// Materials of every law of strain, for tests that go through all of them.
#ifndef VSC_TESTS_TISSUE_LAWS_H
#define VSC_TESTS_TISSUE_LAWS_H

#include "model/definition.h"

enum { TISSUE_LAWS = 14 };

// Law number `k`: the tissue laws, each on the full and on the isochoric deformation, the switches
// and dispersion of Holzapfel-Ogden, and springs with couplings.
static inline vsc_material_def tissue_law(int k)
{
  static const vsc_holzapfel_ogden_def myocardium = {.a = 0.8, .b = 3, .a_f = 5, .b_f = 6,
                                                     .a_s = 2, .b_s = 4, .a_fs = 0.6, .b_fs = 5,
                                                     .steepness = 40};
  vsc_material_def m = vsc_default_material();
  m.volume_modulus = 60;
  m.stabilization = 4;
  m.shear = 3;
  m.guccione = (vsc_guccione_def){.C = 2, .fibre = 8, .cross = 2, .shear = 4};
  m.fung = (vsc_fung_def){.C = 1.2, .b = {9, 4, 3, 5, 2, 6}};
  m.holzapfel_ogden = myocardium;
  m.mooney_rivlin = (vsc_invariants_def){1.4, 0.6};
  m.veronda_westmann = (vsc_invariants_def){0.7, 2.5};
  static const vsc_law laws[5] = {VSC_LAW_NEO_HOOKEAN, VSC_LAW_GUCCIONE, VSC_LAW_FUNG,
                                  VSC_LAW_MOONEY_RIVLIN, VSC_LAW_VERONDA_WESTMANN};
  if (k < 10) {
    m.law = laws[k / 2];
    m.isochoric = k % 2;
  } else if (k < 13) {
    m.law = VSC_LAW_HOLZAPFEL_OGDEN;
    m.isochoric = k == 11;
    m.compression = k == 10 ? VSC_FIBRES_ALWAYS : k == 11 ? VSC_FIBRES_SHARP : VSC_FIBRES_SMOOTH;
    m.holzapfel_ogden.kappa_f = k == 12 ? 0.1 : 0;
    m.holzapfel_ogden.kappa_s = k == 12 ? 0.2 : 0;
  } else {
    for (int a = 0; a < 3; a++) {
      m.axial[a] = 9 - 2 * a;
      m.angular[a] = 3 + a;
      m.coupling[a] = 2 - 1.5 * a;
    }
  }
  return m;
}

#endif
