// SPDX-License-Identifier: GPL-3.0-or-later
// The program `viscera`: says how idle threads of libgomp wait, which CHOLMOD uses, and becomes viscera-verbs. libgomp
// reads its variables while it is loaded, before any main starts, and by default its idle threads spin: on a busy
// machine that costs several times the CPU. So they are set here, where none of some eighty libraries is loaded
// yet. A user who has set the policy keeps it; binding stays the user's.
#include <stdlib.h>

#include "tools/beside.h"

int main(int argc, char **argv)
{
  (void)argc;
  setenv("OMP_WAIT_POLICY", "PASSIVE", 0);
  return vsc_become("viscera-verbs", "it belongs beside viscera or in the PATH", argv);
}
