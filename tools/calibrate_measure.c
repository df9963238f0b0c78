// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/calibrate_measure.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mech/force.h"
#include "tools/shapes.h"

typedef struct block {
  vsc_mesh *mesh;
  vsc_axes *axes;
  vsc_surface boundary;
  vsc_model *model;
  vsc_state *state;
  uint32_t *number;  // the model's number of each mesh node
  size_t size;       // 3 x nodes, numbered as in the mesh
  double *force;     // 2 x 4 x nodes
  gsl_matrix *K;     // size x size, then its LU factors
  gsl_permutation *order;
  gsl_vector *load, *displacement;
} block;

static const double fiber[3] = {0.48, 0.6, 0.64}, sheet[3] = {-0.8, 0.6, 0.3};

static vsc_status make_body(block *b, const vsc_material_def *material, vsc_volume_kind volume,
                            vsc_error *error)
{
  const vsc_block_shape shape = {
      .cells = {4, 4, 4}, .size = {4, 4, 4}, .tets_per_cell = 5, .jitter = 0.25, .seed = 7};
  vsc_status status = vsc_block_mesh(&shape, &b->mesh, error);
  if (status == VSC_OK) status = vsc_boundary(b->mesh, &b->boundary, error);
  if (status != VSC_OK) return status;
  b->axes = vsc_axes_create(b->mesh->element_count);
  if (b->axes == NULL) return vsc_fail_memory(error, "a block");
  for (size_t t = 0; t < b->mesh->element_count; t++)
    b->axes->known[t] = vsc_axes_complete(fiber, sheet, b->axes->frames + 9 * t);
  vsc_material_def passive = *material;
  passive.active = vsc_default_active();
  passive.region_count = 0;
  passive.inclusion_count = 0;
  vsc_definition definition = vsc_default_definition();
  definition.materials = &passive;
  definition.material_count = 1;
  definition.volume = volume;
  definition.end_time = 1;
  status = vsc_model_build(b->mesh, b->axes, &definition, &b->model, error);
  return status == VSC_OK ? vsc_state_create(b->model, &b->state, error) : status;
}

static vsc_status make_arrays(block *b, vsc_error *error)
{
  b->size = 3 * b->mesh->node_count;
  b->number = vsc_model_node_numbers(b->model);
  b->K = gsl_matrix_calloc(b->size, b->size);
  b->order = gsl_permutation_alloc(b->size);
  b->load = gsl_vector_calloc(b->size);
  b->displacement = gsl_vector_calloc(b->size);
  if (b->number == NULL || b->K == NULL || b->order == NULL || b->load == NULL ||
      b->displacement == NULL || !VSC_NEW(b->force, 8 * b->mesh->node_count))
    return vsc_fail_memory(error, "a block");
  return VSC_OK;
}

static void free_block(block *b)
{
  gsl_vector_free(b->displacement);
  gsl_vector_free(b->load);
  gsl_permutation_free(b->order);
  gsl_matrix_free(b->K);
  vsc_free(b->force);
  vsc_free(b->number);
  vsc_state_free(b->state);
  vsc_model_free(b->model);
  vsc_surface_free(&b->boundary);
  vsc_axes_free(b->axes);
  vsc_mesh_free(b->mesh);
}

// K_ij = -d f_i / d x_j
static void fill_stiffness(block *b)
{
  const double h = 1e-5;  // mm: elements are 1 mm; its square and rounding over it are both 1e-11
  double *x = b->state->x, *plus = b->force, *minus = plus + 4 * b->mesh->node_count;
  for (size_t j = 0; j < b->size; j++) {
    double *moved = &x[4 * (size_t)b->number[j / 3] + j % 3];
    const double rest = *moved;
    *moved = rest + h;
    vsc_force(b->model, x, NULL, 0, &b->state->scratch, plus);
    *moved = rest - h;
    vsc_force(b->model, x, NULL, 0, &b->state->scratch, minus);
    *moved = rest;
    for (size_t i = 0; i < b->size; i++) {
      const size_t p = 4 * (size_t)b->number[i / 3] + i % 3;
      gsl_matrix_set(b->K, i, j, (minus[p] - plus[p]) / (2 * h));
    }
  }
}

// Adds w r r^T for the six rigid motions r: loads without force and moment don't move along them,
// and K has an inverse.
static void fix_rigid_motions(block *b)
{
  gsl_vector_const_view diagonal = gsl_matrix_const_diagonal(b->K);
  const double weight = gsl_blas_dasum(&diagonal.vector) / (double)(b->size * b->size);
  for (int k = 0; k < 6; k++) {
    for (size_t i = 0; i < b->size; i++) {
      const double *X = b->mesh->nodes + 3 * (i / 3);
      const double unit[3] = {k % 3 == 0, k % 3 == 1, k % 3 == 2};
      const double arm[3] = {X[0] - 2, X[1] - 2, X[2] - 2};
      double turned[3];
      vsc_cross(unit, arm, turned);
      gsl_vector_set(b->load, i, k < 3 ? unit[i % 3] : turned[i % 3]);
    }
    gsl_blas_dger(weight, b->load, b->load, b->K);
  }
}

