// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers, vectors and rotations for tests, the same on every machine.
#ifndef VSC_TESTS_RANDOM_H
#define VSC_TESTS_RANDOM_H

#include <math.h>
#include <stdint.h>

// A number in [0, 1): a 64-bit xorshift generator (Marsaglia), high 53 bits of the scrambled state.
// `seed` must not be 0.
static inline double random_part(uint64_t *seed)
{
  *seed ^= *seed << 13;
  *seed ^= *seed >> 7;
  *seed ^= *seed << 17;
  return (double)((*seed * UINT64_C(2685821657736338717)) >> 11) * 0x1p-53;
}

static inline double random_between(uint64_t *seed, double low, double high)
{
  return low + (high - low) * random_part(seed);
}

static inline void random_fill(uint64_t *seed, double size, double *values, int count)
{
  for (int i = 0; i < count; i++) values[i] = random_between(seed, -size, size);
}

// A rotation matrix by rows, uniform over all rotations: a unit quaternion from within a ball.
static inline void random_rotation(uint64_t *seed, double R[9])
{
  double q[4], square;
  do {
    random_fill(seed, 1, q, 4);
    square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  } while (square > 1 || square < 0.01);
  for (int i = 0; i < 4; i++) q[i] /= sqrt(square);
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  const double rotation[9] = {
      1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
      2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
      2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
  for (int i = 0; i < 9; i++) R[i] = rotation[i];
}

// Rv
static inline void rotate_vector(const double R[9], const double v[3], double turned[3])
{
  for (int i = 0; i < 3; i++)
    turned[i] = R[3 * i] * v[0] + R[3 * i + 1] * v[1] + R[3 * i + 2] * v[2];
}

#endif
