// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that can be computed once: immutable after vsc_model_build. Mesh nodes and tets are
// renumbered for locality; "node" below is an internal number, "slot" an element's internal place.
#ifndef VSC_MODEL_MODEL_H
#define VSC_MODEL_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "mesh/axes.h"
#include "mesh/mesh.h"
#include "mesh/select.h"
#include "model/curve.h"
#include "model/definition.h"
#include "model/stencil.h"

#define VSC_NO_ELEMENT UINT32_MAX  // what an empty slot holds

// A tissue's numbers, as the force loop needs them.
typedef struct vsc_material {
  char name[VSC_NAME];
  double density;          // mg/mm^3
  double axial[3];         // E_f, E_s, E_n, kPa
  double angular[3];       // G_fs, G_sn, G_nf, kPa
  double damping[3];       // eta_f, eta_s, eta_n, kPa ms
  double volume_modulus;   // K, kPa
  double element_modulus;  // of each tet's own U(J), kPa: K, or Ks beside node-averaged volume
  vsc_active_kind active;
  double active_stiffness;  // kPa
  double rest_stretch;
  double tension;   // kPa
  double delay;     // ms
  vsc_curve curve;  // owned; only when active
  size_t element_count;
  double volume;  // mm^3
} vsc_material;

// A block of elements, neighbours in space and of one material. Its nodes are numbered from 0:
// first the nodes that no other patch has (consecutive nodes of the model), then the shared ones.
typedef struct vsc_patch {
  uint32_t material;
  uint32_t first_pack, pack_count;
  uint32_t first_node, own_count;  // own nodes: first_node ... first_node + own_count - 1
  // shared nodes: shared[first_shared ...]; the patch's part of their sums lies at the same places
  // of the partial arrays
  uint32_t first_shared, shared_count;
} vsc_patch;

// A surface under pressure.
typedef struct vsc_pressure {
  char surface[VSC_NAME];
  size_t triangle_count;
  uint32_t *triangles;  // triangle_count x 3 nodes, normal out of the tissue; owned
  double peak;          // kPa
  vsc_curve curve;      // owned
} vsc_pressure;

// Which force terms this scene has; what is absent is not in the loop.
typedef struct vsc_terms {
  bool damping;
  vsc_active_kind active;  // NONE when no element is ever active; kinds may not be mixed
  bool nodal_volume;
  bool gravity;
} vsc_terms;

typedef struct vsc_model {
  size_t node_count, element_count;
  size_t pack_count, patch_count;

  // order
  uint32_t *mesh_node;  // node_count: the mesh's node of each node
  uint32_t *mesh_element;   // pack_count x 4: the mesh's tet of each slot, or VSC_NO_ELEMENT

  // elements
  vsc_pack *packs;        // pack_count
  vsc_patch *patches;     // patch_count
  uint32_t *shared;       // nodes of the patches' shared parts, partial_count in all
  size_t own_node_count;  // nodes [0, own_node_count) belong to one patch each
  uint32_t *sum_start;    // shared nodes + 1: where a shared node's list starts in sum_place
  uint32_t *sum_place;  // partial_count: places in the partial arrays, in the order of the patches
  size_t partial_count;
  size_t most_nodes;  // of any patch
  size_t most_packs;  // of any patch
  uint8_t *known;     // pack_count x 4: 1 where the fibre is known
  double *amplitude;  // pack_count x 4: factor of the activation; NULL: 1 everywhere
  double *delay;      // pack_count x 4: ms, added to the material's; NULL: 0 everywhere

  // nodes
  double *rest;          // node_count x 4: rest position, mm; fourth 0
  double *mass;          // node_count: lumped, mg
  double *inverse_mass;  // node_count x 4: 1/mass, 0 in held directions and in the fourth
  double *weight;        // node_count x 4: mass . gravity, mN; NULL without gravity

  // volume groups of the nodes, when terms.nodal_volume
  double *group_volume;   // node_count: a quarter of the tets' rest volume round the node, mm^3
  double *group_modulus;  // node_count: their volume-weighted K, kPa

  vsc_terms terms;
  size_t material_count;
  vsc_material *materials;
  size_t pressure_count;
  vsc_pressure *pressures;
  double gravity[3];     // mm/ms^2
  size_t surface_count;  // the named surfaces, with the mesh's node numbers
  vsc_surface *surfaces;
  size_t set_count;
  vsc_node_set *sets;  // the named node sets, with the mesh's node numbers
  size_t held_count;   // nodes held in at least one direction
  double end_time;     // ms
  double step;         // ms asked for by the user, or 0
  double safety;
  double total_mass;    // mg
  double total_volume;  // mm^3
  uint64_t hash;        // of everything above: two models with equal hashes move alike
} vsc_model;

// Builds the model of `definition` on `mesh` with the elements' `axes` (NULL: none are known, all
// elements are passive with global axes). Nothing is kept of the arguments. VSC_INPUT for what
// does not fit together: a region without material, a missing array, an empty set, a surface
// that is not there, an active material without fibres, axes that are not
// orthonormal. The caller owns *model.
vsc_status vsc_model_build(const vsc_mesh *mesh, const vsc_axes *axes,
                           const vsc_definition *definition, vsc_model **model, vsc_error *error);

void vsc_model_free(vsc_model *model);  // NULL is fine

// The model's number of node `local` of a patch.
static inline uint32_t vsc_node_of(const vsc_model *model, const vsc_patch *patch, uint32_t local)
{
  return local < patch->own_count ? patch->first_node + local
                                  : model->shared[patch->first_shared + local - patch->own_count];
}

// The model's number of each node of the mesh (node_count), owned by the caller; NULL when memory
// is short.
uint32_t *vsc_model_node_numbers(const vsc_model *model);

// The number of the named surface, or -1.
int vsc_model_find_surface(const vsc_model *model, const char *name);

// Pressure of load `p` at `time`, kPa.
double vsc_model_pressure(const vsc_model *model, size_t p, double time);

// Activation of slot `slot` of `material` at `time`: amplitude . curve(time - delay).
double vsc_model_activation(const vsc_model *model, const vsc_material *material, size_t slot,
                            double time);

#endif
