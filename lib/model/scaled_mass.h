// SPDX-License-Identifier: GPL-3.0-or-later
// What explicit steps of a wanted length have cost in mass.
#ifndef VSC_MODEL_SCALED_MASS_H
#define VSC_MODEL_SCALED_MASS_H

#include <stddef.h>
#include <stdint.h>

// What mass scaling has done (solve/mass_scaling.h); all 0 without it.
typedef struct vsc_scaled_mass {
  double step;   // that is stable now, at rest and at full activation, ms
  double added;  // mg
  double most;   // at one node, as a part of its own mass
  size_t nodes;  // that have more than their own
} vsc_scaled_mass;

// A pass over the nodes (mech/coupled_mass.h): e_next = now e - image M^-1 L e - last e_last + source a.
typedef struct vsc_spread_pass {
  double now, image, last, source;
} vsc_spread_pass;

// The inertia of neighbours against one another that selective mass scaling adds (mech/coupled_mass.h).
typedef struct vsc_coupled_mass {
  int degree;             // passes over the nodes in each step; 0: masses are lumped
  double step;            // that is stable now, at rest and at full activation, ms
  double largest;         // what eigenvalues of M^-1 L are taken to be below, 1/ms^2
  uint32_t *start;        // node_count + 1: where a row of L starts; owned
  uint32_t *columns;      // start[node_count]: nodes, ascending in each row; owned
  double *entries;        // start[node_count]: of L, mN/mm, rows filled up to a multiple of four with zeros at the own
                          // node; owned
  vsc_spread_pass *passes;  // degree; owned
} vsc_coupled_mass;

void vsc_coupled_mass_free(vsc_coupled_mass *mass);  // the content

#endif
