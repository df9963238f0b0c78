// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that can be computed once: immutable after vsc_model_build. Mesh nodes and elements are
// renumbered for locality; "node" below is an internal number, "slot" an element's internal place.
#ifndef VSC_MODEL_MODEL_H
#define VSC_MODEL_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "base/wide.h"
#include "mesh/axes.h"
#include "mesh/face.h"
#include "mesh/facets.h"
#include "mesh/mesh.h"
#include "mesh/select.h"
#include "model/curve.h"
#include "model/definition.h"
#include "model/law_bending.h"
#include "model/law_membrane.h"
#include "model/scaled_mass.h"
#include "model/smoothing.h"
#include "model/stencil.h"

#define VSC_NO_ELEMENT UINT32_MAX  // what an empty slot holds

// What a patch is made of. The first are the kinds of cells (mesh/cell.h).
typedef enum vsc_family {
  VSC_TETS = VSC_TET,
  VSC_HEXES = VSC_HEX,
  VSC_WEDGES = VSC_WEDGE,
  VSC_PYRAMIDS = VSC_PYRAMID,
  VSC_TETS10 = VSC_TET10,
  VSC_SPRINGS_ON_EDGES = VSC_CELLS,  // classical springs
  VSC_TRIANGLES,                     // of membranes
  VSC_BENDS,                         // a membrane's triangles with their neighbours
  VSC_FAMILIES,
} vsc_family;

// Four triangles of a membrane: g_a = sum_k T_ak (x_k - x_0). Empty places have T = 0 and V = 0.
typedef struct vsc_triangle_pack {
  vsc_four T[2][2];  // 1/mm
  vsc_four V;        // thickness times area at rest, mm^3
  uint16_t node[3][VSC_WIDTH];
} vsc_triangle_pack;

// Four bends (model/law_bending.h). Empty places have G = 0.
typedef struct vsc_bend_pack {
  vsc_bends bends;
  uint16_t node[VSC_BEND_NODES][VSC_WIDTH];
} vsc_bend_pack;

// A sheet's numbers, as the force loop needs them.
typedef struct vsc_membrane {
  char name[VSC_NAME];
  double thickness;         // mm
  double density;           // mg/mm^3
  vsc_sheet_moduli moduli;  // kPa
  double damping[2];        // eta_a, eta_b, kPa ms
  double bending;           // D, uJ
  double lag;               // tau = (eta_a + eta_b)/(E_a + E_b) of bending's damping, ms
  size_t triangle_count;
  double area;  // mm^2
} vsc_membrane;

// Four classical springs: force on the first node -[k (l - r) + k_d dl/dt] u, u from the second to
// the first.
typedef struct vsc_edge_pack {
  vsc_four length;  // r at rest, mm
  uint16_t node[2][VSC_WIDTH];
} vsc_edge_pack;

// What law PAPER needs of four tets beside their frames.
typedef struct vsc_chords {
  vsc_four r[3];    // lengths of the axes between the faces at rest, mm
  vsc_four radius;  // sum of the corners' distances from the barycentre at rest, mm
} vsc_chords;

// Four hexahedra under law PAPER: axis l_a = sum_i w_ai x_i between two faces.
typedef struct vsc_hex_axes {
  vsc_four w[3][8];
  vsc_four r[3];       // |l_a| at rest, mm; the axes are at right angles then
  vsc_four radius[8];  // distances of the corners from the barycentre at rest, mm
  vsc_four volume;     // mm^3; for moduli per volume
} vsc_hex_axes;

// Moduli of elements: their material's, or what inclusions make of them. The store holds those of four.
typedef struct vsc_mixture {
  vsc_wide axial[3], angular[3], coupling[3], damping[3];
  vsc_wide viscosity;
  vsc_wide volume_modulus, stabilization, element_modulus;
  vsc_wide share;  // of the element's own material: what its further axes and its activity are
                   // multiplied by
} vsc_mixture;

