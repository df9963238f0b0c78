// SPDX-License-Identifier: GPL-3.0-or-later
// The material axes of each element at rest: fibre f, sheet s, sheet normal n, right-handed and
// orthonormal. Axes have no sign: f and -f are the same fibre. Linear elements have one frame, quadratic
// tets one at each of the points where they are integrated (mesh/cell.h), where axes may differ.
#ifndef VSC_MESH_AXES_H
#define VSC_MESH_AXES_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "mesh/mesh.h"

typedef struct vsc_axes {
  size_t count;    // elements
  int points;      // frames of each element
  double *frames;  // count x points x 3 x 3: rows f, s, n
  uint8_t *known;  // count: 1 where the fibre is known; 0 where there is none: such an element is
                   // passive and its frame is the global axes
} vsc_axes;

// Axes of `count` elements with one frame each: global axes, all unknown. NULL when memory is short.
vsc_axes *vsc_axes_create(size_t count);

// The same for the elements of a mesh: one frame each, or four of quadratic tets.
vsc_axes *vsc_axes_create_for(const vsc_mesh *mesh);

void vsc_axes_free(vsc_axes *axes);  // NULL is fine

// Frame `point` (9 numbers, rows f, s, n) of an element; the only one where there is one.
static inline double *vsc_axes_frame(const vsc_axes *axes, size_t element, int point)
{
  const size_t points = (size_t)axes->points;
  return axes->frames + 9 * (points * element + (points > 1 ? (size_t)point : 0));
}

// Where frame `point` of an element of the mesh lies, mm: at the mean of its vertices, or at that point of
// `rule`, the rule of its kind, where it has several.
void vsc_axes_place(const vsc_axes *axes, const vsc_mesh *mesh, const vsc_cell_rule *rule,
                    size_t element, int point, double at[3]);

// Makes all frames of an element the one completed from a fibre and a hint (vsc_axes_complete), and the
// element known. Returns 0, leaving it alone, when the fibre is none; else 1.
int vsc_axes_set(vsc_axes *axes, size_t element, const double fiber[3], const double *sheet);

// Ends the making of an element's frames one by one: it is `known`, or not and its frames the global axes.
void vsc_axes_finish(vsc_axes *axes, size_t element, int known);

// Completes a frame (rows f, s, n) from a fibre direction and a hint for the sheet, neither of unit
// length. Rule: f is normalised; s is the part of the hint orthogonal to f; when the hint is NULL,
// zero or within 1 degree of f, the hint is the global axis (x, y or z, the first in case of a tie)
// with the smallest |component| of f; n = f x s. Returns 0, leaving the frame alone, when f is
// zero (shorter than 1e-6) or not finite; else 1.
int vsc_axes_complete(const double fiber[3], const double *sheet, double frame[9]);

// Axes at rest, of the same size as `axes`, that the motion from `rest` (node_count x 3, mm) to the mesh's nodes
// carries to `axes`: with its gradient F (of elements of one frame its mean over the points of their rule)
//   f_0 along F^-1 f, s_0 in the plane of F^-1 f and F^-1 s, n_0 = f_0 x s_0,
// since what is drawn on the tissue moves by F. Elements whose fibre is not known keep their frame.
void vsc_axes_carry_back(const vsc_axes *axes, const vsc_mesh *mesh, const double *rest, vsc_axes *back);

// True when each frame is orthonormal and right-handed to 1e-9.
int vsc_axes_valid(const vsc_axes *axes);

// sum += factor v v^T, as xx, xy, xz, yy, yz, zz.
void vsc_add_square(const double v[3], double factor, double sum[6]);

// The unit eigenvector `axis` of the largest eigenvalue of a symmetric matrix (xx, xy, xz, yy, yz,
// zz) by GSL; `values` (may be NULL) takes the eigenvalues, largest first. Returns 0 when the
// matrix is not finite or zero; else 1.
int vsc_top_axis(const double matrix[6], double axis[3], double values[3]);

#endif
