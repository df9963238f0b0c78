// SPDX-License-Identifier: GPL-3.0-or-later
// The folder that `viscera run` leaves: its one series and the files of its frames.
#ifndef VSC_TOOLS_RESULTS_H
#define VSC_TOOLS_RESULTS_H

#include <stdbool.h>
#include <stddef.h>

#include "io/pvd.h"

enum { VSC_RESULT_PATH = 4096 };  // room for a file's name

typedef struct vsc_results {
  char pvd[VSC_RESULT_PATH];  // the series' file
  vsc_pvd *series;     // owned; at least one frame
} vsc_results;

// Whether a file's name is that of a series: ends in .pvd behind something.
bool vsc_is_series(const char *file);

// Opens the only *.pvd of the folder. VSC_INPUT with a message when there is none or several, or it
// has no frame. On success the caller frees with vsc_results_close; after an error there is nothing
// to free.
vsc_status vsc_results_open(const char *folder, vsc_results *results, vsc_error *error);

// The frame nearest to that time (s); the last for NAN.
size_t vsc_results_nearest(const vsc_results *results, double time);

void vsc_results_close(vsc_results *results);

// The number behind "key" in FOLDER/summary.json; NAN when there is none.
double vsc_results_number(const char *folder, const char *key);

#endif
