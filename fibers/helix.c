// SPDX-License-Identifier: GPL-3.0-or-later
#include "fibers/helix.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/ellipsoid.h"
#include "mesh/split.h"
#include "solve/cholmod.h"

static const double PARALLEL = 1e-3;  // sine of the angle below which two axes are one

int vsc_helix_frame(const double transmural[3], const double long_axis[3], double angle,
                    double frame[9])
{
  double e_t[3], e_l[3], e_c[3], fiber[3];
  memcpy(e_t, transmural, sizeof e_t);
  memcpy(e_l, long_axis, sizeof e_l);
  const double length = vsc_normalize(e_t), axis_length = vsc_normalize(e_l);
  if (!(isfinite(length) && length > 0 && isfinite(axis_length) && axis_length > 0)) return 0;
  vsc_cross(e_l, e_t, e_c);
  if (vsc_normalize(e_c) < PARALLEL) {
    int least = 0;
    for (int a = 1; a < 3; a++)
      if (fabs(e_t[a]) < fabs(e_t[least])) least = a;
    const double global[3] = {least == 0, least == 1, least == 2};
    vsc_cross(global, e_t, e_c);
    vsc_normalize(e_c);
  }
  vsc_cross(e_t, e_c, e_l);
  for (int a = 0; a < 3; a++) fiber[a] = cos(angle) * e_c[a] + sin(angle) * e_l[a];
  return vsc_axes_complete(fiber, e_t, frame);
}

// The gradients of the four linear shape functions of a tet, 1/mm; returns its volume, mm^3, not
// negative, so that tets turned over in a bent element leave the Laplace problem definite.
static double shape_gradients(const vsc_mesh *mesh, const uint32_t node[4], double gradient[4][3])
{
  double edge[3][3];
  for (int i = 0; i < 3; i++)
    vsc_subtract(&mesh->nodes[3 * (size_t)node[i + 1]], &mesh->nodes[3 * (size_t)node[0]], edge[i]);
  for (int i = 0; i < 3; i++) vsc_cross(edge[(i + 1) % 3], edge[(i + 2) % 3], gradient[i + 1]);
  const double determinant = vsc_dot(edge[0], gradient[1]);
  for (int a = 0; a < 3; a++) {
    for (int i = 1; i < 4; i++) gradient[i][a] /= determinant;
    gradient[0][a] = -(gradient[1][a] + gradient[2][a] + gradient[3][a]);
  }
  return fabs(determinant) / 6;
}

// grad N_i (1/mm) of a quadratic tet at point q of its rule, and the volume that the point stands for.
static double point_gradients(const vsc_mesh *mesh, size_t element, const vsc_cell_rule *rule, int q,
                              double gradient[VSC_MOST_CORNERS][3])
{
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  double J[3][3] = {{0}}, dual[3][3];
  for (int i = 0; i < 10; i++)
    for (int k = 0; k < 3; k++)
      for (int a = 0; a < 3; a++)
        J[k][a] += rule->D[q][k][i] * mesh->nodes[3 * (size_t)corner[i] + (size_t)a];
  for (int k = 0; k < 3; k++) vsc_cross(J[(k + 1) % 3], J[(k + 2) % 3], dual[k]);
  const double determinant = vsc_dot(J[0], dual[0]);
  for (int i = 0; i < 10; i++)
    for (int a = 0; a < 3; a++)
      gradient[i][a] = (rule->D[q][0][i] * dual[0][a] + rule->D[q][1][i] * dual[1][a] +
                        rule->D[q][2][i] * dual[2][a]) / determinant;
  return rule->weight[q] * determinant;
}

// The mean gradient over an element's tets, and their volume.
static void gradient_of(const vsc_mesh *mesh, size_t element, const double *depth,
                        double gradient[3], double *volume)
{
  uint32_t tets[VSC_MOST_TETS][4];
  double shape[4][3];
  const int count = vsc_mesh_split(mesh, element, tets);
  *volume = 0;
  memset(gradient, 0, 3 * sizeof *gradient);
  for (int t = 0; t < count; t++) {
    const double part = shape_gradients(mesh, tets[t], shape);
    *volume += part;
    for (int i = 0; i < 4; i++)
      for (int a = 0; a < 3; a++) gradient[a] += part * shape[i][a] * depth[tets[t][i]];
  }
  for (int a = 0; a < 3; a++) gradient[a] /= *volume;
}

// ---- The Laplace problem: the known nodes are numbered -1, the free ones from 0.

