// SPDX-License-Identifier: GPL-3.0-or-later
// HDF5, loaded when the first checkpoint is written or read, or a file is looked into.
#ifndef VSC_IO_HDF5_H
#define VSC_IO_HDF5_H

#include <stdio.h>

#include "base/status.h"
#include "io/checkpoint.h"

// Prints the attributes and the datasets (shape, unit) at the root of an HDF5 file to `stream`, one
// indented line each. VSC_INPUT when the file is missing or isn't HDF5, VSC_SYSTEM when the HDF5 library is not there.
vsc_status vsc_hdf5_contents(const char *file, FILE *stream, vsc_error *error);

// What the module does for vsc_checkpoint_write, vsc_checkpoint_read and vsc_hdf5_contents.
typedef struct vsc_hdf5 {
  __typeof__(vsc_checkpoint_write) *write_checkpoint;
  __typeof__(vsc_checkpoint_read) *read_checkpoint;
  __typeof__(vsc_hdf5_contents) *print_contents;
} vsc_hdf5;

// Gives the functions of the module. VSC_SYSTEM when it or the HDF5 library is not there.
vsc_status vsc_hdf5_load(const vsc_hdf5 **hdf5, vsc_error *error);

#endif
