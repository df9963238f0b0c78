// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/step_limit.h"

#include <math.h>
#include <string.h>

#include "mech/element.h"
#include "model/small_strain.h"

// What a tension at full activation adds to the tangent: T to the axes that it pulls, and as it grows
// with length |T'| of the vector (1, k_s, k_n).
static double tension_stiffness(const vsc_material *m)
{
  const double *part = m->tension_parts, most = fmax(1, fmax(part[0], part[1]));
  if (m->active != VSC_ACTIVE_TENSION) return 0;
  return m->tension * (most + fabs(m->length_factor) * sqrt(1 + part[0] * part[0] + part[1] * part[1]));
}

// A bound of the tangent of four elements' springs at rest: E_a along an axis, 2 G_ab across, and all
// couplings; a fibre that pulls with a tension T adds T across, T = E_f (1 - r) in an active spring.
// Further axes add theirs.
static vsc_wide stiffest_springs(const vsc_model *model, const vsc_patch *patch, size_t k)
{
  const vsc_material *material = &model->materials[patch->material];
  const vsc_pack_law law = vsc_pack_law_of(model, patch, k);
  vsc_wide most;
  for (int l = 0; l < VSC_WIDTH; l++) {
    double along = 0, across = 0, tension = 0, coupled = 0;
    for (int a = 0; a < 3; a++) {
      along = fmax(along, law.springs.axial[a][l]);
      across = fmax(across, 2 * law.springs.angular[a][l]);
      coupled += fabs(law.coupling[a][l]);
    }
    if (material->active == VSC_ACTIVE_SPRING) {
      along = fmax(along, law.active_axial[l]);
      tension = along * (1 - material->rest_stretch);
    }
    most[l] = fmax(along, across + tension) + tension_stiffness(material) + coupled;
  }
  for (size_t d = 0; d < material->axis_count; d++)
    most += model->axes[material->first_axis + d].modulus;
  for (size_t d = 0; d < material->pair_count; d++)
    most += 2 * model->pairs[material->first_pair + d].modulus;
  return most;
}

// K of four elements: their own, and for tets that share volume the mean of their nodes' groups':
// V_n J_n'^2 <= sum_e V_e/4 J_e'^2.
static vsc_wide volume_moduli(const vsc_model *model, const vsc_patch *patch, size_t k)
{
  const vsc_pack_law law = vsc_pack_law_of(model, patch, k);
  if (patch->family != VSC_TETS) return law.volume_modulus + law.stabilization;
  vsc_wide modulus = law.element_modulus;
  if (!vsc_patch_shares_volume(model, patch)) return modulus;
  for (int c = 0; c < 4; c++)
    for (int l = 0; l < VSC_WIDTH; l++)
      modulus[l] +=
          model->group_modulus[vsc_node_of(model, patch, vsc_pack_nodes(model, patch, k)[c][l])] / 4;
  return modulus;
}

// sum_q V B_i . B_j of corners i and j, B_ai = sum_k T_ak D_ki
static vsc_wide gradient_products(const vsc_model *model, const vsc_patch *patch, size_t k, int i, int j)
{
  vsc_wide sum = vsc_splat(0);
  for (int q = 0; q < vsc_family_frames(model, patch->family); q++) {
    const vsc_frame *frame = vsc_pack_frames(model, patch, k) + q;
    const double(*D)[VSC_MOST_CORNERS] = model->rules[patch->family].D[q];
    for (int a = 0; a < 3; a++) {
      const vsc_wide *T = frame->T[a];
      sum += frame->V * (T[0] * D[0][i] + T[1] * D[1][i] + T[2] * D[2][i]) *
             (T[0] * D[0][j] + T[1] * D[1][j] + T[2] * D[2][j]);
    }
  }
  return sum;
}

// The same of each corner with itself.
VSC_CLONED static void gradient_squares(const vsc_model *model, const vsc_patch *patch, size_t k, vsc_wide *squares)
{
  const int corners = vsc_family_corners(patch->family);
  for (int i = 0; i < corners; i++) squares[i] = vsc_splat(0);
  for (int q = 0; q < vsc_family_frames(model, patch->family); q++) {
    const vsc_frame *frame = vsc_pack_frames(model, patch, k) + q;
    const double(*D)[VSC_MOST_CORNERS] = model->rules[patch->family].D[q];
    for (int i = 0; i < corners; i++)
      for (int a = 0; a < 3; a++) {
        const vsc_wide *T = frame->T[a], B = T[0] * D[0][i] + T[1] * D[1][i] + T[2] * D[2][i];
        squares[i] += frame->V * B * B;
      }
  }
}

// What radial forces add to a corner of law PAPER, each bounded by all of them, mN/mm.
static double radial_stiffness(const vsc_material *material, uint32_t family)
{
  return material->law == VSC_LAW_PAPER ? material->paper.volume * (family == VSC_TETS ? 4 : 2) : 0;
}

// The tangent of four cells at rest, volume aside.
static vsc_wide stiffest(const vsc_model *model, const vsc_patch *patch, size_t k)
{
  const vsc_material *material = &model->materials[patch->material];
  if (material->law == VSC_LAW_SPRINGS || material->law == VSC_LAW_PAPER)
    return stiffest_springs(model, patch, k);
  return vsc_splat(vsc_material_stiffest(model, material) + tension_stiffness(material));
}

