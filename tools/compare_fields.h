// SPDX-License-Identifier: GPL-3.0-or-later
// How far apart the arrays of two results are, on one mesh or on two.
#ifndef VSC_TOOLS_COMPARE_FIELDS_H
#define VSC_TOOLS_COMPARE_FIELDS_H

#include <stdbool.h>

#include "tools/compare_pair.h"

// The differences d = a - b of one array, summed up over all its values and frames.
typedef struct vsc_norms {
  char name[VSC_NAME];
  const char *where;  // "points", "elements" or "triangles"
  double largest;     // max |d|
  double squares;     // sum d^2
  double reference;   // sum b^2
  size_t values;      // n
  size_t left_out;    // places of A that lie too far outside B to have a value there
  double volume;            // sum V over the n values: mm^3 that the place of each stands for; 0 where
                            // there are no elements
  double volume_squares;    // sum V d^2
  double volume_reference;  // sum V b^2
} vsc_norms;

// Zeroed it is empty; vsc_comparison_free.
typedef struct vsc_comparison {
  size_t count, room;
  vsc_norms *arrays;  // room, owned; count used
  char note[512];     // what is not compared, and why
} vsc_comparison;

// Adds the arrays that two files have in common. On the same mesh (and on one of the same counts and
// connectivity, whose positions are compared too) value by value; else the arrays of B, the reference, are
// interpolated at A's nodes, and A's elements take the values of those of B in which their centres
// lie. The latter also where only the nodes are the same. Elements' fibre axes, which have no sign, are
// compared with the sign that is nearer, and so is their helix_angle, modulo 180 degrees. `pair` is made for the
// first files and again only when meshes change. VSC_INPUT for files that cannot be read, and for different
// meshes of which one is a surface.
vsc_status vsc_compare_files(vsc_comparison *all, vsc_pair *pair, const char *file_a,
                             const char *file_b, vsc_error *error);

// Adds the sums of `more` to those of `all`.
vsc_status vsc_comparison_merge(vsc_comparison *all, const vsc_comparison *more, vsc_error *error);

void vsc_comparison_free(vsc_comparison *all);

// sqrt(sum d^2/n) and sqrt(sum d^2/sum b^2), or (by_volume) sqrt(sum V d^2/sum V) and sqrt(sum V d^2/
// sum V b^2), which meshes of other densities leave alone. NAN by volume where there is none; infinite
// where only the reference is zero.
double vsc_norms_rms(const vsc_norms *n, bool by_volume);
double vsc_norms_relative(const vsc_norms *n, bool by_volume);

#endif
