// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/raster.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"

vsc_raster *vsc_raster_create(int width, int height)
{
  const size_t pixels = (size_t)width * (size_t)height;
  vsc_raster *raster;
  if (!VSC_NEW(raster, 1)) return NULL;
  raster->width = width;
  raster->height = height;
  if (!VSC_NEW(raster->depth, pixels) || !VSC_NEW(raster->kind, pixels) ||
      !VSC_NEW(raster->colour, 3 * pixels)) {
    vsc_raster_free(raster);
    return NULL;
  }
  for (size_t p = 0; p < pixels; p++) raster->depth[p] = INFINITY;
  return raster;
}

void vsc_raster_free(vsc_raster *raster)
{
  if (raster == NULL) return;
  vsc_free(raster->depth);
  vsc_free(raster->kind);
  vsc_free(raster->colour);
  vsc_free(raster);
}

vsc_vertex vsc_vertex_mix(const vsc_vertex *a, const vsc_vertex *b, double t)
{
  double x[VSC_VERTEX_NUMBERS], y[VSC_VERTEX_NUMBERS];
  vsc_vertex mixed;
  memcpy(x, a, sizeof x);
  memcpy(y, b, sizeof y);
  for (int i = 0; i < VSC_VERTEX_NUMBERS; i++) x[i] += t * (y[i] - x[i]);
  memcpy(&mixed, x, sizeof mixed);
  return mixed;
}

// Twice the signed area of the triangle a, b, (x, y).
static double edge(const double a[3], const double b[3], double x, double y)
{
  return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

static int between(double value, int low, int high)
{
  return value < low ? low : value > high ? high : (int)value;
}

void vsc_raster_triangle(vsc_raster *raster, const vsc_vertex corners[3], int kind,
                         vsc_shader shader, const void *context)
{
  const double *a = corners[0].place, *b = corners[1].place, *c = corners[2].place;
  const double area = edge(a, b, c[0], c[1]);
  if (area == 0 || !isfinite(area)) return;
  const int left = between(floor(fmin(a[0], fmin(b[0], c[0]))), 0, raster->width);
  const int right = between(ceil(fmax(a[0], fmax(b[0], c[0]))), 0, raster->width);
  const int top = between(floor(fmin(a[1], fmin(b[1], c[1]))), 0, raster->height);
  const int bottom = between(ceil(fmax(a[1], fmax(b[1], c[1]))), 0, raster->height);
  for (int row = top; row < bottom; row++) {
    for (int column = left; column < right; column++) {
      const double x = column + 0.5, y = row + 0.5;
      const double u = edge(c, a, x, y) / area, v = edge(a, b, x, y) / area;
      if (u < 0 || v < 0 || u + v > 1) continue;
      const size_t pixel = (size_t)row * (size_t)raster->width + (size_t)column;
      const float depth = (float)(a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]));
      if (depth >= raster->depth[pixel]) continue;
      raster->depth[pixel] = depth;
      raster->kind[pixel] = (uint8_t)kind;
      const vsc_vertex ab = vsc_vertex_mix(&corners[0], &corners[1], u / fmax(1 - v, 1e-12));
      const vsc_vertex here = vsc_vertex_mix(&ab, &corners[2], v);
      shader(&here, kind, context, raster->colour + 3 * pixel);
    }
  }
}

static bool jumps(const vsc_raster *raster, size_t p, size_t q, float step)
{
  if (raster->kind[p] != raster->kind[q]) return true;
  return raster->kind[p] != 0 && fabsf(raster->depth[p] - raster->depth[q]) > step;
}

void vsc_raster_outline(vsc_raster *raster, float step)
{
  const size_t width = (size_t)raster->width, height = (size_t)raster->height;
  for (size_t row = 1; row + 1 < height; row++) {
    for (size_t column = 1; column + 1 < width; column++) {
      const size_t p = row * width + column;
      if (raster->kind[p] == 0) continue;
      if (!jumps(raster, p, p - 1, step) && !jumps(raster, p, p + 1, step) &&
          !jumps(raster, p, p - width, step) && !jumps(raster, p, p + width, step))
        continue;
      for (int k = 0; k < 3; k++) raster->colour[3 * p + k] *= 0.45F;
    }
  }
}

void vsc_raster_shrink(const vsc_raster *raster, int factor, uint8_t *pixels, int stride)
{
  const float samples = (float)(factor * factor);
  for (int row = 0; row < raster->height / factor; row++) {
    for (int column = 0; column < raster->width / factor; column++) {
      float sum[4] = {0};
      for (int s = 0; s < factor * factor; s++) {
        const int x = column * factor + s % factor, y = row * factor + s / factor;
        const size_t p = (size_t)y * (size_t)raster->width + (size_t)x;
        if (raster->kind[p] == 0) continue;
        sum[3] += 1;
        for (int k = 0; k < 3; k++) sum[k] += raster->colour[3 * p + k];
      }
      uint32_t argb = (uint32_t)lroundf(255 * sum[3] / samples) << 24;
      for (int k = 0; k < 3; k++) argb |= (uint32_t)lroundf(255 * sum[k] / samples) << (16 - 8 * k);
      memcpy(pixels + (size_t)row * (size_t)stride + 4 * (size_t)column, &argb, sizeof argb);
    }
  }
}
