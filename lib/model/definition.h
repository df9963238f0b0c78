// SPDX-License-Identifier: GPL-3.0-or-later
// What the user asks to simulate, as plain structs with documented defaults: no file and no mesh in
// it. Units inside: mm, ms, mg, kPa = mg/(mm ms^2), mN, uJ; they are consistent, so no factor
// appears anywhere.
#ifndef VSC_MODEL_DEFINITION_H
#define VSC_MODEL_DEFINITION_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "base/text.h"
#include "mesh/select.h"
#include "model/fiber_def.h"

// A function of time with values mostly in [0, 1]; loads and activation scale it by a peak value.
typedef enum vsc_curve_kind {
  VSC_CURVE_CONSTANT,     // 1
  VSC_CURVE_RAMP,         // min(max((t - start)/duration, 0), 1)
  VSC_CURVE_HALF_SINE,    // sin(pi (t - start)/duration) for start <= t <= start + duration, else 0
  VSC_CURVE_DOUBLE_HILL,  // g1/(1+g1) . 1/(1+g2), scaled to peak 1;
                          // g1 = ((t-start)/rise)^rise_power, g2 = ((t-start)/fall)^fall_power
  VSC_CURVE_TANH_PAIR,    // (1 + tanh((t-start)/rise))/2 . (1 - tanh((t-start-duration)/fall))/2
  VSC_CURVE_TABLE,        // monotone (Steffen) spline through given points, flat outside them
  VSC_CURVE_BESTEL,           // a fibre's tension, and
  VSC_CURVE_BESTEL_PRESSURE,  // the pressure in a ventricle, from equations: model/curve_driver.h
} vsc_curve_kind;

typedef struct vsc_curve_def {
  vsc_curve_kind kind;  // default CONSTANT
  double start;         // ms; default 0, BESTEL 160, BESTEL_PRESSURE 170
  double duration;      // ms; default 300
  double rise;          // ms; DOUBLE_HILL time constant, TANH_PAIR steepness; default 100 and 20 (the latter plausible, not
                        // published)
  double fall;          // ms; likewise; default 300 and 20
  double rise_power;    // DOUBLE_HILL: default 2
  double fall_power;    // DOUBLE_HILL: default 20
  double period;        // ms; the curve repeats; 0: it does not; default 0
  size_t point_count;   // TABLE: at least 2
  double *times;        // TABLE: point_count, rising, ms; owned
  double *values;       // TABLE: point_count; owned
  double stop;          // BESTEL and BESTEL_PRESSURE, also below: end of systole, ms; default 484
  double width;         // gamma, of the switches, ms; default 5
  double rate_up;       // alpha_max, in systole, 1/ms; default 0.005
  double rate_down;     // alpha_min, otherwise, 1/ms, below 0; default -0.03
  double rate_pre;      // BESTEL_PRESSURE: alpha_pre, until the end of systole, 1/ms; default 0.005
  double rate_mid;      // BESTEL_PRESSURE: alpha_mid, always, 1/ms; default 0.001
  double filling;       // BESTEL_PRESSURE: sigma_pre/sigma_mid in a second, 1/ms; default 0.4375e-3
} vsc_curve_def;

typedef enum vsc_active_kind {
  VSC_ACTIVE_NONE,
  VSC_ACTIVE_SPRING,   // the fibre spring itself changes: E_f(t) = E_f + a (stiffness - E_f),
                       // rest stretch r(t) = 1 - a (1 - rest_stretch)
  VSC_ACTIVE_TENSION,  // a tension T(t) = a tension along the fibre, as second Piola-Kirchhoff
                       // stress: S += T f0 f0 (Land et al. 2015), that is P_f += T g_f; it may
                       // depend on length and act across the fibre (model/law_active.h)
} vsc_active_kind;

// Activation a = amplitude . curve(t - delay) of an element, 0 at rest and 1 at the peak.
typedef struct vsc_active_def {
  vsc_active_kind kind;  // default NONE
  double stiffness;      // SPRING: fibre modulus at a = 1, kPa
  double rest_stretch;   // SPRING: rest stretch at a = 1, in (0, 1]; default 1
  double tension;        // TENSION: at a = 1, kPa
  double length_factor;  // TENSION: beta of T = a tension max(0, 1 + beta (|g_f| - 1)); default 0
  double sheet_fraction, normal_fraction;  // TENSION: of T along s and n; default 0
  vsc_curve_def curve;
  double delay;                    // ms, default 0
  char amplitude_array[VSC_NAME];  // cell array that multiplies the amplitude; empty: 1
  char delay_array[VSC_NAME];      // cell array added to the delay; empty: 0
  double delay_unit;               // ms per unit of delay_array; default 1
} vsc_active_def;

