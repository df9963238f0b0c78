// SPDX-License-Identifier: GPL-3.0-or-later
// The module `hdf5`: what is linked to HDF5, so that the library need not be.
#include "io/hdf5.h"

#include <errno.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include <hdf5.h>

#include "base/mem.h"
#include "io/replace.h"

static const char FORMAT[] = "viscera checkpoint";
static const int64_t VERSION = 1;
enum { CHUNK_NUMBERS = 1 << 17 };  // numbers under one checksum
enum { MEMORY_STEP = 1 << 20 };  // bytes by which a file in memory grows
enum { TEXT = 256 };  // bytes of an attribute's value that are shown

// ---- checkpoints

// HDF5 prints each error to stderr unless it is told not to.
typedef struct hush {
  H5E_auto2_t handler;
  void *data;
} hush;

static hush hush_hdf5(void)
{
  hush former = {0};
  H5Eget_auto2(H5E_DEFAULT, &former.handler, &former.data);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  return former;
}

static void unhush_hdf5(hush former)
{
  H5Eset_auto2(H5E_DEFAULT, former.handler, former.data);
}

static bool write_attribute(hid_t place, const char *name, hid_t file_type, hid_t memory_type,
                            const void *value)
{
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(place, name, file_type, space, H5P_DEFAULT, H5P_DEFAULT);
  const bool written = attribute >= 0 && H5Awrite(attribute, memory_type, value) >= 0;
  const bool closed = attribute >= 0 && H5Aclose(attribute) >= 0;
  H5Sclose(space);
  return written && closed;
}

static bool write_text(hid_t place, const char *name, const char *text)
{
  const hid_t type = H5Tcopy(H5T_C_S1);
  const bool written = H5Tset_size(type, strlen(text) + 1) >= 0 &&
                       write_attribute(place, name, type, type, text);
  H5Tclose(type);
  return written;
}

// Storage in chunks that carry a checksum, so that a damaged file is noticed.
static hid_t checked_layout(int rank, const hsize_t shape[2])
{
  const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  hsize_t chunk[2] = {CHUNK_NUMBERS, 1};
  if (rank == 2) {
    chunk[1] = shape[1] < CHUNK_NUMBERS ? shape[1] : CHUNK_NUMBERS;
    chunk[0] = CHUNK_NUMBERS / chunk[1];
  }
  if (chunk[0] > shape[0]) chunk[0] = shape[0];
  H5Pset_chunk(layout, rank, chunk);
  H5Pset_fletcher32(layout);
  return layout;
}

static bool write_block(hid_t file, const vsc_block *block)
{
  const hsize_t shape[2] = {block->rows, block->columns};
  const int rank = block->columns == 1 ? 1 : 2;
  const bool empty = block->rows == 0 || block->columns == 0;
  const hid_t space = H5Screate_simple(rank, shape, NULL);
  const hid_t layout = empty ? H5Pcreate(H5P_DATASET_CREATE) : checked_layout(rank, shape);
  const hid_t set = H5Dcreate2(file, block->name, H5T_IEEE_F64LE, space, H5P_DEFAULT, layout,
                               H5P_DEFAULT);
  bool written = set >= 0;
  if (written && !empty)
    written = H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, block->values) >= 0;
  written = written && write_text(set, "unit", block->unit);
  if (set >= 0) written = H5Dclose(set) >= 0 && written;
  H5Pclose(layout);
  H5Sclose(space);
  return written;
}

// All of a file's content, in memory: HDF5 goes astray, up to the end of the program, where a file cannot be written in
// full. NULL when there is not enough of it; the caller frees it.
static void *make_image(const char *name, uint64_t model_hash, size_t block_count, const vsc_block *blocks,
                        size_t *size)
{
  const hid_t memory = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(memory, MEMORY_STEP, false);
  const hid_t file = H5Fcreate(name, H5F_ACC_TRUNC, H5P_DEFAULT, memory);
  H5Pclose(memory);
  if (file < 0) return NULL;
  bool written = write_text(file, "format", FORMAT) &&
                 write_attribute(file, "version", H5T_STD_I64LE, H5T_NATIVE_INT64, &VERSION) &&
                 write_attribute(file, "model_hash", H5T_STD_U64LE, H5T_NATIVE_UINT64, &model_hash);
  for (size_t i = 0; i < block_count && written; i++) written = write_block(file, &blocks[i]);
  written = written && H5Fflush(file, H5F_SCOPE_LOCAL) >= 0;
  const ssize_t bytes = written ? H5Fget_file_image(file, NULL, 0) : 0;
  void *image = bytes > 0 ? vsc_alloc((size_t)bytes, 1) : NULL;
  if (image != NULL) *size = (size_t)H5Fget_file_image(file, image, (size_t)bytes);
  H5Fclose(file);
  return image;
}

