// SPDX-License-Identifier: GPL-3.0-or-later
// What `viscera check` says of a scene's mesh.
#ifndef VSC_RUN_CHECK_MESH_H
#define VSC_RUN_CHECK_MESH_H

#include <stdio.h>

#include "run/problem.h"

// Writes to `stream` what the mesh holds, its size, what was set right when it was read, the quality of its elements,
// and, where there are such, parts that are joined to nothing else and nodes that lie at one place. VSC_SYSTEM when
// memory is short.
vsc_status vsc_check_mesh(const vsc_problem *problem, FILE *stream, vsc_error *error);

#endif
