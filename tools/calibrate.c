// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera calibrate`: the stiffness of springs in every direction, and springs for given moduli.
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "io/scene.h"
#include "io/units.h"
#include "tools/calibrate_print.h"
#include "tools/calibrate_measure.h"
#include "tools/run_plot.h"
#include "tools/scene_options.h"
#include "tools/verbs.h"

static const char help[] =
    "Usage: viscera calibrate [OPTION]... SCENE\n"
    "       viscera calibrate --young F,S,N --shear FS,SN,NF --poisson FS,SN,NF\n"
    "       viscera calibrate --young F,S,N --shear FS,SN,NF --incompressible\n"
    "       viscera calibrate --isotropic E,NU\n"
    "The first prints what the springs of a scene's materials amount to at small strain: Young's\n"
    "modulus in the axes, diagonals and over all directions, shear moduli and Poisson's ratios, "
    "in\n"
    "closed form and as measured by loading an irregular block of tets with the program's own\n"
    "forces. The others find the springs (none negative) that come nearest to wanted moduli, "
    "print\n"
    "them as a material for a scene, and what is matched and what is not as comments beside it.\n\n"
    "  -m, --material NAME     only this material of the scene\n"
    "  -s, --set KEY=VALUE     replace or add a value of the scene\n"
    "      --young F,S,N       Young's moduli along fibre, sheet and normal; one for all three\n"
    "      --shear FS,SN,NF    shear moduli, likewise\n"
    "      --poisson FS,SN,NF  Poisson's ratios: pulled along the first axis, how much thinner "
    "along\n"
    "                          the second\n"
    "      --isotropic E,NU    Young's modulus and Poisson's ratio of a material without "
    "directions\n"
    "      --incompressible    Poisson's ratios follow from Young's moduli\n"
    "      --volume-modulus K  then: what remains against compression (100 times the largest "
    "Young)\n"
    "      --axes 3|9|13       springs along f, s, n (3), the face diagonals too, the space\n"
    "                          diagonals too\n"
    "      --random N          also N random directions\n"
    "      --picture FILE.png  draw Young's modulus in the planes f-s, s-n, n-f; the numbers go "
    "to\n"
    "                          FILE.csv beside it\n"
    "  -h, --help              this text\n\n"
    "Examples:\n"
    "  viscera calibrate data/beat.yaml\n"
    "  viscera calibrate data/block.yaml --random 20 --picture muscle.png\n"
    "  # liver, shear modulus 2.14 kPa by magnetic resonance elastography (Venkatesh 2014)\n"
    "  viscera calibrate --young 6.42kPa --shear 2.14kPa --incompressible\n"
    "  # liver of a real-time simulator (AMSES 2015, doi 10.1186/s40323-015-0049-1)\n"
    "  viscera calibrate --isotropic 1.6kPa,0.48\n"
    "  # passive myocardium at small strain: Guccione's law with C = 2 kPa, b = 8, 2, 4 (Land "
    "2015)\n"
    "  viscera calibrate --young 18kPa,7.2kPa,7.2kPa --shear 4kPa,2kPa,4kPa --incompressible\n"
    "  # two independent Poisson couplings: what three axes leave open, nine match\n"
    "  viscera calibrate --young 10kPa,4kPa,3kPa --shear 3kPa,2kPa,3kPa --poisson 0.3,0.2,0.1 "
    "--axes 9\n";

typedef struct request {
  vsc_scene_options scene;
  const char *material, *picture;
  bool young, shear, poisson, isotropic, incompressible;
  vsc_moduli moduli;
  bool volume_given;
  double volume_modulus;
  int axes;  // 0: not given
  int random;
} request;

static int fail(const vsc_error *error)
{
  fprintf(stderr, "viscera: calibrate: %s\n", error->text);
  return (int)error->status;
}

// ---- options

// Reads `text` as `count` values with commas between them; one value stands for all where `alike`.
static vsc_status read_list(const char *option, const char *text, const vsc_quantity *quantity,
                            int count, bool alike, double *values, vsc_error *error)
{
  char copy[256];
  int found = 0;
  snprintf(copy, sizeof copy, "%s", text);
  for (char *rest = copy, *item; (item = strsep(&rest, ",")) != NULL; found++) {
    vsc_error reason;
    if (found < count && vsc_units_read(item, quantity[found], &values[found], &reason) != VSC_OK)
      return vsc_fail(error, VSC_INPUT, "--%s %s: %s", option, text, reason.text);
  }
  if (found == 1 && alike)
    for (; found < count; found++) values[found] = values[0];
  if (found == count) return VSC_OK;
  return vsc_fail(error, VSC_INPUT, "--%s %s: %d values, expected %d with commas between them",
                  option, text, found, count);
}

