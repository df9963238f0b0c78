// SPDX-License-Identifier: GPL-3.0-or-later
// The program `viscera`: says how idle threads wait, and becomes viscera-verbs. libgomp reads its variables while it
// is loaded, before any main starts, and by default its idle threads spin: on a busy machine that costs several
// times the CPU. So they are set here, where none of the some eighty libraries is loaded yet. A user who has set
// the policy keeps it; binding stays the user's.
#include <stdlib.h>

#include "tools/beside.h"

int main(int argc, char **argv)
{
  (void)argc;
  if (getenv("OMP_WAIT_POLICY") == NULL && setenv("OMP_WAIT_POLICY", "PASSIVE", 1) == 0)
    // Some ten microseconds of spinning before a thread sleeps: the passes of a small mesh follow one another that
    // fast (the shipped beat: 1.6 times as fast on two threads, with less processor time).
    setenv("GOMP_SPINCOUNT", "10000", 0);
  return vsc_become("viscera-verbs", "it belongs beside viscera or in the PATH", argv);
}
