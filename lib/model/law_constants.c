// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/law_constants.h"

#include <math.h>
#include <string.h>

static vsc_law_constant pressure(const char *key, double value, bool positive)
{
  return (vsc_law_constant){key, "kPa", value, positive, INFINITY};
}

static vsc_law_constant number(const char *key, double value, bool positive)
{
  return (vsc_law_constant){key, "", value, positive, INFINITY};
}

static size_t copy(const vsc_law_constant *from, size_t count, vsc_law_constant *list)
{
  memcpy(list, from, count * sizeof *list);
  return count;
}

static size_t guccione(const vsc_guccione_def *law, vsc_law_constant *list)
{
  const vsc_law_constant all[] = {
      pressure("guccione.C", law->C, true), number("guccione.bf", law->fibre, true),
      number("guccione.bt", law->cross, true), number("guccione.bfs", law->shear, true)};
  return copy(all, sizeof all / sizeof *all, list);
}

static size_t fung(const vsc_fung_def *law, vsc_law_constant *list)
{
  static const char *const keys[6] = {"fung.bff", "fung.bss", "fung.bnn",
                                      "fung.bfs", "fung.bsn", "fung.bnf"};
  list[0] = pressure("fung.C", law->C, true);
  for (int k = 0; k < 6; k++) list[1 + k] = number(keys[k], law->b[k], true);
  return 7;
}

// An exponent means something where its term is there.
static size_t holzapfel_ogden(const vsc_material_def *material, vsc_law_constant *list)
{
  const vsc_holzapfel_ogden_def *law = &material->holzapfel_ogden;
  const vsc_law_constant all[] = {
      pressure("holzapfel_ogden.a", law->a, true),
      number("holzapfel_ogden.b", law->b, true),
      pressure("holzapfel_ogden.af", law->a_f, false),
      number("holzapfel_ogden.bf", law->b_f, law->a_f > 0),
      pressure("holzapfel_ogden.as", law->a_s, false),
      number("holzapfel_ogden.bs", law->b_s, law->a_s > 0),
      pressure("holzapfel_ogden.afs", law->a_fs, false),
      number("holzapfel_ogden.bfs", law->b_fs, law->a_fs > 0),
      {"holzapfel_ogden.kappa_f", "", law->kappa_f, false, 1.0 / 3},
      {"holzapfel_ogden.kappa_s", "", law->kappa_s, false, 1.0 / 3},
      number("holzapfel_ogden.steepness", law->steepness, true)};
  const size_t count = sizeof all / sizeof *all;
  // k belongs to the smooth switch
  return copy(all, material->compression == VSC_FIBRES_SMOOTH ? count : count - 1, list);
}

size_t vsc_law_constants(const vsc_material_def *material,
                         vsc_law_constant list[VSC_MOST_CONSTANTS])
{
  switch (material->law) {
    case VSC_LAW_NEO_HOOKEAN:
      list[0] = pressure("neo_hookean.shear", material->shear, true);
      return 1;
    case VSC_LAW_GUCCIONE:
      return guccione(&material->guccione, list);
    case VSC_LAW_FUNG:
      return fung(&material->fung, list);
    case VSC_LAW_HOLZAPFEL_OGDEN:
      return holzapfel_ogden(material, list);
    case VSC_LAW_MOONEY_RIVLIN:
      list[0] = pressure("mooney_rivlin.c1", material->mooney_rivlin.c1, true);
      list[1] = pressure("mooney_rivlin.c2", material->mooney_rivlin.c2, false);
      return 2;
    case VSC_LAW_VERONDA_WESTMANN:
      list[0] = pressure("veronda_westmann.c1", material->veronda_westmann.c1, true);
      list[1] = number("veronda_westmann.c2", material->veronda_westmann.c2, true);
      return 2;
    default:
      return 0;
  }
}

bool vsc_couplings_hold(const vsc_material_def *material)
{
  const double *E = material->axial, *H = material->coupling, K = material->volume_modulus;
  const double f = E[0] + K, s = E[1] + K, n = E[2] + K;
  const double fs = H[0] + K, sn = H[1] + K, nf = H[2] + K;
  const double determinant = f * (s * n - sn * sn) - fs * (fs * n - sn * nf) + nf * (fs * sn - s * nf);
  if (H[0] == 0 && H[1] == 0 && H[2] == 0) return true;
  return f > 0 && f * s > fs * fs && determinant > 0;
}