// Area times outward normal of a boundary triangle.
static void triangle_normal(const block *b, const uint32_t node[3], double n[3])
{
  const double *X = b->mesh->nodes, *first = X + 3 * (size_t)node[0];
  double e[3], f[3];
  vsc_subtract(X + 3 * (size_t)node[1], first, e);
  vsc_subtract(X + 3 * (size_t)node[2], first, f);
  vsc_cross(e, f, n);
  for (int i = 0; i < 3; i++) n[i] /= 2;
}

// Tractions of the stress (3 x 3) on the boundary.
static void fill_load(block *b, const double stress[9])
{
  gsl_vector_set_zero(b->load);
  for (size_t t = 0; t < b->boundary.count; t++) {
    const uint32_t *node = b->boundary.triangles + 3 * t;
    double n[3];
    triangle_normal(b, node, n);
    for (int c = 0; c < 3; c++)
      for (int i = 0; i < 3; i++)
        *gsl_vector_ptr(b->load, 3 * (size_t)node[c] + i) += vsc_dot(stress + 3 * i, n) / 3;
  }
}

// Mean strain (3 x 3) of the displaced block.
static void read_strain(const block *b, double strain[9])
{
  memset(strain, 0, 9 * sizeof *strain);
  for (size_t t = 0; t < b->boundary.count; t++) {
    const uint32_t *node = b->boundary.triangles + 3 * t;
    double n[3], u[3] = {0};
    triangle_normal(b, node, n);
    for (int c = 0; c < 3; c++)
      for (int i = 0; i < 3; i++) u[i] += gsl_vector_get(b->displacement, 3 * node[c] + i) / 3;
    for (int i = 0; i < 9; i++)
      strain[i] += (u[i / 3] * n[i % 3] + u[i % 3] * n[i / 3]) / (2 * b->model->total_volume);
  }
}

// Column `v` of S: the strain, in the frame, under the unit stress number v of the frame.
static void measure_column(block *b, int v, double S[36])
{
  const int place[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {2, 0}, {0, 1}};
  const double *R = b->axes->frames;  // rows f, s, n, the same in all elements
  const double *d = R + 3 * place[v][0], *e = R + 3 * place[v][1];
  double stress[9], strain[9], along[3];
  for (int i = 0; i < 9; i++)
    stress[i] = (d[i / 3] * e[i % 3] + e[i / 3] * d[i % 3]) / (v < 3 ? 2 : 1);
  fill_load(b, stress);
  gsl_linalg_LU_solve(b->K, b->order, b->load, b->displacement);
  read_strain(b, strain);
  for (int w = 0; w < 6; w++) {
    const double *p = R + 3 * place[w][0], *q = R + 3 * place[w][1];
    for (int i = 0; i < 3; i++) along[i] = vsc_dot(strain + 3 * i, q);
    // the stiffness is symmetric but for rounding
    const double value = (w < 3 ? 1 : 2) * vsc_dot(p, along) / 2;
    S[6 * w + v] += value;
    S[6 * v + w] += value;
  }
}

static vsc_status measure(const vsc_material_def *material, vsc_volume_kind volume, double S[36],
                          vsc_error *error)
{
  block b = {0};
  vsc_status status = make_body(&b, material, volume, error);
  if (status == VSC_OK) status = make_arrays(&b, error);
  if (status == VSC_OK) {
    int sign;
    fill_stiffness(&b);
    fix_rigid_motions(&b);
    gsl_linalg_LU_decomp(b.K, b.order, &sign);
    gsl_vector_const_view pivots = gsl_matrix_const_diagonal(b.K);
    double least = INFINITY;
    for (size_t i = 0; i < b.size; i++) least = fmin(least, fabs(gsl_matrix_get(b.K, i, i)));
    if (!(least > 1e-9 * gsl_blas_dasum(&pivots.vector) / (double)b.size))
      status = vsc_fail(error, VSC_NUMERICAL, "material %s: a block of it has free mechanisms",
                        material->name);
  }
  memset(S, 0, 36 * sizeof *S);
  for (int v = 0; status == VSC_OK && v < 6; v++) measure_column(&b, v, S);
  free_block(&b);
  return status;
}

vsc_status vsc_measure_compliance(const vsc_material_def *material, vsc_volume_kind volume,
                                  double S[36], vsc_error *error)
{
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  const vsc_status status = measure(material, volume, S, error);
  gsl_set_error_handler(handler);
  return status;
}