// A further axis of a material; direction of unit length in f, s, n.
typedef struct vsc_axis {
  double direction[3], modulus, damping;
} vsc_axis;

// An angular spring between two axes, directions as above.
typedef struct vsc_pair {
  double first[3], second[3];
  double cosine;  // at rest
  double modulus;
} vsc_pair;

// A tissue's numbers, as the force loop needs them.
typedef struct vsc_material {
  char name[VSC_NAME];
  double density;          // mg/mm^3
  double axial[3];         // E_f, E_s, E_n, kPa
  double angular[3];       // G_fs, G_sn, G_nf, kPa
  double coupling[3];      // H_fs, H_sn, H_nf, kPa
  double damping[3];       // eta_f, eta_s, eta_n, kPa ms
  double viscosity;        // eta of S = eta dE/dt, kPa ms
  bool damped;             // whether anything in it resists velocity, whatever its law
  double volume_modulus;   // K, kPa; of the shared volume where there is one
  double stabilization;    // Ks, kPa: of each frame's own U(J) beside the shared volume of its nodes
                           // or its element; 0 when all elements are tets and alone
  double element_modulus;  // of a tet's own U(J), kPa: Ks beside node-averaged volume, else K + Ks, so
                           // that tets and other kinds have one bulk modulus
  vsc_active_kind active;
  double active_stiffness;  // kPa
  double rest_stretch;
  double tension;   // kPa
  double length_factor;     // beta
  double tension_parts[2];  // k_s, k_n
  double delay;     // ms
  vsc_curve curve;  // owned; only when active
  size_t element_count;
  double volume;  // mm^3
  vsc_law law;
  bool general;             // needs the kernel of any law: what the springs' own kernels lack
  bool isochoric;
  vsc_fibre_switch compression;  // law HOLZAPFEL_OGDEN
  double rest_shear;        // m of -m ln J, kPa: of each frame's own volume, beside its U(J)
  vsc_paper_def paper;
  vsc_classical_def classical;
  double shear;             // law NEO_HOOKEAN, kPa
  vsc_fung_def fung;        // laws FUNG and GUCCIONE
  vsc_holzapfel_ogden_def holzapfel_ogden;
  vsc_invariants_def invariants;  // laws MOONEY_RIVLIN and VERONDA_WESTMANN
  size_t first_axis, axis_count;  // in the model's axes
  size_t first_pair, pair_count;  // in the model's pairs
  size_t branch_count;            // of its Prony series
  vsc_prony_def branches[VSC_MOST_BRANCHES];
} vsc_material;

// A block of elements, neighbours in space, of one family and one material. Its nodes are numbered from 0: first the
// nodes that no other patch has (consecutive nodes of the model), then the shared ones.
typedef struct vsc_patch {
  uint32_t family;    // a vsc_family
  uint32_t material;  // of a membrane's triangles and bends: the membrane
  uint32_t first_pack, pack_count;  // packs are counted through all patches
  uint32_t first_frame;             // so are frames, where the family has some
  uint32_t first_node, own_count;   // own nodes: first_node ... first_node + own_count - 1
  // shared nodes: shared[first_shared ...]; the patch's part of their sums lies at the same places
  // of the partial arrays
  uint32_t first_shared, shared_count;
  uint32_t mixed;    // 1: its elements hold inclusions
  uint32_t still;    // 1: none of its nodes can ever move, so that it is not evaluated
  size_t packs;      // where its packs begin in the model's store, bytes
  size_t law_data;   // law PAPER: vsc_chords or vsc_hex_axes of each pack; 0: none
  size_t mixtures;   // mixed: vsc_mixture of each pack; 0: none
  size_t smoothed;   // smoothed tets: vsc_smoothed_pack of each pack; 0: its elements are not smoothed
} vsc_patch;