// How the elements of a material answer to deformation.
typedef enum vsc_law {
  VSC_LAW_SPRINGS,    // the frame's springs in energy form, moduli per volume (default)
  VSC_LAW_PAPER,      // the formulas of Bourguignon & Cani 2000 as printed, constants per element; no
                      // gradient of an energy: neither energy nor momenta are kept
  VSC_LAW_CLASSICAL,  // a damped spring on each edge of the mesh, and on the main diagonals of
                      // hexahedra
  // tissue laws, functions of strain: psi(E) per volume beside the volume energy
  VSC_LAW_NEO_HOOKEAN,       // model/law_neo_hookean.h
  VSC_LAW_GUCCIONE,          // model/law_fung.h, transversely isotropic
  VSC_LAW_FUNG,              // model/law_fung.h, orthotropic; Usyk's law
  VSC_LAW_HOLZAPFEL_OGDEN,   // model/law_holzapfel_ogden.h
  VSC_LAW_MOONEY_RIVLIN,     // model/law_mooney_rivlin.h
  VSC_LAW_VERONDA_WESTMANN,  // model/law_veronda_westmann.h
} vsc_law;

// Whether the law is a function of strain on the elements' frames, with a volume energy beside it.
static inline bool vsc_law_is_of_strain(vsc_law law)
{
  return law != VSC_LAW_PAPER && law != VSC_LAW_CLASSICAL;
}

// Constants of LAW_PAPER, the same for each element whatever its size (mN/mm = N/m).
typedef struct vsc_paper_def {
  double axial[3];        // k_s of the springs along f, s, n, mN/mm
  double damping[3];      // their k_d, mN ms/mm
  double angular[3];      // k_s of the angular springs fs, sn, nf, mN
  double volume;          // k_s against a change of the corners' distances from the barycentre, mN/mm
  double volume_damping;  // hexahedra: k_d of the springs from the corners to the barycentre, mN ms/mm
  double active;          // k_s of the fibre spring at activation 1, mN/mm (active kind SPRING)
} vsc_paper_def;

// Constants of LAW_CLASSICAL, the same for each edge.
typedef struct vsc_classical_def {
  double stiffness;  // k_s, mN/mm
  double damping;    // k_d, mN ms/mm
} vsc_classical_def;

// Constants of LAW_GUCCIONE.
typedef struct vsc_guccione_def {
  double C;                     // kPa
  double fibre, cross, shear;   // bf, bt, bfs
} vsc_guccione_def;

// Constants of LAW_FUNG.
typedef struct vsc_fung_def {
  double C;     // kPa
  double b[6];  // b_ff, b_ss, b_nn, b_fs, b_sn, b_nf
} vsc_fung_def;

// What becomes of fibres in compression (LAW_HOLZAPFEL_OGDEN).
typedef enum vsc_fibre_switch {
  VSC_FIBRES_ALWAYS,  // nothing (default)
  VSC_FIBRES_SHARP,   // they are switched off
  VSC_FIBRES_SMOOTH,  // likewise, by a logistic function
} vsc_fibre_switch;

// Constants of LAW_HOLZAPFEL_OGDEN.
typedef struct vsc_holzapfel_ogden_def {
  double a, b;                // of the ground: kPa, 1
  double a_f, b_f, a_s, b_s;  // of fibres and sheets; default 0: none
  double a_fs, b_fs;          // between them
  double kappa_f, kappa_s;    // dispersions, 0 to 1/3; default 0
  double steepness;           // k of SMOOTH; default 100
} vsc_holzapfel_ogden_def;

// Constants of LAW_MOONEY_RIVLIN (both kPa) and LAW_VERONDA_WESTMANN (kPa, 1).
typedef struct vsc_invariants_def {
  double c1, c2;
} vsc_invariants_def;

enum { VSC_MOST_AXES = 64 };  // beside f, s, n

// An axis beside f, s, n: psi += E (|g_d| - 1)^2 / 2 with g_d = d_f g_f + d_s g_s + d_n g_n.
typedef struct vsc_axis_def {
  double direction[3];  // d in f, s, n; any length but 0
  double modulus;       // E, kPa
  double damping;       // eta along it, kPa ms
} vsc_axis_def;

// An angular spring between two axes: psi += G (c - c at rest)^2 / 2, c the cosine between them.
typedef struct vsc_pair_def {
  int axes[2];     // 0 f, 1 s, 2 n, 3 the first of `axes`, ...
  double modulus;  // G, kPa
} vsc_pair_def;