static vsc_status write_checkpoint(const char *file, uint64_t model_hash, size_t block_count,
                                   const vsc_block *blocks, vsc_error *error)
{
  const hush former = hush_hdf5();
  size_t size = 0;
  void *image = make_image(file, model_hash, block_count, blocks, &size);
  unhush_hdf5(former);
  if (image == NULL) return vsc_fail_memory(error, "a checkpoint");
  const vsc_status status = vsc_replace_whole(file, image, size, true, error);
  vsc_free(image);
  return status;
}

static bool read_attribute(hid_t file, const char *name, hid_t type, void *value)
{
  const hid_t attribute = H5Aopen(file, name, H5P_DEFAULT);
  if (attribute < 0) return false;
  const hid_t space = H5Aget_space(attribute);
  const hid_t stored = H5Aget_type(attribute);
  const bool read = H5Sget_simple_extent_npoints(space) == 1 &&
                    H5Tget_class(stored) == H5Tget_class(type) &&
                    H5Aread(attribute, type, value) >= 0;
  H5Tclose(stored);
  H5Sclose(space);
  H5Aclose(attribute);
  return read;
}

// Whether the text attribute `name` is `expected`.
static bool has_text(hid_t file, const char *name, const char *expected)
{
  char text[64] = "";
  const hid_t attribute = H5Aopen(file, name, H5P_DEFAULT);
  if (attribute < 0) return false;
  const hid_t space = H5Aget_space(attribute);
  const hid_t type = H5Aget_type(attribute);
  if (H5Sget_simple_extent_npoints(space) == 1 && H5Tget_class(type) == H5T_STRING &&
      H5Tis_variable_str(type) == 0 && H5Tget_size(type) < sizeof text)
    H5Aread(attribute, type, text);
  H5Tclose(type);
  H5Sclose(space);
  H5Aclose(attribute);
  return strcmp(text, expected) == 0;
}

static vsc_status check_header(const char *name, hid_t file, uint64_t model_hash, vsc_error *error)
{
  int64_t version = 0;
  uint64_t hash = 0;
  if (!has_text(file, "format", FORMAT))
    return vsc_fail(error, VSC_INPUT, "%s: is an HDF5 file but no viscera checkpoint: name another",
                    name);
  if (!read_attribute(file, "version", H5T_NATIVE_INT64, &version) || version != VERSION)
    return vsc_fail(error, VSC_INPUT,
                    "%s: checkpoint version %" PRId64 ", this program reads %" PRId64
                    ": resume with the program that wrote it",
                    name, version, VERSION);
  if (!read_attribute(file, "model_hash", H5T_NATIVE_UINT64, &hash) || hash != model_hash)
    return vsc_fail(error, VSC_INPUT,
                    "%s: belongs to another model (hash %016" PRIx64 ", this one's is %016" PRIx64
                    "): resume with the scene and the mesh that it was written with",
                    name, hash, model_hash);
  return VSC_OK;
}

// Checks shape and type of a data set; on failure says why.
static const char *mismatch(hid_t set, const vsc_block *block)
{
  const hid_t space = H5Dget_space(set);
  const hid_t type = H5Dget_type(set);
  const int wanted = block->columns == 1 ? 1 : 2;
  hsize_t shape[2] = {0, 1};
  const char *reason = NULL;
  if (H5Sget_simple_extent_ndims(space) != wanted) reason = "has another number of dimensions";
  else H5Sget_simple_extent_dims(space, shape, NULL);
  if (reason == NULL && (shape[0] != block->rows || (wanted == 2 && shape[1] != block->columns)))
    reason = "has another shape";
  if (reason == NULL && H5Tequal(type, H5T_IEEE_F64LE) <= 0) reason = "holds no 64-bit numbers";
  H5Tclose(type);
  H5Sclose(space);
  return reason;
}

static vsc_status read_block(const char *name, hid_t file, const vsc_block *block,
                             vsc_error *error)
{
  const hid_t set = H5Dopen2(file, block->name, H5P_DEFAULT);
  if (set < 0)
    return vsc_fail(error, VSC_INPUT, "%s: has no data set %s: resume from another checkpoint",
                    name, block->name);
  const char *reason = mismatch(set, block);
  const bool empty = block->rows == 0 || block->columns == 0;
  if (reason == NULL && !empty &&
      H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, block->values) < 0)
    reason = "is damaged";
  H5Dclose(set);
  if (reason == NULL) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s: data set %s %s (%zu x %zu expected): resume from another checkpoint", name,
                  block->name, reason, block->rows, block->columns);
}

static vsc_status read_all(const char *name, uint64_t model_hash, size_t block_count,
                           const vsc_block *blocks, vsc_error *error)
{
  const hid_t file = H5Fopen(name, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0)
    return vsc_fail(error, VSC_INPUT, "%s: is damaged, cut short or no HDF5 file: name another",
                    name);
  vsc_status status = check_header(name, file, model_hash, error);
  for (size_t i = 0; i < block_count && status == VSC_OK; i++)
    status = read_block(name, file, &blocks[i], error);
  H5Fclose(file);
  return status;
}

