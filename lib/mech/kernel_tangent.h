// SPDX-License-Identifier: GPL-3.0-or-later
// The tangent of four cells of one family: K_ij = -df_i/dx_j, with what velocities add. Internal to mech;
// included by kernel_body.h.
#ifndef VSC_MECH_KERNEL_TANGENT_H
#define VSC_MECH_KERNEL_TANGENT_H

#include "mech/kernel_law.h"
#include "mech/kernel_tets.h"

// One frame of four cells, ready for its tangent.
typedef struct tangent_frame {
  vsc_wide3 g[3], cofactor[3];
  vsc_wide B[3][VSC_MOST_CORNERS];       // B_ai
  vsc_wide3 c[VSC_MOST_CORNERS];         // c_i = sum_a cof_a B_ai: the gradient of J
  vsc_wide3 strain[VSC_MOST_CORNERS][6]; // de_k/dx_i
  vsc_wide J;
} tangent_frame;

VSC_INLINE void open_frame(const vsc_frame *frame, const double (*D)[VSC_MOST_CORNERS], int corners,
                           const vsc_wide3 g[3], tangent_frame *out)
{
  for (int a = 0; a < 3; a++) out->g[a] = g[a];
  out->J = cofactor_of(g, out->cofactor);
  for (int i = 0; i < corners; i++) {
    for (int a = 0; a < 3; a++)
      out->B[a][i] =
          frame->T[a][0] * D[0][i] + frame->T[a][1] * D[1][i] + frame->T[a][2] * D[2][i];
    out->c[i] = vsc_wide_combine(out->B[0][i], out->cofactor[0], out->B[1][i], out->cofactor[1],
                                 out->B[2][i], out->cofactor[2]);
    for (int a = 0; a < 3; a++) {
      const int b = (a + 1) % 3;
      out->strain[i][a] = vsc_wide_scale(out->B[a][i], g[a]);
      out->strain[i][3 + a] =
          vsc_wide_add(vsc_wide_scale(out->B[a][i], g[b]), vsc_wide_scale(out->B[b][i], g[a]));
    }
  }
}

// S and D of four frames at strain e. Not inlined: there is one copy of the laws for all kinds of cells.
static __attribute__((noinline)) void law_tangent(const vsc_law_input *in, const vsc_wide e[6],
                                                  vsc_law_answer *answer)
{
  vsc_law_evaluate(in, e, VSC_LAW_TANGENT, answer);
}

// S that the iterate before foretold: S + D de with de the linear strain of the step from `former` to g.
VSC_INLINE void foretell_stress(const vsc_law_input *in, const vsc_wide3 former[3],
                                const vsc_wide3 g[3], vsc_wide S[6])
{
  vsc_wide e[6], step[6];
  vsc_wide3 moved[3];
  vsc_law_answer before;
  for (int a = 0; a < 3; a++) moved[a] = vsc_wide_minus(g[a], former[a]);
  vsc_strain_of(former, e);
  vsc_strain_rate(former, moved, step);
  law_tangent(in, e, &before);
  for (int k = 0; k < 6; k++) {
    S[k] = before.S[k];
    for (int l = 0; l < 6; l++) S[k] += before.D[k][l] * step[l];
  }
}

// J before the step from `former` to g, and its linear change in it.
VSC_INLINE vsc_wide foretell_ratio(const vsc_wide3 former[3], const vsc_wide3 g[3], vsc_wide *change)
{
  vsc_wide3 cofactor[3];
  const vsc_wide J = cofactor_of(former, cofactor);
  *change = vsc_splat(0);
  for (int a = 0; a < 3; a++) *change += vsc_wide_dot(cofactor[a], vsc_wide_minus(g[a], former[a]));
  return J;
}

// S and D of the frame, both as the system weighs them: stiffness_factor for positions,
// damping_factor for velocities. With `former` S is what that iterate foretold.
VSC_INLINE void weigh_answer(double stiffness_factor, double damping_factor, const vsc_law_input *in,
                             const vsc_wide3 g[3], const vsc_wide3 *former, const vsc_wide3 *rate,
                             vsc_law_answer *answer)
{
  vsc_wide e[6];
  vsc_strain_of(g, e);
  law_tangent(in, e, answer);
  if (former != NULL) foretell_stress(in, former, g, answer->S);
  vsc_wide viscous[6][6], speed[6];
  if (rate != NULL) {
    vsc_law_viscous(in->material, &in->moduli, in->axes, e, viscous);
    vsc_strain_rate(g, rate, speed);
  }
  for (int k = 0; k < 6; k++) {
    for (int l = 0; rate != NULL && l < 6; l++) answer->S[k] += viscous[k][l] * speed[l];
    answer->S[k] *= stiffness_factor;
    for (int l = 0; l < 6; l++) {
      answer->D[k][l] *= stiffness_factor;
      if (rate != NULL) answer->D[k][l] += damping_factor * viscous[k][l];
    }
  }
}