// A surface under pressure.
typedef struct vsc_pressure {
  char surface[VSC_NAME];
  vsc_facets facets;    // normal out of the tissue; owned
  vsc_face_rule rule;   // of its facets, for fluxes
  double peak;          // kPa
  double direction[3];  // of a dead traction, unit; 0 0 0: pressure along the moving normal
  vsc_curve curve;      // owned
} vsc_pressure;

// A surface on springs and dashpots: the traction -(stiffness u + damping v) per area at rest, u and v
// from the place at rest, either all of them or what is along the normal N at rest. Its forces are
//   f_i = - sum_j W_ij (stiffness u_j + damping v_j),   W_ij = int N_i N_j (1, or N N^T) dA;
// the blocks of node i's row stand one after the other, columns ascending.
typedef struct vsc_robin {
  char surface[VSC_NAME];
  double stiffness;    // kPa/mm
  double damping;      // kPa ms/mm
  bool normal;
  double area;         // mm^2
  size_t node_count;   // rows
  uint32_t *nodes;     // node_count, ascending: the row's node; owned
  uint32_t *start;     // node_count + 1: where a row starts; owned
  uint32_t *columns;   // start[node_count] rows of other nodes (and the own one); owned
  double *blocks;      // start[node_count] x 12, mm^2: three columns of four, the fourth 0; owned
} vsc_robin;

// Nodes that a support moves: in direction i they are at rest + motion_i . curve(t).
typedef struct vsc_moved {
  char set[VSC_NAME];
  int held[3];        // directions that the support holds; in others motion is 0
  double motion[3];   // mm
  vsc_curve curve;    // owned
  size_t node_count;
  uint32_t *nodes;    // owned
  double mass;        // of the nodes, mg
} vsc_moved;

// A rigid thing that nodes may not enter; it moves by motion . curve(t).
typedef struct vsc_obstacle {
  vsc_obstacle_kind kind;
  double point[3];   // of the plane, or the sphere's centre, at curve value 0, mm
  double normal[3];  // PLANE: unit vector towards the free side
  double radius;     // SPHERE, mm
  double friction;
  double motion[3];   // mm
  vsc_curve curve;    // owned
  size_t node_count;  // nodes that it stops
  uint32_t *nodes;    // owned
} vsc_obstacle;

// Volumes that multipliers keep: volume k is the flux through triangles start[k] .. start[k + 1] - 1,
//   v_k = sum_t weight_t (a x b) . c / 6 of their corners a, b, c.
typedef struct vsc_kept_volumes {
  vsc_kept_volume kind;
  size_t count;               // 0: none are kept
  size_t *start;              // count + 1; owned
  uint32_t *triangles;        // x 3 nodes; owned
  double *weights;            // 1, or parts of it; owned
  double *rest;               // V_k, mm^3; owned
  uint32_t *source;           // REGION: the material; NODE, ELEMENT: the mesh's number; owned
} vsc_kept_volumes;

// Which force terms this scene has; what is absent is not in the loop.
typedef struct vsc_terms {
  bool damping;
  bool paper;  // some forces are no gradient of an energy
  bool general;  // some springs have couplings or viscosity, which inclusions may carry elsewhere
  vsc_active_kind active;  // NONE when no element is ever active; kinds may not be mixed
  bool nodal_volume;
  bool smoothed;  // linear tets are
  bool gravity;
} vsc_terms;

