// SPDX-License-Identifier: GPL-3.0-or-later
// The list of frames and their times that ParaView opens.
#ifndef VSC_IO_PVD_H
#define VSC_IO_PVD_H

#include <stddef.h>

#include "base/status.h"

typedef struct vsc_pvd vsc_pvd;

// A list that will be written to `file`, empty. With `keep_until` >= 0 (seconds) the frames of an
// existing file whose times are below it (by more than 1e-9 s) are kept: that is how a resumed run
// trims its series. A missing file is an empty list; one that is no PVD or is cut short is
// VSC_INPUT. Nothing is written yet. On success the caller owns *pvd.
vsc_status vsc_pvd_open(const char *file, double keep_until, vsc_pvd **pvd, vsc_error *error);

// Appends a frame (time in seconds, file name relative to the PVD) and rewrites the list under a
// temporary name, renamed: the file on disk is valid at every moment. It may lack the last 1/64 of the frames until
// vsc_pvd_finish: what is written in all grows as the list does, not as its square. Times must rise;
// VSC_INPUT for one that does not, VSC_SYSTEM when the file cannot be written.
vsc_status vsc_pvd_add(vsc_pvd *pvd, double time, const char *frame, vsc_error *error);

// Rewrites the list as it is, in the same way; the second one if frames lack in the file.
vsc_status vsc_pvd_write(vsc_pvd *pvd, vsc_error *error);
vsc_status vsc_pvd_finish(vsc_pvd *pvd, vsc_error *error);

size_t vsc_pvd_count(const vsc_pvd *pvd);                    // frames
double vsc_pvd_time(const vsc_pvd *pvd, size_t frame);       // seconds
const char *vsc_pvd_frame(const vsc_pvd *pvd, size_t frame); // file name, owned by the list

// The path of a frame of the series read from `file`: beside it, unless its name is absolute.
void vsc_pvd_frame_path(const char *file, const vsc_pvd *pvd, size_t frame, char *path,
                        size_t size);

void vsc_pvd_free(vsc_pvd *pvd);  // NULL is fine

#endif