static vsc_status read_isotropic(request *wish, vsc_error *error)
{
  static const vsc_quantity quantity[2] = {VSC_PRESSURE, VSC_NUMBER};
  double values[2];
  wish->isotropic = true;
  const vsc_status status = read_list("isotropic", optarg, quantity, 2, false, values, error);
  return status != VSC_OK ? status
                          : vsc_moduli_isotropic(values[0], values[1], &wish->moduli, error);
}

static vsc_status read_whole(const char *option, int low, int high, int *value, vsc_error *error)
{
  char *end;
  const long number = strtol(optarg, &end, 10);
  if (end == optarg || *end != '\0' || number < low || number > high)
    return vsc_fail(error, VSC_INPUT, "--%s %s: expected a whole number from %d to %d", option,
                    optarg, low, high);
  *value = (int)number;
  return VSC_OK;
}

static vsc_status read_axes(request *wish, vsc_error *error)
{
  if (read_whole("axes", 3, 13, &wish->axes, error) != VSC_OK) return VSC_INPUT;
  if (wish->axes == 3 || wish->axes == 9 || wish->axes == 13) return VSC_OK;
  return vsc_fail(
      error, VSC_INPUT,
      "--axes %d: expected 3 (f, s, n), 9 (and the face diagonals) or 13 (and the space "
      "diagonals)",
      wish->axes);
}

static vsc_status keep_picture(request *wish, vsc_error *error)
{
  const char *dot = strrchr(optarg, '.');
  wish->picture = optarg;
  if (dot != NULL && strcmp(dot, ".png") == 0 && strlen(optarg) < VSC_PATH) return VSC_OK;
  return vsc_fail(error, VSC_INPUT, "--picture %s: expected a file name that ends in .png", optarg);
}

static vsc_status read_option(int option, request *wish, vsc_error *error)
{
  static const vsc_quantity moduli[3] = {VSC_PRESSURE, VSC_PRESSURE, VSC_PRESSURE};
  static const vsc_quantity ratios[3] = {VSC_NUMBER, VSC_NUMBER, VSC_NUMBER};
  switch (option) {
    case 'y':
      wish->young = true;
      return read_list("young", optarg, moduli, 3, true, wish->moduli.young, error);
    case 'g':
      wish->shear = true;
      return read_list("shear", optarg, moduli, 3, true, wish->moduli.shear, error);
    case 'p':
      wish->poisson = true;
      return read_list("poisson", optarg, ratios, 3, true, wish->moduli.poisson, error);
    case 'i':
      return read_isotropic(wish, error);
    case 'k':
      wish->volume_given = true;
      return read_list("volume-modulus", optarg, moduli, 1, true, &wish->volume_modulus, error);
    case 'a':
      return read_axes(wish, error);
    case 'r':
      return read_whole("random", 0, 1000000, &wish->random, error);
    case 'P':
      return keep_picture(wish, error);
    case 'I':
      wish->incompressible = true;
      return VSC_OK;
    case 'm':
      wish->material = optarg;
      return VSC_OK;
    default:
      return vsc_fail(error, VSC_INPUT, "`viscera calibrate --help` lists the options");
  }
}

// What was asked for must be one of the four forms.
static vsc_status check_form(const request *wish, vsc_error *error)
{
  const bool given = wish->young || wish->shear || wish->poisson;
  if (wish->scene.scene != NULL) {
    if (wish->axes != 0) return vsc_fail(error, VSC_INPUT, "--axes is for moduli, not for a scene");
    if (!given && !wish->isotropic && !wish->incompressible && !wish->volume_given) return VSC_OK;
    return vsc_fail(error, VSC_INPUT, "give a scene or moduli, not both");
  }
  if (wish->material != NULL || wish->scene.setting_count > 0)
    return vsc_fail(error, VSC_INPUT, "--material and --set belong to a scene");
  if (wish->isotropic && !given && !wish->incompressible && !wish->volume_given)
    return VSC_OK;
  if (wish->isotropic)
    return vsc_fail(error, VSC_INPUT,
                    "--isotropic says it all: leave out --young, --shear, "
                    "--poisson, --incompressible and --volume-modulus");
  if (!wish->young || !wish->shear)
    return vsc_fail(error, VSC_INPUT,
                    "give a scene, --isotropic, or --young and --shear; `viscera calibrate --help` "
                    "tells more");
  if (wish->poisson == wish->incompressible)
    return vsc_fail(error, VSC_INPUT, "give either --poisson or --incompressible");
  if (wish->volume_given && !wish->incompressible)
    return vsc_fail(error, VSC_INPUT,
                    "--volume-modulus: it follows from --poisson; give it with --incompressible");
  return VSC_OK;
}

