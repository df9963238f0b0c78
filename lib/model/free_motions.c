// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/free_motions.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOTIONS = 6 };
// Eigenvalues of G below this part of the largest are 0: rounding leaves some 1e-15, and one node that is
// held among a million gives 1e-6.
#define NOTHING 1e-11

// The centre of the nodes, and the largest distance from it: rotations are measured on that.
static double centre_of(const vsc_model *model, double centre[3])
{
  double far = 0;
  for (int i = 0; i < 3; i++) {
    centre[i] = 0;
    for (size_t n = 0; n < model->node_count; n++) centre[i] += model->rest[4 * n + (size_t)i];
    centre[i] /= (double)model->node_count;
  }
  for (size_t n = 0; n < model->node_count; n++) {
    double square = 0;
    for (int i = 0; i < 3; i++) square += pow(model->rest[4 * n + (size_t)i] - centre[i], 2);
    far = fmax(far, square);
  }
  return sqrt(far);
}

// u_a of a node: three translations, three turns about the centre by one over `size`.
static void motions_of(const double *place, const double centre[3], double size, double u[MOTIONS][3])
{
  memset(u, 0, MOTIONS * sizeof u[0]);
  for (int a = 0; a < 3; a++) {
    const int next = (a + 1) % 3, last = (a + 2) % 3;
    u[a][a] = 1;
    // e_a x (X - c)
    u[3 + a][next] = -(place[last] - centre[last]) / size;
    u[3 + a][last] = (place[next] - centre[next]) / size;
  }
}

static void add_supports(const vsc_model *model, const double centre[3], double size, double *G)
{
  for (size_t n = 0; n < model->node_count; n++) {
    double u[MOTIONS][3];
    motions_of(model->rest + 4 * n, centre, size, u);
    for (size_t i = 0; i < 3; i++)
      for (int a = 0; model->inverse_mass[4 * n + i] == 0 && a < MOTIONS; a++)
        for (int b = 0; b < MOTIONS; b++) G[MOTIONS * a + b] += u[a][i] * u[b][i];
  }
}

static void add_robin(const vsc_model *model, const vsc_robin *robin, const double centre[3], double size,
                      double *G)
{
  for (size_t row = 0; robin->stiffness > 0 && row < robin->node_count; row++)
    for (uint32_t k = robin->start[row]; k < robin->start[row + 1]; k++) {
      double u[MOTIONS][3], v[MOTIONS][3];
      motions_of(model->rest + 4 * robin->nodes[row], centre, size, u);
      motions_of(model->rest + 4 * robin->columns[k], centre, size, v);
      const double *S = robin->blocks + 12 * k;
      for (int a = 0; a < MOTIONS; a++)
        for (int b = 0; b < MOTIONS; b++)
          for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
              G[MOTIONS * a + b] += u[a][i] * S[4 * j + i] * v[b][j] / robin->area;
    }
}

// The part of motion `a` that lies in the null space spanned by the first `count` columns.
static double part_in(const double *columns, int count, int a)
{
  double square = 0;
  for (int k = 0; k < count; k++) square += pow(columns[MOTIONS * a + k], 2);
  return square;
}

static void say(const double *columns, int count, char *text, size_t size)
{
  static const char *const axis[3] = {"x", "y", "z"};
  static const char *const verb[2] = {"move along", "turn about"};
  int told = 0;
  text[0] = '\0';
  for (int a = 0; a < MOTIONS; a++) {
    if (part_in(columns, count, a) < 1 - 1e-6) continue;
    bool first = true;
    for (int b = a - a % 3; b < a; b++) first &= part_in(columns, count, b) < 1 - 1e-6;
    const size_t length = strlen(text);
    snprintf(text + length, size - length, "%s%s%s%s", told == 0 ? "" : first ? " and " : ", ",
             first ? verb[a / 3] : "", first ? " " : "", axis[a % 3]);
    told++;
  }
  if (told != count) snprintf(text, size, "move in %d ways as one rigid thing", count);
}

int vsc_free_motions(const vsc_model *model, char *text, size_t size)
{
  double centre[3], G[MOTIONS * MOTIONS] = {0}, values[MOTIONS], columns[MOTIONS * MOTIONS];
  const double far = centre_of(model, centre);
  text[0] = '\0';
  add_supports(model, centre, far, G);
  for (size_t k = 0; k < model->robin_count; k++) add_robin(model, &model->robins[k], centre, far, G);
  gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(MOTIONS);
  if (work == NULL) return 0;
  gsl_matrix_view matrix = gsl_matrix_view_array(G, MOTIONS, MOTIONS);
  gsl_matrix_view vectors = gsl_matrix_view_array(columns, MOTIONS, MOTIONS);
  gsl_vector_view value = gsl_vector_view_array(values, MOTIONS);
  gsl_eigen_symmv(&matrix.matrix, &value.vector, &vectors.matrix, work);
  gsl_eigen_symmv_free(work);
  gsl_eigen_symmv_sort(&value.vector, &vectors.matrix, GSL_EIGEN_SORT_VAL_ASC);
  int count = 0;
  while (count < MOTIONS && values[count] <= NOTHING * values[MOTIONS - 1]) count++;
  if (count > 0) say(columns, count, text, size);
  return count;
}
