// SPDX-License-Identifier: GPL-3.0-or-later
// All that moves, in one HDF5 file that describes itself.
#ifndef VSC_IO_CHECKPOINT_H
#define VSC_IO_CHECKPOINT_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

// One block of numbers of a checkpoint, borrowed.
typedef struct vsc_block {
  const char *name;   // dataset
  const char *unit;   // attribute "unit"
  size_t rows;
  size_t columns;     // 1 for plain lists
  double *values;     // rows x columns
} vsc_block;

// Loads HDF5, which reading and writing else do when they need it, so that a run learns before its first step whether
// its checkpoint can be written. VSC_SYSTEM when it is not there.
vsc_status vsc_checkpoint_ready(vsc_error *error);

// Writes the blocks, with attributes "format" ("viscera checkpoint"), "version", "model_hash", and
// each block's unit, to a temporary name, renamed when complete and on the disk. Numbers are kept
// bit for bit, under checksums. VSC_SYSTEM when that fails; what was there before stays then.
vsc_status vsc_checkpoint_write(const char *file, uint64_t model_hash, size_t block_count,
                                const vsc_block *blocks, vsc_error *error);

// Reads into blocks whose names and shapes say what is expected. VSC_INPUT when the file is
// missing, is no checkpoint, has another version or model hash, lacks a block of that shape or is
// damaged; values of blocks may then have been overwritten.
vsc_status vsc_checkpoint_read(const char *file, uint64_t model_hash, size_t block_count,
                               const vsc_block *blocks, vsc_error *error);

#endif
