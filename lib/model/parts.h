// SPDX-License-Identifier: GPL-3.0-or-later
// Everything of a scene that pulls at nodes, as one list: cells, classical springs on their edges,
// triangles and bends of membranes. Internal to the model room.
#ifndef VSC_MODEL_PARTS_H
#define VSC_MODEL_PARTS_H

#include "mesh/mesh.h"
#include "model/membranes.h"
#include "model/model.h"

// A group is what may share a patch: one family, one material, with or without inclusions, still or not.
typedef struct vsc_parts {
  size_t count;
  uint32_t *group;   // count
  uint32_t *source;  // count: number of the element of the mesh, or of the triangle of its sheet
  const size_t *start;    // count + 1: part k has the nodes[start[k] .. start[k + 1] - 1]
  const uint32_t *nodes;  // of the mesh; both are the mesh's own where all parts are its cells
  size_t *own_start;      // else these
  uint32_t *own_nodes;
  size_t material_count;
  const vsc_sheet *sheets;  // of the model's membranes; borrowed
} vsc_parts;

// Lists the parts of `mesh`, whose element e has the material material_of[e]; mixed[e] is 1 where it
// holds inclusions; still[n] is 1 for nodes that never move; membrane m of the model has sheets[m]. VSC_INPUT for a law
// that does not know the kind of an element. The content of *parts is owned by the caller, to be released also after a
// failure.
vsc_status vsc_parts_list(const vsc_mesh *mesh, const uint32_t *material_of, const uint8_t *mixed,
                          const uint8_t *still, const vsc_sheet *sheets, const vsc_model *model,
                          vsc_parts *parts, vsc_error *error);

void vsc_parts_free(vsc_parts *parts);  // the content

// What a group stands for.
uint32_t vsc_parts_family(const vsc_parts *parts, uint32_t group);
uint32_t vsc_parts_material(const vsc_parts *parts, uint32_t group);
bool vsc_parts_mixed(const vsc_parts *parts, uint32_t group);
bool vsc_parts_still(const vsc_parts *parts, uint32_t group);

#endif