typedef struct vsc_model {
  size_t node_count, element_count, pack_count, patch_count;

  // order
  uint32_t *mesh_node;  // node_count: the mesh's node of each node
  uint32_t *mesh_element;  // pack_count x 4: the mesh's element of each slot, or VSC_NO_ELEMENT (also
                           // for springs, triangles and bends)
  uint32_t *node_source, *element_source;  // the mesh's, where they differ from its own numbers; else NULL

  // elements
  unsigned char *store;   // store_size bytes: packs and law data of all patches
  size_t store_size;
  size_t frame_count;     // packs x frames of their family
  vsc_patch *patches;     // patch_count
  vsc_cell_rule rules[VSC_CELLS];  // D of each kind of cell
  uint32_t *shared;       // nodes of the patches' shared parts, partial_count in all
  size_t own_node_count;  // nodes [0, own_node_count) belong to one patch each
  uint32_t *sum_start;    // shared nodes + 1: where a shared node's list starts in sum_place
  uint32_t *sum_place;  // partial_count: places in the partial arrays, in the order of the patches
  size_t partial_count;
  size_t most_nodes, most_packs;  // of any patch
  size_t still_first, still_count;  // own nodes of patches that are still: these from the first on
  double element_size;  // mean distance of the first two nodes of all parts, mm
  uint8_t *known;     // pack_count x 4: 1 where the fibre is known
  double *amplitude;  // pack_count x 4: factor of the activation; NULL: 1 everywhere
  double *delay;      // pack_count x 4: ms, added to the material's; NULL: 0 everywhere

  // frames of the edges of smoothed tets
  vsc_smoothing smoothing;

  // nodes
  double *rest;          // node_count x 4: rest position, mm; fourth 0
  double *mass;          // node_count: lumped, mg
  double *inverse_mass;  // node_count x 4: 1/mass, 0 in held directions and in the fourth
  double *weight;        // node_count x 4: mass . gravity, mN; of quadratic tets in equilibrium or with
                         // consistent masses int rho N_i gravity dV by the points of their frames; NULL
                         // without gravity

  // volume groups of the nodes, when terms.nodal_volume
  double *group_volume;   // node_count: a quarter of the tets' rest volume round the node, mm^3; 1
                          // where there are none, with modulus 0
  double *group_modulus;  // node_count: 1/K is the volume-weighted mean of theirs, kPa

  vsc_terms terms;
  size_t material_count;
  vsc_material *materials;
  size_t membrane_count;
  vsc_membrane *membranes;
  size_t axis_count;
  vsc_axis *axes;  // further axes of all materials
  size_t pair_count;
  vsc_pair *pairs;
  size_t branch_count;  // most branches of any material's Prony series
  size_t pressure_count;
  vsc_pressure *pressures;
  size_t robin_count;
  vsc_robin *robins;
  size_t moved_count;
  vsc_moved *moved;
  size_t obstacle_count;
  vsc_obstacle *obstacles;
  vsc_kept_volumes kept;
  double gravity[3];     // mm/ms^2
  double *velocity;      // node_count x 4: at the start, 0 in held directions, mm/ms; NULL: at rest
  size_t stopped_count;  // nodes whose initial velocity a support has taken away, wholly or in part
  size_t surface_count;  // the named surfaces, with the mesh's node numbers
  vsc_surface *surfaces;
  size_t set_count;
  vsc_node_set *sets;  // the named node sets, with the mesh's node numbers
  size_t held_count;   // nodes held in at least one direction
  double end_time;     // ms
  double step;         // ms asked for by the user, or 0
  bool force_step;     // taken even above the stable step
  double safety, cycle, cycle_tolerance;  // as the definition has them
  vsc_solve_def solve;
  vsc_mass_kind masses;
  double total_mass;    // mg, without what mass scaling has added
  vsc_scaled_mass scaled;
  vsc_coupled_mass coupled;
  double total_volume;  // mm^3
  uint64_t hash;        // of what moves it: two models with equal hashes move alike
} vsc_model;

// Builds the model of `definition` on `mesh` with the elements' `axes` (NULL: none are known, all elements are
// passive with global axes; one frame for all points of an element will do). Nothing is kept of the arguments.
// VSC_INPUT for what does not fit together: a region without material, a missing array, an empty set, a surface that
// is not there, an active material without fibres, axes that are not orthonormal. The caller owns *model.
vsc_status vsc_model_build(const vsc_mesh *mesh, const vsc_axes *axes, const vsc_definition *definition,
                           vsc_model **model, vsc_error *error);

