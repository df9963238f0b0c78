// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/check.h"

#include <math.h>
#include <string.h>

#include "base/vec3.h"
#include "mesh/surface.h"
#include "model/law_constants.h"
#include "model/small_strain.h"
#include "run/check_mesh.h"
#include "run/check_method.h"

static void say_surface(const vsc_problem *problem, const vsc_surface *surface, FILE *out)
{
  vsc_cavity cavity;
  fprintf(out, "surface    %s: %zu triangles, %.4g cm2", surface->name, surface->count,
          1e-2 * vsc_surface_area(surface, problem->mesh->nodes, 3));
  if (vsc_cavity_make(surface, problem->mesh->node_count, &cavity, NULL) == VSC_OK) {
    const double volume = vsc_cavity_volume(&cavity, problem->mesh->nodes, 3);
    fprintf(out, "; %s, %s %.4g ml", cavity.rim_count ? "open, capped" : "closed",
            volume > 0 ? "a cavity of" : "surrounds", 1e-3 * fabs(volume));
    vsc_cavity_free(&cavity);
  }
  fputc('\n', out);
}

static void say_supports(const vsc_problem *problem, FILE *out)
{
  const vsc_definition *definition = &problem->scene->definition;
  fprintf(out, "supports  ");
  for (size_t s = 0; s < definition->support_count; s++) {
    const vsc_support_def *support = &definition->supports[s];
    size_t nodes = 0;
    for (size_t k = 0; k < problem->model->set_count; k++)
      if (strcmp(problem->model->sets[k].name, support->set) == 0)
        nodes = problem->model->sets[k].count;
    fprintf(out, " %s (%zu nodes) held in%s%s%s", support->set, nodes,
            support->held[0] ? " x" : "", support->held[1] ? " y" : "",
            support->held[2] ? " z" : "");
    const double *motion = support->motion;
    if (motion[0] != 0 || motion[1] != 0 || motion[2] != 0)
      fprintf(out, ", moved by (%g, %g, %g) mm", motion[0], motion[1], motion[2]);
    fputc(';', out);
  }
  fprintf(out, " %zu of %zu nodes in all\n", problem->model->held_count,
          problem->model->node_count);
}

static void say_prestress(const vsc_problem *problem, FILE *out)
{
  const vsc_prestress_def *def = &problem->scene->prestress;
  if (def->loaded)
    fprintf(out,
            "prestress  the mesh is the shape under the loads of %g ms, where the run begins; it will find the shape at "
            "rest, to %g mm in at most %d iterations; what follows takes the mesh for it\n",
            def->time, def->tolerance, def->iterations);
}

static void say_points(const vsc_problem *problem, FILE *out)
{
  const vsc_output_def *output = &problem->scene->output;
  for (size_t p = 0; p < output->point_count; p++) {
    const vsc_place *place = &problem->points[p];
    fprintf(out, "point      %s: in element %u", output->points[p].name,
            problem->mesh->element_source[place->element]);
    if (place->distance > 1e-9) fprintf(out, ", %.3g mm from where it was wanted", place->distance);
    fputc('\n', out);
  }
}

static void say_fibers(const vsc_problem *problem, FILE *out)
{
  const vsc_fiber_report *f = &problem->fibers;
  const vsc_fiber_def *def = &problem->scene->fibers;
  fprintf(
      out,
      "fibres     %s%s%s: %zu of %zu elements (%.1f %%), %zu filled from neighbours, %zu passive",
      vsc_fiber_source_name(def->source), def->source == VSC_FIBER_MAP ? " " : "",
      def->source == VSC_FIBER_MAP ? def->map.file : "", f->with_data, f->elements,
      100.0 * (double)f->with_data / (double)f->elements, f->filled, f->passive);
  if (f->invalid > 0) fprintf(out, "; of %zu the fibre vector is zero or not finite", f->invalid);
  fputc('\n', out);
  if (def->source == VSC_FIBER_NONE) return;
  fprintf(out,
          "angles     azimuth %.0f, %.0f, %.0f deg; elevation %.0f, %.0f, %.0f deg (10, 50, 90 %%)",
          f->azimuth[0], f->azimuth[1], f->azimuth[2], f->elevation[0], f->elevation[1],
          f->elevation[2]);
  if (def->source == VSC_FIBER_MAP)
    fprintf(out, "; agreement of an element's voxels %.2f, %.2f, %.2f of 1", f->coherence[0],
            f->coherence[1], f->coherence[2]);
  fputc('\n', out);
}