typedef struct laplace {
  const vsc_mesh *mesh;
  double *depth;    // node_count: known values, then the solution
  int32_t *number;  // node_count
  size_t free;      // free nodes
  const vsc_cholmod *cholmod;
  cholmod_common common;
  cholmod_sparse *matrix;
  cholmod_dense *right, *solution;
  cholmod_factor *factor;
} laplace;

static void mark_outer(double *value)
{
  *value = *value == 0 || *value == 0.5 ? 0.5 : 1;
}

static void mark_known(laplace *problem, const vsc_surface *endo, const vsc_surface *epi)
{
  const size_t nodes = problem->mesh->node_count;
  double *depth = problem->depth;
  for (size_t i = 0; i < nodes; i++) depth[i] = -1;
  for (size_t k = 0; k < 3 * endo->count; k++) {
    depth[endo->triangles[k]] = 0;
    if (endo->mid != NULL) depth[endo->mid[k]] = 0;
  }
  for (size_t k = 0; k < 3 * epi->count; k++) {
    mark_outer(&depth[epi->triangles[k]]);
    if (epi->mid != NULL) mark_outer(&depth[epi->mid[k]]);
  }
  for (size_t i = 0; i < nodes; i++)
    if (depth[i] < 0)
      problem->number[i] = (int32_t)problem->free++;
    else
      problem->number[i] = -1;
}

static uint32_t root_of(uint32_t *parent, uint32_t node)
{
  while (parent[node] != node) {
    parent[node] = parent[parent[node]];
    node = parent[node];
  }
  return node;
}

// Every part of the mesh must hold a known node, or the matrix is singular.
static vsc_status check_parts(const laplace *problem, vsc_error *error)
{
  const vsc_mesh *mesh = problem->mesh;
  uint32_t *parent;
  if (!VSC_NEW(parent, mesh->node_count)) return vsc_fail_memory(error, "the parts of the mesh");
  for (size_t i = 0; i < mesh->node_count; i++) parent[i] = (uint32_t)i;
  for (size_t e = 0; e < mesh->element_count; e++)
    for (size_t c = mesh->start[e] + 1; c < mesh->start[e + 1]; c++) {
      const uint32_t a = root_of(parent, mesh->corners[c - 1]);
      const uint32_t b = root_of(parent, mesh->corners[c]);
      parent[a < b ? b : a] = a < b ? a : b;
    }
  uint8_t *held;
  if (!VSC_NEW(held, mesh->node_count)) {
    vsc_free(parent);
    return vsc_fail_memory(error, "the parts of the mesh");
  }
  for (size_t i = 0; i < mesh->node_count; i++)
    if (problem->number[i] < 0) held[root_of(parent, (uint32_t)i)] = 1;
  vsc_status status = VSC_OK;
  for (size_t i = 0; i < mesh->node_count && status == VSC_OK; i++)
    if (!held[root_of(parent, (uint32_t)i)])
      status = vsc_fail(error, VSC_INPUT,
                        "helix: node %u lies in a part of the mesh that touches neither the "
                        "endocardium nor the epicardium: remove that part or extend the surfaces",
                        mesh->node_source[i]);
  vsc_free(held);
  vsc_free(parent);
  return status;
}

static vsc_status cholmod_failure(const laplace *problem, vsc_error *error)
{
  switch (problem->common.status) {
    case CHOLMOD_OUT_OF_MEMORY:
      return vsc_fail_memory(error, "the depth of the wall");
    case CHOLMOD_TOO_LARGE:
      return vsc_fail(error, VSC_SYSTEM,
                      "helix: %zu free nodes are too many for the solver: use a coarser mesh",
                      problem->free);
    case CHOLMOD_NOT_POSDEF:
    case CHOLMOD_DSMALL:
      return vsc_fail(error, VSC_NUMERICAL,
                      "helix: the depth problem is singular: look for nearly flat "
                      "tets with `viscera info`");
    default:
      return vsc_fail(error, VSC_SYSTEM, "helix: CHOLMOD failed with status %d",
                      problem->common.status);
  }
}

// Adds volume . grad N_i . grad N_j of `count` nodes.
static void add_products(const laplace *problem, const uint32_t *node, int count, double volume,
                         double (*gradient)[3], cholmod_triplet *triplet)
{
  for (int i = 0; i < count; i++) {
    const int32_t row = problem->number[node[i]];
    if (row < 0) continue;
    for (int j = 0; j < count; j++) {
      const int32_t column = problem->number[node[j]];
      const double value = volume * vsc_dot(gradient[i], gradient[j]);
      if (column < 0) ((double *)problem->right->x)[row] -= value * problem->depth[node[j]];
      if (column < 0 || column > row) continue;
      ((int *)triplet->i)[triplet->nnz] = row;
      ((int *)triplet->j)[triplet->nnz] = column;
      ((double *)triplet->x)[triplet->nnz++] = value;
    }
  }
}

