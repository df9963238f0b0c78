// SPDX-License-Identifier: GPL-3.0-or-later
// What the user asks to simulate, as plain structs with documented defaults: no file and no mesh in
// it. Units inside: mm, ms, mg, kPa = mg/(mm ms^2), mN, uJ; they are consistent, so no factor
// appears anywhere.
#ifndef VSC_MODEL_DEFINITION_H
#define VSC_MODEL_DEFINITION_H

#include <stddef.h>

#include "base/status.h"
#include "base/text.h"
#include "mesh/select.h"

// A function of time with values mostly in [0, 1]; loads and activation scale it by a peak value.
typedef enum vsc_curve_kind {
  VSC_CURVE_CONSTANT,     // 1
  VSC_CURVE_RAMP,         // min(max((t - start)/duration, 0), 1)
  VSC_CURVE_HALF_SINE,    // sin(pi (t - start)/duration) for start <= t <= start + duration, else 0
  VSC_CURVE_DOUBLE_HILL,  // g1/(1+g1) . 1/(1+g2), scaled to peak 1;
                          // g1 = ((t-start)/rise)^rise_power, g2 = ((t-start)/fall)^fall_power
  VSC_CURVE_TANH_PAIR,    // (1 + tanh((t-start)/rise))/2 . (1 - tanh((t-start-duration)/fall))/2
  VSC_CURVE_TABLE,        // monotone (Steffen) spline through given points, flat outside them
} vsc_curve_kind;

typedef struct vsc_curve_def {
  vsc_curve_kind kind;  // default CONSTANT
  double start;         // ms; default 0
  double duration;      // ms; default 300
  double rise;          // ms; DOUBLE_HILL time constant, TANH_PAIR steepness; default 100 and 20
  double fall;          // ms; likewise; default 300 and 20
  double rise_power;    // DOUBLE_HILL: default 2
  double fall_power;    // DOUBLE_HILL: default 20
  double period;        // ms; the curve repeats; 0: it does not; default 0
  size_t point_count;   // TABLE: at least 2
  double *times;        // TABLE: point_count, rising, ms; owned
  double *values;       // TABLE: point_count; owned
} vsc_curve_def;

typedef enum vsc_active_kind {
  VSC_ACTIVE_NONE,
  VSC_ACTIVE_SPRING,   // the fibre spring itself changes: E_f(t) = E_f + a (stiffness - E_f),
                       // rest stretch r(t) = 1 - a (1 - rest_stretch)
  VSC_ACTIVE_TENSION,  // a tension T(t) = a tension along the fibre, as second Piola-Kirchhoff
                       // stress: S += T f0 f0 (Land et al. 2015), that is P_f += T g_f
} vsc_active_kind;

// Activation a = amplitude . curve(t - delay) of an element, 0 at rest and 1 at the peak.
typedef struct vsc_active_def {
  vsc_active_kind kind;  // default NONE
  double stiffness;      // SPRING: fibre modulus at a = 1, kPa
  double rest_stretch;   // SPRING: rest stretch at a = 1, in (0, 1]; default 1
  double tension;        // TENSION: at a = 1, kPa
  vsc_curve_def curve;
  double delay;                    // ms, default 0
  char amplitude_array[VSC_NAME];  // tet array that multiplies the amplitude; empty: 1
  char delay_array[VSC_NAME];      // tet array added to the delay; empty: 0
  double delay_unit;               // ms per unit of delay_array; default 1
} vsc_active_def;

// A tissue. Springs law (Bourguignon & Cani 2000, energy form) on the frame axes g_f, g_s, g_n with
// u_a = g_a/|g_a|, c_ab = u_a . u_b:
//   psi = sum_a E_a (|g_a| - 1)^2 / 2 + sum_{a<b} G_ab c_ab^2 / 2
typedef struct vsc_material_def {
  char name[VSC_NAME];
  size_t region_count;    // 0: every element that no other material names
  int regions[32];        // values of the region array
  double density;         // mg/mm^3; default 1.06
  double axial[3];        // E_f, E_s, E_n, kPa
  double angular[3];      // G_fs, G_sn, G_nf, kPa
  double damping[3];      // axial viscosity eta_f, eta_s, eta_n, kPa ms; default 0
  double volume_modulus;  // K, kPa, of U(J) = K/4 (J^2 - 1 - 2 ln J); default 0
  double stabilization;   // Ks, kPa: the same energy of each tet beside node-averaged volume
  vsc_active_def active;
} vsc_material_def;

// Which elements share one volume ratio J and one pressure.
typedef enum vsc_volume_kind {
  VSC_VOLUME_NODAL,    // all tets round a node (Bonet & Burton), default
  VSC_VOLUME_ELEMENT,  // each tet alone; locks when K is far above the shear modulus
} vsc_volume_kind;

typedef struct vsc_support_def {
  char set[VSC_NAME];  // node set
  int held[3];         // 1: the node does not move in x, y, z
} vsc_support_def;

typedef struct vsc_pressure_def {
  char surface[VSC_NAME];  // surface it acts on, pushing the tissue against the outward normal
  double peak;             // kPa at curve value 1
  vsc_curve_def curve;
} vsc_pressure_def;

typedef struct vsc_definition {
  char region_array[VSC_NAME];  // tet array of region numbers; empty: one region, 0
  size_t material_count;
  vsc_material_def *materials;  // owned
  vsc_volume_kind volume;
  size_t surface_count;
  vsc_selector *surfaces;  // owned
  size_t set_count;
  vsc_selector *sets;  // owned
  size_t support_count;
  vsc_support_def *supports;  // owned
  size_t pressure_count;
  vsc_pressure_def *pressures;  // owned
  double gravity[3];            // mm/ms^2; default 0
  double end_time;              // ms
  double step;                  // ms; 0: from the stable step; default 0
  double safety;                // fraction of the estimated stable step that is taken; default 0.8
} vsc_definition;

// The documented defaults.
vsc_curve_def vsc_default_curve(vsc_curve_kind kind);
vsc_active_def vsc_default_active(void);
vsc_material_def vsc_default_material(void);
vsc_definition vsc_default_definition(void);

// Refuses numbers that mean nothing (negative moduli, no volume modulus, rest stretch outside
// (0, 1], ...) with the key as the scene writes it (materials[0].axial ...), the value and the
// remedy.
vsc_status vsc_definition_check(const vsc_definition *definition, vsc_error *error);

// Releases what the definition owns, not the struct itself.
void vsc_definition_free(vsc_definition *definition);

#endif
