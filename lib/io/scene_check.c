// SPDX-License-Identifier: GPL-3.0-or-later
// What can be said about a scene before its mesh is read: files, names, ranges.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/vec3.h"
#include "io/scene_reading.h"

#define SHORTEST_INTERVAL 1e-9  // between rows, frames, checkpoints: of time.end

vsc_status vsc_selector_finish(vsc_reading *reading, const vsc_slot *slots, void *target)
{
  const vsc_selector *selector = target;
  (void)slots;
  if ((int)selector->kind < 0)
    return vsc_reading_fail(reading,
                            "says not where; give node_array, triangle_array, box, plane "
                            "or boundary (a node set also: surface)");
  const bool array =
      selector->kind == VSC_SELECT_NODE_ARRAY || selector->kind == VSC_SELECT_TRIANGLE_ARRAY;
  if (array && isnan(selector->low))
    return vsc_reading_fail(reading,
                            "an array without value or range; give value: 1 or range: "
                            "[0.5, 1.5]");
  return VSC_OK;
}

// Fails for `key` unless it holds the name of a surface.
static vsc_status need_surface(vsc_reading *reading, const vsc_definition *d, const char *name)
{
  const char *names[65] = {"boundary"};
  size_t count = 1;
  if (strcmp(name, names[0]) == 0) return VSC_OK;
  for (size_t i = 0; i < d->surface_count; i++) {
    if (strcmp(name, d->surfaces[i].name) == 0) return VSC_OK;
    if (count < 65) names[count++] = d->surfaces[i].name;
  }
  const char *nearest = vsc_nearest(name, names, count);
  return vsc_reading_fail(reading, "no surface is named \"%s\"%s%s; define it under surfaces", name,
                          nearest != NULL ? ", the nearest is " : "",
                          nearest != NULL ? nearest : "");
}

static vsc_status check_mesh(vsc_reading *reading, const vsc_scene *scene)
{
  vsc_enter(reading, "mesh.file");
  const vsc_status status = vsc_scene_file_exists(reading, scene->mesh_file);
  if (status != VSC_OK) return status;
  vsc_leave(reading, 0);
  vsc_enter(reading, "mesh.order");
  if (scene->mesh_order != 1 && scene->mesh_order != 2)
    return vsc_reading_fail(reading, "%d; expected 1 (elements as the file has them) or 2 (quadratic "
                            "tetrahedra)", scene->mesh_order);
  vsc_leave(reading, 0);
  for (size_t i = 0; i < scene->curved_count; i++) {
    const vsc_curved_def *curved = &scene->curved[i];
    vsc_enter(reading, "mesh.curved");
    vsc_enter_item(reading, i);
    const size_t length = vsc_enter(reading, "surface");
    const vsc_status known = need_surface(reading, &scene->definition, curved->surface);
    if (known != VSC_OK) return known;
    vsc_leave(reading, length);
    vsc_enter(reading, "ellipsoid.radii");
    for (int a = 0; a < 3; a++)
      if (!(curved->radii[a] > 0))
        return vsc_reading_fail(reading, "%g mm; expected lengths above zero", curved->radii[a]);
    vsc_leave(reading, 0);
  }
  return VSC_OK;
}

static vsc_status check_wall(vsc_reading *reading, const vsc_definition *d, const char *key,
                             const char *name, double angle)
{
  char angle_key[16];
  snprintf(angle_key, sizeof angle_key, "%s_angle", key);
  const size_t length = vsc_enter(reading, key);
  const vsc_status status = need_surface(reading, d, name);
  if (status != VSC_OK) return status;
  vsc_leave(reading, length);
  vsc_enter(reading, angle_key);
  if (!(fabs(angle) <= M_PI / 2))
    return vsc_reading_fail(reading, "%g deg; expected -90 deg to 90 deg", angle * 180 / M_PI);
  vsc_leave(reading, length);
  return VSC_OK;
}

static vsc_status check_helix(vsc_reading *reading, const vsc_scene *scene)
{
  const vsc_fiber_def *fibers = &scene->fibers;
  const size_t length = vsc_enter(reading, "fibers.helix");
  vsc_status status =
      check_wall(reading, &scene->definition, "endo", fibers->endo, fibers->endo_angle);
  if (status == VSC_OK)
    status = check_wall(reading, &scene->definition, "epi", fibers->epi, fibers->epi_angle);
  if (status != VSC_OK) return status;
  vsc_enter(reading, "long_axis");
  if (!(vsc_norm(fibers->long_axis) > 0))
    return vsc_reading_fail(reading, "zero; expected a vector from apex to base");
  vsc_leave(reading, length);
  return VSC_OK;
}

