// SPDX-License-Identifier: GPL-3.0-or-later
// For the C++ files of this folder that read: files looked at before VTK sees them, both formats
// read, arrays copied.
#ifndef VSC_IO_VTK_READ_HH
#define VSC_IO_VTK_READ_HH

#include <strings.h>
#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <vtkBitArray.h>
#include <vtkCharArray.h>
#include <vtkDataArray.h>
#include <vtkDataObjectTypes.h>
#include <vtkDataSetAttributes.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkNew.h>
#include <vtkXMLFileReadTester.h>

extern "C" {
#include "io/vtk_legacy.h"
#include "io/vtk_xml.h"
#include "mesh/mesh.h"
}
#include "io/vtk_quiet.hh"

namespace vsc {

inline bool ends_with(const char *text, const char *ending)
{
  const size_t length = std::strlen(text), tail = std::strlen(ending);
  if (length < tail) return false;
  for (size_t i = 0; i < tail; i++)
    if (std::tolower((unsigned char)text[length - tail + i]) != ending[i]) return false;
  return true;
}

// What can be said of a file before VTK sees it. `ending` is the XML format's.
inline vsc_status check_file(const char *file, const char *ending, vsc_error *error)
{
  struct stat facts;
  FILE *stream = stat(file, &facts) == 0 ? std::fopen(file, "rb") : nullptr;
  if (stream == nullptr)
    return vsc_fail(error, VSC_INPUT, "%s: cannot be opened: %s: check the name", file,
                    std::strerror(errno));
  std::fclose(stream);
  if (!S_ISREG(facts.st_mode))
    return vsc_fail(error, VSC_INPUT, "%s: is not a regular file: name a %s or .vtk file", file,
                    ending);
  if (facts.st_size == 0)
    return vsc_fail(error, VSC_INPUT, "%s: is empty: write it again", file);
  if (ends_with(file, ending) || ends_with(file, ".vtk")) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s: only %s and .vtk files are read here: convert it, for example in ParaView",
                  file, ending);
}

inline vsc_status fail_kind(const char *file, const std::string &found, const char *wanted,
                     vsc_error *error)
{
  return vsc_fail(error, VSC_INPUT, "%s: holds a VTK %s, but %s", file, found.c_str(), wanted);
}

inline vsc_status fail_read(const char *file, const silence &quiet, vsc_error *error)
{
  return vsc_fail(error, VSC_INPUT,
                  "%s: is damaged or cut short (VTK: %s): write it again", file,
                  quiet.said().c_str());
}

// VTK doesn't notice when the numbers of a legacy file's last array end too soon: the missing ones
// come as whatever was in memory. So the file is read once more with a number behind its end: VTK
// must complain of just that number as a keyword or an attribute, or an array has swallowed some of it.
// Where VTK takes it for a count it is none.
constexpr char STRAY[] = "0.271828182845";

// Whether the last lines are those behind an array that describe it, up to an empty line.
inline bool ends_in_metadata(const std::string &text)
{
  const size_t begin = text.rfind("METADATA");
  return begin != std::string::npos &&
         std::all_of(text.begin() + (std::ptrdiff_t)begin, text.end(),
                     [](unsigned char c) { return std::isprint(c) || std::isspace(c); });
}