// The same where `mesh` is the body at rest, and surfaces and node sets are meant of `shown`: the same mesh with its
// nodes elsewhere.
vsc_status vsc_model_build_shown(const vsc_mesh *mesh, const vsc_mesh *shown, const vsc_axes *axes,
                                 const vsc_definition *definition, vsc_model **model, vsc_error *error);

void vsc_model_free(vsc_model *model);  // NULL is fine

// Frames and corners of a family; 0 frames: the family has none.
static inline int vsc_family_frames(const vsc_model *model, uint32_t family)
{
  return family < VSC_CELLS ? model->rules[family].points : 0;
}

static inline int vsc_family_corners(uint32_t family)
{
  if (family == VSC_SPRINGS_ON_EDGES) return 2;
  if (family == VSC_TRIANGLES) return 3;
  if (family == VSC_BENDS) return VSC_BEND_NODES;
  return vsc_cells[family].corners;
}

// Bytes of one pack of a family, and where among them its nodes begin.
static inline size_t vsc_pack_size(const vsc_model *model, uint32_t family)
{
  if (family == VSC_SPRINGS_ON_EDGES) return sizeof(vsc_edge_pack);
  if (family == VSC_TRIANGLES) return sizeof(vsc_triangle_pack);
  if (family == VSC_BENDS) return sizeof(vsc_bend_pack);
  return vsc_pack_bytes(vsc_family_corners(family), vsc_family_frames(model, family));
}

static inline size_t vsc_nodes_offset(const vsc_model *model, uint32_t family)
{
  if (family == VSC_SPRINGS_ON_EDGES) return offsetof(vsc_edge_pack, node);
  if (family == VSC_TRIANGLES) return offsetof(vsc_triangle_pack, node);
  if (family == VSC_BENDS) return offsetof(vsc_bend_pack, node);
  return (size_t)vsc_family_frames(model, family) * sizeof(vsc_frame);
}

// The tets' kernel reads as a vsc_pack what others read as a frame and its nodes.
_Static_assert(offsetof(vsc_pack, node) == sizeof(vsc_frame), "a tet's pack is a frame and nodes");

// Pack `k` (counted through all patches) of a patch: its frames (of cells only), and its nodes [corner][lane].
static inline const vsc_frame *vsc_pack_frames(const vsc_model *model, const vsc_patch *patch, size_t k)
{
  return (const vsc_frame *)(model->store + patch->packs +
                             (k - patch->first_pack) * vsc_pack_size(model, patch->family));
}

static inline const uint16_t (*vsc_pack_nodes(const vsc_model *model, const vsc_patch *patch, size_t k))[VSC_WIDTH]
{
  return (const uint16_t(*)[VSC_WIDTH])(model->store + patch->packs +
                                        (k - patch->first_pack) *
                                            vsc_pack_size(model, patch->family) +
                                        vsc_nodes_offset(model, patch->family));
}

static inline const vsc_triangle_pack *vsc_triangles_of(const vsc_model *model, const vsc_patch *patch)
{
  return (const vsc_triangle_pack *)(model->store + patch->packs);
}

static inline const vsc_bend_pack *vsc_bends_of(const vsc_model *model, const vsc_patch *patch)
{
  return (const vsc_bend_pack *)(model->store + patch->packs);
}

// The moduli of a pack of a material: its own, or those of `mixture` where that is not NULL.
VSC_INLINE vsc_mixture vsc_moduli_or(const vsc_material *material, const vsc_mixture *mixture)
{
  if (mixture != NULL) return *mixture;
  vsc_mixture m = {.share = vsc_splat(1)};
  for (int a = 0; a < 3; a++) {
    m.axial[a] = vsc_splat(material->axial[a]);
    m.angular[a] = vsc_splat(material->angular[a]);
    m.coupling[a] = vsc_splat(material->coupling[a]);
    m.damping[a] = vsc_splat(material->damping[a]);
  }
  m.viscosity = vsc_splat(material->viscosity);
  m.volume_modulus = vsc_splat(material->volume_modulus);
  m.stabilization = vsc_splat(material->stabilization);
  m.element_modulus = vsc_splat(material->element_modulus);
  return m;
}