static vsc_status check_ellipsoid(vsc_reading *reading, const vsc_scene *scene)
{
  const vsc_fiber_def *fibers = &scene->fibers;
  const size_t length = vsc_enter(reading, "fibers.ellipsoid");
  if (fibers->ellipsoid.epi_radius == 0)
    return vsc_reading_fail(reading, "missing; source: ellipsoid needs its radii and lengths");
  if (fibers->endo[0] == '\0' && fibers->epi[0] == '\0') return VSC_OK;
  vsc_status status =
      check_wall(reading, &scene->definition, "endo", fibers->endo, fibers->endo_angle);
  if (status == VSC_OK)
    status = check_wall(reading, &scene->definition, "epi", fibers->epi, fibers->epi_angle);
  if (status == VSC_OK) vsc_leave(reading, length);
  return status;
}

static vsc_status check_fibers(vsc_reading *reading, const vsc_scene *scene)
{
  vsc_status status = VSC_OK;
  if (scene->fibers.source == VSC_FIBER_MAP) {
    vsc_enter(reading, "fibers.map.file");
    if (scene->fibers.map.file[0] == '\0')
      return vsc_reading_fail(reading, "missing; give the image of the angles: angles.vti");
    status = vsc_scene_file_exists(reading, scene->fibers.map.file);
  } else if (scene->fibers.source == VSC_FIBER_CONSTANT) {
    vsc_enter(reading, "fibers.constant.fiber");
    if (!(vsc_norm(scene->fibers.direction) > 0))
      return vsc_reading_fail(reading, "zero or missing; expected a direction such as [1, 0, 0]");
  } else if (scene->fibers.source == VSC_FIBER_HELIX) {
    status = check_helix(reading, scene);
  } else if (scene->fibers.source == VSC_FIBER_ELLIPSOID) {
    status = check_ellipsoid(reading, scene);
  }
  if (status == VSC_OK) vsc_leave(reading, 0);
  return status;
}

static vsc_status check_vessels(vsc_reading *reading, const vsc_definition *d)
{
  for (size_t i = 0; i < d->vessel_count; i++) {
    vsc_enter(reading, "vessels");
    vsc_enter_item(reading, i);
    vsc_enter(reading, "file");
    const vsc_status status = vsc_scene_file_exists(reading, d->vessels[i].file);
    if (status != VSC_OK) return status;
    vsc_leave(reading, 0);
  }
  return VSC_OK;
}

// What comes more often than a run could ever write it is a slip of the unit.
static vsc_status check_interval(vsc_reading *reading, const char *key, double value, bool zero, double end)
{
  vsc_enter(reading, key);
  if (value < 0 || (value == 0 && !zero))
    return vsc_reading_fail(reading, "%g ms; expected %s", value,
                            zero ? "a time, or 0 ms for only at the end" : "a time above zero");
  if (value > 0 && value < SHORTEST_INTERVAL * end)
    return vsc_reading_fail(reading, "%g ms; expected %g ms at least, a thousand-millionth of time.end", value,
                            SHORTEST_INTERVAL * end);
  vsc_leave(reading, 0);
  return VSC_OK;
}

// Names are columns of a table: none twice, nothing in them that would end a cell.
static vsc_status check_point(vsc_reading *reading, const vsc_output_def *output, size_t i)
{
  const vsc_point_def *point = &output->points[i];
  vsc_enter(reading, "output.points");
  const size_t list = vsc_enter_item(reading, i);
  if (output->point_count > VSC_OUTPUT_POINTS) {
    vsc_leave(reading, list);
    return vsc_reading_fail(reading, "%zu of them; expected at most %d", output->point_count,
                            VSC_OUTPUT_POINTS);
  }
  vsc_enter(reading, "name");
  if (point->name[0] == '\0' || !vsc_name_is_plain(point->name))
    return vsc_reading_fail(reading, "\"%s\"; expected a name without commas, brackets, quotes and backslashes",
                            point->name);
  for (size_t k = 0; k < i; k++)
    if (strcmp(output->points[k].name, point->name) == 0)
      return vsc_reading_fail(reading, "\"%s\" names another point too; choose another name",
                              point->name);
  vsc_leave(reading, 0);
  return VSC_OK;
}

// A helix angle needs an axis: its own, or that of the fibres.
static vsc_status check_arrays(vsc_reading *reading, const vsc_scene *scene)
{
  const vsc_output_def *output = &scene->output;
  if (vsc_norm(output->axis) > 0 || scene->fibers.source == VSC_FIBER_HELIX) return VSC_OK;
  for (size_t i = 0; i < output->array_count; i++) {
    if (strcmp(output->arrays[i], "helix_angle") != 0) continue;
    vsc_enter(reading, "output.arrays");
    vsc_enter_item(reading, i);
    return vsc_reading_fail(reading, "helix_angle without an axis; give output.axis, from apex to "
                                     "base: [0, 0, 1]");
  }
  return VSC_OK;
}

