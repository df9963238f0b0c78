// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/specimen.h"

#include <malloc.h>
#include <math.h>

#include "base/parallel.h"
#include "run/problem.h"
#include "solve/explicit.h"

enum { TIMINGS = 5 };
#define SHORTEST_TIMING 0.15  // seconds, but
#define MOST_STEPS 4000       // of some elements only

static vsc_material_def tissue(const vsc_specimen *specimen)
{
  vsc_material_def material = vsc_default_material();
  material.law = specimen->law;
  for (int a = 0; a < 3; a++) {
    material.axial[a] = 10;
    material.angular[a] = 5;
    material.damping[a] = specimen->damping ? 0.1 : 0;
  }
  material.guccione = (vsc_guccione_def){.C = 2, .fibre = 8, .cross = 2, .shear = 4};
  material.holzapfel_ogden = (vsc_holzapfel_ogden_def){
      .a = 0.8, .b = 3, .a_f = 5, .b_f = 6, .a_s = 2, .b_s = 4, .a_fs = 0.6, .b_fs = 5};
  material.classical = (vsc_classical_def){20, specimen->damping ? 1 : 0};
  material.volume_modulus = 100;
  material.stabilization = 10;
  material.active.kind = specimen->active;
  material.active.tension = 1;
  return material;
}

// Fills a scene that stays where it is in memory.
static void make_scene(const vsc_specimen *specimen, const vsc_mesh *mesh, vsc_specimen_scene *scene)
{
  *scene = (vsc_specimen_scene){.mesh = mesh, .definition = vsc_default_definition()};
  vsc_definition *definition = &scene->definition;
  for (size_t i = 0; i < 3 * mesh->node_count; i++) scene->size[i % 3] = fmax(scene->size[i % 3], mesh->nodes[i]);
  for (int m = 0; m < 2; m++) scene->material[m] = tissue(specimen);
  definition->materials = scene->material;
  definition->material_count = 1;
  definition->sets = &scene->set;
  definition->surfaces = &scene->surface;
  definition->supports = &scene->support;
  definition->pressures = &scene->pressure;
  definition->robins = &scene->robin;
  definition->obstacles = &scene->obstacle;
  definition->membranes = &scene->membrane;
  definition->volume = specimen->nodal ? VSC_VOLUME_NODAL : VSC_VOLUME_ELEMENT;
  definition->tets = specimen->smoothed ? VSC_TETS_SMOOTHED : VSC_TETS_PLAIN;
  definition->end_time = 1e5;
  scene->material[0].inclusions = &scene->inclusion;
  if (specimen->feature != NULL) specimen->feature(scene);
}

// Fibres along x.
static vsc_axes *axes_of(const vsc_mesh *mesh)
{
  vsc_axes *axes = vsc_axes_create_for(mesh);
  for (size_t e = 0; axes != NULL && e < mesh->element_count; e++)
    vsc_axes_set(axes, e, (double[3]){1, 0, 0}, NULL);
  return axes;
}

static double allocated(void)
{
  const struct mallinfo2 info = mallinfo2();
  return (double)info.uordblks + (double)info.hblkhd;
}

static double now(int threads)
{
  return threads == 1 ? vsc_cpu_seconds() : vsc_wall_seconds();
}

// Packs are read once, by the volume pass a third of them again; nodes have positions, velocities, forces and masses, 13
// numbers of four doubles with damping, 9 without, 2 more with volumes and pressures. Smoothed tets are read twice and
// leave their deformation for their edges, which leave their stress for them.
static double traffic_of(const vsc_model *model)
{
  const double nodes = (double)model->node_count, packs = (double)model->pack_count;
  const double edges = (double)model->smoothing.pack_count, matrices = 4 * 12 * sizeof(double);
  double bytes = (double)model->store_size + 32 * nodes * (model->terms.damping ? 13 : 9);
  if (model->terms.nodal_volume) bytes += 128 * packs + 64 * nodes;
  if (model->terms.smoothed)
    bytes += (double)model->store_size + 2 * matrices * packs + edges * (sizeof(vsc_edge_frame) + 2 * matrices);
  return bytes;
}

static vsc_status time_steps(vsc_specimen_run *run, int threads, double *seconds, vsc_error *error)
{
  const double dt = run->state->limit.step;
  for (;;) {
    const double start = now(threads);
    const vsc_status status = vsc_steps(run->model, run->state, dt, run->steps, error);
    if (status != VSC_OK) return status;
    const double passed = now(threads) - start;
    *seconds = fmin(*seconds, passed / run->steps);
    if (passed >= SHORTEST_TIMING || run->steps >= MOST_STEPS) return VSC_OK;
    run->steps = fmin(ceil(run->steps * fmin(1.5 * SHORTEST_TIMING / fmax(passed, 1e-4), 100)), MOST_STEPS);
  }
}

static vsc_status start_on(vsc_specimen_run *run, int threads, vsc_error *error)
{
  vsc_parallel_set_threads(threads);
  vsc_state_free(run->state);
  run->state = NULL;
  run->steps = 2;
  const vsc_status status = vsc_state_create(run->model, &run->state, error);
  return status == VSC_OK ? vsc_start(run->model, run->state, error) : status;
}

vsc_status vsc_specimen_open(const vsc_specimen *specimen, const vsc_mesh *mesh, vsc_specimen_run *run,
                             vsc_specimen_cost *cost, vsc_error *error)
{
  vsc_specimen_scene scene;
  *run = (vsc_specimen_run){0};
  *cost = (vsc_specimen_cost){
      .elements = mesh->element_count, .nodes = mesh->node_count, .one = INFINITY, .all = INFINITY};
  make_scene(specimen, mesh, &scene);
  vsc_axes *axes = axes_of(mesh);
  if (axes == NULL) return vsc_fail_memory(error, "the bench");
  vsc_parallel_set_threads(1);
  const double before = allocated(), start = vsc_cpu_seconds();
  vsc_status status = vsc_model_build(mesh, axes, &scene.definition, &run->model, error);
  if (status == VSC_OK) status = start_on(run, 1, error);
  cost->build = vsc_cpu_seconds() - start;
  cost->bytes = allocated() - before;
  if (status == VSC_OK) cost->traffic = traffic_of(run->model);
  vsc_axes_free(axes);
  return status;
}

vsc_status vsc_specimen_step(vsc_specimen_run *run, double *seconds, vsc_error *error)
{
  vsc_parallel_set_threads(1);
  return time_steps(run, 1, seconds, error);
}

void vsc_specimen_close(vsc_specimen_run *run)
{
  vsc_state_free(run->state);
  vsc_model_free(run->model);
  *run = (vsc_specimen_run){0};
  vsc_parallel_set_threads(0);
}

vsc_status vsc_specimen_time(const vsc_specimen *specimen, const vsc_mesh *mesh, bool all,
                             vsc_specimen_cost *cost, vsc_error *error)
{
  vsc_specimen_run run;
  vsc_parallel_set_threads(0);
  const int threads = vsc_parallel_threads();
  vsc_status status = vsc_specimen_open(specimen, mesh, &run, cost, error);
  for (int k = 0; k < TIMINGS && status == VSC_OK; k++) status = time_steps(&run, 1, &cost->one, error);
  if (status == VSC_OK && all) status = start_on(&run, threads, error);
  for (int k = 0; k < TIMINGS && status == VSC_OK && all; k++)
    status = time_steps(&run, threads, &cost->all, error);
  vsc_specimen_close(&run);
  return status;
}
