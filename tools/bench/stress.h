// SPDX-License-Identifier: GPL-3.0-or-later
// What `viscera bench stability` puts tissue through: a stress, a law, a kind of element and a method make a
// case, which is a scene and a mesh like any user's.
#ifndef VSC_TOOLS_BENCH_STRESS_H
#define VSC_TOOLS_BENCH_STRESS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

// How the block of 4 x 2 x 2 bricks of 1 mm is spoilt.
typedef enum vsc_stress_shape {
  VSC_STRESS_GOOD,    // its inner nodes are moved a little
  VSC_STRESS_FLAT,    // one layer of bricks is so flat that its diagonals rise by 0.1 degree
  VSC_STRESS_SLIVER,  // an inner node is pushed until an element is as flat as that
  VSC_STRESS_SMALL,   // one brick is a thousandth as large as its neighbours
} vsc_stress_shape;

typedef struct vsc_stress {
  const char *name;         // in names of cases
  const char *what;         // in reports
  vsc_stress_shape shape;
  double axes;              // fibre's modulus over the others', times what the law has; 0 means 1, as below
  double regions;           // moduli of one half over those of the other
  double volume;            // volume modulus over shear modulus; 0: 20
  double masses;            // density of one half over that of the other
  double viscosity;         // Pa s; 0: none
  double tension;           // kPa; 0: 5
  const char *curve;        // of the tension; NULL: one half sine over the run
  bool delays;              // each element starts at a random time
  double pressure;          // kPa, at the free end, in half of the run; 0: 1
  double gravity;           // m/s2, downwards
  double motion;            // mm, of the far end, which then is held, towards the near one
  double end;               // ms; 0: 10
} vsc_stress;

extern const vsc_stress vsc_stresses[];
extern const size_t vsc_stress_count;

typedef struct vsc_stress_case {
  size_t stress, law, kind, method;  // numbers in their lists
  char name[96];                     // STRESS-LAW-KIND-METHOD
} vsc_stress_case;

extern const char *const vsc_stress_laws[];
extern const size_t vsc_stress_law_count;
extern const char *const vsc_stress_kinds[];
extern const size_t vsc_stress_kind_count;
enum { VSC_STRESS_EXPLICIT, VSC_STRESS_COUPLED, VSC_STRESS_IMPLICIT, VSC_STRESS_EQUILIBRIUM, VSC_STRESS_METHODS };
extern const char *const vsc_stress_methods[VSC_STRESS_METHODS];

// Goes to the next case; begin with a zeroed one whose name is empty. False behind the last. Unless `whole`,
// which has every law with every kind of element, each stress meets each law and each kind, by each method,
// but the other of the two goes round. What means nothing is left out: more axes than a law has, slivers
// that a kind cannot have, laws of edges without motion.
bool vsc_stress_next(vsc_stress_case *at, bool whole);

// Whether the body itself is the stress, not what is done to it: at rest others are like `nothing`.
bool vsc_stress_rests(const vsc_stress_case *at);

// Writes FOLDER/mesh.vtu, FOLDER/scene.yaml of the case and FOLDER/rest.yaml, the body with nothing done to it.
// VSC_SYSTEM when that fails, VSC_INPUT when the mesh cannot be made.
vsc_status vsc_stress_write(const vsc_stress_case *at, const char *folder, vsc_error *error);

#endif
