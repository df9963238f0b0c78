// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/tensors.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "base/sort.h"
#include "base/vec3.h"
#include "mech/element.h"
#include "mech/force.h"
#include "mech/prony.h"
#include "model/law.h"
#include "model/law_viscous.h"
#include "model/law_volume.h"

bool vsc_field_is_tensor(vsc_field field)
{
  return field >= VSC_FIELD_STRAIN_FIBER && field <= VSC_FIELD_PRINCIPAL_STRESS_AXIS;
}

bool vsc_field_is_stress(vsc_field field)
{
  return field >= VSC_FIELD_STRESS_FIBER && field <= VSC_FIELD_PRINCIPAL_STRESS_AXIS;
}

bool vsc_patch_has_stress(const vsc_model *model, const vsc_patch *patch)
{
  return vsc_patch_is_solid(patch) && vsc_law_is_of_strain(model->materials[patch->material].law);
}

// Symmetric tensors of four elements: 11 22 33 12 23 31, in fibre axes and in global ones.
typedef struct pack_tensors {
  vsc_wide fiber[6], global[6];
} pack_tensors;

// sum += weight sum_ab T_ab a_a (x) a_b
VSC_INLINE void add_products(vsc_wide weight, const vsc_wide T[6], const vsc_wide3 a[3],
                             vsc_wide sum[6])
{
  vsc_wide3 b[3];
  vsc_stress_on_axes(T, a, b);
  for (int c = 0; c < 3; c++) {
    const vsc_wide left[3] = {a[c].x, a[c].y, a[c].z}, right[3] = {b[c].x, b[c].y, b[c].z};
    for (int i = 0; i < 3; i++) {
      sum[i] += weight * (left[i] * right[i]);
      sum[3 + i] += weight * (left[i] * right[(i + 1) % 3]);
    }
  }
}

static void divide(vsc_wide by, pack_tensors *sum)
{
  const vsc_wide inverse = vsc_wide_inverse(by, 0);
  for (int i = 0; i < 6; i++) {
    sum->fiber[i] *= inverse;
    sum->global[i] *= inverse;
  }
}

// E = sum_ab E_ab a_a (x) a_b, a_a the axes at rest.
static pack_tensors strain_of(const vsc_model *model, const vsc_patch *patch, size_t k,
                              const double *x)
{
  pack_tensors sum = {0};
  vsc_wide volume = vsc_splat(0);
  for (int q = 0; q < vsc_family_frames(model, patch->family); q++) {
    const vsc_wide V = vsc_pack_frames(model, patch, k)[q].V;
    vsc_wide3 rest[3], g[3];
    vsc_wide E[6];
    vsc_pack_axes(model, patch, k, q, model->rest, rest);
    vsc_pack_axes(model, patch, k, q, x, g);
    vsc_strain_of(g, E);
    for (int a = 0; a < 3; a++) E[3 + a] *= 0.5;
    for (int i = 0; i < 6; i++) sum.fiber[i] += V * E[i];
    add_products(V, E, rest, sum.global);
    volume += V;
  }
  divide(volume, &sum);
  return sum;
}

// S of the law with its activity, and of what resists the rate of strain.
static void stress_on_frame(const vsc_law_input *in, const vsc_wide3 g[3], const vsc_wide3 *rate,
                            vsc_wide S[6])
{
  vsc_law_answer answer;
  vsc_wide e[6], speed[6];
  vsc_strain_of(g, e);
  vsc_law_evaluate(in, e, VSC_LAW_STRESS, &answer);
  memcpy(S, answer.S, sizeof answer.S);
  if (rate == NULL) return;
  vsc_strain_rate(g, rate, speed);
  vsc_law_add_viscous_stress(in->material, &in->moduli, in->axes, e, speed, S);
}

static vsc_wide3 unit_of(vsc_wide3 a)
{
  const vsc_wide length = vsc_wide_sqrt(vsc_wide_dot(a, a));
  return vsc_wide_scale(vsc_wide_inverse(length, VSC_NO_LENGTH), a);
}

// The axes as seen in the deformed fibre frame: f along g_f, s in the plane of g_f and g_s, n across it.
static void in_deformed_frame(const vsc_wide3 g[3], vsc_wide3 seen[3])
{
  const vsc_wide3 f = unit_of(g[0]), n = unit_of(vsc_wide_cross(g[0], g[1]));
  const vsc_wide3 s = vsc_wide_cross(n, f);
  for (int a = 0; a < 3; a++)
    seen[a] = (vsc_wide3){vsc_wide_dot(f, g[a]), vsc_wide_dot(s, g[a]), vsc_wide_dot(n, g[a])};
}

