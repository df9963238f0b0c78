// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles drawn into a picture in memory, the nearer over the farther (a depth buffer).
#ifndef VSC_TOOLS_PLOT_RASTER_H
#define VSC_TOOLS_PLOT_RASTER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { VSC_VERTEX_NUMBERS = 10 };

// A corner of a triangle: what is interpolated over its pixels.
typedef struct vsc_vertex {
  double place[3];   // pixels from the left, pixels from the top, depth (larger is farther)
  double normal[3];  // in the same axes as the light
  double rest[3];    // position at rest, mm
  double value;      // what is shown in colour
} vsc_vertex;

_Static_assert(sizeof(vsc_vertex) == VSC_VERTEX_NUMBERS * sizeof(double),
               "interpolated as numbers");

// A pixel that holds nothing has the depth INFINITY and the kind 0.
typedef struct vsc_raster {
  int width, height;
  float *depth;   // width x height
  uint8_t *kind;  // width x height: what was drawn, as the caller numbers it
  float *colour;  // width x height x 3: red, green, blue in [0, 1]
} vsc_raster;

// Says the colour of a pixel from the interpolated vertex.
typedef void (*vsc_shader)(const vsc_vertex *vertex, int kind, const void *context,
                           float colour[3]);

// An empty picture; NULL when memory is short.
vsc_raster *vsc_raster_create(int width, int height);

void vsc_raster_free(vsc_raster *raster);  // NULL is fine

// Draws a triangle where nothing nearer has been drawn; parts outside the picture are cut off.
void vsc_raster_triangle(vsc_raster *raster, const vsc_vertex corners[3], int kind,
                         vsc_shader shader, const void *context);

// Darkens the pixels where the kind or the depth (by more than `step`) jumps: outlines.
void vsc_raster_outline(vsc_raster *raster, float step);

// The picture made smaller `factor` times, as cairo's ARGB32 with premultiplied alpha (holes are
// transparent), into rows of `stride` bytes.
void vsc_raster_shrink(const vsc_raster *raster, int factor, uint8_t *pixels, int stride);

// a + t (b - a), every number of it.
vsc_vertex vsc_vertex_mix(const vsc_vertex *a, const vsc_vertex *b, double t);

#endif
