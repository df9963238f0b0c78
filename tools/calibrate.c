// SPDX-License-Identifier: GPL-3.0-or-later
// viscera calibrate: what springs are equivalent to in every direction, and the springs of a material.
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "io/scene.h"
#include "io/units.h"
#include "model/calibration.h"
#include "tools/calibrate_measure.h"
#include "tools/run_plot.h"
#include "tools/verbs.h"

static const char help[] =
    "Usage: viscera calibrate [OPTION]... SCENE\n"
    "       viscera calibrate [OPTION]... --isotropic E,NU\n"
    "       viscera calibrate [OPTION]... --young Yf,Ys,Yn --shear Gfs,Gsn,Gnf --poisson Nfs,Nsn,Nnf\n"
    "With a scene: the elastic constants that its materials' springs are equivalent to at small "
    "strain,\n"
    "in closed form and measured on a block of irregular tets. With constants: the springs that come\n"
    "nearest to them, as lines for a scene, and what they reach of what was wanted.\n\n"
    "      --young A,B,C        Young's moduli along fibre, sheet, normal: 10 kPa,4 kPa,3 kPa\n"
    "      --shear A,B,C        shear moduli fs, sn, nf\n"
    "      --poisson A,B,C      nu_fs, nu_sn, nu_nf (along b over along a, pulled along a)\n"
    "      --isotropic E,NU     Young's modulus and Poisson's ratio\n"
    "      --incompressible K   in place of --poisson: with the volume modulus K, which is large\n"
    "      --axes 3|9|13        springs along f, s, n; also along the face diagonals; and the space\n"
    "                           diagonals of the frame [3]\n"
    "      --random N           Young's modulus measured in N random directions too\n"
    "      --picture FILE.png   Young's modulus in the planes f-s, s-n and n-f, as a picture\n"
    "  -h, --help               this text\n\n"
    "Examples:\n"
    "  viscera calibrate data/beat.yaml\n"
    "  viscera calibrate --isotropic '1.6 kPa,0.48'                     liver (1.6 kPa, 0.48)\n"
    "  viscera calibrate --young '16 kPa,8 kPa,6 kPa' --shear '4 kPa,2 kPa,4 kPa' --incompressible "
    "'1 MPa'\n";

typedef struct wish {
  vsc_orthotropic constants;
  double volume_modulus;
  bool young, shear, poisson, incompressible;
  vsc_calibration_axes axes;
  long random;
  const char *picture, *scene;
} wish;

// ---- reading

// `count` quantities with commas between them.
static bool read_list(const char *option, const char *text, vsc_quantity quantity, int count,
                      double *values)
{
  char copy[256], *rest = copy;
  vsc_error error;
  snprintf(copy, sizeof copy, "%s", text);
  for (int i = 0; i < count; i++) {
    char *item = strsep(&rest, ",");
    if (item == NULL || (i + 1 == count && rest != NULL)) {
      fprintf(stderr, "viscera calibrate: --%s '%s': expected %d values with commas between them\n",
              option, text, count);
      return false;
    }
    while (*item == ' ') item++;
    if (vsc_units_read(item, quantity, &values[i], &error) != VSC_OK) {
      fprintf(stderr, "viscera calibrate: --%s '%s': %s\n", option, text, error.text);
      return false;
    }
  }
  return true;
}

static bool read_isotropic(const char *text, wish *w)
{
  char copy[256], *rest = copy;
  double young, poisson;
  snprintf(copy, sizeof copy, "%s", text);
  const char *first = strsep(&rest, ",");
  if (rest == NULL) {
    fprintf(stderr, "viscera calibrate: --isotropic '%s': expected such as '10 kPa,0.45'\n", text);
    return false;
  }
  if (!read_list("isotropic", first, VSC_PRESSURE, 1, &young) ||
      !read_list("isotropic", rest, VSC_NUMBER, 1, &poisson))
    return false;
  w->constants = vsc_isotropic(young, poisson);
  w->young = w->shear = w->poisson = true;
  return true;
}