static vsc_status check_output(vsc_reading *reading, const vsc_scene *scene)
{
  const vsc_output_def *output = &scene->output;
  const double end = scene->definition.end_time;
  vsc_status status = check_interval(reading, "output.frames", output->frame_interval, false, end);
  if (status == VSC_OK)
    status = check_interval(reading, "output.signals", output->signal_interval, false, end);
  if (status == VSC_OK)
    status = check_interval(reading, "output.checkpoint", output->checkpoint_interval, true, end);
  if (status == VSC_OK) status = check_arrays(reading, scene);
  for (size_t i = 0; i < output->cavity_count && status == VSC_OK; i++) {
    vsc_enter(reading, "output.cavities");
    vsc_enter_item(reading, i);
    status = need_surface(reading, &scene->definition, output->cavities[i]);
    if (status == VSC_OK) vsc_leave(reading, 0);
  }
  for (size_t i = 0; i < output->point_count && status == VSC_OK; i++)
    status = check_point(reading, output, i);
  return status;
}

// What has no unloaded shape (yet), as keys and what to do; NULL: nothing.
static const char *what_does_not_unload(const vsc_definition *d)
{
  for (size_t m = 0; m < d->material_count; m++) {
    if (!vsc_law_is_of_strain(d->materials[m].law)) return "law: paper or classical; take law: springs";
    if (d->materials[m].prony_count > 0) return "prony, whose stress depends on the way; leave prony out";
  }
  if (d->membrane_count > 0) return "membranes; leave them out";
  if (d->obstacle_count > 0) return "obstacles; leave them out";
  if (d->kept_volume != VSC_KEEP_NONE) return "keep_volume; take a large volume_modulus";
  if (d->solve.incompressible > 0) return "solver.incompressible; take a large volume_modulus";
  return NULL;
}

static vsc_status check_prestress(vsc_reading *reading, const vsc_scene *scene)
{
  const vsc_prestress_def *p = &scene->prestress;
  const vsc_definition *d = &scene->definition;
  if (!p->loaded) return VSC_OK;
  const char *not = what_does_not_unload(d);
  const size_t length = vsc_enter(reading, "prestress");
  const size_t group = vsc_enter(reading, "mesh");
  if (not != NULL) return vsc_reading_fail(reading, "loaded; not with %s", not);
  vsc_leave(reading, group);
  vsc_enter(reading, "time");
  if (!(p->time >= 0 && p->time < d->end_time))
    return vsc_reading_fail(reading, "%g ms; expected a time from 0 ms on and before time.end, %g ms", p->time,
                            d->end_time);
  const double steps = d->step > 0 ? p->time / d->step : 0;
  if (fabs(steps - round(steps)) > 1e-9 * fmax(steps, 1))
    return vsc_reading_fail(reading, "%g ms; expected a multiple of time.step, %g ms", p->time, d->step);
  vsc_leave(reading, group);
  vsc_enter(reading, "tolerance");
  if (!(p->tolerance > 0 && isfinite(p->tolerance)))
    return vsc_reading_fail(reading, "%g mm; expected a length above zero", p->tolerance);
  vsc_leave(reading, group);
  vsc_enter(reading, "iterations");
  if (p->iterations < 1) return vsc_reading_fail(reading, "%d; expected one at least", p->iterations);
  vsc_leave(reading, length);
  return VSC_OK;
}

static vsc_status check_cycle(vsc_reading *reading, const vsc_definition *d)
{
  if (d->cycle == 0) return VSC_OK;
  const bool sound = d->cycle > 0 && d->cycle < d->end_time;
  if (sound && d->cycle_tolerance > 0 && d->cycle_tolerance < 1) return VSC_OK;
  vsc_enter(reading, "time");
  vsc_enter(reading, sound ? "cycle_tolerance" : "cycle");
  if (sound) return vsc_reading_fail(reading, "%g; expected a part of the stroke above 0 and below 1", d->cycle_tolerance);
  return vsc_reading_fail(reading, "%g ms; expected a time above zero and before time.end, %g ms", d->cycle, d->end_time);
}

static vsc_status check_pressures(vsc_reading *reading, const vsc_scene *scene)
{
  if (scene->definition.pressure_count <= VSC_MOST_PRESSURES) return VSC_OK;
  vsc_enter(reading, "pressures");
  return vsc_reading_fail(reading, "%zu of them; expected at most %d",
                          scene->definition.pressure_count, VSC_MOST_PRESSURES);
}

vsc_status vsc_scene_check(vsc_reading *reading, const vsc_scene *scene)
{
  vsc_error found;
  vsc_status status = check_mesh(reading, scene);
  if (status != VSC_OK) return status;
  status = vsc_definition_check(&scene->definition, &found);
  if (status != VSC_OK) return vsc_reading_locate(reading, &found);
  status = check_pressures(reading, scene);
  if (status == VSC_OK) status = check_cycle(reading, &scene->definition);
  if (status == VSC_OK) status = check_prestress(reading, scene);
  if (status == VSC_OK) status = check_fibers(reading, scene);
  if (status == VSC_OK) status = check_vessels(reading, &scene->definition);
  return status == VSC_OK ? check_output(reading, scene) : status;
}