static void add_element(const laplace *problem, size_t e, const vsc_cell_rule *quadratic,
                        cholmod_triplet *triplet)
{
  const vsc_mesh *mesh = problem->mesh;
  uint32_t tets[VSC_MOST_TETS][4];
  double gradient[VSC_MOST_CORNERS][3];
  if (mesh->kinds[e] == VSC_TET10) {
    for (int q = 0; q < quadratic->points; q++) {
      const double volume = point_gradients(mesh, e, quadratic, q, gradient);
      add_products(problem, vsc_mesh_corners(mesh, e), 10, volume, gradient, triplet);
    }
    return;
  }
  const int count = vsc_mesh_split(mesh, e, tets);
  for (int t = 0; t < count; t++) {
    const double volume = shape_gradients(mesh, tets[t], gradient);
    add_products(problem, tets[t], 4, volume, gradient, triplet);
  }
}

// Entries of the triangle of the matrix before equal places are added up.
static size_t count_entries(const vsc_mesh *mesh)
{
  uint32_t tets[VSC_MOST_TETS][4];
  size_t count = 0;
  for (size_t e = 0; e < mesh->element_count; e++)
    count += mesh->kinds[e] == VSC_TET10 ? 4 * 55 : 10 * (size_t)vsc_mesh_split(mesh, e, tets);
  return count;
}

static bool assemble(laplace *problem)
{
  const size_t n = problem->free;
  const vsc_mesh *mesh = problem->mesh;
  cholmod_common *common = &problem->common;
  problem->right = problem->cholmod->zeros(n, 1, CHOLMOD_REAL, common);
  cholmod_triplet *triplet =
      problem->cholmod->allocate_triplet(n, n, count_entries(mesh), -1, CHOLMOD_REAL, common);
  if (problem->right != NULL && triplet != NULL) {
    const vsc_cell_rule quadratic = vsc_cell_rule_of(VSC_TET10);
    for (size_t e = 0; e < mesh->element_count; e++) add_element(problem, e, &quadratic, triplet);
    problem->matrix = problem->cholmod->triplet_to_sparse(triplet, 0, common);
  }
  problem->cholmod->free_triplet(&triplet, common);
  return problem->matrix != NULL;
}

static vsc_status solve(laplace *problem, vsc_error *error)
{
  cholmod_common *common = &problem->common;
  if (!assemble(problem)) return cholmod_failure(problem, error);
  problem->factor = problem->cholmod->analyze(problem->matrix, common);
  if (problem->factor == NULL) return cholmod_failure(problem, error);
  if (!problem->cholmod->factorize(problem->matrix, problem->factor, common) || common->status != CHOLMOD_OK)
    return cholmod_failure(problem, error);
  problem->solution = problem->cholmod->solve(CHOLMOD_A, problem->factor, problem->right, common);
  if (problem->solution == NULL) return cholmod_failure(problem, error);
  const double *x = problem->solution->x;
  for (size_t i = 0; i < problem->mesh->node_count; i++)
    if (problem->number[i] >= 0) problem->depth[i] = fmin(fmax(x[problem->number[i]], 0), 1);
  return VSC_OK;
}

static vsc_status solve_free_nodes(laplace *problem, vsc_error *error)
{
  cholmod_common *common = &problem->common;
  vsc_status status = vsc_cholmod_load(&problem->cholmod, error);
  if (status != VSC_OK) return status;
  problem->cholmod->start(common);
  common->print = 0;
  common->error_handler = NULL;
  status = solve(problem, error);
  problem->cholmod->free_dense(&problem->solution, common);
  problem->cholmod->free_dense(&problem->right, common);
  problem->cholmod->free_factor(&problem->factor, common);
  problem->cholmod->free_sparse(&problem->matrix, common);
  problem->cholmod->finish(common);
  return status;
}

vsc_status vsc_helix_depth(const vsc_mesh *mesh, const vsc_surface *endo, const vsc_surface *epi,
                           double *depth, vsc_error *error)
{
  laplace problem = {.mesh = mesh, .depth = depth};
  if (!VSC_NEW(problem.number, mesh->node_count))
    return vsc_fail_memory(error, "the depth of the wall");
  mark_known(&problem, endo, epi);
  vsc_status status = check_parts(&problem, error);
  if (status == VSC_OK && problem.free > 0) status = solve_free_nodes(&problem, error);
  vsc_free(problem.number);
  return status;
}