// A part of each element's volume that is another material: moduli and densities are mixed by volume,
// E = (1 - sum phi) E_own + sum phi_j E_j (Voigt). Where phi > 0 both laws are SPRINGS.
typedef struct vsc_inclusion_def {
  char material[VSC_NAME];        // the other material's name
  char fraction_array[VSC_NAME];  // element array of phi in [0, 1]
} vsc_inclusion_def;

enum { VSC_MOST_BRANCHES = 8 };  // of a Prony series

// A branch of a Prony series (mech/prony.h): a part of the law's stress, and the time in which it relaxes.
typedef struct vsc_prony_def {
  double modulus;  // g, part of the instantaneous stress
  double time;     // tau, ms
} vsc_prony_def;

// A tissue. Springs law (Bourguignon & Cani 2000, energy form) on the frame axes g_f, g_s, g_n with
// u_a = g_a/|g_a|, c_ab = u_a . u_b:
//   psi = sum_a E_a (|g_a| - 1)^2 / 2 + sum_{a<b} [G_ab c_ab^2 / 2 + H_ab (|g_a| - 1) (|g_b| - 1)]
typedef struct vsc_material_def {
  char name[VSC_NAME];
  size_t region_count;    // 0: every element that no other material names
  int regions[32];        // values of the region array
  double density;         // mg/mm^3; default 1.06
  double axial[3];        // E_f, E_s, E_n, kPa
  double angular[3];      // G_fs, G_sn, G_nf, kPa
  double coupling[3];     // H_fs, H_sn, H_nf, kPa; default 0
  double damping[3];      // axial viscosity eta_f, eta_s, eta_n, kPa ms; default 0
  double viscosity;       // laws of strain: eta of S = eta dE/dt, kPa ms; default 0
  bool isochoric;         // tissue laws: on the deformation without its change of volume, of
                          // HOLZAPFEL_OGDEN the ground alone; default false: on all of it
  double volume_modulus;  // K, kPa, of U(J) = K/4 (J^2 - 1 - 2 ln J); default 0
  double stabilization;   // Ks, kPa: the same energy of each frame beside a shared volume; 0: law SPRINGS
                          // has none, other laws take their shear modulus (K/2 at most) out of K. Nothing
                          // is shared, and Ks means nothing, in a mesh of linear tets with VOLUME_ELEMENT
  vsc_active_def active;
  vsc_law law;
  vsc_paper_def paper;          // law PAPER; axial, angular, damping and volume_modulus are not used
  vsc_classical_def classical;  // law CLASSICAL; likewise
  double shear;                 // law NEO_HOOKEAN: mu, kPa
  vsc_guccione_def guccione;
  vsc_fung_def fung;
  vsc_holzapfel_ogden_def holzapfel_ogden;
  vsc_fibre_switch compression;  // law HOLZAPFEL_OGDEN; default ALWAYS
  vsc_invariants_def mooney_rivlin, veronda_westmann;
  size_t axis_count;            // law SPRINGS: axes beside f, s, n
  vsc_axis_def *axes;           // owned
  size_t pair_count;            // law SPRINGS: angular springs beside fs, sn, nf
  vsc_pair_def *pairs;          // owned
  size_t inclusion_count;
  vsc_inclusion_def *inclusions;  // owned
  size_t prony_count;             // laws of strain: branches of a Prony series
  vsc_prony_def *prony;           // owned
} vsc_material_def;

// A sheet of tissue on a surface (a capsule, a valve, cloth): each triangle has two axes in its
// plane, a along `direction` as projected into it and b across,
//   psi = t A (E_a (|g_a|-1)^2/2 + E_b (|g_b|-1)^2/2 + G c_ab^2/2 + K (J-1)^2/2),
// J the ratio of areas, and resists bending as an isotropic plate of Poisson ratio K/(E + K) does
// (model/law_bending.h). Bending is damped as the plane is.
typedef struct vsc_membrane_def {
  char name[VSC_NAME];
  char surface[VSC_NAME];  // one of the surfaces, "boundary", or "triangles": all that the file has
  double thickness;        // t, mm
  double density;          // mg/mm^3; default 1.06
  double axial[2];         // E_a, E_b, kPa
  double angular;          // G, kPa
  double area_modulus;     // K, kPa; default 0
  double damping[2];       // eta_a, eta_b, kPa ms; default 0
  double bending;          // flexural rigidity D, uJ = mN mm; default 0: none
  double direction[3];     // of axis a; default 1 0 0
} vsc_membrane_def;

