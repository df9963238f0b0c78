// SPDX-License-Identifier: GPL-3.0-or-later
// The kinds of elements: corners, faces, edges, shape functions and the points at which they are
// integrated. Corners are numbered so that the reference element is right-handed, which is VTK's
// way but for wedges (vtk.h): a hexahedron has 0 1 2 3 round the bottom and 4 5 6 7 above them, a
// wedge 0 1 2 below 3 4 5, a pyramid 0 1 2 3 round the bottom and 4 on top. A quadratic tetrahedron
// has the corners of a tetrahedron and then a node in the middle of each edge, in the order of its
// edges: 01 12 02 03 13 23.
#ifndef VSC_MESH_CELL_H
#define VSC_MESH_CELL_H

typedef enum vsc_cell {
  VSC_TET,
  VSC_HEX,
  VSC_WEDGE,
  VSC_PYRAMID,
  VSC_TET10,  // quadratic tetrahedron
  VSC_CELLS,  // how many kinds there are
} vsc_cell;

enum { VSC_MOST_CORNERS = 10, VSC_MOST_FACES = 6, VSC_MOST_EDGES = 12, VSC_MOST_POINTS = 8 };

typedef struct vsc_cell_kind {
  const char *name;    // "tetrahedron"
  const char *plural;  // "tetrahedra"
  int corners, face_count, edge_count;  // corners: all its nodes
  int vertices;                  // of them the first that lie at corners; the others lie in the middle
                                 // of the edges, in their order
  int faces[VSC_MOST_FACES][4];  // vertices, counter-clockwise from outside; 3 of them: the last is -1
  int edges[VSC_MOST_EDGES][2];  // vertices
} vsc_cell_kind;

extern const vsc_cell_kind vsc_cells[VSC_CELLS];

// The node in the middle of the edge between vertices a and b; -1 where there is none.
int vsc_cell_middle(const vsc_cell_kind *kind, int a, int b);

// A quadrature rule and the shape functions at its points. The coordinates xi are the cell's own:
// (xi_1, xi_2, xi_3) in the reference element. The rules integrate the gradients of the shape
// functions over any cell with straight edges exactly (tet 1 point, hex 2 x 2 x 2, wedge 3 x 2,
// pyramid 2 x 2 x 2 collapsed), so that a constant stress is in equilibrium across cells of
// different kinds. The quadratic tet's four points (Hammer & Stroud 1956, degree 2) do so with
// straight edges; where edges are curved its gradients are of degree 4 and the rule leaves a
// remainder of higher order in the size of the cell.
typedef struct vsc_cell_rule {
  int points;
  double weight[VSC_MOST_POINTS];  // sums to the volume that xi runs through
  double N[VSC_MOST_POINTS][VSC_MOST_CORNERS];      // shape functions
  double D[VSC_MOST_POINTS][3][VSC_MOST_CORNERS];   // d N_i / d xi_k
} vsc_cell_rule;

// The rule of a kind. Never fails.
vsc_cell_rule vsc_cell_rule_of(vsc_cell kind);

// N_i and D[k][i] = d N_i / d xi_k of a kind at `xi`: tet and wedge in [0, 1] with
// xi_1 + xi_2 (+ xi_3) <= 1, wedge's xi_3 in [-1, 1]; hex in [-1, 1]^3; pyramid xi_1, xi_2 in
// [-1, 1], xi_3 in [0, 1], collapsed: N_4 = xi_3, the others bilinear times (1 - xi_3). Quadratic tet:
// L_i (2 L_i - 1) at corners and 4 L_i L_j between them, of the tet's shape functions L.
void vsc_cell_shape(vsc_cell kind, const double xi[3], double N[VSC_MOST_CORNERS],
                    double D[3][VSC_MOST_CORNERS]);

#endif
