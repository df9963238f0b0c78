// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/energies.h"

#include "mech/element.h"
#include "model/law.h"
#include "model/law_viscous.h"
#include "model/law_volume.h"

VSC_INLINE vsc_wide length_of(vsc_wide3 a)
{
  return vsc_wide_sqrt(vsc_wide_dot(a, a));
}

VSC_INLINE vsc_wide per_length(vsc_wide number, vsc_wide length)
{
  const vsc_wide_mask long_enough = length > VSC_NO_LENGTH;
  return vsc_where(long_enough, number / vsc_select(long_enough, length, vsc_splat(1)));
}

VSC_INLINE vsc_wide3 along_axis(const double d[3], const vsc_wide3 g[3])
{
  return vsc_wide_combine(vsc_splat(d[0]), g[0], vsc_splat(d[1]), g[1], vsc_splat(d[2]), g[2]);
}

// ---- cells

VSC_INLINE void add_more_axes(const vsc_model *model, const vsc_material *material, vsc_wide V,
                              const vsc_wide3 g[3], const vsc_wide3 rate[3], vsc_pack_energies *sum)
{
  for (size_t d = 0; d < material->axis_count; d++) {
    const vsc_axis *axis = &model->axes[material->first_axis + d];
    const vsc_wide3 way = along_axis(axis->direction, g);
    const vsc_wide length = length_of(way), strain = length - 1;
    const vsc_wide speed = vsc_wide_dot(along_axis(axis->direction, rate), way) / vsc_no_shorter(length);
    sum->axial += 0.5 * axis->modulus * V * strain * strain;
    sum->dissipation += axis->damping * V * speed * speed;
  }
  for (size_t d = 0; d < material->pair_count; d++) {
    const vsc_pair *pair = &model->pairs[material->first_pair + d];
    const vsc_wide3 first = along_axis(pair->first, g), second = along_axis(pair->second, g);
    const vsc_wide c = vsc_wide_dot(first, second) / vsc_no_shorter(length_of(first)) / vsc_no_shorter(length_of(second));
    sum->angular += 0.5 * pair->modulus * V * (c - pair->cosine) * (c - pair->cosine);
  }
}

VSC_INLINE void add_springs(const vsc_model *model, const vsc_material *material,
                            const vsc_pack_law *law, vsc_wide V, const vsc_wide3 g[3],
                            const vsc_wide3 rate[3], vsc_pack_energies *sum)
{
  const vsc_frame_axes axes = vsc_frame_of(g);
  sum->axial += V * vsc_springs_axial_energy(&law->springs, &axes);
  sum->angular += V * vsc_springs_angular_energy(&law->springs, &axes);
  for (int a = 0; a < 3; a++) {
    const vsc_wide speed = vsc_wide_dot(rate[a], axes.u[a]);
    sum->dissipation += V * law->damping[a] * speed * speed;
    sum->axial += V * law->coupling[a] * (axes.length[a] - 1) * (axes.length[(a + 1) % 3] - 1);
  }
  add_more_axes(model, material, law->share * V, g, rate, sum);
}

// psi - m ln J of a tissue law.
VSC_INLINE void add_tissue(const vsc_material *material, vsc_wide V, const vsc_wide3 g[3],
                           vsc_pack_energies *sum)
{
  const vsc_law_input in = {.material = material, .moduli = vsc_moduli_or(material, NULL)};
  const vsc_wide J = vsc_pack_ratio(g);
  vsc_law_answer answer;
  vsc_wide e[6];
  vsc_strain_of(g, e);
  vsc_law_evaluate(&in, e, VSC_LAW_ENERGY, &answer);
  sum->axial += V * answer.energy;
  for (int l = 0; l < VSC_WIDTH; l++) {
    sum->axial[l] += V[l] * vsc_rest_energy(material->rest_shear, J[l]);
    sum->continued[l] += V[l] > 0 && answer.exponent[l] > VSC_LARGEST_EXPONENT;
  }
}

// eta dE/dt : dE/dt
VSC_INLINE vsc_wide viscous_power(vsc_wide viscosity, const vsc_wide3 g[3], const vsc_wide3 rate[3])
{
  vsc_wide speed[6], square = vsc_splat(0);
  vsc_strain_rate(g, rate, speed);
  for (int k = 0; k < 6; k++) square += (k < 3 ? 1.0 : 0.5) * speed[k] * speed[k];
  return viscosity * square;
}

// Four frames of any law of strain, which stand for the volumes V.
VSC_INLINE void add_law(const vsc_model *model, const vsc_material *material, const vsc_pack_law *law,
                        bool damped, vsc_wide V, const vsc_wide3 g[3], const vsc_wide3 rate[3],
                        vsc_pack_energies *sum)
{
  if (material->law == VSC_LAW_SPRINGS)
    add_springs(model, material, law, V, g, rate, sum);
  else
    add_tissue(material, V, g, sum);
  if (damped) sum->dissipation += V * viscous_power(law->viscosity, g, rate);
}