// U'(J) that all frames share: of the cell's mean volume ratio, or the mean of a tet's nodes.
static vsc_wide shared_pressure(const vsc_patch_work *work, const vsc_model *model,
                                const vsc_patch *patch, size_t k, const vsc_mixture *moduli,
                                const vsc_wide *J)
{
  const vsc_frame *frames = vsc_pack_frames(model, patch, k);
  vsc_wide pressure = vsc_splat(0), volume = vsc_splat(0), rest = vsc_splat(0);
  if (patch->family == VSC_TETS) {
    const uint16_t(*node)[VSC_WIDTH] = vsc_pack_nodes(model, patch, k);
    for (int c = 0; work->shares_volume && c < 4; c++)
      for (int l = 0; l < VSC_WIDTH; l++) pressure[l] += 0.25 * work->pressure[node[c][l]];
    return pressure;
  }
  for (int q = 0; q < vsc_family_frames(model, patch->family); q++) {
    volume += frames[q].V * J[q];
    rest += frames[q].V;
  }
  const vsc_wide_mask full = rest > 0;
  if (work->multipliers != NULL) pressure = work->multipliers[k - patch->first_pack];
  return pressure +
         vsc_volume_stress(moduli->volume_modulus, vsc_select(full, volume, vsc_splat(1)) /
                                                       vsc_select(full, rest, vsc_splat(1)));
}

// The multiplier that keeps the volume of number `source`; 0 where that cannot change.
static double kept_at(const vsc_kept_volumes *kept, const double *pressure, uint32_t source)
{
  const uint32_t *found = bsearch(&source, kept->source, kept->count, sizeof source, vsc_compare_uint32);
  return found != NULL ? pressure[found - kept->source] : 0;
}

// What multipliers of kept volumes add to the mean stress: they push outwards where they are positive. Those of single
// elements are left out: their sums over neighbours are known, they are not.
static vsc_wide kept_stress(const vsc_model *model, const vsc_patch *patch, size_t k, const double *pressure)
{
  const vsc_kept_volumes *kept = &model->kept;
  const int corners = vsc_family_corners(patch->family);
  vsc_wide sum = vsc_splat(0);
  if (kept->kind == VSC_KEEP_TOTAL) return vsc_splat(-pressure[0]);
  if (kept->kind == VSC_KEEP_REGION) return vsc_splat(-kept_at(kept, pressure, patch->material));
  for (int c = 0; kept->kind == VSC_KEEP_NODE && c < corners; c++)
    for (int l = 0; l < VSC_WIDTH; l++) {
      const uint32_t node = vsc_node_of(model, patch, vsc_pack_nodes(model, patch, k)[c][l]);
      sum[l] += kept_at(kept, pressure, model->mesh_node[node]) / corners;
    }
  return -sum;
}

// S += what the branches of Prony series have in the frame.
static void add_relaxed(const vsc_model *model, const vsc_material *material, const double *prony, size_t frame,
                        vsc_wide S[6])
{
  vsc_wide relaxed[6];
  if (material->branch_count == 0) return;
  vsc_prony_stress(model, material, prony, frame, relaxed);
  for (int i = 0; i < 6; i++) S[i] += relaxed[i];
}

// J sigma = sum_ab S_ab g_a (x) g_b + J p 1 of each frame; sigma = sum V (J sigma)/sum V J.
static pack_tensors stress_of(const vsc_patch_work *work, const vsc_model *model,
                              const vsc_patch *patch, size_t k, const vsc_state *state)
{
  const size_t place = k - patch->first_pack;
  const int frames = vsc_family_frames(model, patch->family);
  const vsc_law_input in = {
      .material = work->material,
      .axes = work->axes,
      .pairs = work->pairs,
      .moduli = vsc_moduli_or(work->material, patch->mixed ? vsc_pack_mixture(model, patch, k) : NULL),
      .activation = work->activation[place * work->activation_stride]};
  // a tet's own volume modulus, or that of each frame beside the shared volume
  const vsc_wide own =
      patch->family == VSC_TETS ? in.moduli.element_modulus : in.moduli.stabilization;
  vsc_wide3 g[VSC_MOST_POINTS][3], rate[3], seen[3];
  vsc_wide J[VSC_MOST_POINTS], S[6], volume = vsc_splat(0);
  pack_tensors sum = {0};
  for (int q = 0; q < frames; q++) {
    vsc_pack_axes(model, patch, k, q, state->x, g[q]);
    J[q] = vsc_pack_ratio(g[q]);
  }
  vsc_wide shared = shared_pressure(work, model, patch, k, &in.moduli, J);
  if (model->kept.count > 0) shared += kept_stress(model, patch, k, state->kept_pressure);
  for (int q = 0; q < frames; q++) {
    const vsc_wide V = vsc_pack_frames(model, patch, k)[q].V;
    const vsc_wide pressure = V * J[q] * (shared + vsc_volume_stress(own, J[q]) +
                                          vsc_rest_stress(vsc_splat(work->material->rest_shear), J[q]));
    if (work->w != NULL) vsc_pack_axes(model, patch, k, q, state->v, rate);
    stress_on_frame(&in, g[q], work->w != NULL ? rate : NULL, S);
    add_relaxed(model, work->material, state->prony, patch->first_frame + place * (size_t)frames + (size_t)q, S);
    in_deformed_frame(g[q], seen);
    add_products(V, S, seen, sum.fiber);
    add_products(V, S, g[q], sum.global);
    for (int i = 0; i < 3; i++) {
      sum.fiber[i] += pressure;
      sum.global[i] += pressure;
    }
    volume += V * J[q];
  }
  divide(volume, &sum);
  return sum;
}

