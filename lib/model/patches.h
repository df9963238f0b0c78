// SPDX-License-Identifier: GPL-3.0-or-later
// Cutting the mesh into patches. Internal to the model room.
#ifndef VSC_MODEL_PATCHES_H
#define VSC_MODEL_PATCHES_H

#include "mesh/axes.h"
#include "mesh/mesh.h"
#include "model/model.h"
#include "model/parts.h"

// Orders the parts by group and along a space-filling curve, cuts them into patches, numbers the
// nodes, and fills the "order" and "elements" fields of the model but for amplitude, delay and
// mixtures. `axes` may be NULL. VSC_INPUT for a hexahedron in which law PAPER finds no axis.
vsc_status vsc_patches_build(const vsc_mesh *mesh, const vsc_axes *axes, const vsc_parts *parts,
                             vsc_model *model, vsc_error *error);

// The parts of a patch in their order: where they come from and, one after the other, their nodes in the mesh.
typedef struct vsc_patch_parts {
  size_t count;
  const uint32_t *source;   // count: as in vsc_parts
  const uint32_t *nodes;    // count x vsc_family_corners
  const vsc_sheet *sheets;  // as in vsc_parts
} vsc_patch_parts;

// Fills the packs of a patch (in the model's store) from its parts; `local` maps nodes of the mesh to
// numbers within the patch. Errors as above.
vsc_status vsc_patch_fill(const vsc_mesh *mesh, const vsc_axes *axes, const vsc_patch_parts *parts,
                          const uint32_t *local, const vsc_patch *patch, vsc_model *model, vsc_error *error);

#endif