vsc_pack_energies vsc_edge_energies_of(const vsc_model *model, const vsc_edge_work *work, size_t k)
{
  const vsc_pack_law law = vsc_material_law(work->material);
  vsc_pack_energies sum = {0};
  vsc_wide3 g[3], rate[3] = {0};
  vsc_edge_axes(work, k, work->gradient, g);
  if (work->rate != NULL) vsc_edge_axes(work, k, work->rate, rate);
  add_law(model, work->material, &law, work->rate != NULL, work->frames[k].V, g, rate, &sum);
  return sum;
}

VSC_CLONED static vsc_pack_energies cells(const vsc_model *model, const vsc_patch *patch, size_t k, const vsc_pack_law *law,
                                          vsc_wide3 (*axes)[3], const double *v)
{
  const vsc_material *material = &model->materials[patch->material];
  const vsc_frame *frames = vsc_pack_frames(model, patch, k);
  const int points = vsc_family_frames(model, patch->family);
  const bool damped = vsc_patch_is_damped(model, patch);
  vsc_pack_energies sum = {0};
  vsc_wide rest = vsc_splat(0), now = vsc_splat(0);
  for (int q = 0; q < points; q++) {
    const vsc_wide V = frames[q].V;
    vsc_wide3 rate[3] = {0};
    if (damped) vsc_pack_axes(model, patch, k, q, v, rate);
    const vsc_wide J = vsc_pack_ratio(axes[q]);
    if (!patch->smoothed) add_law(model, material, law, damped, V, axes[q], rate, &sum);
    sum.volume +=
        V * vsc_volume_energies(patch->family == VSC_TETS ? law->element_modulus : law->stabilization, J);
    rest += V;
    now += V * J;
  }
  if (patch->family != VSC_TETS) {
    const vsc_wide J = vsc_select(rest > 0, now / vsc_select(rest > 0, rest, vsc_splat(1)), vsc_splat(1));
    sum.volume += rest * vsc_volume_energies(law->volume_modulus, J);
  }
  return sum;
}

// ---- law PAPER

VSC_INLINE void add_paper_axes(const vsc_paper_def *paper, const vsc_wide3 l[3], const vsc_wide3 rate[3],
                               const vsc_wide r[3], vsc_pack_energies *sum)
{
  vsc_wide length[3];
  for (int a = 0; a < 3; a++) {
    length[a] = length_of(l[a]);
    const vsc_wide speed = per_length(vsc_wide_dot(rate[a], l[a]), length[a]);
    sum->axial += 0.5 * paper->axial[a] * (length[a] - r[a]) * (length[a] - r[a]);
    sum->dissipation += paper->damping[a] * speed * speed;
  }
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3;
    const vsc_wide c = per_length(per_length(vsc_wide_dot(l[a], l[b]), length[a]), length[b]);
    sum->angular += 0.25 * paper->angular[a] * (r[a] + r[b]) * c * c;
  }
}

static vsc_pack_energies paper_cells(const vsc_model *model, const vsc_patch *patch, size_t k,
                                     vsc_wide3 (*frame)[3], const double *x, const double *v)
{
  const vsc_paper_def *paper = &model->materials[patch->material].paper;
  const bool tets = patch->family == VSC_TETS;
  const int corners = tets ? 4 : 8;
  const vsc_chords *chords = vsc_pack_law_data(model, patch, k);
  const vsc_hex_axes *axes = vsc_pack_law_data(model, patch, k);
  vsc_pack_energies sum = {0};
  vsc_wide3 at[8], speed[8], l[3] = {0}, rate[3] = {0}, centre = {0}, drift = {0};
  vsc_pack_corners(model, patch, vsc_pack_nodes(model, patch, k), corners, x, at);
  vsc_pack_corners(model, patch, vsc_pack_nodes(model, patch, k), corners, v, speed);
  if (tets) {
    vsc_pack_axes(model, patch, k, 0, v, rate);
    for (int a = 0; a < 3; a++) {
      l[a] = vsc_wide_scale(chords->r[a], frame[0][a]);
      rate[a] = vsc_wide_scale(chords->r[a], rate[a]);
    }
  }
  for (int a = 0; a < 3 && !tets; a++)
    for (int i = 0; i < 8; i++) {
      l[a] = vsc_wide_add(l[a], vsc_wide_scale(axes->w[a][i], at[i]));
      rate[a] = vsc_wide_add(rate[a], vsc_wide_scale(axes->w[a][i], speed[i]));
    }
  add_paper_axes(paper, l, rate, tets ? chords->r : axes->r, &sum);
  const vsc_wide part = vsc_splat(1.0 / corners);
  for (int i = 0; i < corners; i++) {
    centre = vsc_wide_add(centre, vsc_wide_scale(part, at[i]));
    drift = vsc_wide_add(drift, vsc_wide_scale(part, speed[i]));
  }
  vsc_wide radius = vsc_splat(0);
  for (int i = 0; i < corners; i++) {
    const vsc_wide3 d = vsc_wide_minus(at[i], centre);
    const vsc_wide length = length_of(d);
    radius += length;
    if (tets) continue;
    // the barycentre is not pulled back, so the power is that of the corner alone
    const vsc_wide change = per_length(vsc_wide_dot(vsc_wide_minus(speed[i], drift), d), length);
    const vsc_wide own = per_length(vsc_wide_dot(speed[i], d), length);
    sum.volume += 0.5 * paper->volume * (length - axes->radius[i]) * (length - axes->radius[i]);
    sum.dissipation += paper->volume_damping * change * own;
  }
  if (tets) sum.volume += 0.5 * paper->volume * (radius - chords->radius) * (radius - chords->radius);
  return sum;
}