enum { YOUNG = 256, SHEAR, POISSON, ISOTROPIC, INCOMPRESSIBLE, AXES, RANDOM, PICTURE };

static bool read_option(int option, const char *text, wish *w)
{
  switch (option) {
    case YOUNG: return w->young = read_list("young", text, VSC_PRESSURE, 3, w->constants.young);
    case SHEAR: return w->shear = read_list("shear", text, VSC_PRESSURE, 3, w->constants.shear);
    case POISSON:
      return w->poisson = read_list("poisson", text, VSC_NUMBER, 3, w->constants.poisson);
    case ISOTROPIC: return read_isotropic(text, w);
    case INCOMPRESSIBLE:
      return w->incompressible =
                 read_list("incompressible", text, VSC_PRESSURE, 1, &w->volume_modulus);
    case AXES:
      w->axes = (vsc_calibration_axes)strtol(text, NULL, 10);
      if (w->axes == VSC_THREE_AXES || w->axes == VSC_NINE_AXES || w->axes == VSC_THIRTEEN_AXES)
        return true;
      fprintf(stderr, "viscera calibrate: --axes '%s': expected 3, 9 or 13\n", text);
      return false;
    case RANDOM:
      w->random = strtol(text, NULL, 10);
      if (w->random > 0 && w->random <= 10000) return true;
      fprintf(stderr, "viscera calibrate: --random '%s': expected a number from 1 to 10000\n", text);
      return false;
    default:
      w->picture = text;
      return true;
  }
}

static int read_arguments(int argc, char **argv, wish *w, bool *helped)
{
  static const struct option options[] = {
      {"young", required_argument, NULL, YOUNG},
      {"shear", required_argument, NULL, SHEAR},
      {"poisson", required_argument, NULL, POISSON},
      {"isotropic", required_argument, NULL, ISOTROPIC},
      {"incompressible", required_argument, NULL, INCOMPRESSIBLE},
      {"axes", required_argument, NULL, AXES},
      {"random", required_argument, NULL, RANDOM},
      {"picture", required_argument, NULL, PICTURE},
      {"help", no_argument, NULL, 'h'},
      {0}};
  for (int c; (c = getopt_long(argc, argv, "h", options, NULL)) != -1;) {
    if (c == 'h') {
      *helped = true;
      return fputs(help, stdout) < 0 ? VSC_SYSTEM : VSC_OK;
    }
    if (c == '?' || !read_option(c, optarg, w)) return VSC_INPUT;
  }
  w->scene = optind < argc ? argv[optind] : NULL;
  const bool constants = w->young && w->shear && (w->poisson || w->incompressible);
  const bool some = w->young || w->shear || w->poisson || w->incompressible;
  if (optind + 1 >= argc && (w->scene != NULL ? !some : constants)) return VSC_OK;
  fputs(
      "viscera calibrate: give one scene, or --isotropic, or --young and --shear with --poisson or "
      "--incompressible; see `viscera calibrate --help`\n",
      stderr);
  return VSC_INPUT;
}

// ---- tables

static void print_constants(const vsc_orthotropic *got, const vsc_orthotropic *wanted)
{
  static const char *const names[9] = {"Y_f", "Y_s", "Y_n", "G_fs", "G_sn", "G_nf",
                                       "nu_fs", "nu_sn", "nu_nf"};
  const double *of_got = got->young, *of_wanted = wanted ? wanted->young : NULL;
  printf("  %-8s%12s", "", "springs");
  puts(wanted ? "      wanted   difference" : "");
  for (int k = 0; k < 9; k++) {
    printf("  %-8s%12.6g", names[k], of_got[k]);
    if (wanted)
      printf("%12.6g  %+9.3f %s", of_wanted[k],
             k < 6 ? 100 * (of_got[k] / of_wanted[k] - 1) : of_got[k] - of_wanted[k],
             k < 6 ? "%" : "");
    printf("%s\n", k < 6 ? (wanted ? "" : " kPa") : "");
  }
}
_Static_assert(sizeof(vsc_orthotropic) == 9 * sizeof(double), "read as nine numbers above");

