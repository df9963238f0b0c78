// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/free_motions.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"

enum { MOTIONS = 6 };
// Eigenvalues of G below this part of the largest are 0: rounding leaves some 1e-15, and one node that is
// held among a million gives 1e-6.
#define NOTHING 1e-11

// Nodes that elements or membranes join, directly or through others.
typedef struct part {
  uint32_t first;   // the lowest of its nodes
  size_t nodes, elements;
  double centre[3]; // of the nodes, mm
  double size;      // the largest distance from it, mm: rotations are measured on that
  double G[MOTIONS * MOTIONS];
} part;

typedef struct body {
  const vsc_model *model;
  size_t part_count;
  part *parts;        // part_count, by their lowest nodes
  uint32_t *part_of;  // node_count
} body;

static uint32_t root_of(uint32_t *parent, uint32_t node)
{
  while (parent[node] != node) {
    parent[node] = parent[parent[node]];
    node = parent[node];
  }
  return node;
}

// parent[n]: a lower node of the same part, or n itself where that is the lowest.
static void join_nodes(const vsc_model *model, uint32_t *parent)
{
  for (size_t n = 0; n < model->node_count; n++) parent[n] = (uint32_t)n;
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++) {
      const uint16_t(*node)[VSC_WIDTH] = vsc_pack_nodes(model, patch, k);
      for (int c = 1; c < vsc_family_corners(patch->family); c++)
        for (int l = 0; l < VSC_WIDTH; l++) {
          const uint32_t a = root_of(parent, vsc_node_of(model, patch, node[0][l]));
          const uint32_t b = root_of(parent, vsc_node_of(model, patch, node[c][l]));
          parent[a < b ? b : a] = a < b ? a : b;
        }
    }
  }
}

static void count_elements(body *body)
{
  const vsc_model *model = body->model;
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!vsc_patch_is_solid(patch)) continue;
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      for (int l = 0; l < VSC_WIDTH; l++)
        if (model->mesh_element[VSC_WIDTH * k + (size_t)l] != VSC_NO_ELEMENT)
          body->parts[body->part_of[vsc_node_of(model, patch, vsc_pack_nodes(model, patch, k)[0][l])]].elements++;
  }
}

static void measure_parts(body *body)
{
  const vsc_model *model = body->model;
  for (size_t n = 0; n < model->node_count; n++) {
    part *own = &body->parts[body->part_of[n]];
    own->nodes++;
    for (size_t i = 0; i < 3; i++) own->centre[i] += model->rest[4 * n + i];
  }
  for (size_t k = 0; k < body->part_count; k++)
    for (int i = 0; i < 3; i++) body->parts[k].centre[i] /= (double)body->parts[k].nodes;
  for (size_t n = 0; n < model->node_count; n++) {
    part *own = &body->parts[body->part_of[n]];
    double square = 0;
    for (size_t i = 0; i < 3; i++) square += pow(model->rest[4 * n + i] - own->centre[i], 2);
    own->size = fmax(own->size, sqrt(square));
  }
}

// False when memory is short.
static bool find_parts(body *body)
{
  const size_t nodes = body->model->node_count;
  uint32_t *parent = NULL;
  bool made = VSC_NEW(parent, nodes) && VSC_NEW(body->part_of, nodes);
  if (made) {
    join_nodes(body->model, parent);
    for (uint32_t n = 0; n < nodes; n++)
      body->part_of[n] = parent[n] == n ? (uint32_t)body->part_count++ : body->part_of[root_of(parent, n)];
    made = VSC_NEW(body->parts, body->part_count);
  }
  for (uint32_t n = 0; made && n < nodes; n++)
    if (parent[n] == n) body->parts[body->part_of[n]].first = n;
  vsc_free(parent);
  if (!made) return false;
  measure_parts(body);
  count_elements(body);
  return true;
}

// u_a of a node: three translations, three turns about the centre of its part by one over its size.
static void motions_of(const body *body, size_t node, double u[MOTIONS][3])
{
  const double *place = body->model->rest + 4 * node;
  const part *own = &body->parts[body->part_of[node]];
  memset(u, 0, MOTIONS * sizeof u[0]);
  for (int a = 0; a < 3; a++) {
    const int next = (a + 1) % 3, last = (a + 2) % 3;
    u[a][a] = 1;
    // e_a x (X - c)
    u[3 + a][next] = -(place[last] - own->centre[last]) / own->size;
    u[3 + a][last] = (place[next] - own->centre[next]) / own->size;
  }
}