// ---- what is done

// Has viscera-plot draw the curves, which are written beside the picture.
static vsc_status draw(const request *wish, const vsc_answer *answer, const char *title,
                       vsc_error *error)
{
  char csv[VSC_PATH];
  snprintf(csv, sizeof csv, "%.*s.csv", (int)strlen(wish->picture) - 4, wish->picture);
  const vsc_status status = vsc_write_polar(csv, answer, error);
  if (status != VSC_OK) return status;
  char *arguments[] = {"viscera: plot",       "--polar", csv, "--title", (char *)title, "-o",
                       (char *)wish->picture, NULL};
  const int code = vsc_run_plot(arguments);
  if (code == 0) return VSC_OK;
  return vsc_fail(error, (vsc_status)code, "%s: not drawn; the curves are in %s", wish->picture,
                  csv);
}

static vsc_status describe(const request *wish, const vsc_material_def *material,
                           vsc_volume_kind volume, vsc_error *error)
{
  double C[36], S[36], measured[36];
  vsc_status status = vsc_stiffness_of(material, volume, C, error);
  if (status == VSC_OK) status = vsc_invert_six(C, S, error);
  if (status == VSC_OK) status = vsc_measure_compliance(material, volume, measured, error);
  if (status != VSC_OK) return status;
  const vsc_answer answer = {.springs = S, .measured = measured};
  printf("%s, at rest%s%s\n", material->name,
         material->active.kind != VSC_ACTIVE_NONE ? ", not activated" : "",
         material->inclusion_count > 0 ? ", without its inclusions" : "");
  vsc_print_table(stdout, "", &answer, wish->random);
  return wish->picture != NULL ? draw(wish, &answer, material->name, error) : VSC_OK;
}

static vsc_status describe_scene(const request *wish, vsc_error *error)
{
  vsc_scene *scene = NULL;
  const vsc_scene_options *options = &wish->scene;
  vsc_status status =
      vsc_scene_read(options->scene, options->settings, options->setting_count, &scene, error);
  if (status != VSC_OK) return status;
  const vsc_definition *definition = &scene->definition;
  size_t found = 0, described = 0;
  if (wish->picture != NULL && wish->material == NULL && definition->material_count > 1)
    status = vsc_fail(error, VSC_INPUT, "--picture: %s has %zu materials: choose one by --material",
                      options->scene, definition->material_count);
  for (size_t m = 0; status == VSC_OK && m < definition->material_count; m++) {
    const vsc_material_def *material = &definition->materials[m];
    if (wish->material != NULL && strcmp(wish->material, material->name) != 0) continue;
    if (found++ > 0) putchar('\n');
    status = describe(wish, material, definition->volume, error);
    described += status == VSC_OK;
    if (status != VSC_INPUT || wish->material != NULL || definition->material_count == 1) continue;
    fprintf(stderr, "viscera: calibrate: %s\n", error->text);  // another law: other materials follow
    status = VSC_OK;
  }
  if (status == VSC_OK && found > 0 && described == 0)
    status = vsc_fail(error, VSC_INPUT, "%s: none of its materials can be described",
                      options->scene);
  if (status == VSC_OK && found == 0)
    status = vsc_fail(error, VSC_INPUT, "--material %s: %s has no such material", wish->material,
                      options->scene);
  vsc_scene_free(scene);
  return status;
}

