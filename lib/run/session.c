// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/session.h"

#include <stdio.h>

void vsc_session_path(const vsc_session *session, const char *what, char path[VSC_PATH])
{
  const char *name = what[0] == '.' ? session->name : "";
  snprintf(path, VSC_PATH, "%.*s/%.*s%.100s", VSC_LONGEST_DIRECTORY, session->options->directory,
           VSC_NAME, name, what);
}
