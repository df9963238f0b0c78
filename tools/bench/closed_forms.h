// SPDX-License-Identifier: GPL-3.0-or-later
// Exact answers that the benchmarks' results are held against. Each is of one parameter, the rest being
// that of the scene it belongs to.
#ifndef VSC_TOOLS_BENCH_CLOSED_FORMS_H
#define VSC_TOOLS_BENCH_CLOSED_FORMS_H

// Move along z, mm, of the end of data/benchmarks/beam.yaml under its weight, with the Poisson ratio nu:
// Timoshenko's -q L^4 / (8 E I) - q L^2 / (2 k G A) with Cowper's k = 10 (1 + nu) / (12 + 11 nu) (1966),
// L = 10 mm, section 1 mm x 1 mm, E = 10 MPa, q = 1 mg/mm^3 x 9.81 m/s^2 per area.
double vsc_beam_sag(double nu);

// Inner radius, mm, of a thick sphere, and of a thick cylinder that cannot grow longer, of incompressible
// rubber psi = mu/2 (I_1 - 3), mu = 1 kPa, radii 1 and 2 mm at rest, under the pressure p (kPa) inside
// (Rivlin 1948; Green & Zerna 1954), with l_a = a / A, l_b = b / B:
//   sphere    p = mu (2 / l_b + 1 / (2 l_b^4) - 2 / l_a - 1 / (2 l_a^4)),       b^3 = B^3 + a^3 - A^3
//   cylinder  p = mu (ln (l_a / l_b) + (A^2 - a^2) / 2 (1 / b^2 - 1 / a^2)),    b^2 = B^2 + a^2 - A^2
// up to a = 1.7 (sphere: beyond 1.8 the pressure falls again) and 100.
double vsc_sphere_inner(double p);
double vsc_cylinder_inner(double p);

// Move of the inner wall, mm, of the same bodies at small strain under p = 1 mPa with E = 1 kPa and the
// Poisson ratio nu (Lame 1852):
//   sphere    u(a) = p a^3 / (b^3 - a^3) (a / (3 K) + b^3 / (4 mu a^2))
//   cylinder  u(a) = (1 + nu) / E p a^2 / (b^2 - a^2) ((1 - 2 nu) a + b^2 / a)
double vsc_sphere_move(double nu);
double vsc_cylinder_move(double nu);

// By how much, mm, the middle of the loaded side of data/benchmarks/cook.yaml, (48, 52, 0.5) mm, rises with the
// Poisson ratio nu: 0.3, 0.4, 0.49, 0.499 or 0.4999, NAN for others. Not a closed form: that of 0.4999 is
// of elements of order 5 to 8 in the plane, graded to the edges; the others are extrapolated from quadratic tets, 8, 16 and
// 32 bricks along each side, whose errors fall three to four times from one to the next, to 0.003 mm. So extrapolated,
// 0.4999 gives 6.959; 0.3 by hexahedra 7.951.
double vsc_cook_rise(double nu);

#endif