static void say_vessels(const vsc_problem *problem, FILE *out)
{
  for (size_t v = 0; v < problem->scene->definition.vessel_count; v++) {
    const vsc_vessel_def *def = &problem->scene->definition.vessels[v];
    const vsc_vessel_report *r = &problem->vessels[v];
    fprintf(out,
            "vessel     %s: %s, %zu %s, %.4g ml; in the mesh %.4g ml of %s in %zu elements, %zu along "
            "it (fraction %g and more)\n",
            def->name, def->file, r->pieces, r->surface ? "triangles" : "segments",
            1e-3 * r->own_volume, 1e-3 * r->volume, def->material, r->elements, r->directed,
            def->threshold);
  }
}

// The law's constants, and what it is at small strain.
static void say_tissue(const vsc_model *model, const vsc_material *m, const vsc_material_def *def,
                       FILE *out)
{
  vsc_law_constant constants[VSC_MOST_CONSTANTS];
  const size_t count = vsc_law_constants(def, constants);
  const int law = (int)strcspn(constants[0].key, ".");
  fprintf(out, "law %.*s%s:", law, constants[0].key, m->isochoric ? ", isochoric" : "");
  for (size_t k = 0; k < count; k++)
    fprintf(out, "%s %s %g%s%s", k > 0 ? "," : "", constants[k].key + law + 1, constants[k].value,
            constants[k].unit[0] ? " " : "", constants[k].unit);
  fprintf(out,
          "; shear modulus at rest up to %.4g kPa; K %g; own K of a frame %g kPa; viscosity %g kPa ms\n",
          vsc_material_shear(model, m), def->volume_modulus, m->stabilization, m->viscosity);
}

static void say_law(const vsc_model *model, const vsc_material *m, const vsc_material_def *def,
                    FILE *out)
{
  const vsc_paper_def *p = &m->paper;
  if (m->law == VSC_LAW_CLASSICAL)
    fprintf(out, "classical springs on the edges: k_s %g mN/mm, k_d %g mN ms/mm\n",
            m->classical.stiffness, m->classical.damping);
  else if (m->law == VSC_LAW_PAPER)
    fprintf(out,
            "the paper's law: axial k_s %g, %g, %g mN/mm; angular %g, %g, %g mN; volume %g mN/mm; "
            "k_d %g, %g, %g mN ms/mm\n",
            p->axial[0], p->axial[1], p->axial[2], p->angular[0], p->angular[1], p->angular[2],
            p->volume, p->damping[0], p->damping[1], p->damping[2]);
  else if (m->law != VSC_LAW_SPRINGS)
    say_tissue(model, m, def, out);
  else
    fprintf(out,
            "E_f,s,n %g, %g, %g; G_fs,sn,nf %g, %g, %g; K %g; own K of a frame %g kPa; damping %g, "
            "%g, %g kPa ms\n",
            m->axial[0], m->axial[1], m->axial[2], m->angular[0], m->angular[1], m->angular[2],
            m->volume_modulus, m->stabilization, m->damping[0], m->damping[1], m->damping[2]);
  if (m->law == VSC_LAW_SPRINGS && m->general)
    fprintf(out, "also       %s: H_fs,sn,nf %g, %g, %g kPa; viscosity %g kPa ms\n", m->name,
            m->coupling[0], m->coupling[1], m->coupling[2], m->viscosity);
}

static void say_material(const vsc_model *model, const vsc_material *m, const vsc_material_def *def,
                         FILE *out)
{
  fprintf(out, "material   %s: %zu elements, %.4g ml; ", m->name, m->element_count, 1e-3 * m->volume);
  say_law(model, m, def, out);
  for (size_t d = 0; d < m->axis_count; d++) {
    const vsc_axis *axis = &model->axes[m->first_axis + d];
    fprintf(out, "axis       %s: %zu along (%.3g, %.3g, %.3g) in f, s, n: %g kPa\n", m->name, d + 3,
            axis->direction[0], axis->direction[1], axis->direction[2], axis->modulus);
  }
  if (m->active == VSC_ACTIVE_TENSION)
    fprintf(out, "active     %s: tension up to %g kPa, delay %g ms, period %g ms\n", m->name,
            m->tension * vsc_curve_peak(&m->curve), m->delay, m->curve.period);
  if (m->length_factor != 0 || m->tension_parts[0] > 0 || m->tension_parts[1] > 0)
    fprintf(out, "active     %s: length factor %g; %g and %g of the tension along s and n\n", m->name,
            m->length_factor, m->tension_parts[0], m->tension_parts[1]);
  if (m->active == VSC_ACTIVE_SPRING)
    fprintf(out,
            "active     %s: fibre %s %g to %g %s, rest stretch 1 to %g, delay %g ms, period %g ms\n",
            m->name, m->law == VSC_LAW_PAPER ? "k_s" : "modulus",
            m->law == VSC_LAW_PAPER ? m->paper.axial[0] : m->axial[0],
            m->law == VSC_LAW_PAPER ? m->paper.active : m->active_stiffness,
            m->law == VSC_LAW_PAPER ? "mN/mm" : "kPa", m->rest_stretch, m->delay, m->curve.period);
}