// The springs for the wanted moduli: the incompressible limit in closed form where three axes
// do, else the nearest ones.
static vsc_status find_springs(request *wish, vsc_spring_constants *springs, vsc_error *error)
{
  vsc_moduli *moduli = &wish->moduli;
  const int axes = wish->axes == 0 ? 3 : wish->axes;
  if (!wish->incompressible) return vsc_calibrate(moduli, axes, springs, error);
  const double *Y = moduli->young;
  if (!wish->volume_given) wish->volume_modulus = 100 * fmax(Y[0], fmax(Y[1], Y[2]));
  *springs = (vsc_spring_constants){.volume_modulus = wish->volume_modulus};
  memcpy(springs->angular, moduli->shear, sizeof springs->angular);
  vsc_status status = vsc_moduli_incompressible(wish->volume_modulus, moduli, error);
  if (status == VSC_OK) status = vsc_axial_incompressible(Y, springs->axial, error);
  if (status != VSC_OK) return status;
  if (axes > 3 || fmin(springs->axial[0], fmin(springs->axial[1], springs->axial[2])) < 0)
    return vsc_calibrate(moduli, axes, springs, error);
  return vsc_compare_springs(moduli, springs, error);
}

static void print_verdict(const vsc_spring_constants *springs)
{
  const double least = springs->least_energy, most = springs->most_energy;
  if (least > 1 - 1e-6 && most < 1 + 1e-6)
    puts("  # matched exactly");
  else
    printf(
        "  # not matched exactly: depending on the strain, the springs store %.4g to %.4g times "
        "the "
        "wanted energy\n",
        least, most);
  puts("  # at small strain:");
}

static vsc_status answer_wish(request *wish, vsc_error *error)
{
  double wanted[36], C[36], S[36], measured[36];
  vsc_spring_constants springs;
  vsc_material_def material = {0};
  vsc_status status = find_springs(wish, &springs, error);
  if (status == VSC_OK) status = vsc_material_of_springs(&springs, &material, error);
  if (status != VSC_OK) return status;
  vsc_copy_name(material.name, "tissue");
  vsc_moduli_compliance(&wish->moduli, wanted);
  status = vsc_stiffness_of(&material, VSC_VOLUME_ELEMENT, C, error);
  if (status == VSC_OK) status = vsc_invert_six(C, S, error);
  if (status == VSC_OK)
    status = vsc_measure_compliance(&material, VSC_VOLUME_ELEMENT, measured, error);
  if (status == VSC_OK) {
    const vsc_answer answer = {.wanted = wanted, .springs = S, .measured = measured};
    vsc_print_material(stdout, &material);
    print_verdict(&springs);
    vsc_print_table(stdout, "  # ", &answer, wish->random);
    if (wish->picture != NULL) status = draw(wish, &answer, "springs for given moduli", error);
  }
  vsc_free(material.axes);
  return status;
}

int vsc_verb_calibrate(int argc, char **argv)
{
  static const struct option options[] = {{"material", required_argument, NULL, 'm'},
                                          {"set", required_argument, NULL, 's'},
                                          {"young", required_argument, NULL, 'y'},
                                          {"shear", required_argument, NULL, 'g'},
                                          {"poisson", required_argument, NULL, 'p'},
                                          {"isotropic", required_argument, NULL, 'i'},
                                          {"incompressible", no_argument, NULL, 'I'},
                                          {"volume-modulus", required_argument, NULL, 'k'},
                                          {"axes", required_argument, NULL, 'a'},
                                          {"random", required_argument, NULL, 'r'},
                                          {"picture", required_argument, NULL, 'P'},
                                          {"help", no_argument, NULL, 'h'},
                                          {0}};
  request wish = {0};
  vsc_error error;
  for (int c; (c = getopt_long(argc, argv, "m:s:h", options, NULL)) != -1;) {
    if (c == 'h') return fputs(help, stdout) < 0 ? VSC_SYSTEM : VSC_OK;
    if (c == 's') {
      if (vsc_keep_setting(&wish.scene, optarg) != 0) return VSC_INPUT;
    } else if (read_option(c, &wish, &error) != VSC_OK) {
      return fail(&error);
    }
  }
  if (argc - optind > 1) {
    vsc_fail(&error, VSC_INPUT, "%s: one scene is enough", argv[optind + 1]);
    return fail(&error);
  }
  wish.scene.scene = argv[optind];
  vsc_status status = check_form(&wish, &error);
  if (status == VSC_OK)
    status = wish.scene.scene != NULL ? describe_scene(&wish, &error) : answer_wish(&wish, &error);
  return status == VSC_OK ? VSC_OK : fail(&error);
}
