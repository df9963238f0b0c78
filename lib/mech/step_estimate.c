// SPDX-License-Identifier: GPL-3.0-or-later
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/random.h"
#include "mech/coupled_mass.h"
#include "mech/force.h"
#include "mech/step_limit.h"

// What the eigenvalue may be too small by.
#define ALLOWANCE 1.1
// Noise in each estimate's first vector, as a part of its length.
#define NOISE 0.5
// Iterations go on while one raises the eigenvalue by more than this factor, from ENOUGH to MOST_ITERATIONS by more
// than the second.
#define RISING 1.001
#define RISING_LATE 1.003
enum { ENOUGH = 14, MOST_ITERATIONS = 40 };
// By how much the 2/dt of damping may be off before it is set right, not knowing and knowing how the eigenvalue changes
// with it; but not in the first iterations, in which x is mostly noise.
#define RATE_ERROR 0.02
#define KNOWN_RATE_ERROR 0.05
enum { NOISY_ITERATIONS = 2 };
// Nodes go in pieces that depend on their number alone, so that sums are the same on any number of threads.
enum { NODES_PER_PIECE = 256, MOST_PIECES = 64, SUMS = 6 };

// What passes over the nodes share. Products are those of the mass norm, A is M^-1 (K + rate C). Where masses are
// coupled, those of neighbours move by P d when d is asked of them (coupled_mass.h): A is M^-1 (K + rate C) P, and the
// product is <a, b> = a . M P b, for which it is symmetric. Each vector z then has its spread P z beside it, of which
// `place` and `speed` are made; without coupling they are one.
typedef struct search {
  const vsc_model *model;
  vsc_state *state;
  double time;
  bool coupled;      // masses
  bool symmetric;    // A: else all that is known is power iteration
  vsc_wide *x;       // the eigenvector so far, |x| = 1
  vsc_wide *image;   // A x
  vsc_wide *d;       // the way in which x is changed next; without coupling `place`
  vsc_wide *place;   // P d; while A d is measured where that leads to
  vsc_wide *speed;   // rate . size . d, with damping
  vsc_wide *moved;   // forces there, then size . A d
  vsc_wide *spread_x, *spread_image, *spread_moved;  // P of these
  double rate;       // 2/dt
  double size;       // what d is multiplied by to be far below an element; 0: there is no way
  double quotient;   // <x, A x>
  double square;     // <A x, A x>
  double slope;      // d|A x|/d rate; 0: not known
  double x_of_x, x_of_d, d_of_x, d_of_d;  // the next x and what comes to the next d, made of x and size . d
  double shift;      // what is added to rate
  double parts[MOST_PIECES][SUMS];        // of sums, or in the first the largest
} search;

static size_t piece_count(const vsc_model *model)
{
  const size_t pieces = (model->node_count + NODES_PER_PIECE - 1) / NODES_PER_PIECE;
  return pieces < MOST_PIECES ? pieces : MOST_PIECES;
}

// The first node of a piece; of the piece behind the last the number of nodes.
static size_t first_node(const search *s, size_t piece)
{
  return s->model->node_count * piece / piece_count(s->model);
}

static void pass(search *s, vsc_piece *work)
{
  vsc_parallel_for(piece_count(s->model), work, s);
}

static void add_up(const search *s, double sums[SUMS])
{
  memset(sums, 0, SUMS * sizeof *sums);
  for (size_t p = 0; p < piece_count(s->model); p++)
    for (int k = 0; k < SUMS; k++) sums[k] += s->parts[p][k];
}

// The size at which the largest component of d, which a pass has left in the parts, is far below an element and far
// above the rounding of positions.
static double probe_size(const search *s)
{
  double most = 0;
  for (size_t p = 0; p < piece_count(s->model); p++) most = fmax(most, s->parts[p][0]);
  return most > 0 ? 1e-6 * s->model->element_size / most : 0;
}

VSC_INLINE double sum_of(vsc_wide a)
{
  return (a[0] + a[1]) + (a[2] + a[3]);
}

VSC_INLINE vsc_wide larger(vsc_wide most, vsc_wide a)
{
  a = vsc_select(a < 0, -a, a);
  return vsc_select(a > most, a, most);
}

VSC_INLINE double largest_of(vsc_wide a)
{
  return fmax(fmax(a[0], a[1]), fmax(a[2], a[3]));
}

// to = P z
static void spread(const search *s, const vsc_wide *z, vsc_wide *to)
{
  memcpy(to, vsc_coupled_mass_spread(s->model, &s->state->scratch, (const double *)z),
         s->model->node_count * sizeof *to);
}

