// SPDX-License-Identifier: GPL-3.0-or-later
// What the verbs that take a scene share: its file, --set and --threads.
#ifndef VSC_TOOLS_SCENE_OPTIONS_H
#define VSC_TOOLS_SCENE_OPTIONS_H

#include "run/problem.h"

enum { VSC_MOST_SETTINGS = 64 };

typedef struct vsc_scene_options {
  const char *scene;  // file
  const char *settings[VSC_MOST_SETTINGS];
  size_t setting_count;
} vsc_scene_options;

// Keeps one --set text; prints a message and returns 2 when there are too many.
int vsc_keep_setting(vsc_scene_options *options, const char *setting);

// Reads a whole number for --threads and sets it; prints a message and returns 2 when it is none.
int vsc_keep_threads(const char *text);

// Loads the scene; prints the one-line message when that fails. Returns the exit code.
int vsc_load_scene(const vsc_scene_options *options, vsc_problem **problem);

#endif
