// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/image.h"

#include "base/mem.h"
#include "base/vec3.h"

vsc_image *vsc_image_create(const size_t size[3])
{
  vsc_image *image;
  if (!VSC_NEW(image, 1)) return NULL;
  for (int axis = 0; axis < 3; axis++) {
    image->size[axis] = size[axis];
    image->spacing[axis] = 1;
    image->direction[4 * axis] = 1;
  }
  return image;
}

void vsc_image_free(vsc_image *image)
{
  if (image == NULL) return;
  vsc_arrays_free(&image->data);
  vsc_arrays_free(&image->cell_data);
  vsc_free(image);
}

void vsc_image_take_cells(vsc_image *image)
{
  double first[3], origin[3];
  for (int axis = 0; axis < 3; axis++) {
    first[axis] = image->size[axis] > 1 ? 0.5 : 0;
    if (image->size[axis] > 1) image->size[axis]--;
  }
  vsc_image_position(image, first, origin);
  for (int axis = 0; axis < 3; axis++) image->origin[axis] = origin[axis];
  vsc_arrays_free(&image->data);
  image->data = image->cell_data;
  image->cell_data = (vsc_arrays){0};
}

void vsc_image_position(const vsc_image *image, const double index[3], double position[3])
{
  const double scaled[3] = {image->spacing[0] * index[0], image->spacing[1] * index[1],
                            image->spacing[2] * index[2]};
  for (int row = 0; row < 3; row++)
    position[row] = image->origin[row] + vsc_dot(image->direction + 3 * row, scaled);
}

// direction^-1 by cross products: the rows of the inverse are c1 x c2, c2 x c0, c0 x c1 over the
// determinant, with c0, c1, c2 the columns.
void vsc_image_index(const vsc_image *image, const double position[3], double index[3])
{
  double columns[3][3], relative[3], row[3];
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) columns[c][r] = image->direction[3 * r + c];
  vsc_subtract(position, image->origin, relative);
  vsc_cross(columns[1], columns[2], row);
  const double determinant = vsc_dot(columns[0], row);
  for (int axis = 0; axis < 3; axis++) {
    vsc_cross(columns[(axis + 1) % 3], columns[(axis + 2) % 3], row);
    index[axis] = vsc_dot(row, relative) / determinant / image->spacing[axis];
  }
}