static void say_membranes(const vsc_model *model, FILE *out)
{
  for (size_t k = 0; k < model->membrane_count; k++) {
    const vsc_membrane *m = &model->membranes[k];
    fprintf(out,
            "membrane   %s: %zu triangles, %.4g cm2, %g mm thick, %.4g g; E_a,b %g, %g; G %g; K %g kPa; "
            "damping %g, %g kPa ms; bending %g mN mm\n",
            m->name, m->triangle_count, 1e-2 * m->area, m->thickness,
            1e-3 * m->density * m->thickness * m->area, m->moduli.axial[0], m->moduli.axial[1],
            m->moduli.angular, m->moduli.area, m->damping[0], m->damping[1], m->bending);
  }
}

// A material's law as scenes call it.
static void name_law(const vsc_material *m, const vsc_material_def *def, char name[VSC_NAME])
{
  vsc_law_constant constants[VSC_MOST_CONSTANTS];
  const char *key = m->law == VSC_LAW_PAPER ? "paper" : m->law == VSC_LAW_CLASSICAL ? "classical" : "springs";
  if (vsc_law_is_of_strain(m->law) && m->law != VSC_LAW_SPRINGS) {
    vsc_law_constants(def, constants);
    key = constants[0].key;
  }
  snprintf(name, VSC_NAME, "%.*s", (int)strcspn(key, "."), key);
}

// Each law in use once, in the order of the materials; springs of membranes.
static void say_laws(const vsc_problem *problem, FILE *out)
{
  const vsc_model *model = problem->model;
  unsigned said = 0;
  for (size_t m = 0; m < model->material_count; m++) {
    const vsc_material *material = &model->materials[m];
    char name[VSC_NAME];
    if (said >> material->law & 1) continue;
    name_law(material, &problem->scene->definition.materials[m], name);
    fprintf(out, "%s%s", said > 0 ? ", " : "", name);
    said |= 1u << material->law;
  }
  if (model->membrane_count > 0) fprintf(out, "%ssprings of membranes", said > 0 ? ", " : "");
}

static bool has_axial_damping(const vsc_model *model, const vsc_material *material)
{
  const double *damping = material->damping;
  bool has = material->law == VSC_LAW_SPRINGS && fmax(damping[0], fmax(damping[1], damping[2])) > 0;
  for (size_t k = 0; k < material->axis_count; k++) has |= model->axes[material->first_axis + k].damping > 0;
  return has;
}

// What resists velocity.
static void say_damping(const vsc_model *model, FILE *out)
{
  bool viscous = false, axial = false;
  for (size_t m = 0; m < model->material_count; m++) {
    const vsc_material *material = &model->materials[m];
    const bool has_viscosity = vsc_law_is_of_strain(material->law) && material->viscosity > 0;
    viscous |= has_viscosity;
    axial |= material->damped && (!has_viscosity || has_axial_damping(model, material));
  }
  for (size_t m = 0; m < model->membrane_count; m++) axial |= model->membranes[m].lag > 0;
  fprintf(out, "%s%s", viscous ? ", viscosity" : "", axial ? ", axial damping" : "");
}

// How fast the body is at the start.
static void say_velocity(const vsc_model *model, FILE *out)
{
  double momentum[3] = {0}, energy = 0, most = 0;
  for (size_t n = 0; n < model->node_count; n++) {
    const double *v = model->velocity + 4 * n;
    for (int i = 0; i < 3; i++) momentum[i] += model->mass[n] * v[i];
    energy += 0.5 * model->mass[n] * vsc_dot(v, v);
    most = fmax(most, vsc_norm(v));
  }
  fprintf(out, "velocity   at the start: up to %.4g m/s, momentum (%.4g, %.4g, %.4g) mg m/s, energy %.4g mJ\n",
          most, momentum[0], momentum[1], momentum[2], 1e-3 * energy);
}