static void add_supports(body *body)
{
  const vsc_model *model = body->model;
  for (size_t n = 0; n < model->node_count; n++) {
    double u[MOTIONS][3], *G = body->parts[body->part_of[n]].G;
    motions_of(body, n, u);
    for (size_t i = 0; i < 3; i++)
      for (int a = 0; model->inverse_mass[4 * n + i] == 0 && a < MOTIONS; a++)
        for (int b = 0; b < MOTIONS; b++) G[MOTIONS * a + b] += u[a][i] * u[b][i];
  }
}

static void add_robin(body *body, const vsc_robin *robin)
{
  for (size_t row = 0; robin->stiffness > 0 && row < robin->node_count; row++)
    for (uint32_t k = robin->start[row]; k < robin->start[row + 1]; k++) {
      double u[MOTIONS][3], v[MOTIONS][3], *G = body->parts[body->part_of[robin->nodes[row]]].G;
      motions_of(body, robin->nodes[row], u);
      motions_of(body, robin->nodes[robin->columns[k]], v);
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
  if (told != count) snprintf(text, size, "move in %d way%s as one rigid thing", count, count > 1 ? "s" : "");
}

// How many motions of a part nothing resists; told in `text` where there are any.
static int free_motions_of(part *own, gsl_eigen_symmv_workspace *work, char *text, size_t size)
{
  double values[MOTIONS], columns[MOTIONS * MOTIONS];
  gsl_matrix_view matrix = gsl_matrix_view_array(own->G, MOTIONS, MOTIONS);
  gsl_matrix_view vectors = gsl_matrix_view_array(columns, MOTIONS, MOTIONS);
  gsl_vector_view value = gsl_vector_view_array(values, MOTIONS);
  gsl_eigen_symmv(&matrix.matrix, &value.vector, &vectors.matrix, work);
  gsl_eigen_symmv_sort(&value.vector, &vectors.matrix, GSL_EIGEN_SORT_VAL_ASC);
  int count = 0;
  while (count < MOTIONS && values[count] <= NOTHING * values[MOTIONS - 1]) count++;
  if (count > 0) say(columns, count, text, size);
  return count;
}

// "48 elements with node 3 at (0, 0, 7) mm"
static void say_part(const body *body, const part *own, char *text, size_t size)
{
  const double *place = body->model->rest + 4 * (size_t)own->first;
  const size_t count = own->elements > 0 ? own->elements : own->nodes;
  snprintf(text, size, "%zu %s with node %u at (%.4g, %.4g, %.4g) mm", count, own->elements > 0 ? "elements" : "nodes",
           vsc_source_number(body->model->node_source, body->model->mesh_node[own->first]), place[0], place[1], place[2]);
}

static void say_where(const body *body, const part *own, char *text, size_t size)
{
  char what[VSC_FREE_TEXT];
  const size_t length = strlen(text);
  say_part(body, own, what, sizeof what);
  snprintf(text + length, size - length, " in a part of it, %s, that is joined to nothing else", what);
}

// The parts and what holds them; false when memory is short. To be closed in any case.
static bool open_body(const vsc_model *model, body *body)
{
  body->model = model;
  if (!find_parts(body)) return false;
  add_supports(body);
  for (size_t k = 0; k < model->robin_count; k++) add_robin(body, &model->robins[k]);
  return true;
}

static void close_body(body *body)
{
  vsc_free(body->parts);
  vsc_free(body->part_of);
}

int vsc_free_motions(const vsc_model *model, char *text, size_t size)
{
  body body = {0};
  int count = 0;
  text[0] = '\0';
  gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(MOTIONS);
  const bool made = work != NULL && open_body(model, &body);
  for (size_t k = 0; k < body.part_count && made && count == 0; k++) {
    count = free_motions_of(&body.parts[k], work, text, size);
    if (count > 0 && body.part_count > 1) say_where(&body, &body.parts[k], text, size);
  }
  gsl_eigen_symmv_free(work);
  close_body(&body);
  return count;
}

// Whether no direction of any of its nodes is held, and no spring acts on them.
static bool is_loose(const part *own)
{
  for (int a = 0; a < MOTIONS; a++)
    if (own->G[(MOTIONS + 1) * a] > 0) return false;
  return true;
}

size_t vsc_loose_parts(const vsc_model *model, size_t *parts, char *text, size_t size)
{
  body body = {0};
  size_t count = 0;
  text[0] = '\0';
  const bool made = open_body(model, &body);
  for (size_t k = 0; k < body.part_count && made; k++)
    if (is_loose(&body.parts[k]) && count++ == 0) say_part(&body, &body.parts[k], text, size);
  *parts = made ? body.part_count : 0;
  close_body(&body);
  return count;
}