// Law data and mixture of a pack; only where the patch has them.
static inline const void *vsc_pack_law_data(const vsc_model *model, const vsc_patch *patch, size_t k)
{
  const size_t bytes = patch->family == VSC_TETS ? sizeof(vsc_chords) : sizeof(vsc_hex_axes);
  return model->store + patch->law_data + (k - patch->first_pack) * bytes;
}

static inline const vsc_mixture *vsc_pack_mixture(const vsc_model *model, const vsc_patch *patch, size_t k)
{
  return (const vsc_mixture *)(model->store + patch->mixtures) + (k - patch->first_pack);
}

// What smoothed tets have; only where the patch is smoothed.
static inline const vsc_smoothed_pack *vsc_pack_smoothed(const vsc_model *model, const vsc_patch *patch, size_t k)
{
  return (const vsc_smoothed_pack *)(model->store + patch->smoothed) + (k - patch->first_pack);
}

static inline bool vsc_patch_is_surface(const vsc_patch *patch)
{
  return patch->family == VSC_TRIANGLES || patch->family == VSC_BENDS;
}

static inline bool vsc_patch_is_solid(const vsc_patch *patch)
{
  return patch->family < VSC_CELLS;
}

// Whether its elements are tets that share their volume with all round a node.
static inline bool vsc_patch_shares_volume(const vsc_model *model, const vsc_patch *patch)
{
  return model->terms.nodal_volume && patch->family == VSC_TETS &&
         vsc_law_is_of_strain(model->materials[patch->material].law);
}

// The model's number of node `local` of a patch.
static inline uint32_t vsc_node_of(const vsc_model *model, const vsc_patch *patch, uint32_t local)
{
  return local < patch->own_count ? patch->first_node + local
                                  : model->shared[patch->first_shared + local - patch->own_count];
}

// The model's number of each node of the mesh (node_count), owned by the caller; NULL when memory is short.
uint32_t *vsc_model_node_numbers(const vsc_model *model);

// The number of the named surface, or -1.
int vsc_model_find_surface(const vsc_model *model, const char *name);

// Pressure of load `p` at `time`, kPa.
double vsc_model_pressure(const vsc_model *model, size_t p, double time);

// Whether any support moves.
bool vsc_supports_move(const vsc_model *model);

// Puts the nodes of moving supports where they are at `time` (ms), in the directions in which they are moved: x
// (node_count x 4, mm) = rest + load . motion . curve(time). `load`: the part of the motion that is taken, 1 but on the
// way to a first equilibrium.
void vsc_supports_place(const vsc_model *model, double time, double load, double *x);

// Kept volume k at positions x (node_count x 4), mm^3.
double vsc_kept_volume_of(const vsc_model *model, size_t k, const double *x);

// The corners of triangle t of kept volume k at positions x, seen from the volume's first node (mm; its surface is closed,
// so that the origin does not count), and, unless NULL, what they add to the gradient of the volume:
// d(w (a x b) . c/6)/da = w (b x c)/6, mm^2.
void vsc_kept_triangle(const vsc_model *model, size_t k, size_t t, const double *x, double at[3][3], double gradient[3][3]);

// Where an obstacle is at `time`: its point or centre, mm.
void vsc_obstacle_place(const vsc_obstacle *obstacle, double time, double point[3]);

// How far `x` is outside an obstacle whose point is at `point` (below 0: inside), mm, and the unit vector out of it.
double vsc_obstacle_gap(const vsc_obstacle *obstacle, const double point[3], const double x[3], double normal[3]);

// Activation of slot `slot` of `material` at `time`: amplitude . curve(time - delay).
double vsc_model_activation(const vsc_model *model, const vsc_material *material, size_t slot, double time);

// The same of an edge frame, with the means of its tets' amplitudes and delays.
double vsc_model_edge_activation(const vsc_model *model, const vsc_material *material, size_t edge, double time);

#endif