static void print_directions(const double S[36], const vsc_sample *sample)
{
  printf("  Young's modulus, kPa       closed form    measured\n");
  for (int k = 0; k < VSC_DIRECTIONS; k++) {
    const vsc_named_direction direction = vsc_direction(k);
    printf("  along %-20s%12.6g%12.6g\n", direction.name, vsc_young(S, direction.d),
           vsc_sample_young(sample, direction.d));
  }
  const vsc_young_range range = vsc_young_over_sphere(S);
  printf("  over all directions     least %.6g, mean %.6g, most %.6g: anisotropy %.4g\n", range.low,
         range.mean, range.high, range.high / range.low);
}

static void print_random(const double S[36], const vsc_sample *sample, long count)
{
  double worst = 0;
  srand(1);
  for (long k = 0; k < count; k++) {
    double d[3];
    do
      for (int i = 0; i < 3; i++) d[i] = 2 * ((double)rand() / RAND_MAX) - 1;
    while (vsc_norm(d) > 1 || vsc_norm(d) < 0.1);
    vsc_normalize(d);
    const double closed = vsc_young(S, d), measured = vsc_sample_young(sample, d);
    printf("  along (%6.3f, %6.3f, %6.3f)  %12.6g%12.6g\n", d[0], d[1], d[2], closed, measured);
    worst = fmax(worst, fabs(measured / closed - 1));
  }
  if (count > 0) printf("  measured and closed form differ by %.2g at most\n", worst);
}

// CSV of Young's modulus round the three planes: angle, closed and wanted in each; then the picture
// program draws it.
static vsc_status draw(const wish *w, const double S[36], const double *wanted,
                       const vsc_sample *sample, vsc_error *error)
{
  char table[4096];
  if (w->picture == NULL) return VSC_OK;
  snprintf(table, sizeof table, "%s.csv", w->picture);
  FILE *file = fopen(table, "w");
  if (file == NULL) return vsc_fail(error, VSC_SYSTEM, "%s: cannot be written", table);
  fputs("angle [deg],closed f-s,closed s-n,closed n-f,measured f-s,measured s-n,measured n-f", file);
  fputs(wanted ? ",wanted f-s,wanted s-n,wanted n-f\n" : "\n", file);
  for (int angle = 0; angle <= 360; angle += 5) {
    double closed[3], measured[3], target[3];
    for (int p = 0; p < 3; p++) {
      double d[3] = {0};
      d[p] = cos(angle * M_PI / 180);
      d[(p + 1) % 3] = sin(angle * M_PI / 180);
      closed[p] = vsc_young(S, d);
      measured[p] = vsc_sample_young(sample, d);
      target[p] = wanted ? vsc_young(wanted, d) : 0;
    }
    fprintf(file, "%d", angle);
    for (int p = 0; p < 3; p++) fprintf(file, ",%.8g", closed[p]);
    for (int p = 0; p < 3; p++) fprintf(file, ",%.8g", measured[p]);
    for (int p = 0; p < 3 && wanted; p++) fprintf(file, ",%.8g", target[p]);
    fputc('\n', file);
  }
  if (fclose(file) != 0) return vsc_fail(error, VSC_SYSTEM, "%s: cannot be written", table);
  char *arguments[] = {"viscera-plot", "--polar", table, "-o", (char *)w->picture, NULL};
  const int code = vsc_run_plot(arguments);
  remove(table);
  if (code != 0) return vsc_fail(error, (vsc_status)code, "%s: could not be drawn", w->picture);
  printf("  picture: %s\n", w->picture);
  return VSC_OK;
}

