// SPDX-License-Identifier: GPL-3.0-or-later
// A voxel image: a regular grid of points with named arrays. Lengths in mm.
#ifndef VSC_MESH_IMAGE_H
#define VSC_MESH_IMAGE_H

#include <stddef.h>

#include "mesh/mesh.h"

typedef struct vsc_image {
  size_t size[3];       // points along i, j, k
  double origin[3];     // position of point (0,0,0), mm
  double spacing[3];    // mm, > 0
  double direction[9];  // columns: unit vectors of i, j, k (row-major 3x3); may be left-handed
  vsc_arrays data;      // one tuple per point, i fastest. An image file whose arrays lie on cells
                        // is read as an image whose points are the cell centres
  vsc_arrays cell_data; // of a file with arrays on points and on cells, those on cells: a tuple for each, i fastest
} vsc_image;

// An image of size[0] x size[1] x size[2] points without arrays: origin 0, spacing 1, direction the
// identity; NULL when memory is short.
vsc_image *vsc_image_create(const size_t size[3]);

void vsc_image_free(vsc_image *image);  // NULL is fine

// Makes an image the image of its cell centres, with cell_data as its data; what was on its points is lost. An axis of
// one point stays as it is.
void vsc_image_take_cells(vsc_image *image);

// position = origin + direction . (spacing * index), mm
void vsc_image_position(const vsc_image *image, const double index[3], double position[3]);

// The continuous index (i, j, k) of a position, the inverse of vsc_image_position.
void vsc_image_index(const vsc_image *image, const double position[3], double index[3]);

#endif
