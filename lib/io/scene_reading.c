// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/scene_reading.h"

#include <errno.h>
#include <stdarg.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/mem.h"

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

vsc_status vsc_scene_file_exists(vsc_reading *reading, const char *file)
{
  struct stat found;
  if (stat(file, &found) != 0)
    return vsc_reading_fail(reading,
                            "%s: %s; expected a file, relative names count from the "
                            "scene's folder",
                            file, strerror(errno));
  if (!S_ISREG(found.st_mode)) return vsc_reading_fail(reading, "%s: not a file", file);
  if (access(file, R_OK) != 0)
    return vsc_reading_fail(reading, "%s: %s; make it readable", file, strerror(errno));
  return VSC_OK;
}

vsc_status vsc_scene_resolve(vsc_reading *reading, const char *file, char resolved[VSC_PATH])
{
  const char *slash = strrchr(reading->file, '/');
  const int folder = file[0] == '/' || slash == NULL ? 0 : (int)(slash + 1 - reading->file);
  const int length = snprintf(resolved, VSC_PATH, "%.*s%s", folder, reading->file, file);
  if (length >= VSC_PATH)
    return vsc_reading_fail(reading, "\"%.60s...\": a file name of more than %d bytes; shorten it",
                            file, VSC_PATH - 1);
  vsc_scene *scene = reading->scene;
  if (!vsc_grow((void **)&scene->inputs, scene->input_count, scene->input_count + 1, VSC_PATH))
    return vsc_fail_memory(reading->error, "the scene");
  strcpy(scene->inputs[scene->input_count++], resolved);
  return VSC_OK;
}
