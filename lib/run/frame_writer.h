// SPDX-License-Identifier: GPL-3.0-or-later
// Frames on their way to the disk: a thread of its own writes them while the run goes on, so that stepping waits
// for the disk only when that is slower than the run.
#ifndef VSC_RUN_FRAME_WRITER_H
#define VSC_RUN_FRAME_WRITER_H

#include "io/pvd.h"
#include "io/scene.h"
#include "io/vtk.h"

enum { VSC_SNAPSHOT_ARRAYS = 24 };

typedef struct vsc_snapshot {
  char file[VSC_PATH];         // the VTU
  char name[VSC_NAME + 64];    // the same, as the series names it
  double time;                 // s
  vsc_mesh shown;              // a copy of the struct; what it points to is borrowed until the frame is written
  size_t count;
  vsc_vtk_array arrays[VSC_SNAPSHOT_ARRAYS];
  bool owned[VSC_SNAPSHOT_ARRAYS];  // whether the array's values are the frame's
  bool double_precision;
} vsc_snapshot;

void vsc_snapshot_free(vsc_snapshot *frame);  // NULL is fine

typedef struct vsc_frame_writer vsc_frame_writer;

// A writer that adds its frames to `pvd` (borrowed; not to be used by others until vsc_frame_writer_finish has
// returned). With `beside` it has a thread, without it writes at once. The caller owns *writer. VSC_SYSTEM when there
// is no memory or no thread.
vsc_status vsc_frame_writer_create(vsc_pvd *pvd, bool beside, vsc_frame_writer **writer, vsc_error *error);

// Gives a frame (from VSC_NEW) away, also on failure. One frame at most waits while another is written: a further one
// is waited for. Returns the first failure of all frames so far, after which nothing more is written.
vsc_status vsc_frame_writer_take(vsc_frame_writer *writer, vsc_snapshot *frame, vsc_error *error);

// Returns when every frame lies on the disk and in the series, with the first failure.
vsc_status vsc_frame_writer_finish(vsc_frame_writer *writer, vsc_error *error);

// Processor seconds of writing so far, of frames that are on the disk.
double vsc_frame_writer_seconds(vsc_frame_writer *writer);

void vsc_frame_writer_free(vsc_frame_writer *writer);  // finishes; NULL is fine

#endif
