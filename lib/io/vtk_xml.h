// SPDX-License-Identifier: GPL-3.0-or-later
// What must hold in a VTK XML file (.vtu, .vtp, .vti) before VTK may read it.
#ifndef VSC_IO_VTK_XML_H
#define VSC_IO_VTK_XML_H

#include "base/status.h"

// Checks what VTK takes as it is and then ends the program, allocates without bound or leaves memory unset:
// - counts of points, cells, components and tuples: what they announce fits in a file of that size (unpacked where it is
//   compressed);
// - the first block sizes of compressed arrays, inline or appended: a wrong header_type shows there;
// - an image's pieces: they lie in WholeExtent and fill it, no cell twice.
// VSC_INPUT with the file's name if any of this does not hold, or the file cannot be read. What is no XML, or lacks what VTK
// itself misses, passes.
vsc_status vsc_xml_check(const char *file, vsc_error *error);

#endif
