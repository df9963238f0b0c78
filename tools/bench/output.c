// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/output.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tools/run_plot.h"

static vsc_status begin(vsc_bench_output *output, const char *file, vsc_error *error)
{
  const vsc_status status = vsc_replace_begin(file, &output->table, error);
  if (status == VSC_OK) output->csv = output->table.stream;
  return status;
}

vsc_status vsc_bench_output_begin(vsc_bench_output *output, const char *folder, const char *name, const char *csv,
                                  vsc_error *error)
{
  char file[VSC_FILE_NAME + 64];
  *output = (vsc_bench_output){.folder = folder, .name = name};
  if (folder == NULL) return csv != NULL ? begin(output, csv, error) : VSC_OK;
  if (mkdir(folder, 0777) != 0 && errno != EEXIST)
    return vsc_fail(error, VSC_SYSTEM, "%s: cannot be made: %s", folder, strerror(errno));
  snprintf(file, sizeof file, "%.*s/%s.csv", VSC_FILE_NAME, folder, name);
  return begin(output, file, error);
}

vsc_status vsc_bench_output_end(vsc_bench_output *output, vsc_status status, vsc_error *error)
{
  if (output->csv == NULL) return status;
  if (status != VSC_OK) {
    vsc_replace_cancel(&output->table);
    return status;
  }
  status = vsc_replace_end(&output->table, false, error);
  if (status == VSC_OK && output->folder != NULL) vsc_bench_draw(output->folder, output->name, "--bench");
  return status;
}

void vsc_bench_draw(const char *folder, const char *name, const char *option)
{
  char csv[VSC_FILE_NAME + 64], picture[VSC_FILE_NAME + 64];
  snprintf(csv, sizeof csv, "%.*s/%s.csv", VSC_FILE_NAME, folder, name);
  snprintf(picture, sizeof picture, "%.*s/%s.png", VSC_FILE_NAME, folder, name);
  unlink(picture);  // of an earlier table
  char *words[] = {"plot", (char *)option, csv, "-o", picture, NULL};
  vsc_run_plot(words);
  vsc_bench_say_files(folder, name);
}

int vsc_bench_say_files(const char *folder, const char *name)
{
  static const char *const kinds[] = {"csv", "png"};
  int count = 0;
  for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
    char file[VSC_FILE_NAME + 64];
    snprintf(file, sizeof file, "%.*s/%s.%s", VSC_FILE_NAME, folder, name, kinds[k]);
    if (access(file, R_OK) != 0) continue;
    printf("%s%s", count++ > 0 ? ", " : "written: ", file);
  }
  if (count > 0) puts("");
  fflush(stdout);
  return count;
}
