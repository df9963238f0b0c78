// SPDX-License-Identifier: GPL-3.0-or-later
// Models of quadratic tets: masses, weight, one frame or four, and what is refused.
#include "base/vec3.h"
#include "kinds_body.h"
#include "mech/element.h"
#include "model/masses.h"

// Point k of 64 over the reference tet, by four Gauss points along each collapsed coordinate; returns its weight, of 1
// in all. Exact to degree 5.
static double gauss_point(int k, double xi[3])
{
  static const double at[4] = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281,
                               0.9305681557970263};
  static const double weight[4] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731,
                                   0.1739274225687269};
  const int a = k / 16, b = k / 4 % 4, c = k % 4;
  xi[2] = at[c];
  xi[1] = at[b] * (1 - xi[2]);
  xi[0] = at[a] * (1 - xi[2] - xi[1]);
  return weight[a] * weight[b] * weight[c] * (1 - xi[2] - xi[1]) * (1 - xi[2]) * 6;
}

// int N_i N_j dV / V over the reference tet.
static double integral_of_product(int i, int j)
{
  double sum = 0, N[VSC_MOST_CORNERS], D[3][VSC_MOST_CORNERS], xi[3];
  for (int k = 0; k < 64; k++) {
    const double weight = gauss_point(k, xi);
    vsc_cell_shape(VSC_TET10, xi, N, D);
    sum += weight * N[i] * N[j];
  }
  return sum;
}

// The lumped ones are the diagonal, scaled; 1e-14: the rounding of 64 terms.
static void masses_are_those_of_the_functions(void **state)
{
  (void)state;
  double diagonal = 0, lumped[VSC_MOST_CORNERS];
  for (int i = 0; i < 10; i++) {
    diagonal += integral_of_product(i, i);
    for (int j = 0; j < 10; j++)
      assert_close(vsc_quadratic_mass(i, j), integral_of_product(i, j), 0, 1e-14);
  }
  vsc_mesh *mesh = mesh_of(ALL_TETS10, 2, 4);
  const vsc_cell_rule rule = vsc_cell_rule_of(VSC_TET10);
  for (size_t e = 0; e < mesh->element_count; e++) {
    const double volume = vsc_mesh_element_volume(mesh, e);
    vsc_lumped_volumes(mesh, &rule, e, lumped);
    for (int i = 0; i < 10; i++)
      assert_close(lumped[i], volume * integral_of_product(i, i) / diagonal, 1e-13, 0);
  }
  vsc_mesh_free(mesh);
}

static void open_body(random_body *body, uint64_t seed)
{
  const vsc_material_def springs = springs_material(NULL, NULL);
  kinds_open(body, mesh_of(ALL_TETS10, 2, seed), &springs, VSC_VOLUME_ELEMENT, seed + 1);
}

static void rebuild(random_body *body)
{
  vsc_ledger_free(body->ledger);
  vsc_state_free(body->state);
  vsc_model_free(body->model);
  body_build(body);
}

// All of the weight is there: of steps as the lumped masses have it, of equilibria as int N_i does, which
// moves no linear function's work: sum_i w_i x_i = g int rho x dV.
static void weight_is_consistent_where_it_may(void **state)
{
  (void)state;
  random_body body;
  open_body(&body, 6);
  body.definition.gravity[2] = -0.01;
  rebuild(&body);
  const vsc_model *model = body.model;
  for (size_t n = 0; n < model->node_count; n++)
    assert_close(model->weight[4 * n + 2], -0.01 * model->mass[n], 1e-15, 0);
  body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  rebuild(&body);
  model = body.model;
  double sum = 0, moment[3] = {0}, centre[3] = {0}, least = 0;
  for (size_t n = 0; n < model->node_count; n++) {
    sum += model->weight[4 * n + 2];
    least = fmax(least, model->weight[4 * n + 2]);
    for (size_t a = 0; a < 3; a++) moment[a] += model->weight[4 * n + 2] * model->rest[4 * n + a];
  }
  for (size_t e = 0; e < body.mesh->element_count; e++) {
    double at[3];
    vsc_mesh_element_centre(body.mesh, e, at);
    for (int a = 0; a < 3; a++)
      centre[a] += -0.01 * body.materials[0].density * vsc_mesh_element_volume(body.mesh, e) * at[a];
  }
  assert_close(sum, -0.01 * model->total_mass, 1e-13, 0);
  for (int a = 0; a < 3; a++) assert_close(moment[a], centre[a], 1e-12, 0);
  assert_true(least > 0);  // a corner of few tets
  body_close(&body);
}