// ---- what is made of a tensor

static double von_mises(const double T[6])
{
  const double a = T[0] - T[1], b = T[1] - T[2], c = T[2] - T[0];
  return sqrt(0.5 * (a * a + b * b + c * c) + 3 * (T[3] * T[3] + T[4] * T[4] + T[5] * T[5]));
}

// Eigenvalues from the largest to the smallest, and the unit vector of the largest, whose largest
// component is positive.
static void principal(const double T[6], double values[3], double axis[3])
{
  double matrix[9] = {T[0], T[3], T[5], T[3], T[1], T[4], T[5], T[4], T[2]}, vectors[9];
  double memory[4][3];
  gsl_eigen_symmv_workspace work = {3, memory[0], memory[1], memory[2], memory[3]};
  gsl_matrix_view from = gsl_matrix_view_array(matrix, 3, 3);
  gsl_vector_view value = gsl_vector_view_array(values, 3);
  gsl_matrix_view vector = gsl_matrix_view_array(vectors, 3, 3);
  gsl_eigen_symmv(&from.matrix, &value.vector, &vector.matrix, &work);
  gsl_eigen_symmv_sort(&value.vector, &vector.matrix, GSL_EIGEN_SORT_VAL_DESC);
  int largest = 0;
  for (int i = 1; i < 3; i++)
    if (fabs(vectors[3 * i]) > fabs(vectors[3 * largest])) largest = i;
  for (int i = 0; i < 3; i++)
    axis[i] = vectors[3 * largest] < 0 ? -vectors[3 * i] : vectors[3 * i];
}

static void read_slot(const pack_tensors *tensors, vsc_field field, int lane, bool known,
                      double *value)
{
  double fiber[6], global[6], other[3];
  for (int i = 0; i < 6; i++) {
    fiber[i] = known ? tensors->fiber[i][lane] : 0;
    global[i] = tensors->global[i][lane];
  }
  switch (field) {
    case VSC_FIELD_STRAIN_FIBER:
    case VSC_FIELD_STRESS_FIBER:
      memcpy(value, fiber, sizeof fiber);
      break;
    case VSC_FIELD_VON_MISES:
      *value = von_mises(global);
      break;
    case VSC_FIELD_PRINCIPAL_STRAINS:
    case VSC_FIELD_PRINCIPAL_STRESSES:
      principal(global, value, other);
      break;
    case VSC_FIELD_PRINCIPAL_STRAIN_AXIS:
    case VSC_FIELD_PRINCIPAL_STRESS_AXIS:
      principal(global, other, value);
      break;
    default:
      memcpy(value, global, sizeof global);
  }
}

// ---- all elements

typedef struct tensor_reading {
  const vsc_model *model;
  vsc_state *state;
  vsc_field field;
  double *values;
} tensor_reading;

static void read_patch(void *context, size_t p, int thread)
{
  const tensor_reading *r = context;
  const vsc_model *model = r->model;
  const vsc_patch *patch = &model->patches[p];
  const bool stress = vsc_field_is_stress(r->field);
  const size_t components = (size_t)vsc_field_components(r->field);
  if (!vsc_patch_is_solid(patch) || (stress && !vsc_patch_has_stress(model, patch))) return;
  // velocities of equilibria say how the load changes: nothing resists them
  const double *w = model->solve.kind == VSC_SOLVE_EQUILIBRIUM ? NULL : r->state->v;
  vsc_patch_work work = {0};
  if (stress)
    work = vsc_patch_prepare(model, patch, r->state->x, w, NULL, r->state->time,
                             &r->state->scratch, thread);
  for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++) {
    const pack_tensors tensors = stress ? stress_of(&work, model, patch, k, r->state)
                                        : strain_of(model, patch, k, r->state->x);
    for (int l = 0; l < VSC_WIDTH; l++) {
      const size_t slot = VSC_WIDTH * k + (size_t)l, element = model->mesh_element[slot];
      if (element == VSC_NO_ELEMENT) continue;
      read_slot(&tensors, r->field, l, model->known[slot], r->values + components * element);
    }
  }
}

void vsc_read_tensors(const vsc_model *model, vsc_state *state, vsc_field field, double *values)
{
  tensor_reading r = {model, state, field, values};
  memset(values, 0,
         (size_t)vsc_field_components(field) * model->element_count * sizeof *values);
  if (vsc_field_is_stress(field) && model->terms.nodal_volume)
    vsc_group_volumes(model, state->x, &state->scratch);
  vsc_parallel_for(model->patch_count, read_patch, &r);
}