// The first d: x + a random one of NOISE times its length (any length when there is none yet): what becomes the
// stiffest elsewhere must not have to grow from nothing.
static void stir(search *s)
{
  const vsc_model *model = s->model;
  const size_t bytes = model->node_count * sizeof *s->x;
  uint64_t seed = 1 + (uint64_t)s->state->limit.refreshes;
  double length = 0, noise = 0;
  vsc_wide most = vsc_splat(0);
  for (size_t n = 0; n < model->node_count; n++) {
    vsc_wide random = vsc_splat(0);
    for (int i = 0; i < 3; i++)
      if (model->inverse_mass[4 * n + (size_t)i] > 0) random[i] = vsc_next_random(&seed);
    s->d[n] = random;
    noise += model->mass[n] * sum_of(random * random);
    length += model->mass[n] * sum_of(s->x[n] * s->x[n]);
  }
  const double scale = length > 0 ? NOISE * sqrt(length / noise) : 1;
  for (size_t n = 0; n < model->node_count; n++) {
    s->d[n] = s->x[n] + scale * s->d[n];
    s->image[n] = vsc_splat(0);
  }
  if (s->coupled) {
    memset(s->spread_x, 0, bytes);
    memset(s->spread_image, 0, bytes);
    spread(s, s->d, s->place);
  }
  for (size_t n = 0; n < model->node_count; n++) most = larger(most, s->place[n]);
  memset(s->parts, 0, sizeof s->parts);
  s->parts[0][0] = largest_of(most);
  s->size = probe_size(s);
}

VSC_CLONED static void step_aside(void *context, size_t piece, int thread)
{
  (void)thread;
  const search *s = context;
  const vsc_wide *at = (const vsc_wide *)s->state->x;
  for (size_t n = first_node(s, piece), end = first_node(s, piece + 1); n < end; n++) {
    const vsc_wide d = s->size * s->place[n];
    if (s->coupled) s->d[n] *= s->size;
    s->place[n] = at[n] + d;
    if (s->model->terms.damping) s->speed[n] = s->rate * d;
  }
}

// A d, or C x, by the difference of forces.
VSC_CLONED static void take_difference(void *context, size_t piece, int thread)
{
  (void)thread;
  const search *s = context;
  const vsc_wide *base = (const vsc_wide *)s->state->force;
  const vsc_wide *inverse_mass = (const vsc_wide *)s->model->inverse_mass;
  for (size_t n = first_node(s, piece), end = first_node(s, piece + 1); n < end; n++)
    s->moved[n] = inverse_mass[n] * (base[n] - s->moved[n]);
}

static void take_image(search *s)
{
  pass(s, take_difference);
  if (s->coupled) spread(s, s->moved, s->spread_moved);
}

// Of d, A d, x, A x the products that are needed. P d is what the positions differ by, so that it is what the forces
// belong to, to the last bit.
VSC_CLONED static void take_products(void *context, size_t piece, int thread)
{
  (void)thread;
  search *s = context;
  const vsc_wide *at = (const vsc_wide *)s->state->x;
  vsc_wide sums[SUMS] = {0};
  for (size_t n = first_node(s, piece), end = first_node(s, piece + 1); n < end; n++) {
    const double mass = s->model->mass[n];
    const vsc_wide spread_d = s->place[n] - at[n], d = s->coupled ? s->d[n] : spread_d, image = s->moved[n];
    sums[0] += mass * d * spread_d;
    sums[1] += mass * spread_d * image;
    sums[2] += mass * s->spread_moved[n] * image;
    sums[3] += mass * s->spread_x[n] * image;
    sums[4] += mass * s->spread_image[n] * image;
    sums[5] += mass * s->spread_x[n] * d;
  }
  for (int k = 0; k < SUMS; k++) s->parts[piece][k] = sum_of(sums[k]);
}

// Of one node: x, A x, A d and d, or what these are spread to.
VSC_INLINE void turn_node(const search *s, size_t n, vsc_wide d, vsc_wide *x, vsc_wide *image, const vsc_wide *moved,
                          vsc_wide *way)
{
  const vsc_wide before = x[n];
  const double quotient = s->symmetric ? s->quotient : 0;
  x[n] = s->x_of_x * before + s->x_of_d * d;
  image[n] = s->x_of_x * image[n] + s->x_of_d * moved[n];
  way[n] = image[n] - quotient * x[n] + s->d_of_x * before + s->d_of_d * d;
}