// S + H - L S_0 and D - L D_0 of a Prony series (mech/prony.h), weighed as the answer is, but for what
// of S_0 keeps a law of the full deformation free of stress at rest (exact for J above VSC_VOLUME_J0).
// Not inlined, as laws are not.
static __attribute__((noinline)) void relax_answer(const vsc_patch_work *work, vsc_wide share, int q,
                                                   const vsc_wide3 g[3], const vsc_wide3 *former,
                                                   vsc_law_answer *answer)
{
  const vsc_law_input own = {.material = work->material,
                             .axes = work->axes,
                             .pairs = work->pairs,
                             .moduli = vsc_moduli_or(work->material, NULL)};
  const vsc_wide loss = work->stiffness_factor * work->loss * share;
  vsc_law_answer passive;
  vsc_wide e[6];
  vsc_strain_of(g, e);
  law_tangent(&own, e, &passive);
  if (former != NULL) foretell_stress(&own, former, g, passive.S);
  for (int k = 0; k < 6; k++) {
    answer->S[k] += work->stiffness_factor * work->past[q][k] - loss * passive.S[k];
    for (int l = 0; l < 6; l++) answer->D[k][l] -= loss * passive.D[k][l];
  }
}

// K += c_i (x) curvature c_j
VSC_INLINE void add_outer(vsc_wide3 left, vsc_wide3 right, vsc_wide K[9])
{
  const vsc_wide l[3] = {left.x, left.y, left.z};
  for (int r = 0; r < 3; r++) {
    K[3 * r] += l[r] * right.x;
    K[3 * r + 1] += l[r] * right.y;
    K[3 * r + 2] += l[r] * right.z;
  }
}

// K += [w]x
VSC_INLINE void add_turn(vsc_wide3 w, vsc_wide K[9])
{
  K[1] -= w.z;
  K[2] += w.y;
  K[3] += w.z;
  K[5] -= w.x;
  K[6] -= w.y;
  K[7] += w.x;
}

// K_ij += V [ sum_ab B_ai S_ab B_bj 1 + (de/dx_i)^T D (de/dx_j) + p [w_ij]x + U'' c_i c_j^T ],
// w_ij = sum_c g_c (B_{c-1,i} B_{c+1,j} - B_{c+1,i} B_{c-1,j})
VSC_INLINE void add_frame_tangent(const tangent_frame *f, const vsc_law_answer *answer, vsc_wide V,
                                  vsc_wide pressure, vsc_wide curvature, int corners, vsc_wide *K)
{
  const vsc_wide p = V * pressure, bulk = V * curvature;
  for (int j = 0; j < corners; j++) {
    vsc_wide3 stress[6];  // D de/dx_j
    vsc_wide pull[3];     // sum_b S_ab B_bj
    for (int k = 0; k < 6; k++) {
      stress[k] = wide_zero();
      for (int l = 0; l < 6; l++)
        stress[k] = vsc_wide_add(stress[k], vsc_wide_scale(V * answer->D[k][l], f->strain[j][l]));
    }
    for (int a = 0; a < 3; a++)
      pull[a] = V * (answer->S[a] * f->B[a][j] + answer->S[3 + a] * f->B[(a + 1) % 3][j] +
                     answer->S[3 + (a + 2) % 3] * f->B[(a + 2) % 3][j]);
    const vsc_wide3 squeeze = vsc_wide_scale(bulk, f->c[j]);
    for (int i = j; i < corners; i++) {
      vsc_wide *block = K + 9 * (i * (i + 1) / 2 + j);
      for (int k = 0; k < 6; k++) add_outer(f->strain[i][k], stress[k], block);
      add_outer(f->c[i], squeeze, block);
      const vsc_wide level = f->B[0][i] * pull[0] + f->B[1][i] * pull[1] + f->B[2][i] * pull[2];
      for (int r = 0; r < 3; r++) block[4 * r] += level;
      vsc_wide turn[3];
      for (int c = 0; c < 3; c++)
        turn[c] = p * (f->B[(c + 2) % 3][i] * f->B[(c + 1) % 3][j] -
                       f->B[(c + 1) % 3][i] * f->B[(c + 2) % 3][j]);
      add_turn(vsc_wide_combine(turn[0], f->g[0], turn[1], f->g[1], turn[2], f->g[2]), block);
    }
  }
}

// The pressure that all frames of four cells share, and what J's gradient is multiplied by: U' and
// U''/V of the cell's mean volume ratio; of a tet that shares its volume with others its nodes' mean.
typedef struct shared_volume {
  vsc_wide pressure, curvature;
} shared_volume;

VSC_INLINE shared_volume share_volume(const vsc_patch_work *work, const opened_pack *pack,
                                      int corners, int points, vsc_wide modulus, vsc_wide3 (*g)[3])
{
  vsc_wide whole;
  const vsc_wide J = mean_ratio(pack, points, pack->h, g, NULL, &whole);
  if (corners == 4) return (shared_volume){nodes_pressure(work, pack), vsc_splat(0)};
  return (shared_volume){vsc_volume_stress(modulus, J), vsc_volume_curvature(modulus, J) / whole};
}

