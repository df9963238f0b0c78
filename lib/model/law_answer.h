// SPDX-License-Identifier: GPL-3.0-or-later
// What laws fill in (model/law.h).
#ifndef VSC_MODEL_LAW_ANSWER_H
#define VSC_MODEL_LAW_ANSWER_H

#include "base/wide.h"

typedef struct vsc_law_answer {
  vsc_wide energy;   // psi, kPa
  vsc_wide S[6];     // kPa
  vsc_wide D[6][6];  // kPa
} vsc_law_answer;

#endif
