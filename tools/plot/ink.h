// SPDX-License-Identifier: GPL-3.0-or-later
// Texts, bars and scales of the pictures, and the PNG that they are written to.
#ifndef VSC_TOOLS_PLOT_INK_H
#define VSC_TOOLS_PLOT_INK_H

#include <cairo.h>

#include "base/status.h"

extern const double VSC_INK[3], VSC_FAINT[3];  // red, green, blue of texts

void vsc_use_font(cairo_t *cairo, cairo_font_weight_t weight);

// Writes `text` at (x, y), `align` (0 to 1) of its width to the left of x; sizes in pixels.
void vsc_write_text(cairo_t *cairo, double x, double y, double size, const double colour[3],
                    double align, const char *text);

// The next of 1, 2, 5 times a power of ten that divides `span` into five parts at most.
double vsc_tick_step(double span);

// The bar of a round length (mm) that tells the scale, in pixels per mm, of a picture.
void vsc_draw_scale(cairo_t *cairo, double x, double y, double scale);

// A bar of vsc_view_colour's colours from `low` to `high`, with ticks and a title.
void vsc_draw_bar(cairo_t *cairo, double x, double y, double width, double low, double high,
                  const char *title);

// VSC_INPUT for a picture's name that does not end in .png.
vsc_status vsc_check_png(const char *file, vsc_error *error);

// Writes a PNG by way of a temporary name, of which nothing is left when it cannot: VSC_SYSTEM.
vsc_status vsc_write_png(cairo_surface_t *surface, const char *file, vsc_error *error);

// Draws what belongs to a page.
typedef void vsc_page_part(cairo_t *cairo, const void *what);

// A white page of that many pixels with a title and what `draw` draws of `what`, as a PNG; errors as above.
vsc_status vsc_write_page(int width, int height, const char *title, vsc_page_part *draw, const void *what,
                          const char *file, vsc_error *error);

#endif
