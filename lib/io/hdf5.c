// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/hdf5.h"

#include "base/module.h"

vsc_status vsc_hdf5_load(const vsc_hdf5 **hdf5, vsc_error *error)
{
  const void *table;
  const vsc_status status = vsc_module_load("hdf5", "libhdf5-dev", &table, error);
  *hdf5 = table;
  return status;
}

vsc_status vsc_hdf5_contents(const char *file, FILE *stream, vsc_error *error)
{
  const vsc_hdf5 *hdf5;
  const vsc_status status = vsc_hdf5_load(&hdf5, error);
  return status == VSC_OK ? hdf5->print_contents(file, stream, error) : status;
}