// How the mass goes to the nodes, and with it the weight; in equilibria, where masses do nothing else, as LUMPED.
typedef enum vsc_mass_kind {
  VSC_MASS_LUMPED,   // row sums of the consistent mass: a quarter of a tet to each corner (default)
  VSC_MASS_VORONOI,  // what of the body is nearest to the node (model/masses.h)
  VSC_MASS_EQUAL,    // all nodes alike, the same total
  VSC_MASS_CONSISTENT,  // int rho N_i N_j dV, which joins nodes; for solve implicit only. What else is
                        // told by masses (momentum) takes the lumped ones
} vsc_mass_kind;

// Volumes that are kept to rounding by Lagrange multipliers, beside the volume energy.
typedef enum vsc_kept_volume {
  VSC_KEEP_NONE,     // default
  VSC_KEEP_TOTAL,    // of the whole body
  VSC_KEEP_REGION,   // of each material
  VSC_KEEP_NODE,     // of the elements round each node, each sharing its volume among its corners
  VSC_KEEP_ELEMENT,  // of each element
} vsc_kept_volume;

enum { VSC_MOST_OBSTACLES = 8 };

typedef enum vsc_obstacle_kind { VSC_OBSTACLE_PLANE, VSC_OBSTACLE_SPHERE } vsc_obstacle_kind;

// A rigid thing that no node may enter.
typedef struct vsc_obstacle_def {
  vsc_obstacle_kind kind;
  double point[3];     // PLANE: a point of it; SPHERE: its centre, mm
  double normal[3];    // PLANE: towards the free side, any length
  double radius;       // SPHERE, mm
  double friction;     // Coulomb's coefficient; default 0
  double motion[3];    // it moves by motion . curve(t), mm; default 0
  vsc_curve_def curve; // default constant
  char set[VSC_NAME];  // node set that it stops; empty: all nodes
} vsc_obstacle_def;

// Which linear tets share one volume ratio J and one pressure. Cells of other kinds share theirs among their own
// frames in any case; beside them a tet that is alone has K + Ks, so that a material has one bulk modulus.
typedef enum vsc_volume_kind {
  VSC_VOLUME_NODAL,    // all tets round a node (Bonet & Burton), default
  VSC_VOLUME_ELEMENT,  // each tet alone; locks when K is far above the shear modulus
} vsc_volume_kind;

// What linear tets' laws are evaluated on.
typedef enum vsc_tets_kind {
  VSC_TETS_PLAIN,     // each tet's own deformation (default)
  VSC_TETS_SMOOTHED,  // its average over the tets round each edge (model/smoothing.h)
} vsc_tets_kind;

typedef struct vsc_support_def {
  char set[VSC_NAME];  // node set
  int held[3];         // 1: in x, y, z the node moves by the support's motion only
  double motion[3];    // held directions are at rest + motion . curve(t), mm; default 0
  vsc_curve_def curve; // default constant
} vsc_support_def;

enum { VSC_MOST_MOVED = 8 };  // supports with a motion

// Springs and dashpots per area between a surface and its place at rest: the traction
// -(stiffness u + damping v), either of all of u and v or of (u . N) N with the normal N at rest.
typedef struct vsc_robin_def {
  char surface[VSC_NAME];
  double stiffness;  // kPa/mm; default 0
  double damping;    // kPa ms/mm; default 0
  bool normal;       // default false: all directions
} vsc_robin_def;

typedef struct vsc_pressure_def {
  char surface[VSC_NAME];  // surface it acts on, pushing the tissue against the outward normal
  double peak;             // kPa at curve value 1
  double direction[3];     // of any length: the load keeps it, per area at rest (a dead traction); default
                           // 0 0 0: it is a pressure, along the moving normal
  vsc_curve_def curve;
} vsc_pressure_def;

// How fast each node is at the start.
typedef struct vsc_velocity_def {
  char array[VSC_NAME];  // node array of three numbers; empty: at rest (default)
  double unit;           // one unit of it, mm/ms; default 1
} vsc_velocity_def;

// How a state is moved on in time.
typedef enum vsc_solve_kind {
  VSC_SOLVE_EXPLICIT,     // Stoermer-Verlet (default)
  VSC_SOLVE_EQUILIBRIUM,  // forces balance at each time that is written; no inertia, no damping
  VSC_SOLVE_IMPLICIT,     // one of the schemes below
} vsc_solve_kind;

