// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/scene.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "io/scene_reading.h"

enum { LARGEST_SCENE = 8 << 20 };  // bytes

// Reads until the end of the stream or one byte more than a scene may have; false when memory is short.
static bool read_stream(FILE *stream, char **text, size_t *size)
{
  for (size_t room = 1 << 14;; room *= 2) {
    if (!vsc_grow((void **)text, *size, room, 1)) return false;
    *size += fread(*text + *size, 1, room - *size, stream);
    if (*size < room || *size > LARGEST_SCENE) return true;
  }
}

// The whole file in memory, *text (NULL before) owned by the caller.
static vsc_status read_whole_file(const char *file, char **text, size_t *size, vsc_error *error)
{
  FILE *stream = fopen(file, "rb");
  if (stream == NULL)
    return vsc_fail(error, VSC_INPUT, "%s: %s; expected a scene file", file, strerror(errno));
  vsc_status status = VSC_OK;
  if (!read_stream(stream, text, size))
    status = vsc_fail_memory(error, "the scene file");
  else if (ferror(stream))
    status = vsc_fail(error, VSC_INPUT, "%s: %s; expected a scene file", file, strerror(errno));
  else if (*size > LARGEST_SCENE)
    status = vsc_fail(error, VSC_INPUT, "%s: more than %d MB; expected a scene file, is it one?",
                      file, LARGEST_SCENE >> 20);
  if (status != VSC_OK) vsc_free(*text);
  fclose(stream);
  return status;
}

vsc_prestress_def vsc_default_prestress(void)
{
  return (vsc_prestress_def){.tolerance = 0.01, .iterations = 20};
}

static vsc_scene *create_scene(const char *file)
{
  vsc_scene *scene;
  if (!VSC_NEW(scene, 1)) return NULL;
  snprintf(scene->file, sizeof scene->file, "%s", file);
  scene->mesh_unit = 1;
  scene->mesh_order = 1;
  scene->prestress = vsc_default_prestress();
  scene->fibers = vsc_default_fiber();
  scene->definition = vsc_default_definition();
  scene->output.frame_interval = scene->output.signal_interval = NAN;  // not given
  return scene;
}

// Intervals that the scene does not give: of a motion 10 and 1 ms, where steps are long both 10;
// equilibria are found at the end only, or where frames are wanted.
static void complete_output(vsc_scene *scene)
{
  vsc_output_def *output = &scene->output;
  const vsc_solve_kind kind = scene->definition.solve.kind;
  if (isnan(output->frame_interval))
    output->frame_interval = kind == VSC_SOLVE_EQUILIBRIUM ? scene->definition.end_time : 10;
  if (isnan(output->signal_interval))
    output->signal_interval = kind == VSC_SOLVE_EXPLICIT ? 1 : output->frame_interval;
}

static vsc_status apply_settings(vsc_reading *reading, vsc_slot *slots, const char *const *texts,
                                 size_t count, vsc_setting *settings)
{
  vsc_status status = VSC_OK;
  for (size_t i = 0; i < count && status == VSC_OK; i++) {
    settings[i].text = texts[i];
    reading->current = &settings[i];
    status = vsc_scene_set(reading, slots, &settings[i]);
    reading->current = NULL;
    reading->setting_count = i + 1;
  }
  return status;
}

static vsc_status convert(vsc_reading *reading, const vsc_slot *slots, vsc_scene **scene)
{
  vsc_scene *made = create_scene(reading->file);
  if (made == NULL) return vsc_fail_memory(reading->error, "the scene");
  reading->scene = made;
  vsc_status status = vsc_group_convert(reading, &vsc_scene_group, slots, made);
  if (status == VSC_OK) complete_output(made);
  if (status == VSC_OK) status = vsc_scene_check(reading, made);
  if (status == VSC_OK)
    *scene = made;
  else
    vsc_scene_free(made);
  return status;
}

static vsc_status read_text(vsc_reading *reading, const char *text, size_t size,
                            const char *const *texts, size_t count, vsc_scene **scene)
{
  vsc_setting *settings;
  vsc_slot *slots = NULL;
  if (!VSC_NEW(settings, count)) return vsc_fail_memory(reading->error, "the settings");
  vsc_status status = vsc_scene_load(reading, text, size, &slots);
  reading->settings = settings;
  if (status == VSC_OK) status = apply_settings(reading, slots, texts, count, settings);
  if (status == VSC_OK) status = convert(reading, slots, scene);
  vsc_scene_unload(slots);
  vsc_free(settings);
  return status;
}

vsc_status vsc_scene_read(const char *file, const char *const *settings, size_t setting_count,
                          vsc_scene **scene, vsc_error *error)
{
  char *text = NULL;
  size_t size = 0;
  vsc_locator *locator = NULL;
  if (strlen(file) >= VSC_PATH)
    return vsc_fail(error, VSC_INPUT, "%.60s...: a file name of more than %d bytes; shorten it",
                    file, VSC_PATH - 1);
  vsc_status status = read_whole_file(file, &text, &size, error);
  if (status != VSC_OK) return status;
  status = vsc_locator_open(file, text, size, &locator, error);
  if (status == VSC_OK) {
    vsc_reading reading = {.file = file, .locator = locator, .error = error};
    status = read_text(&reading, text, size, settings, setting_count, scene);
    vsc_locator_close(locator);
  }
  vsc_free(text);
  return status;
}

void vsc_scene_free(vsc_scene *scene)
{
  if (scene == NULL) return;
  vsc_definition_free(&scene->definition);
  vsc_free(scene->inputs);
  vsc_free(scene->curved);
  vsc_free(scene->output.points);
  vsc_free(scene);
}
