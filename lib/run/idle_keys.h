// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of a scene that its method does not look at. Internal to the run room.
#ifndef VSC_RUN_IDLE_KEYS_H
#define VSC_RUN_IDLE_KEYS_H

#include "io/scene.h"

enum { VSC_IDLE_KEYS = 256 };  // room for all of their names

// Writes the keys of `solver`, `prestress` and `time`, and `masses`, whose values are not the default ones although
// nothing depends on them: "solver.rho, time.step". Returns their number.
int vsc_idle_keys(const vsc_scene *scene, char keys[VSC_IDLE_KEYS]);

#endif
