// SPDX-License-Identifier: GPL-3.0-or-later
// Models of quadratic tets: masses, weight, one frame or four, and what is refused.
#include "kinds_body.h"
#include "mech/element.h"
#include "model/masses.h"

// int N_i N_j dV / V over the reference tet by four Gauss points along each collapsed coordinate: exact
// to degree 7.
static double integral_of_product(int i, int j)
{
  static const double at[4] = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281,
                               0.9305681557970263};
  static const double weight[4] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731,
                                   0.1739274225687269};
  double sum = 0;
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++)
      for (int c = 0; c < 4; c++) {
        double N[VSC_MOST_CORNERS], D[3][VSC_MOST_CORNERS];
        const double z = at[c], y = at[b] * (1 - z), x = at[a] * (1 - z - y);
        vsc_cell_shape(VSC_TET10, (const double[3]){x, y, z}, N, D);
        sum += weight[a] * weight[b] * weight[c] * (1 - z - y) * (1 - z) * 6 * N[i] * N[j];
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
      cmocka_unit_test(each_point_has_its_axes),
      cmocka_unit_test(one_frame_will_do),
      cmocka_unit_test(what_knows_corners_only_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
