// SPDX-License-Identifier: GPL-3.0-or-later
// What a material answers to the deformation of a frame: energy, stress, tangent.
//
// Laws are functions of the Green-Lagrange strain in fibre axes, which the frame's axes give exactly:
//
//   e = (E_ff, E_ss, E_nn, 2 E_fs, 2 E_sn, 2 E_nf),  E_ab = (g_a . g_b - delta_ab)/2
//   S_k = d psi / d e_k   second Piola-Kirchhoff stress, ff ss nn fs sn nf
//   D_kl = d S_k / d e_l  symmetric
//   P_a = sum_b S_ab g_b  force per area at rest on the frame's axes
//
// so that every law is objective by construction. Volume energies U(J) are no part of a law: they
// belong to the volume group of the frame, and so does the logarithm -m ln J that keeps a law of the
// full deformation free of stress at rest (model/law_volume.h); laws of a material that is
// `isochoric` see the deformation without its change of volume (model/law_isochoric.h).
#ifndef VSC_MODEL_LAW_H
#define VSC_MODEL_LAW_H

#include "base/wide.h"
#include "model/law_active.h"
#include "model/law_fung.h"
#include "model/law_holzapfel_ogden.h"
#include "model/law_isochoric.h"
#include "model/law_mooney_rivlin.h"
#include "model/law_neo_hookean.h"
#include "model/law_springs_strain.h"
#include "model/law_veronda_westmann.h"
#include "model/model.h"

// What the answer depends on beside the strain.
typedef struct vsc_law_input {
  const vsc_material *material;
  const vsc_axis *axes;   // of the material
  const vsc_pair *pairs;  // likewise
  vsc_mixture moduli;     // of the four elements
  vsc_wide activation;    // 0 when passive
} vsc_law_input;

// e of four frames.
VSC_INLINE void vsc_strain_of(const vsc_wide3 g[3], vsc_wide e[6])
{
  for (int a = 0; a < 3; a++) {
    e[a] = 0.5 * (vsc_wide_dot(g[a], g[a]) - 1);
    e[3 + a] = vsc_wide_dot(g[a], g[(a + 1) % 3]);
  }
}

// P_a = sum_b S_ab g_b
VSC_INLINE void vsc_stress_on_axes(const vsc_wide S[6], const vsc_wide3 g[3], vsc_wide3 P[3])
{
  for (int a = 0; a < 3; a++) {
    const int next = (a + 1) % 3, last = (a + 2) % 3;
    P[a] = vsc_wide_combine(S[a], g[a], S[3 + a], g[next], S[3 + last], g[last]);
  }
}

// The part of a law that may be put on the isochoric deformation.
VSC_INLINE void vsc_law_ground(const vsc_material *material, const vsc_wide e[6],
                               vsc_law_depth depth, vsc_law_answer *answer)
{
  const vsc_holzapfel_ogden_def *myocardium = &material->holzapfel_ogden;
  switch (material->law) {
    case VSC_LAW_NEO_HOOKEAN:
      vsc_law_neo_hookean(material->shear, e, depth, answer);
      break;
    case VSC_LAW_MOONEY_RIVLIN:
      vsc_law_mooney_rivlin(&material->invariants, e, depth, answer);
      break;
    case VSC_LAW_VERONDA_WESTMANN:
      vsc_law_veronda_westmann(&material->invariants, e, depth, answer);
      break;
    case VSC_LAW_HOLZAPFEL_OGDEN:
      vsc_add_exponential_ground(myocardium->a, myocardium->b, e, depth, answer);
      break;
    default:  // GUCCIONE and FUNG
      vsc_law_fung(&material->fung, e, depth, answer);
  }
}

// The law's answer at strain e, activity included: into `answer`, which is overwritten, as deep as
// `depth`. The energy is that of the passive material.
VSC_INLINE void vsc_law_evaluate(const vsc_law_input *in, const vsc_wide e[6], vsc_law_depth depth,
                                 vsc_law_answer *answer)
{
  const vsc_material *material = in->material;
  *answer = (vsc_law_answer){0};
  if (material->law == VSC_LAW_SPRINGS) {
    vsc_law_springs_strain(material, &in->moduli, in->axes, in->pairs, in->activation, e,
                           depth == VSC_LAW_ENERGY, depth == VSC_LAW_TANGENT, answer);
  } else {
    vsc_isochoric iso;
    if (material->isochoric) vsc_isochoric_of(e, &iso);
    vsc_law_ground(material, material->isochoric ? iso.e : e, depth, answer);
    if (material->isochoric) vsc_isochoric_answer(&iso, depth, answer);
    if (material->law == VSC_LAW_HOLZAPFEL_OGDEN)
      vsc_law_holzapfel_ogden_fibres(&material->holzapfel_ogden, material->compression, e, depth,
                                     answer);
  }
  if (depth != VSC_LAW_ENERGY && material->active == VSC_ACTIVE_TENSION)
    vsc_law_add_tension(material, in->moduli.share * in->activation, e, depth == VSC_LAW_TANGENT,
                        answer);
}

#endif
