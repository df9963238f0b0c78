// SPDX-License-Identifier: GPL-3.0-or-later
// What laws fill in (model/law.h).
#ifndef VSC_MODEL_LAW_ANSWER_H
#define VSC_MODEL_LAW_ANSWER_H

#include "base/wide.h"

// How much of the answer is wanted; always a constant, so that the rest is not compiled.
typedef enum vsc_law_depth { VSC_LAW_ENERGY, VSC_LAW_STRESS, VSC_LAW_TANGENT } vsc_law_depth;

typedef struct vsc_law_answer {
  vsc_wide energy;    // psi, kPa
  vsc_wide S[6];      // kPa
  vsc_wide D[6][6];   // kPa
  vsc_wide exponent;  // largest exponent of the law here, 0 without any; above
                      // VSC_LARGEST_EXPONENT the law is continued (model/law_exponential.h)
} vsc_law_answer;

#endif