// A bound of what a rate of strain adds to stress, kPa ms.
static double strongest_damping(const vsc_model *model, const vsc_material *material)
{
  double most = fmax(material->damping[0], fmax(material->damping[1], material->damping[2]));
  for (size_t d = 0; d < material->axis_count; d++) most += model->axes[material->first_axis + d].damping;
  return most + material->viscosity;
}

// Who takes stiffness, and whether that of pairs of nodes too.
typedef struct receiver {
  vsc_coupling_sink *sink;
  void *context;
  bool pairs;
  double rate;  // 2/dt, 1/ms
} receiver;

// The nodes j of `corners` with which node i is a pair.
static int first_partner(const receiver *to, int i)
{
  return to->pairs ? 0 : i;
}

static int last_partner(const receiver *to, int i, int corners)
{
  return to->pairs ? corners - 1 : i;
}

static void give(const receiver *to, const vsc_model *model, const vsc_patch *patch, uint16_t a, uint16_t b, double k)
{
  to->sink(to->context, vsc_node_of(model, patch, a), vsc_node_of(model, patch, b), k);
}

static void give_cells(const receiver *to, const vsc_model *model, const vsc_patch *patch)
{
  const vsc_material *material = &model->materials[patch->material];
  const double radial = to->pairs ? 0 : radial_stiffness(material, patch->family);
  const double damping = to->rate * strongest_damping(model, material);
  const int corners = vsc_family_corners(patch->family);
  for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++) {
    const vsc_wide modulus = stiffest(model, patch, k) + volume_moduli(model, patch, k) + damping;
    const uint16_t(*node)[VSC_WIDTH] = vsc_pack_nodes(model, patch, k);
    vsc_wide squares[VSC_MOST_CORNERS];
    gradient_squares(model, patch, k, squares);
    for (int i = 0; i < corners; i++)
      for (int j = first_partner(to, i); j <= last_partner(to, i, corners); j++) {
        const vsc_wide square = i == j ? squares[i] : gradient_products(model, patch, k, i, j);
        for (int l = 0; l < VSC_WIDTH; l++)
          if (model->mesh_element[VSC_WIDTH * k + (size_t)l] != VSC_NO_ELEMENT)
            give(to, model, patch, node[i][l], node[j][l], modulus[l] * square[l] + radial);
      }
  }
}

// A classical spring bounds k on both of its nodes.
static void give_springs(const receiver *to, const vsc_model *model, const vsc_patch *patch)
{
  const vsc_edge_pack *packs = (const vsc_edge_pack *)(model->store + patch->packs);
  const double stiffness = model->materials[patch->material].classical.stiffness;
  for (size_t k = 0; k < patch->pack_count; k++)
    for (int l = 0; l < VSC_WIDTH; l++)
      for (int i = 0; i < 2 && packs[k].length[l] > 0; i++)
        for (int j = first_partner(to, i); j <= last_partner(to, i, 2); j++)
          give(to, model, patch, packs[k].node[i][l], packs[k].node[j][l], i == j ? stiffness : -stiffness);
}

// At rest a triangle's energy is at most V (max(E, 2 G) + 2 K) |dg|^2 / 2.
static void give_triangles(const receiver *to, const vsc_model *model, const vsc_patch *patch)
{
  const vsc_sheet_moduli *law = &model->membranes[patch->material].moduli;
  const double modulus =
      fmax(fmax(law->axial[0], law->axial[1]), 2 * law->angular) + 2 * law->area;
  const vsc_triangle_pack *packs = vsc_triangles_of(model, patch);
  for (size_t k = 0; k < patch->pack_count; k++)
    for (int i = 0; i < 3; i++)
      for (int j = first_partner(to, i); j <= last_partner(to, i, 3); j++) {
        vsc_wide product = vsc_splat(0);
        for (int a = 0; a < 2; a++) {
          const vsc_wide *T = packs[k].T[a], B[3] = {-(T[0] + T[1]), T[0], T[1]};
          product += B[i] * B[j];
        }
        for (int l = 0; l < VSC_WIDTH; l++)
          give(to, model, patch, packs[k].node[i][l], packs[k].node[j][l], modulus * packs[k].V[l] * product[l]);
      }
}