// int N_i dV over the element as its edges are, to rounding; returns its volume.
static double exact_shares(const vsc_mesh *mesh, size_t element, double shares[10])
{
  double N[VSC_MOST_CORNERS], D[3][VSC_MOST_CORNERS], xi[3], volume = 0;
  memset(shares, 0, 10 * sizeof *shares);
  for (int k = 0; k < 64; k++) {
    double h[3][3] = {{0}}, across[3];
    const double weight = gauss_point(k, xi);
    vsc_cell_shape(VSC_TET10, xi, N, D);
    for (int i = 0; i < 10; i++)
      for (size_t b = 0; b < 9; b++)
        h[b / 3][b % 3] += D[b / 3][i] * mesh->nodes[3 * (size_t)vsc_mesh_corners(mesh, element)[i] + b % 3];
    vsc_cross(h[1], h[2], across);
    const double part = weight / 6 * vsc_dot(h[0], across);
    for (int i = 0; i < 10; i++) shares[i] += part * N[i];
    volume += part;
  }
  return volume;
}

// The weights of an equilibrium's nodes against those by exact_shares, as a part of the largest, and the same of what
// straight edges would have it: -1/20 and 1/5 of each element.
static void compare_weights(double bend, uint64_t seed, double *off, double *straight)
{
  random_body body;
  open_body(&body, seed);
  for (size_t n = 27; n < body.mesh->node_count; n++)
    for (size_t a = 0; a < 3; a++) body.mesh->nodes[3 * n + a] += random_between(&seed, -bend, bend);
  body.definition.gravity[1] = 1 / body.materials[0].density;
  body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  rebuild(&body);
  double *exact = numbers(body.mesh->node_count), *plain = numbers(body.mesh->node_count), shares[10], most = 0;
  for (size_t e = 0; e < body.mesh->element_count; e++) {
    const double volume = exact_shares(body.mesh, e, shares);
    for (int i = 0; i < 10; i++) {
      const uint32_t node = vsc_mesh_corners(body.mesh, e)[i];
      exact[node] += shares[i];
      plain[node] += volume * (i < 4 ? -0.05 : 0.2);
    }
  }
  *off = *straight = 0;
  for (size_t n = 0; n < body.model->node_count; n++) {
    const uint32_t node = body.model->mesh_node[n];
    most = fmax(most, fabs(exact[node]));
    *off = fmax(*off, fabs(body.model->weight[4 * n + 1] - exact[node]));
    *straight = fmax(*straight, fabs(plain[node] - exact[node]));
  }
  *off /= most;
  *straight /= most;
  vsc_free(exact);
  vsc_free(plain);
  body_close(&body);
}

// With straight edges the four points are exact. With nodes moved by chance off the middles of edges of 1 mm their
// remainder is of the first order too, but a quarter of what straight edges would leave.
static void weight_knows_bent_edges(void **state)
{
  (void)state;
  double off, straight;
  compare_weights(0, 12, &off, &straight);
  assert_close(off, 0, 0, 1e-13);
  assert_close(straight, 0, 0, 1e-13);
  for (double bend = 0.04; bend > 0.004; bend /= 2) {
    compare_weights(bend, 12, &off, &straight);
    assert_true(straight > 0.5 * bend);
    assert_true(off < straight / 4);
  }
}

// At rest the axes of each frame are those of its point; rounding of sums of ten places up to 2 mm.
static void each_point_has_its_axes(void **state)
{
  (void)state;
  random_body body;
  open_body(&body, 7);
  const vsc_model *model = body.model;
  for (size_t p = 0; p < model->patch_count; p++)
    for (size_t k = model->patches[p].first_pack;
         k < model->patches[p].first_pack + model->patches[p].pack_count; k++)
      for (int q = 0; q < 4; q++) {
        vsc_wide3 g[3];
        vsc_pack_axes(model, &model->patches[p], k, q, model->rest, g);
        for (int l = 0; l < VSC_WIDTH; l++) {
          const uint32_t element = model->mesh_element[VSC_WIDTH * k + (size_t)l];
          if (element == VSC_NO_ELEMENT) continue;
          const double *frame = vsc_axes_frame(body.axes, element, q);
          for (int a = 0; a < 3; a++) {
            assert_close(g[a].x[l], frame[3 * a], 0, 1e-13);
            assert_close(g[a].y[l], frame[3 * a + 1], 0, 1e-13);
            assert_close(g[a].z[l], frame[3 * a + 2], 0, 1e-13);
          }
        }
      }
  body_close(&body);
}

