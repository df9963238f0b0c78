// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/scene.h"

#include <errno.h>
#include <stdarg.h>
#include <string.h>

#include "base/mem.h"
#include "io/scene_reading.h"

enum { LARGEST_SCENE = 8 << 20 };  // bytes

size_t vsc_enter(vsc_reading *reading, const char *key)
{
  const size_t length = strlen(reading->key);
  const char *dot = length > 0 && key[0] != '\0' ? "." : "";
  snprintf(reading->key + length, VSC_SCENE_KEY - length, "%s%s", dot, key);
  return length;
}

size_t vsc_enter_item(vsc_reading *reading, size_t item)
{
  const size_t length = strlen(reading->key);
  snprintf(reading->key + length, VSC_SCENE_KEY - length, "[%zu]", item);
  return length;
}

void vsc_leave(vsc_reading *reading, size_t length)
{
  reading->key[length] = '\0';
}

// The setting that gave `key` or something that contains it; the last one counts.
static const vsc_setting *setting_of(const vsc_reading *reading, const char *key)
{
  for (size_t i = reading->setting_count; i-- > 0;) {
    const vsc_setting *setting = &reading->settings[i];
    const size_t length = strlen(setting->key);
    if (length > 0 && strncmp(setting->key, key, length) == 0 && strchr(".[", key[length]) != NULL)
      return setting;
  }
  return NULL;
}

static vsc_status fail_at(const vsc_reading *reading, const char *key, const char *text)
{
  const vsc_setting *setting = reading->current;
  if (setting == NULL) setting = setting_of(reading, key);
  const char *colon = key[0] != '\0' ? ": " : "";
  if (setting != NULL)
    return vsc_fail(reading->error, VSC_INPUT, "%s: --set %.100s: %s%s%s", reading->file,
                    setting->text, key, colon, text);
  return vsc_fail(reading->error, VSC_INPUT, "%s:%zu: %s%s%s", reading->file,
                  vsc_locator_line(reading->locator, key), key, colon, text);
}

vsc_status vsc_reading_fail(const vsc_reading *reading, const char *format, ...)
{
  char text[VSC_ERROR_TEXT];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return fail_at(reading, reading->key, text);
}

vsc_status vsc_reading_locate(const vsc_reading *reading, const vsc_error *found)
{
  char key[VSC_SCENE_KEY];
  const char *colon = strstr(found->text, ": ");
  if (found->status != VSC_INPUT || colon == NULL)
    return vsc_fail(reading->error, found->status, "%s: %s", reading->file, found->text);
  snprintf(key, sizeof key, "%.*s", (int)(colon - found->text), found->text);
  return fail_at(reading, key, colon + 2);
}

// Reads until the end of the stream or one byte more than a scene may have.
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

static vsc_scene *create_scene(const char *file)
{
  vsc_scene *scene;
  if (!VSC_NEW(scene, 1)) return NULL;
  snprintf(scene->file, sizeof scene->file, "%s", file);
  scene->mesh_unit = 1;
  scene->fibers = vsc_default_fiber();
  scene->definition = vsc_default_definition();
  scene->output.frame_interval = 10;
  scene->output.signal_interval = 1;
  return scene;
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
  vsc_status status = vsc_group_convert(reading, &vsc_scene_group, slots, made);
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
  vsc_free(scene);
}
