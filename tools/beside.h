// SPDX-License-Identifier: GPL-3.0-or-later
// The other programs of viscera, which lie beside the one that runs, or in the PATH.
#ifndef VSC_TOOLS_BESIDE_H
#define VSC_TOOLS_BESIDE_H

// Becomes `program` with these arguments (argv[0] to NULL). Returns the exit code 4, having said on stderr that it
// cannot be started and, in `remedy`, what that takes.
int vsc_become(const char *program, const char *remedy, char **argv);

#endif
