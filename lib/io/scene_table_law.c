// SPDX-License-Identifier: GPL-3.0-or-later
// The constants of tissue laws.
#include "io/scene_rows.h"

#define CONSTANT(field, what) QUANTITY(vsc_material_def, field, what), .needed = VSC_ALWAYS
#define OPTIONAL(field, what) QUANTITY(vsc_material_def, field, what)

static const vsc_row vsc_law_neo_hookean_group_rows[] = {
    {"shear", CONSTANT(shear, VSC_PRESSURE), .text = "5 kPa",
     .meaning = "mu of psi = mu/2 (I1 - 3)"},
};
GROUP(, vsc_law_neo_hookean_group, -1);

static const vsc_row vsc_law_guccione_group_rows[] = {
    {"C", CONSTANT(guccione.C, VSC_PRESSURE), .text = "2 kPa",
     .meaning = "of psi = C/2 (exp(Q) - 1)"},
    {"bf", CONSTANT(guccione.fibre, VSC_NUMBER), .text = "8", .meaning = "along the fibre"},
    {"bt", CONSTANT(guccione.cross, VSC_NUMBER), .text = "2",
     .meaning = "along and between sheet and normal"},
    {"bfs", CONSTANT(guccione.shear, VSC_NUMBER), .text = "4",
     .meaning = "between the fibre and these"},
};
GROUP(, vsc_law_guccione_group, -1);

static const vsc_row vsc_law_fung_group_rows[] = {
    {"C", CONSTANT(fung.C, VSC_PRESSURE), .text = "0.88 kPa",
     .meaning = "of psi = C/2 (exp(Q) - 1), Q = bff Eff^2 + ... + 2 bfs Efs^2 + ..."},
    {"bff", CONSTANT(fung.b[0], VSC_NUMBER), .text = "18.5", .meaning = "along the fibre"},
    {"bss", CONSTANT(fung.b[1], VSC_NUMBER), .text = "3.6", .meaning = "along the sheet"},
    {"bnn", CONSTANT(fung.b[2], VSC_NUMBER), .text = "3.6", .meaning = "along the normal"},
    {"bfs", CONSTANT(fung.b[3], VSC_NUMBER), .text = "2.8", .meaning = "between fibre and sheet"},
    {"bsn", CONSTANT(fung.b[4], VSC_NUMBER), .text = "2.8", .meaning = "between sheet and normal"},
    {"bnf", CONSTANT(fung.b[5], VSC_NUMBER), .text = "2.8", .meaning = "between normal and fibre"},
};
GROUP(, vsc_law_fung_group, -1);

static const vsc_word compressions[] = {{"none", VSC_FIBRES_ALWAYS},
                                        {"sharp", VSC_FIBRES_SHARP},
                                        {"smooth", VSC_FIBRES_SMOOTH},
                                        {NULL, 0}};

static const vsc_row vsc_law_holzapfel_ogden_group_rows[] = {
    {"a", CONSTANT(holzapfel_ogden.a, VSC_PRESSURE), .text = "59 Pa",
     .meaning = "of the ground, a/2b (exp(b (I1 - 3)) - 1)"},
    {"b", CONSTANT(holzapfel_ogden.b, VSC_NUMBER), .text = "8.023", .meaning = "its exponent"},
    {"af", OPTIONAL(holzapfel_ogden.a_f, VSC_PRESSURE), .text = "18472 Pa",
     .meaning = "of the fibres, af/2bf (exp(bf (I4f - 1)^2) - 1); default 0 kPa"},
    {"bf", OPTIONAL(holzapfel_ogden.b_f, VSC_NUMBER), .text = "16.026", .meaning = "its exponent"},
    {"as", OPTIONAL(holzapfel_ogden.a_s, VSC_PRESSURE), .text = "2481 Pa",
     .meaning = "of the sheets, likewise; default 0 kPa"},
    {"bs", OPTIONAL(holzapfel_ogden.b_s, VSC_NUMBER), .text = "11.12", .meaning = "its exponent"},
    {"afs", OPTIONAL(holzapfel_ogden.a_fs, VSC_PRESSURE), .text = "216 Pa",
     .meaning = "between them, afs/2bfs (exp(bfs I8fs^2) - 1); default 0 kPa"},
    {"bfs", OPTIONAL(holzapfel_ogden.b_fs, VSC_NUMBER), .text = "11.436",
     .meaning = "its exponent"},
    {"kappa_f", OPTIONAL(holzapfel_ogden.kappa_f, VSC_NUMBER), .text = "0",
     .meaning = "dispersion of the fibres, 0 to 1/3"},
    {"kappa_s", OPTIONAL(holzapfel_ogden.kappa_s, VSC_NUMBER), .text = "0",
     .meaning = "dispersion of the sheets"},
    {"switch", CHOICE(vsc_material_def, compression, compressions), .text = "smooth",
     .meaning = "compressed fibres: none (as pulled ones), sharp (off), smooth (off, logistic)"},
    {"steepness", OPTIONAL(holzapfel_ogden.steepness, VSC_NUMBER), .text = "100",
     .meaning = "smooth: k of 1/(1 + exp(-k (I4 - 1)))"},
};
GROUP(, vsc_law_holzapfel_ogden_group, -1);

static const vsc_row vsc_law_mooney_rivlin_group_rows[] = {
    {"c1", CONSTANT(mooney_rivlin.c1, VSC_PRESSURE), .text = "1 kPa",
     .meaning = "of psi = c1 (I1 - 3) + c2 (I2 - 3)"},
    {"c2", CONSTANT(mooney_rivlin.c2, VSC_PRESSURE), .text = "0.2 kPa",
     .meaning = "the shear modulus is 2 (c1 + c2)"},
};
GROUP(, vsc_law_mooney_rivlin_group, -1);

static const vsc_row vsc_law_veronda_westmann_group_rows[] = {
    {"c1", CONSTANT(veronda_westmann.c1, VSC_PRESSURE), .text = "0.5 kPa",
     .meaning = "of psi = c1 (exp(c2 (I1 - 3)) - 1) - c1 c2/2 (I2 - 3)"},
    {"c2", CONSTANT(veronda_westmann.c2, VSC_NUMBER), .text = "4",
     .meaning = "the shear modulus is c1 c2"},
};
GROUP(, vsc_law_veronda_westmann_group, -1);