// The tables of one material; `wanted` may be NULL.
static vsc_status print_material(const wish *w, const vsc_material_def *material,
                                 vsc_volume_kind volume, const vsc_orthotropic *wanted,
                                 vsc_error *error)
{
  double C[36], S[36], S_wanted[36];
  vsc_sample *sample = NULL;
  vsc_status status = vsc_stiffness_of(material, volume, C, error);
  if (status == VSC_OK) status = vsc_invert_six(C, S, error);
  if (status == VSC_OK && wanted) status = vsc_compliance_of(wanted, S_wanted, error);
  if (status == VSC_OK) status = vsc_sample_open(material, volume, &sample, error);
  if (status != VSC_OK) return status;
  const vsc_orthotropic got = vsc_constants_of(S);
  print_constants(&got, wanted);
  print_directions(S, sample);
  print_random(S, sample, w->random);
  status = draw(w, S, wanted ? S_wanted : NULL, sample, error);
  vsc_sample_close(sample);
  return status;
}

// ---- the two ways

static vsc_status describe_scene(const wish *w, vsc_error *error)
{
  vsc_scene *scene;
  vsc_status status = vsc_scene_read(w->scene, NULL, 0, &scene, error);
  if (status != VSC_OK) return status;
  const vsc_definition *d = &scene->definition;
  for (size_t m = 0; m < d->material_count && status == VSC_OK; m++) {
    printf("material %s\n", d->materials[m].name);
    status = print_material(w, &d->materials[m], d->volume, NULL, error);
  }
  vsc_scene_free(scene);
  return status;
}

static void print_springs(const vsc_material_def *m)
{
  printf("axial:   {f: %.6g kPa, s: %.6g kPa, n: %.6g kPa}\n", m->axial[0], m->axial[1], m->axial[2]);
  printf("angular: {fs: %.6g kPa, sn: %.6g kPa, nf: %.6g kPa}\n", m->angular[0], m->angular[1],
         m->angular[2]);
  printf("volume_modulus: %.6g kPa\n", m->volume_modulus);
  if (m->axis_count > 0) puts("axes:");
  for (size_t k = 0; k < m->axis_count; k++)
    printf("  - {direction: [%g, %g, %g], modulus: %.6g kPa}\n", m->axes[k].direction[0],
           m->axes[k].direction[1], m->axes[k].direction[2], m->axes[k].modulus);
}

static vsc_status find_springs(const wish *w, vsc_error *error)
{
  vsc_material_def material = vsc_default_material();
  vsc_orthotropic wanted = w->constants;
  double residual = 0, S[36], C[36];
  vsc_copy_name(material.name, "wanted");
  vsc_status status =
      w->incompressible
          ? vsc_calibrate_incompressible(&wanted, w->volume_modulus, &material, error)
          : vsc_calibrate(&wanted, w->axes, &material, &residual, error);
  if (status == VSC_OK && w->incompressible) {
    // Poisson's ratios were not asked for: those that the springs have
    status = vsc_stiffness_of(&material, VSC_VOLUME_ELEMENT, C, error);
    if (status == VSC_OK) status = vsc_invert_six(C, S, error);
    if (status == VSC_OK)
      memcpy(wanted.poisson, vsc_constants_of(S).poisson, sizeof wanted.poisson);
  }
  if (status == VSC_OK) {
    print_springs(&material);
    printf("# %s\n", residual < 1e-9 ? "exact" : "as near as springs of positive modulus come");
    if (residual >= 1e-9)
      printf("# what is left of the stiffness, seen from the wanted one: %.3g of %.3g\n", residual,
             sqrt(6));
    status = print_material(w, &material, VSC_VOLUME_ELEMENT, &wanted, error);
  }
  vsc_free(material.axes);
  return status;
}

int vsc_verb_calibrate(int argc, char **argv)
{
  wish w = {.axes = VSC_THREE_AXES};
  bool helped = false;
  vsc_error error;
  const int code = read_arguments(argc, argv, &w, &helped);
  if (code != VSC_OK || helped) return code;
  const vsc_status status = w.scene ? describe_scene(&w, &error) : find_springs(&w, &error);
  if (status != VSC_OK) fprintf(stderr, "viscera calibrate: %s\n", error.text);
  return (int)status;
}