static size_t triangles_of(const vsc_model *model, const char *surface)
{
  return model->surfaces[vsc_model_find_surface(model, surface)].count;
}

static void say_terms(const vsc_problem *problem, FILE *out)
{
  const vsc_model *model = problem->model;
  const char *volumes = "";
  for (size_t m = 0; m < model->material_count; m++)
    if (model->materials[m].element_count > 0 && model->materials[m].law != VSC_LAW_CLASSICAL)
      volumes = model->terms.nodal_volume ? "; volume of node groups and of each element"
                                          : "; volume of each element";
  fputs("terms      ", out);
  say_laws(problem, out);
  say_damping(model, out);
  fprintf(out, "%s%s%s%s", volumes,
          model->terms.active == VSC_ACTIVE_SPRING ? "; active springs" : "",
          model->terms.active == VSC_ACTIVE_TENSION ? "; active tension" : "",
          model->terms.gravity ? "; gravity" : "");
  for (size_t p = 0; p < model->pressure_count; p++)
    fprintf(out, "; %s on %s up to %g kPa (%zu triangles)",
            vsc_norm(model->pressures[p].direction) > 0 ? "dead traction" : "pressure", model->pressures[p].surface,
            model->pressures[p].peak * vsc_curve_peak(&model->pressures[p].curve),
            triangles_of(model, model->pressures[p].surface));
  fputc('\n', out);
  if (model->terms.smoothed)
    fprintf(out, "smoothed   laws of linear tets on %zu edges\n", model->smoothing.edge_count);
  if (model->velocity != NULL) say_velocity(model, out);
  for (size_t r = 0; r < model->robin_count; r++) {
    const vsc_robin *bed = &model->robins[r];
    fprintf(out,
            "robin      %s: %zu triangles, %.4g cm2, %s; stiffness %g kPa/mm, in all %.4g mN/mm; "
            "damping %g kPa ms/mm, in all %.4g mN ms/mm\n",
            bed->surface, triangles_of(model, bed->surface), 1e-2 * bed->area,
            bed->normal ? "along the normal" : "in all directions", bed->stiffness,
            bed->stiffness * bed->area, bed->damping, bed->damping * bed->area);
  }
  static const char *const kept[] = {"", "the whole body", "each material", "each node", "each element"};
  if (model->kept.count > 0)
    fprintf(out, "kept       volume of %s, %zu in all, by multipliers\n", kept[model->kept.kind],
            model->kept.count);
  for (size_t o = 0; o < model->obstacle_count; o++) {
    const vsc_obstacle *it = &model->obstacles[o];
    fprintf(out, "obstacle   %zu: %s at (%g, %g, %g)", o,
            it->kind == VSC_OBSTACLE_PLANE ? "plane" : "sphere", it->point[0], it->point[1],
            it->point[2]);
    if (it->kind == VSC_OBSTACLE_SPHERE) fprintf(out, ", radius %g mm", it->radius);
    fprintf(out, ", friction %g, stops %zu nodes\n", it->friction, it->node_count);
  }
}

vsc_status vsc_check(const vsc_problem *problem, FILE *stream, int *warnings, vsc_error *error)
{
  const vsc_model *model = problem->model;
  fprintf(stream, "scene      %s\n", problem->scene->file);
  vsc_status status = vsc_check_mesh(problem, stream, error);
  if (status != VSC_OK) return status;
  for (size_t s = 0; s < model->surface_count; s++)
    say_surface(problem, &model->surfaces[s], stream);
  say_supports(problem, stream);
  say_prestress(problem, stream);
  say_points(problem, stream);
  if (problem->mesh->element_count > 0) say_fibers(problem, stream);
  say_vessels(problem, stream);
  for (size_t m = 0; m < model->material_count; m++)
    say_material(model, &model->materials[m], &problem->scene->definition.materials[m], stream);
  say_membranes(model, stream);
  say_terms(problem, stream);
  status = vsc_check_method(problem, stream, error);
  if (status == VSC_OK) {
    const int found = vsc_check_warnings(problem, true, stream, "warning    ");
    if (found == 0) fprintf(stream, "warnings   none\n");
    if (warnings) *warnings = found;
  }
  return status;
}