// The axes of all frames at the iterate before, and the pressure that it foretold for the cell.
VSC_INLINE vsc_wide foretell_pressure(const vsc_patch_work *work, const opened_pack *pack,
                                      int corners, int points, vsc_wide modulus, vsc_wide3 (*g)[3],
                                      vsc_wide3 (*former)[3])
{
  vsc_wide3 h[VSC_MOST_POINTS][3];
  vsc_wide change = vsc_splat(0), whole;
  open_derivatives(work, pack, corners, points, work->before, h);
  const vsc_wide J = mean_ratio(pack, points, h, former, NULL, &whole);
  for (int q = 0; q < points; q++) {
    vsc_wide step;
    foretell_ratio(former[q], g[q], &step);
    change += pack->frames[q].V * step;
  }
  return vsc_volume_stress(modulus, J) + vsc_volume_curvature(modulus, J) * change / whole;
}

// What a frame's own volume pushes with: U' and -m/J; foretold where there is an iterate before.
VSC_INLINE vsc_wide own_pressure(vsc_wide modulus, vsc_wide rest, vsc_wide J, const vsc_wide3 *former,
                                 const vsc_wide3 g[3])
{
  if (former == NULL) return vsc_volume_stress(modulus, J) + vsc_rest_stress(rest, J);
  vsc_wide change;
  const vsc_wide before = foretell_ratio(former, g, &change);
  return vsc_volume_stress(modulus, before) + vsc_rest_stress(rest, before) +
         (vsc_volume_curvature(modulus, before) + vsc_rest_curvature(rest, before)) * change;
}

VSC_INLINE void tangent_kernel(const vsc_patch_work *work, size_t k, int corners, int points,
                               vsc_wide *K)
{
  const vsc_law_input in = law_input_of(work, k);
  opened_pack pack;
  vsc_wide3 g[VSC_MOST_POINTS][3], b[VSC_MOST_CORNERS];
  open_pack(work, k, corners, points, work->w != NULL, &pack);
  const vsc_frame *frames = pack.frames;
  shared_volume shared = share_volume(work, &pack, corners, points, in.moduli.volume_modulus, g);
  vsc_wide3 former[VSC_MOST_POINTS][3];
  if (work->before != NULL) {
    const vsc_wide foretold = foretell_pressure(work, &pack, corners, points,
                                                in.moduli.volume_modulus, g, former);
    if (corners != 4) shared.pressure = foretold;
  }
  shared.pressure += multiplier_of(work, k);
  const vsc_wide own = corners == 4 ? in.moduli.element_modulus : in.moduli.stabilization;
  for (int i = 0; i < 9 * corners * (corners + 1) / 2; i++) K[i] = vsc_splat(0);
  for (int c = 0; c < corners; c++) b[c] = wide_zero();
  for (int q = 0; q < points; q++) {
    tangent_frame frame;
    vsc_law_answer answer;
    vsc_wide3 rate[3];
    const frame_numbers numbers = frame_of(&frames[q], 0);
    if (work->w != NULL) solid_axes(&numbers, pack.speed[q], rate);
    open_frame(&frames[q], work->rule->D[q], corners, g[q], &frame);
    const vsc_wide3 *before = work->before != NULL ? former[q] : NULL;
    // smoothed tets leave their law to the edges
    if (work->smoothed != NULL)
      answer = (vsc_law_answer){0};
    else
      weigh_answer(work->stiffness_factor, work->damping_factor, &in, g[q], before,
                   work->w != NULL ? rate : NULL, &answer);
    vsc_wide rest = vsc_splat(work->smoothed != NULL ? 0 : work->material->rest_shear);
    if (work->past != NULL) {
      relax_answer(work, in.moduli.share, q, g[q], before, &answer);
      rest *= 1 - work->loss;
    }
    const vsc_wide p = shared.pressure + own_pressure(own, rest, frame.J, before, g[q]);
    const vsc_wide curvature =
        vsc_volume_curvature(own, frame.J) + vsc_rest_curvature(rest, frame.J);
    add_frame_tangent(&frame, &answer, frames[q].V, work->stiffness_factor * p,
                      work->stiffness_factor * curvature, corners, K);
    for (int c = 0; c < corners; c++)
      b[c] = vsc_wide_add(b[c], vsc_wide_scale(frames[q].V, frame.c[c]));
  }
  if (corners == 4) return;
  for (int j = 0; j < corners; j++) {
    const vsc_wide3 right = vsc_wide_scale(work->stiffness_factor * shared.curvature, b[j]);
    for (int i = j; i < corners; i++) add_outer(b[i], right, K + 9 * (i * (i + 1) / 2 + j));
  }
}

#define TANGENT_KERNEL(name, corners, points)                                      \
  static void tangent_##name(const vsc_patch_work *work, size_t k, vsc_wide *K)    \
  {                                                                                \
    tangent_kernel(work, k, corners, points, K);                                   \
  }
TANGENT_KERNEL(tets, 4, 1)
TANGENT_KERNEL(hexes, 8, 8)
TANGENT_KERNEL(wedges, 6, 6)
TANGENT_KERNEL(pyramids, 5, 8)
TANGENT_KERNEL(tets10, 10, 4)

#endif