// The next x and its image; d becomes what is left of A x, the residual, and the part of the last way that makes it
// conjugate to that.
VSC_CLONED static void turn(void *context, size_t piece, int thread)
{
  (void)thread;
  search *s = context;
  const vsc_wide *at = (const vsc_wide *)s->state->x;
  vsc_wide most = vsc_splat(0);
  for (size_t n = first_node(s, piece), end = first_node(s, piece + 1); n < end; n++) {
    if (s->coupled) turn_node(s, n, s->d[n], s->x, s->image, s->moved, s->d);
    turn_node(s, n, s->place[n] - at[n], s->spread_x, s->spread_image, s->spread_moved, s->place);
    most = larger(most, s->place[n]);
  }
  s->parts[piece][0] = largest_of(most);
}

// The best x in the plane of x and d. With u = (d - p x)/|d - p x|, p = <x, d>, at right angles to x, A there is
//   (q  b)   q = <x, A x>, b = <x, A u>,
//   (b  e),  e = <u, A u>.
// The better eigenvector is x cos + u sin, of theta = (q + e)/2 + h, h^2 = (q - e)^2/4 + b^2, the other one
// u' = u cos - x sin. The next way is the residual A x - theta x of the new x plus c u', c = <A x, A u'>/2h, for which
// <u', (A - theta) d> = 0: conjugate gradients of the quotient (Bradbury and Fletcher 1966). False when there is no
// way any more but rounding: d then is no longer at right angles to x.
static bool choose(search *s, bool first)
{
  const bool alone = first || !s->symmetric;
  double sums[SUMS];
  add_up(s, sums);
  const double p = alone ? 0 : sums[5], rest = sums[0] - p * p;
  if (rest <= 0.5 * sums[0]) return false;
  const double length = sqrt(rest), e = (sums[1] - p * (2 * sums[3] - p * s->quotient)) / rest;
  const double b = (sums[3] - p * s->quotient) / length, product = (sums[4] - p * s->square) / length;
  const double square = (sums[2] - p * (2 * sums[4] - p * s->square)) / rest;
  const double half = 0.5 * (s->quotient - e), h = sqrt(half * half + b * b);
  double cosine = 0, sine = 1, c = 0;
  if (!alone && h > 0) {
    // as (theta - e, b), or where that would cancel (b, theta - q)
    const double along = half > 0 ? h + half : fabs(b), across = half > 0 ? b : copysign(h - half, b);
    const double norm = sqrt(along * along + across * across);
    cosine = along / norm, sine = across / norm;
    c = ((cosine * cosine - sine * sine) * product + cosine * sine * (square - s->square)) / (2 * h);
  }
  s->quotient = alone ? e : 0.5 * (s->quotient + e) + h;
  s->square = cosine * cosine * s->square + 2 * cosine * sine * product + sine * sine * square;
  s->x_of_d = sine / length, s->x_of_x = cosine - p * s->x_of_d;
  s->d_of_d = c * cosine / length, s->d_of_x = -c * sine - p * s->d_of_d;
  return true;
}

// Measures A d and changes x and d. False when d is lost in the rounding of positions.
static bool improve(search *s, bool first)
{
  vsc_state *state = s->state;
  pass(s, step_aside);
  vsc_force(s->model, (const double *)s->place, s->model->terms.damping ? (const double *)s->speed : NULL, s->time,
            &state->scratch, (double *)s->moved);
  take_image(s);
  pass(s, take_products);
  if (!choose(s, first)) return false;
  pass(s, turn);
  s->size = probe_size(s);
  return true;
}

// The step of the eigenvalue, which with damping depends on it: with what is known of that
//   lambda = |A x| + slope (2/step - rate),  ALLOWANCE lambda step^2 = 4.
static double step_of(const search *s)
{
  const double rest = fmax(sqrt(s->square) - s->slope * s->rate, 0), c = ALLOWANCE * s->slope;
  return 4 / (c + sqrt(c * c + 4 * ALLOWANCE * rest));
}

// The products of C x.
VSC_CLONED static void take_damping(void *context, size_t piece, int thread)
{
  (void)thread;
  search *s = context;
  vsc_wide sums[SUMS] = {0};
  for (size_t n = first_node(s, piece), end = first_node(s, piece + 1); n < end; n++) {
    const double mass = s->model->mass[n];
    sums[0] += mass * s->spread_x[n] * s->moved[n];
    sums[1] += mass * s->spread_image[n] * s->moved[n];
    sums[2] += mass * s->spread_moved[n] * s->moved[n];
  }
  for (int k = 0; k < SUMS; k++) s->parts[piece][k] = sum_of(sums[k]);
}

