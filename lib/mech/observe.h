// SPDX-License-Identifier: GPL-3.0-or-later
// What is seen of a state: totals for signals, fields for frames, and the energy ledger. Computed
// only when asked for.
#ifndef VSC_MECH_OBSERVE_H
#define VSC_MECH_OBSERVE_H

#include "mech/state.h"

// Sums and ranges over the whole body at one moment.
typedef struct vsc_totals {
  double kinetic;                // sum m |v|^2 / 2, uJ
  double axial;                  // axial springs at their passive moduli; all of tissue laws, uJ
  double angular;                // angular springs, uJ
  double volume_energy;          // all volume groups, uJ
  double membrane;               // membranes in their planes, uJ
  double bending;                // bending of membranes, uJ
  double springs;                // springs on surfaces, uJ
  double gravity_energy;         // - sum m g . x, uJ, 0 at rest
  double dissipation;            // power of all damping, uJ/ms
  double momentum[3];            // sum m v, mg mm/ms
  double angular_momentum[3];    // sum m x x v, mg mm^2/ms
  double volume;                 // of the tissue, mm^3
  double J_low, J_high;          // range of the frames' volume ratios
  double group_low, group_high;  // range of the node groups' volume ratios; 1 without them
  double stretch_low, stretch_high,
      stretch_mean;  // fibre stretch |g_f| (mean by rest volume), known fibres only
  double tension_high,
      tension_mean;    // active tension, kPa (mean by rest volume, over active materials)
  double known_volume; // rest volume of the elements with a known fibre, mm^3
  double inverted;     // number of elements with J <= 0 in a frame, or at a node of a quadratic tet
  double continued;    // number of frames beyond a law's largest exponent (model/law_exponential.h)
  double contact_work;   // done by moving obstacles since the start, uJ
  double contact_lost;   // in impacts and friction since the start, uJ
  double support_work;   // done by moving supports since the start, uJ
  double prony_work;     // taken by Prony series since the start (mech/prony.h), uJ
  double active_work;  // done by active tension since the last call on the same ledger, uJ
} vsc_totals;

// Works done on the body since the start, kept up at each vsc_observe; what passed between two
// calls is integrated by the trapezoidal rule, so its error falls with the square of their
// distance.
typedef struct vsc_ledger {
  double active;       // work of active tension, uJ
  double pressure;     // work of pressures, uJ
  double dissipated;   // by damping, uJ
  double start;        // kinetic + stored energy at the first call, uJ
  double time;         // of the last call, ms
  double dissipation;  // power at the last call, uJ/ms
  double calls;
  double *way;      // (frames + packs of edges) x 4: along which tension worked, at the last call
                    // (mech/element.h); of no size when nothing is active. Owned
  double *tension;  // likewise: active tension at the last call, kPa. Owned
  double *push;     // forces and places of the nodes under pressure (mech/loads.h). Owned
  vsc_totals *parts;  // of each patch and of each block of edges. Owned
} vsc_ledger;

vsc_status vsc_ledger_create(const vsc_model *model, vsc_ledger **ledger, vsc_error *error);
void vsc_ledger_free(vsc_ledger *ledger);  // NULL is fine

// Fills `totals` from the state and carries the ledger on to the state's time. With `resume` the
// works are left as they are (read from a checkpoint of this very state) and only the last call's
// values are renewed.
void vsc_observe(const vsc_model *model, vsc_state *state, vsc_ledger *ledger, bool resume,
                 vsc_totals *totals);

// Kinetic + stored energy - energy at the start - works + dissipation: 0 but for rounding and
// quadrature, uJ.
double vsc_balance_error(const vsc_ledger *ledger, const vsc_totals *totals);

typedef enum vsc_field {
  VSC_FIELD_DISPLACEMENT,  // nodes x 3, mm
  VSC_FIELD_VELOCITY,      // nodes x 3, mm/ms = m/s
  VSC_FIELD_GROUP_RATIO,   // nodes x 1: J of the node's volume group (1 without groups)
  VSC_FIELD_FIBER,  // elements x 3: unit vector of the deformed axis; 0 where the fibre is not known
  VSC_FIELD_SHEET,
  VSC_FIELD_NORMAL,
  VSC_FIELD_ACTIVE_TENSION,  // elements x 1, kPa: T, or what an active spring adds to the passive one
  VSC_FIELD_STRETCH,         // elements x 1: |g_f|
  VSC_FIELD_VOLUME_RATIO,    // elements x 1: J
  // Strains and stresses, of which an element has the mean of its frames. Strain is Green-Lagrange's,
  // by rest volume: E = (F^T F - 1)/2. Stress is Cauchy's, kPa, by deformed volume (0 where that is
  // not above 0), of all that acts in the tissue at the state's time, activity, damping and the multipliers that keep
  // volumes (those of the last step's balance; of single elements none) included:
  //   sigma = 1/J sum_ab S_ab g_a (x) g_b + p 1,  p = U'(J) of the frame and of its volume group, and
  // -m/J of laws of the full deformation (model/law_volume.h).
  // In fibre axes components are ff ss nn fs sn nf, of strain in the axes at rest, of stress in the
  // deformed ones: f along g_f, s in the plane of g_f and g_s, n across it; 0 where the fibre is not
  // known. In global axes xx yy zz xy yz xz.
  VSC_FIELD_STRAIN_FIBER,           // elements x 6
  VSC_FIELD_STRAIN,                 // elements x 6
  VSC_FIELD_PRINCIPAL_STRAINS,      // elements x 3: from the largest to the smallest
  VSC_FIELD_PRINCIPAL_STRAIN_AXIS,  // elements x 3: unit vector of the largest, in the body at rest
  VSC_FIELD_STRESS_FIBER,           // elements x 6, kPa
  VSC_FIELD_STRESS,                 // elements x 6, kPa
  VSC_FIELD_VON_MISES,              // elements x 1, kPa: sqrt(3/2 s : s), s the deviator of sigma
  VSC_FIELD_PRINCIPAL_STRESSES,     // elements x 3, kPa
  VSC_FIELD_PRINCIPAL_STRESS_AXIS,  // elements x 3
  VSC_FIELD_HELIX_ANGLE,  // elements x 1, degrees: vsc_read_helix_angle reads it
} vsc_field;

// True for fields on nodes.
bool vsc_field_on_nodes(vsc_field field);

// 6, 3 or 1.
int vsc_field_components(vsc_field field);

// VSC_INPUT when the model has no such field: stress, where a material's law is not a function of
// strain (paper, classical).
vsc_status vsc_field_check(const vsc_model *model, vsc_field field, vsc_error *error);

// Writes a field in the mesh's own order; `values` has room for all tuples. Elements without the field
// (vsc_field_check) get 0; smoothed tets show their own deformation, not their edges'.
void vsc_read_field(const vsc_model *model, vsc_state *state, vsc_field field, double *values);

// The angle of each element's deformed fibre above the circumference, in degrees, -90 to 90, into
// `values` (the mesh's order): seen from the line through `centre` (mm) along `axis` (from apex to
// base, of any length but 0),
//   atan(f . e_l / f . e_c),  e_l along the axis, e_c = e_l x (from the line to the element)
// as fibers/helix.h counts it, on a cylinder: where the wall leans from the axis by an angle b, its
// tangent is that within the wall times cos b. 0 where the fibre is not known.
void vsc_read_helix_angle(const vsc_model *model, const vsc_state *state, const double centre[3],
                          const double axis[3], double *values);

#endif