inline std::string load_with_stray(const char *file)
{
  std::ifstream stream(file, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  size_t third_line = text.find('\n');
  if (third_line != std::string::npos) third_line = text.find('\n', third_line + 1);
  const bool binary = third_line != std::string::npos &&
                      strncasecmp(text.c_str() + third_line + 1, "binary", 6) == 0;
  const char *between = ends_in_metadata(text) ? "\n\n" : binary ? "" : "\n";
  return text + between + STRAY + "\n";
}

template <typename Reader> bool breaks_off(const char *file, const silence &quiet)
{
  const std::string text = load_with_stray(file);
  vtkNew<vtkCharArray> array;
  array->SetNumberOfValues((vtkIdType)text.size());
  std::memcpy(array->GetPointer(0), text.data(), text.size());
  vtkNew<Reader> reader;
  reader->SetInputArray(array);
  reader->ReadFromInputStringOn();
  reader->Update();
  const std::string said = quiet.said(), stray = STRAY;
  return said.find("keyword: " + stray) == std::string::npos &&
         said.find("attribute type: " + stray) == std::string::npos;
}

// Reads a .vtk file of the VTK type that `Reader` reads.
template <typename Reader>
vsc_status read_legacy(const char *file, int type, const char *wanted, const silence &quiet,
                       vtkSmartPointer<vtkDataObject> &object, vsc_error *error)
{
  vtkNew<vtkGenericDataObjectReader> tester;
  tester->SetFileName(file);
  const int found = tester->ReadOutputType();
  if (found < 0)
    return vsc_fail(error, VSC_INPUT,
                    "%s: is not a legacy VTK file (VTK: %s): check its first lines", file,
                    quiet.said().c_str());
  if (found != type)
    return fail_kind(file, vtkDataObjectTypes::GetClassNameFromTypeId(found) + 3, wanted, error);
  const vsc_status status = vsc_legacy_check(file, error);
  if (status != VSC_OK) return status;
  vtkNew<Reader> reader;
  reader->SetFileName(file);
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllNormalsOn();
  reader->ReadAllTensorsOn();
  reader->ReadAllColorScalarsOn();
  reader->ReadAllTCoordsOn();
  reader->ReadAllFieldsOn();
  reader->Update();
  if (quiet.failed() || reader->GetErrorCode() != 0 || breaks_off<Reader>(file, quiet))
    return fail_read(file, quiet, error);
  object = reader->GetOutput();
  return VSC_OK;
}

// Whether the last element of an XML file is closed: VTK does not notice when the data appended before that are cut short.
inline bool is_closed(const char *file)
{
  constexpr std::streamoff TAIL = 4096;
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = stream.tellg();
  stream.seekg(std::max<std::streamoff>(size - TAIL, 0));
  const std::string tail((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  return tail.find("</VTKFile>") != std::string::npos;
}

// Reads an XML file whose VTKFile element has the type `type`.
template <typename Reader>
vsc_status read_xml(const char *file, const char *type, const char *wanted, const silence &quiet,
                    vtkSmartPointer<vtkDataObject> &object, vsc_error *error)
{
  vtkNew<vtkXMLFileReadTester> tester;
  tester->SetFileName(file);
  if (!tester->TestReadFile() || tester->GetFileDataType() == nullptr)
    return vsc_fail(error, VSC_INPUT,
                    "%s: is not a VTK XML file: check its first lines (a legacy file's name ends "
                    "in .vtk)",
                    file);
  if (std::strcmp(tester->GetFileDataType(), type) != 0)
    return fail_kind(file, tester->GetFileDataType(), wanted, error);
  if (!is_closed(file)) return fail_read(file, quiet, error);
  const vsc_status status = vsc_xml_check(file, error);
  if (status != VSC_OK) return status;
  vtkNew<Reader> reader;
  reader->SetFileName(file);
  reader->Update();
  if (quiet.failed() || reader->GetErrorCode() != 0) return fail_read(file, quiet, error);
  object = reader->GetOutputDataObject(0);
  return VSC_OK;
}

// Copies tuples to doubles: those numbered in `picks`, or all when there is no list.
template <typename Number>
void copy_numbers(const Number *from, int width, size_t tuples,
                  const std::vector<uint32_t> *picks, double *to)
{
  for (size_t i = 0; i < tuples; i++) {
    const Number *tuple = from + (size_t)width * (picks != nullptr ? (*picks)[i] : i);
    for (int k = 0; k < width; k++) *to++ = (double)tuple[k];
  }
}

inline void copy_array(vtkDataArray *from, size_t tuples, const std::vector<uint32_t> *picks, double *to)
{
  const int width = from->GetNumberOfComponents();
  if (vtkBitArray *bits = vtkBitArray::SafeDownCast(from)) {
    for (size_t i = 0; i < tuples; i++)
      for (int k = 0; k < width; k++)
        *to++ = bits->GetComponent((vtkIdType)(picks != nullptr ? (*picks)[i] : i), k);
    return;
  }
  switch (from->GetDataType()) {
    vtkTemplateMacro(
      copy_numbers(static_cast<VTK_TT *>(from->GetVoidPointer(0)), width, tuples, picks, to));
  }
}

// Adds the numeric arrays of `attributes` (which lie on `expected` points or cells).
inline vsc_status add_arrays(const char *file, vtkDataSetAttributes *attributes, size_t expected,
                      const std::vector<uint32_t> *picks, vsc_arrays *arrays, vsc_error *error)
{
  for (int i = 0; i < attributes->GetNumberOfArrays(); i++) {
    vtkDataArray *array = attributes->GetArray(i);
    if (array == nullptr || array->GetName() == nullptr || array->GetNumberOfComponents() < 1)
      continue;
    if (array->GetNumberOfTuples() != (vtkIdType)expected)
      return vsc_fail(error, VSC_INPUT,
                      "%s: array %s has %lld values for %zu places: write it again", file,
                      array->GetName(), (long long)array->GetNumberOfTuples(), expected);
    const size_t tuples = picks != nullptr ? picks->size() : expected;
    vsc_array *copy =
      vsc_arrays_add(arrays, array->GetName(), array->GetNumberOfComponents(), tuples);
    if (copy == nullptr) return vsc_fail_memory(error, "the mesh's arrays");
    copy->single = array->GetDataType() == VTK_FLOAT;
    copy_array(array, tuples, picks, copy->values);
  }
  return VSC_OK;
}

}  // namespace vsc

#endif