// One frame of each element stands for all its points.
static void one_frame_will_do(void **state)
{
  (void)state;
  random_body body;
  open_body(&body, 8);
  vsc_axes *single = random_axes(body.mesh->element_count, 9);
  for (size_t e = 0; e < single->count; e++) {
    for (int q = 0; q < body.axes->points; q++)
      memcpy(vsc_axes_frame(body.axes, e, q), vsc_axes_frame(single, e, 0), 9 * sizeof(double));
    body.axes->known[e] = single->known[e];
  }
  rebuild(&body);
  const uint64_t hash = body.model->hash;
  vsc_axes_free(body.axes);
  body.axes = single;
  rebuild(&body);
  assert_true(body.model->hash == hash);
  body_close(&body);

  // but not four frames for elements of one point
  vsc_mesh *linear = mesh_of(ALL_TETS, 2, 8), *quadratic = mesh_of(ALL_TETS10, 2, 8);
  vsc_axes *four = random_axes_for(quadratic, 3);
  vsc_material_def springs = springs_material(NULL, NULL);
  vsc_definition definition = vsc_default_definition();
  definition.end_time = 1;
  definition.material_count = 1;
  definition.materials = &springs;
  vsc_model *model;
  vsc_error error;
  assert_int_equal(vsc_model_build(linear, four, &definition, &model, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "axes of 4 frames per element for a mesh of linear ones"));
  vsc_axes_free(four);
  vsc_mesh_free(linear);
  vsc_mesh_free(quadratic);
}

static void assert_refused(const vsc_mesh *mesh, const vsc_definition *definition, const char *words)
{
  vsc_model *model = NULL;
  vsc_error error = {0};
  assert_int_equal(vsc_model_build(mesh, NULL, definition, &model, &error), VSC_INPUT);
  if (strstr(error.text, words) == NULL) fail_msg("\"%s\" not in \"%s\"", words, error.text);
}

static void what_knows_corners_only_is_refused(void **state)
{
  (void)state;
  vsc_mesh *mesh = mesh_of(ALL_TETS10, 2, 4);
  vsc_material_def material = springs_material(NULL, NULL);
  vsc_membrane_def membrane = vsc_default_membrane();
  membrane.thickness = membrane.density = membrane.axial[0] = membrane.axial[1] = 1;
  vsc_copy_name(membrane.name, "skin");
  vsc_copy_name(membrane.surface, "boundary");
  vsc_definition plain = vsc_default_definition();
  plain.end_time = 1;
  plain.material_count = 1;
  plain.materials = &material;
  vsc_definition asked = plain;
  asked.masses = VSC_MASS_VORONOI;
  assert_refused(mesh, &asked, "masses: voronoi: not with quadratic tetrahedra");
  asked = plain;
  asked.kept_volume = VSC_KEEP_TOTAL;
  assert_refused(mesh, &asked, "keep_volume: not with quadratic tetrahedra");
  asked = plain;
  asked.membrane_count = 1;
  asked.membranes = &membrane;
  assert_refused(mesh, &asked, "membranes: not with quadratic tetrahedra");
  material = paper_material();
  assert_refused(mesh, &plain, "is a quadratic tetrahedron; law: paper knows tetrahedra");
  material = classical_material();
  assert_refused(mesh, &plain, "is a quadratic tetrahedron, whose edges bend: law: classical");
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(masses_are_those_of_the_functions),
      cmocka_unit_test(weight_is_consistent_where_it_may),
      cmocka_unit_test(weight_knows_bent_edges),
      cmocka_unit_test(each_point_has_its_axes),
      cmocka_unit_test(one_frame_will_do),
      cmocka_unit_test(what_knows_corners_only_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
