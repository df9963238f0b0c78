// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/hdf5_contents.h"

#include <errno.h>
#include <hdf5.h>
#include <inttypes.h>
#include <string.h>

enum { TEXT = 256 };

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

vsc_status vsc_hdf5_contents(const char *file, FILE *stream, vsc_error *error)
{
  FILE *there = fopen(file, "rb");
  if (there == NULL) return vsc_fail(error, VSC_INPUT, "%s: %s", file, strerror(errno));
  fclose(there);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);  // the messages are ours to give
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