// How Newton's method solves its linear systems.
typedef enum vsc_linear_kind {
  VSC_LINEAR_AUTO,       // diagonal blocks until a factorisation would have been cheaper (default)
  VSC_LINEAR_DIRECT,     // a Cholesky factor, made anew when the former one has become a bad
                         // preconditioner
  VSC_LINEAR_ITERATIVE,  // conjugate gradients with diagonal blocks only: little memory
} vsc_linear_kind;

// Implicit schemes (solve/implicit.h).
typedef enum vsc_scheme {
  VSC_SCHEME_GENERALIZED_ALPHA,  // default
  VSC_SCHEME_TRAPEZOID,
  VSC_SCHEME_BDF2,
} vsc_scheme;

// How equilibrium is found.
typedef enum vsc_statics {
  VSC_STATICS_NEWTON,      // default
  VSC_STATICS_RELAXATION,  // damped explicit steps: no matrix
} vsc_statics;

#define VSC_USUAL_TOLERANCE 1e-6  // of balanced forces, where a definition leaves it to us

typedef struct vsc_solve_def {
  vsc_solve_kind kind;
  vsc_statics method;  // of EQUILIBRIUM
  vsc_linear_kind linear;
  vsc_scheme scheme;
  double rho;        // GENERALIZED_ALPHA: by what the fastest motions decay in each step, 0 to 1; default 0.5
  double accuracy;   // IMPLICIT without a given step: error of a step as a part of the body's size;
                     // default 1e-4
  double tolerance;  // of the residual, as a part of the forces at work; 0 (default): 1e-6, but IMPLICIT without a
                     // given step as accuracy, from 1e-6 to 1e-4
  double incompressible;  // EQUILIBRIUM by Newton: largest |J - 1| of volumes that tets share and of other
                          // elements, by multipliers; 0: as K has it (default)
} vsc_solve_def;

typedef struct vsc_definition {
  char region_array[VSC_NAME];  // cell array of region numbers; empty: one region, 0
  size_t material_count;
  vsc_material_def *materials;  // owned
  size_t vessel_count;
  vsc_vessel_def *vessels;  // owned
  vsc_volume_kind volume;
  vsc_tets_kind tets;
  size_t surface_count;
  vsc_selector *surfaces;  // owned
  size_t set_count;
  vsc_selector *sets;  // owned
  size_t support_count;
  vsc_support_def *supports;  // owned
  size_t pressure_count;
  vsc_pressure_def *pressures;  // owned
  size_t robin_count;
  vsc_robin_def *robins;  // owned
  size_t membrane_count;
  vsc_membrane_def *membranes;  // owned
  size_t obstacle_count;
  vsc_obstacle_def *obstacles;  // owned
  vsc_kept_volume kept_volume;
  vsc_mass_kind masses;
  double gravity[3];            // mm/ms^2; default 0
  vsc_velocity_def velocity;
  double end_time;              // ms
  double cycle;                 // ms; a run may stop when a cycle of this length repeats the last; 0: not
  double cycle_tolerance;       // to which it has to repeat it (run/cycle.h); default 1e-3
  double step;                  // ms; 0: from the stable step; default 0
  bool force_step;              // takes `step` even when it is above the stable one; default false
  double mass_scaling;          // ms; vsc_scale_masses adds mass until steps may be as long; 0: none
  double most_added_mass;       // part of the body's mass that it may add; default 0.05
  double selective_mass_scaling;  // ms; vsc_scale_masses makes neighbours inert against one another until steps may be
                                  // as long; 0: not
  double safety;                // fraction of the estimated stable step that is taken; default 0.8
  vsc_solve_def solve;
} vsc_definition;

// The documented defaults.
vsc_curve_def vsc_default_curve(vsc_curve_kind kind);
vsc_active_def vsc_default_active(void);
vsc_material_def vsc_default_material(void);
vsc_membrane_def vsc_default_membrane(void);
vsc_obstacle_def vsc_default_obstacle(void);
vsc_support_def vsc_default_support(void);
vsc_definition vsc_default_definition(void);

// Whether the material takes elements of its own: those of its regions or, without any, what no other
// material names. One without regions that a vessel or an inclusion names takes none.
bool vsc_takes_elements(const vsc_definition *definition, size_t material);

// Refuses numbers that mean nothing (negative moduli, no volume modulus, rest stretch outside
// (0, 1], ...), and kinds that their enumeration does not have, with the key as the scene writes it
// (materials[0].axial ...), the value and the remedy.
vsc_status vsc_definition_check(const vsc_definition *definition, vsc_error *error);

// Releases what the definition owns, not the struct itself.
void vsc_definition_free(vsc_definition *definition);

#endif