// |dm_k/dx_i|^2 summed over k, of four bends at rest: |m| <= sum_i of its roots times |x_i - rest|.
static void moment_gradients(const vsc_bends *bends, const vsc_wide3 x[VSC_BEND_NODES],
                             vsc_wide square[VSC_BEND_NODES])
{
  vsc_fold folds[VSC_BEND_FOLDS];
  vsc_bend_folds(x, folds);
  for (int i = 0; i < VSC_BEND_NODES; i++) square[i] = vsc_splat(0);
  for (int k = 0; k < 3; k++) {
    vsc_wide3 gradient[VSC_BEND_NODES] = {0};
    for (int j = 0; j < VSC_BEND_FOLDS; j++) {
      const vsc_fold *fold = &folds[j];
      const int *node = vsc_bend_fold_nodes[j];
      const vsc_wide G = fold->slope * bends->G[k][j];
      const vsc_wide s_part[4] = {fold->s_l - 1, -fold->s_l, vsc_splat(1), vsc_splat(0)};
      const vsc_wide r_part[4] = {fold->r_l - 1, -fold->r_l, vsc_splat(0), vsc_splat(1)};
      for (int c = 0; c < 4; c++)
        gradient[node[c]] = vsc_wide_combine(vsc_splat(1), gradient[node[c]], G * s_part[c],
                                             fold->on_s, G * r_part[c], fold->on_r);
    }
    for (int i = 0; i < VSC_BEND_NODES; i++) square[i] += vsc_wide_dot(gradient[i], gradient[i]);
  }
}

static void give_bends(const receiver *to, const vsc_model *model, const vsc_patch *patch)
{
  const vsc_bend_pack *packs = vsc_bends_of(model, patch);
  for (size_t k = 0; k < patch->pack_count && !to->pairs; k++) {
    const vsc_bend_pack *pack = &packs[k];
    vsc_wide3 x[VSC_BEND_NODES];
    vsc_wide square[VSC_BEND_NODES];
    vsc_pack_corners(model, patch, pack->node, VSC_BEND_NODES, model->rest, x);
    moment_gradients(&pack->bends, x, square);
    for (int i = 0; i < VSC_BEND_NODES; i++)
      for (int l = 0; l < VSC_WIDTH; l++) give(to, model, patch, pack->node[i][l], pack->node[i][l], square[i][l]);
  }
}

// Whether a place of the pack is taken.
static bool is_taken(const vsc_model *model, const vsc_patch *patch, size_t slot)
{
  const size_t k = slot / VSC_WIDTH - patch->first_pack, l = slot % VSC_WIDTH;
  if (patch->family == VSC_TRIANGLES) return vsc_triangles_of(model, patch)[k].V[l] > 0;
  if (patch->family == VSC_BENDS)
    return vsc_bends_of(model, patch)[k].node[1][l] != vsc_bends_of(model, patch)[k].node[0][l];
  return model->mesh_element[slot] != VSC_NO_ELEMENT;
}

// The springs of a surface, as those of one face: stiffness int N_i N_j dA between nodes.
static void give_surface(const receiver *to, const vsc_robin *bed)
{
  const double stiffness = bed->stiffness + to->rate * bed->damping;
  for (size_t row = 0; row < bed->node_count; row++)
    for (uint32_t k = bed->start[row]; k < bed->start[row + 1]; k++) {
      const double *W = bed->blocks + 12 * (size_t)k;
      if (to->pairs || bed->columns[k] == row)
        to->sink(to->context, bed->nodes[row], bed->nodes[bed->columns[k]],
                 stiffness * (W[0] + W[5] + W[10]) / (bed->normal ? 1 : 3));
    }
}

static void give_all(const receiver *to, const vsc_model *model)
{
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (patch->family == VSC_SPRINGS_ON_EDGES) give_springs(to, model, patch);
    if (patch->family == VSC_TRIANGLES) give_triangles(to, model, patch);
    if (patch->family == VSC_BENDS) give_bends(to, model, patch);
    if (vsc_patch_is_solid(patch) && model->materials[patch->material].law != VSC_LAW_CLASSICAL)
      give_cells(to, model, patch);
  }
  for (size_t r = 0; r < model->robin_count; r++) give_surface(to, &model->robins[r]);
}

static void add_to_node(void *context, uint32_t a, uint32_t b, double k)
{
  (void)b;
  ((double *)context)[a] += k;
}

void vsc_limit_stiffness(const vsc_model *model, double rate, double *stiffness)
{
  memset(stiffness, 0, model->node_count * sizeof *stiffness);
  give_all(&(receiver){add_to_node, stiffness, false, rate}, model);
}

void vsc_limit_couplings(const vsc_model *model, double rate, vsc_coupling_sink *sink, void *context)
{
  give_all(&(receiver){sink, context, true, rate}, model);
}

double vsc_limit_bound(const vsc_model *model, vsc_scratch *scratch, size_t *slot)
{
  double *stiffness = scratch->trial, most = 0;
  *slot = 0;
  vsc_limit_stiffness(model, 0, stiffness);
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (patch->family == VSC_SPRINGS_ON_EDGES || patch->still) continue;
    const size_t first = VSC_WIDTH * (size_t)patch->first_pack;
    for (size_t k = first; k < first + VSC_WIDTH * (size_t)patch->pack_count; k++) {
      if (!is_taken(model, patch, k)) continue;
      double sum = 0;
      for (int c = 0; c < vsc_family_corners(patch->family); c++) {
        const uint16_t local = vsc_pack_nodes(model, patch, k / VSC_WIDTH)[c][k % VSC_WIDTH];
        const uint32_t node = vsc_node_of(model, patch, local);
        sum += stiffness[node] / model->mass[node];
      }
      if (sum > most) *slot = k;
      most = fmax(most, sum);
    }
  }
  return most;
}
