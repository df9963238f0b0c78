// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/checkpoint.h"

#include "io/hdf5.h"

vsc_status vsc_checkpoint_ready(vsc_error *error)
{
  const vsc_hdf5 *hdf5;
  return vsc_hdf5_load(&hdf5, error);
}

vsc_status vsc_checkpoint_write(const char *file, uint64_t model_hash, size_t block_count,
                                const vsc_block *blocks, vsc_error *error)
{
  const vsc_hdf5 *hdf5;
  const vsc_status status = vsc_hdf5_load(&hdf5, error);
  return status == VSC_OK ? hdf5->write_checkpoint(file, model_hash, block_count, blocks, error) : status;
}

vsc_status vsc_checkpoint_read(const char *file, uint64_t model_hash, size_t block_count,
                               const vsc_block *blocks, vsc_error *error)
{
  const vsc_hdf5 *hdf5;
  const vsc_status status = vsc_hdf5_load(&hdf5, error);
  return status == VSC_OK ? hdf5->read_checkpoint(file, model_hash, block_count, blocks, error) : status;
}