// A x and the residual in d as they are with the new rate.
VSC_CLONED static void shift_rate(void *context, size_t piece, int thread)
{
  (void)thread;
  search *s = context;
  vsc_wide most = vsc_splat(0);
  for (size_t n = first_node(s, piece), end = first_node(s, piece + 1); n < end; n++) {
    if (s->coupled) {
      s->image[n] += s->shift * s->moved[n];
      s->d[n] += s->shift * s->moved[n] + s->d_of_x * s->x[n];
    }
    s->spread_image[n] += s->shift * s->spread_moved[n];
    s->place[n] += s->shift * s->spread_moved[n] + s->d_of_x * s->spread_x[n];
    most = larger(most, s->place[n]);
  }
  s->parts[piece][0] = largest_of(most);
}

// Brings the rate to that of the step, where it is too far from it: d|A x|/d rate = <A x, C x>/|A x|.
static void follow_step(search *s, int iteration)
{
  const double error = fabs(2 / step_of(s) - s->rate);
  if (s->rate > 0 && iteration < NOISY_ITERATIONS) return;
  if (error <= (s->slope > 0 ? KNOWN_RATE_ERROR : RATE_ERROR) * s->rate) return;
  double sums[SUMS];
  vsc_force(s->model, s->state->x, (const double *)s->spread_x, s->time, &s->state->scratch, (double *)s->moved);
  take_image(s);
  pass(s, take_damping);
  add_up(s, sums);
  s->slope = fmax(sums[1], 0) / sqrt(s->square);
  s->shift = 2 / step_of(s) - s->rate;
  s->d_of_x = s->symmetric ? -s->shift * sums[0] : 0;
  pass(s, shift_rate);
  s->size = probe_size(s);
  s->rate += s->shift;
  s->quotient += s->shift * sums[0];
  s->square += s->shift * (2 * sums[1] + s->shift * sums[2]);
}

// x <- A x, of length 1: one iteration that costs nothing.
VSC_CLONED static void keep_image(void *context, size_t piece, int thread)
{
  (void)thread;
  const search *s = context;
  const double length = sqrt(s->square);
  for (size_t n = first_node(s, piece), end = first_node(s, piece + 1); n < end; n++)
    s->x[n] = s->image[n] / length;
}

// The paper's formulas derive from no energy.
static bool is_symmetric(const vsc_model *model)
{
  for (size_t m = 0; m < model->material_count; m++)
    if (model->materials[m].law == VSC_LAW_PAPER) return false;
  return true;
}

int vsc_limit_enough(const vsc_model *model)
{
  return is_symmetric(model) ? ENOUGH : MOST_ITERATIONS;
}

static search open_search(const vsc_model *model, vsc_state *state, double time)
{
  const size_t count = model->node_count;
  vsc_wide *trial = (vsc_wide *)state->scratch.trial, *lone = (vsc_wide *)state->scratch.lone;
  search s = {.model = model,
              .state = state,
              .time = time,
              .coupled = model->coupled.degree > 0,
              .symmetric = is_symmetric(model),
              .x = (vsc_wide *)state->limit.mode,
              // predicted velocities are free between steps
              .image = model->terms.damping ? (vsc_wide *)state->scratch.predicted : trial + 2 * count,
              .place = trial,
              .d = trial,
              .speed = trial + 2 * count,
              .moved = trial + count,
              .rate = state->limit.step > 0 ? 2 * model->safety / state->limit.step : 0};
  s.spread_x = s.coupled ? lone : s.x;
  s.spread_image = s.coupled ? lone + count : s.image;
  s.spread_moved = s.coupled ? lone + 2 * count : s.moved;
  if (s.coupled) s.d = lone + 3 * count;
  return s;
}

void vsc_limit_refresh(const vsc_model *model, vsc_state *state, double time, int iterations)
{
  vsc_limit *limit = &state->limit;
  const int enough = vsc_limit_enough(model);
  search s = open_search(model, state, time);
  double before = 0;
  limit->eigenvalue = 0;
  stir(&s);
  // forces at the same place without velocity; state->force is free: the next step rewrites it
  vsc_force(model, state->x, NULL, time, &state->scratch, state->force);
  for (int i = 0; i < iterations ||
                  (i < MOST_ITERATIONS && limit->eigenvalue > (i < enough ? RISING : RISING_LATE) * before); i++) {
    before = limit->eigenvalue;
    if (!(s.size > 0) || !improve(&s, i == 0)) break;
    limit->eigenvalue = sqrt(s.square);
    if (!(s.square > 0)) continue;
    if (model->terms.damping) follow_step(&s, i);
    const double stable = step_of(&s);
    limit->step = model->safety * stable;
    // forces that overflow are not those of a body that gives way
    limit->eigenvalue = isfinite(s.square) ? 4 / (ALLOWANCE * stable * stable) : INFINITY;
  }
  if (s.square > 0) pass(&s, keep_image);
  limit->refreshes++;
}