// ---- From the depth to the axes

// The volume-weighted mean gradient at every node, times the volume round it.
static void nodal_gradients(const vsc_mesh *mesh, const double *depth, double *nodal)
{
  for (size_t e = 0; e < mesh->element_count; e++) {
    double gradient[3], volume;
    gradient_of(mesh, e, depth, gradient, &volume);
    for (size_t c = mesh->start[e]; c < mesh->start[e + 1]; c++)
      for (size_t a = 0; a < 3; a++)
        nodal[3 * (size_t)mesh->corners[c] + a] += volume * gradient[a];
  }
}

// Depth and its gradient at the frame of an element: the mean of its nodes and over it; of a quadratic tet
// at point q. A gradient counts as zero when the depth changes by less than 1e-9 over the size of the
// element.
static void depth_at(const vsc_mesh *mesh, size_t element, const vsc_cell_rule *quadratic, int q,
                     const double *depth, const double *nodal, double *t, double e_t[3])
{
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  const int corners = vsc_mesh_kind(mesh, element)->corners;
  double volume, gradient[VSC_MOST_CORNERS][3];
  *t = 0;
  if (mesh->kinds[element] == VSC_TET10) {
    volume = 4 * point_gradients(mesh, element, quadratic, q, gradient);
    for (int a = 0; a < 3; a++) e_t[a] = 0;
    for (int i = 0; i < corners; i++) {
      *t += quadratic->N[q][i] * depth[corner[i]];
      for (int a = 0; a < 3; a++) e_t[a] += gradient[i][a] * depth[corner[i]];
    }
  } else {
    gradient_of(mesh, element, depth, e_t, &volume);
    for (int c = 0; c < corners; c++) *t += depth[corner[c]] / (double)corners;
  }
  if (vsc_norm(e_t) * cbrt(volume) > 1e-9) return;
  for (size_t a = 0; a < 3; a++) {
    e_t[a] = 0;
    for (size_t c = mesh->start[element]; c < mesh->start[element + 1]; c++)
      e_t[a] += nodal[3 * (size_t)mesh->corners[c] + a];
  }
}

static void set_axes(const vsc_mesh *mesh, const vsc_fiber_def *definition, const double *depth,
                     const double *nodal, vsc_axes *axes)
{
  const vsc_cell_rule quadratic = vsc_cell_rule_of(VSC_TET10);
  for (size_t e = 0; e < mesh->element_count; e++) {
    int known = 1;
    for (int q = 0; q < axes->points; q++) {
      double e_t[3], at[3], t, *frame = vsc_axes_frame(axes, e, q);
      depth_at(mesh, e, &quadratic, q, depth, nodal, &t, e_t);
      const double angle = (1 - t) * definition->endo_angle + t * definition->epi_angle;
      vsc_axes_place(axes, mesh, &quadratic, e, q, at);
      if (definition->source == VSC_FIBER_ELLIPSOID)
        known &= vsc_ellipsoid_frame_at(definition, at, t, frame);
      else
        known &= vsc_helix_frame(e_t, definition->long_axis, angle, frame);
    }
    vsc_axes_finish(axes, e, known);
  }
}

vsc_status vsc_fibers_helix(const vsc_mesh *mesh, const vsc_fiber_def *definition,
                            const vsc_surface *endo, const vsc_surface *epi, vsc_axes *axes,
                            vsc_error *error)
{
  const double length = vsc_norm(definition->long_axis);
  if (!(isfinite(length) && length > 0))
    return vsc_fail(error, VSC_INPUT, "helix: the long axis (%g, %g, %g) must not be zero",
                    definition->long_axis[0], definition->long_axis[1], definition->long_axis[2]);
  if (!isfinite(definition->endo_angle) || !isfinite(definition->epi_angle))
    return vsc_fail(error, VSC_INPUT, "helix: the angles %g and %g must be finite",
                    definition->endo_angle, definition->epi_angle);
  double *depth = NULL, *nodal = NULL;
  vsc_status status = VSC_OK;
  if (!VSC_NEW(depth, mesh->node_count) || !VSC_NEW(nodal, 3 * mesh->node_count))
    status = vsc_fail_memory(error, "the depth of the wall");
  if (status == VSC_OK) status = vsc_helix_depth(mesh, endo, epi, depth, error);
  if (status == VSC_OK) {
    nodal_gradients(mesh, depth, nodal);
    set_axes(mesh, definition, depth, nodal, axes);
  }
  vsc_free(depth);
  vsc_free(nodal);
  return status;
}