// ---- classical springs

static vsc_pack_energies edge_springs(const vsc_model *model, const vsc_patch *patch, size_t k,
                                      const double *x, const double *v)
{
  const vsc_classical_def *law = &model->materials[patch->material].classical;
  const vsc_edge_pack *pack =
      (const vsc_edge_pack *)(model->store + patch->packs) + (k - patch->first_pack);
  vsc_wide3 at[2], speed[2];
  vsc_pack_corners(model, patch, pack->node, 2, x, at);
  vsc_pack_corners(model, patch, pack->node, 2, v, speed);
  const vsc_wide3 way = vsc_wide_minus(at[0], at[1]);
  const vsc_wide length = length_of(way), strain = length - pack->length;
  const vsc_wide change = per_length(vsc_wide_dot(vsc_wide_minus(speed[0], speed[1]), way), length);
  return (vsc_pack_energies){.axial = 0.5 * law->stiffness * strain * strain,
                             .dissipation = law->damping * change * change};
}

// ---- membranes

static vsc_pack_energies triangles(const vsc_model *model, const vsc_patch *patch, size_t k,
                                   const double *x, const double *v)
{
  const vsc_triangle_pack *pack = vsc_triangles_of(model, patch) + (k - patch->first_pack);
  const vsc_membrane *membrane = &model->membranes[patch->material];
  vsc_wide3 at[3], speed[3], g[2], rate[2];
  vsc_pack_corners(model, patch, pack->node, 3, x, at);
  vsc_pack_corners(model, patch, pack->node, 3, v, speed);
  for (int a = 0; a < 2; a++) {
    g[a] = rate[a] = (vsc_wide3){vsc_splat(0), vsc_splat(0), vsc_splat(0)};
    for (int i = 0; i < 2; i++) {
      const vsc_wide part = pack->T[a][i];
      g[a] = vsc_wide_add(g[a], vsc_wide_scale(part, vsc_wide_minus(at[i + 1], at[0])));
      rate[a] = vsc_wide_add(rate[a], vsc_wide_scale(part, vsc_wide_minus(speed[i + 1], speed[0])));
    }
  }
  const vsc_sheet_axes axes = vsc_sheet_axes_of(g);
  vsc_pack_energies sum = {.membrane = pack->V * vsc_sheet_energy(&membrane->moduli, &axes)};
  for (int a = 0; a < 2; a++) {
    const vsc_wide change = vsc_wide_dot(rate[a], axes.u[a]);
    sum.dissipation += membrane->damping[a] * pack->V * change * change;
  }
  return sum;
}

static vsc_pack_energies bends(const vsc_model *model, const vsc_patch *patch, size_t k,
                               const double *x, const double *v)
{
  const vsc_bend_pack *pack = vsc_bends_of(model, patch) + (k - patch->first_pack);
  vsc_wide3 at[VSC_BEND_NODES], speed[VSC_BEND_NODES];
  vsc_wide rates[VSC_BEND_FOLDS];
  vsc_fold folds[VSC_BEND_FOLDS];
  vsc_pack_corners(model, patch, pack->node, VSC_BEND_NODES, x, at);
  vsc_pack_corners(model, patch, pack->node, VSC_BEND_NODES, v, speed);
  vsc_bend_folds(at, folds);
  vsc_bend_rates(folds, speed, rates);
  const double lag = model->membranes[patch->material].lag;
  return (vsc_pack_energies){.bending = vsc_bend_energy(&pack->bends, folds),
                             .dissipation = lag * vsc_bend_square(&pack->bends, rates)};
}

vsc_pack_energies vsc_surface_energies_of(const vsc_model *model, const vsc_patch *patch, size_t k,
                                          const double *x, const double *v)
{
  if (patch->family == VSC_TRIANGLES) return triangles(model, patch, k, x, v);
  if (patch->family == VSC_BENDS) return bends(model, patch, k, x, v);
  return edge_springs(model, patch, k, x, v);
}

vsc_pack_energies vsc_cell_energies_of(const vsc_model *model, const vsc_patch *patch, size_t k,
                                       const vsc_pack_law *law, vsc_wide3 (*axes)[3], const double *x,
                                       const double *v)
{
  switch (model->materials[patch->material].law) {
    case VSC_LAW_PAPER:
      return paper_cells(model, patch, k, axes, x, v);
    case VSC_LAW_CLASSICAL:
      return (vsc_pack_energies){0};
    default:
      return cells(model, patch, k, law, axes, v);
  }
}