static vsc_status read_checkpoint(const char *file, uint64_t model_hash, size_t block_count,
                                  const vsc_block *blocks, vsc_error *error)
{
  FILE *stream = fopen(file, "rb");
  if (stream == NULL)
    return vsc_fail(error, VSC_INPUT, "%s: cannot be opened: %s: check the name", file,
                    strerror(errno));
  fclose(stream);
  const hush former = hush_hdf5();
  const vsc_status status = read_all(file, model_hash, block_count, blocks, error);
  unhush_hdf5(former);
  return status;
}

// ---- what a file holds

// The value of an attribute as text; empty when it is neither a string nor one number.
static void attribute_text(hid_t attribute, char text[TEXT])
{
  text[0] = '\0';
  const hid_t type = H5Aget_type(attribute);
  const hid_t space = H5Aget_space(attribute);
  const H5T_class_t class = H5Tget_class(type);
  if (H5Sget_simple_extent_npoints(space) == 1) {
    if (class == H5T_STRING && H5Tis_variable_str(type) > 0) {
      char *value = NULL;
      if (H5Aread(attribute, type, &value) >= 0 && value != NULL) snprintf(text, TEXT, "%s", value);
      if (value != NULL) H5free_memory(value);
    } else if (class == H5T_STRING && H5Tget_size(type) < TEXT) {
      if (H5Aread(attribute, type, text) < 0) text[0] = '\0';
      text[H5Tget_size(type)] = '\0';
    } else if (class == H5T_INTEGER && H5Tget_sign(type) == H5T_SGN_NONE) {
      uint64_t value = 0;
      if (H5Aread(attribute, H5T_NATIVE_UINT64, &value) >= 0)
        snprintf(text, TEXT, "%" PRIu64, value);
    } else if (class == H5T_INTEGER) {
      int64_t value = 0;
      if (H5Aread(attribute, H5T_NATIVE_INT64, &value) >= 0)
        snprintf(text, TEXT, "%" PRId64, value);
    } else if (class == H5T_FLOAT) {
      double value = 0;
      if (H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) >= 0) snprintf(text, TEXT, "%.9g", value);
    }
  }
  H5Sclose(space);
  H5Tclose(type);
}

static herr_t print_attribute(hid_t object, const char *name, const H5A_info_t *info, void *stream)
{
  (void)info;
  char text[TEXT];
  const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
  if (attribute < 0) return 0;
  attribute_text(attribute, text);
  H5Aclose(attribute);
  fprintf(stream, "  %-24s %s\n", name, text);
  return 0;
}

static void print_dataset(hid_t dataset, const char *name, FILE *stream)
{
  hsize_t size[H5S_MAX_RANK];
  const hid_t space = H5Dget_space(dataset);
  const int rank = H5Sget_simple_extent_dims(space, size, NULL);
  H5Sclose(space);
  fprintf(stream, "  %-24s", name);
  for (int d = 0; d < rank; d++)
    fprintf(stream, "%s%llu", d == 0 ? " " : " x ", (unsigned long long)size[d]);
  if (rank == 0) fputs(" one value", stream);
  if (H5Aexists(dataset, "unit") > 0) {
    char unit[TEXT];
    const hid_t attribute = H5Aopen(dataset, "unit", H5P_DEFAULT);
    attribute_text(attribute, unit);
    H5Aclose(attribute);
    if (unit[0] != '\0') fprintf(stream, " [%s]", unit);
  }
  fputc('\n', stream);
}

static herr_t print_link(hid_t group, const char *name, const H5L_info_t *info, void *stream)
{
  (void)info;
  const hid_t object = H5Oopen(group, name, H5P_DEFAULT);
  if (object < 0) {
    fprintf(stream, "  %-24s can't be opened\n", name);
    return 0;
  }
  if (H5Iget_type(object) == H5I_DATASET)
    print_dataset(object, name, stream);
  else
    fprintf(stream, "  %-24s a group\n", name);
  H5Oclose(object);
  return 0;
}

static vsc_status print_all(const char *file, FILE *stream, vsc_error *error)
{
  const hid_t handle = H5Fopen(file, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (handle < 0)
    return vsc_fail(error, VSC_INPUT, "%s: this is no HDF5 file, or a damaged one", file);
  herr_t result = H5Aiterate2(handle, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, print_attribute, stream);
  if (result >= 0)
    result = H5Literate(handle, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, print_link, stream);
  H5Fclose(handle);
  if (result < 0) return vsc_fail(error, VSC_INPUT, "%s: the file is damaged", file);
  return VSC_OK;
}

static vsc_status print_contents(const char *file, FILE *stream, vsc_error *error)
{
  FILE *there = fopen(file, "rb");
  if (there == NULL) return vsc_fail(error, VSC_INPUT, "%s: %s", file, strerror(errno));
  fclose(there);
  const hush former = hush_hdf5();
  const vsc_status status = print_all(file, stream, error);
  unhush_hdf5(former);
  return status;
}

const vsc_hdf5 vsc_hdf5_table = {
    .write_checkpoint = write_checkpoint,
    .read_checkpoint = read_checkpoint,
    .print_contents = print_contents,
};
