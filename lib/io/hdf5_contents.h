// SPDX-License-Identifier: GPL-3.0-or-later
// What an HDF5 file says about itself, for `viscera info`.
#ifndef VSC_IO_HDF5_CONTENTS_H
#define VSC_IO_HDF5_CONTENTS_H

#include <stdio.h>

#include "base/status.h"

// Prints the attributes and the datasets (shape, unit) at the root of an HDF5 file to `stream`, one
// indented line each. VSC_INPUT when the file is missing or isn't HDF5.
vsc_status vsc_hdf5_contents(const char *file, FILE *stream, vsc_error *error);

#endif
