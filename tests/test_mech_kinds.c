// SPDX-License-Identifier: GPL-3.0-or-later
// What holds for every kind of element and every law: forces are gradients, sum to nothing, turn
// with the body, and are the same on any number of threads.
#include <gsl/gsl_linalg.h>

#include "base/vec3.h"
#include "kinds_body.h"
#include "tissue_laws.h"

// A law on a mesh, and which of the properties it has.
typedef struct variant {
  const char *name;
  kinds_mesh mesh;
  vsc_law law;
  vsc_volume_kind volume;
  bool gradient, balanced_forces, balanced_moments;
  int tissue;  // 1 + the number of a tissue law, all in viscous material; 0: none
  vsc_tets_kind tets;
} variant;

#define TISSUE(k, mesh, volume) \
  {"tissue law " #k, mesh, VSC_LAW_SPRINGS, volume, true, true, true, 1 + k, VSC_TETS_PLAIN}

// The paper's angular forces have no potential and turn the element; its radial forces, and the
// springs to the barycentre, which pull at the corner only, push it.
static const variant variants[] = {
    {"hexahedra", ALL_HEXES, VSC_LAW_SPRINGS, VSC_VOLUME_NODAL, true, true, true, 0, VSC_TETS_PLAIN},
    {"all kinds, nodes share", ALL_KINDS, VSC_LAW_SPRINGS, VSC_VOLUME_NODAL, true, true, true, 0, VSC_TETS_PLAIN},
    {"all kinds, elements alone", ALL_KINDS, VSC_LAW_SPRINGS, VSC_VOLUME_ELEMENT, true, true, true, 0, VSC_TETS_PLAIN},
    {"tets", ALL_TETS, VSC_LAW_SPRINGS, VSC_VOLUME_NODAL, true, true, true, 0, VSC_TETS_PLAIN},
    {"quadratic tets", ALL_TETS10, VSC_LAW_SPRINGS, VSC_VOLUME_NODAL, true, true, true, 0, VSC_TETS_PLAIN},
    {"quadratic tets alone", ALL_TETS10, VSC_LAW_SPRINGS, VSC_VOLUME_ELEMENT, true, true, true, 0, VSC_TETS_PLAIN},
    {"smoothed tets", ALL_TETS, VSC_LAW_SPRINGS, VSC_VOLUME_NODAL, true, true, true, 0,
     VSC_TETS_SMOOTHED},
    {"smoothed, all kinds", ALL_KINDS, VSC_LAW_SPRINGS, VSC_VOLUME_ELEMENT, true, true, true, 0,
     VSC_TETS_SMOOTHED},
    {"paper tets", ALL_TETS, VSC_LAW_PAPER, VSC_VOLUME_NODAL, false, false, false, 0, VSC_TETS_PLAIN},
    {"paper hexahedra", ALL_HEXES, VSC_LAW_PAPER, VSC_VOLUME_NODAL, false, false, false, 0, VSC_TETS_PLAIN},
    {"classical tets", ALL_TETS, VSC_LAW_CLASSICAL, VSC_VOLUME_NODAL, true, true, true, 0, VSC_TETS_PLAIN},
    {"classical hexahedra", ALL_HEXES, VSC_LAW_CLASSICAL, VSC_VOLUME_NODAL, true, true, true, 0, VSC_TETS_PLAIN},
    {"classical, all kinds", ALL_KINDS, VSC_LAW_CLASSICAL, VSC_VOLUME_NODAL, true, true, true, 0, VSC_TETS_PLAIN},
    TISSUE(0, ALL_KINDS, VSC_VOLUME_NODAL),
    TISSUE(1, ALL_KINDS, VSC_VOLUME_ELEMENT),
    TISSUE(2, ALL_KINDS, VSC_VOLUME_NODAL),
    TISSUE(3, ALL_KINDS, VSC_VOLUME_NODAL),
    TISSUE(4, ALL_KINDS, VSC_VOLUME_ELEMENT),
    TISSUE(5, ALL_KINDS, VSC_VOLUME_NODAL),
    TISSUE(6, ALL_KINDS, VSC_VOLUME_ELEMENT),
    TISSUE(7, ALL_KINDS, VSC_VOLUME_NODAL),
    TISSUE(8, ALL_KINDS, VSC_VOLUME_NODAL),
    TISSUE(9, ALL_KINDS, VSC_VOLUME_NODAL),
    TISSUE(10, ALL_KINDS, VSC_VOLUME_NODAL),
    TISSUE(11, ALL_KINDS, VSC_VOLUME_NODAL),
    TISSUE(12, ALL_KINDS, VSC_VOLUME_ELEMENT),
    TISSUE(13, ALL_KINDS, VSC_VOLUME_NODAL),
    TISSUE(0, ALL_TETS10, VSC_VOLUME_NODAL),
    TISSUE(3, ALL_TETS10, VSC_VOLUME_NODAL),
    TISSUE(4, ALL_TETS10, VSC_VOLUME_NODAL),
    TISSUE(12, ALL_TETS10, VSC_VOLUME_NODAL),
};
enum { VARIANTS = sizeof variants / sizeof variants[0] };

static void open_variant(random_body *body, const variant *v, size_t n, uint64_t seed)
{
  static vsc_axis_def axes[2];
  static vsc_pair_def pairs[2];
  const vsc_material_def materials[] = {springs_material(axes, pairs), paper_material(),
                                        classical_material()};
  vsc_material_def material = v->tissue > 0 ? tissue_law(v->tissue - 1) : materials[v->law];
  if (v->tissue > 0) material.viscosity = 0.4;
  // the kink of a sharp switch would hide the order of differences
  if (material.compression == VSC_FIBRES_SHARP) material.compression = VSC_FIBRES_ALWAYS;
  kinds_open_tets(body, mesh_of(v->mesh, n, seed), &material, v->volume, v->tets, seed + 1);
}

// |(E(x + h d) - E(x - h d))/2h + f . d| falls as h^2.
static void check_gradient(random_body *body, const char *name)
{
  enum { DIRECTIONS = 8, STEPS = 3 };
  const size_t count = 3 * body->mesh->node_count;
  double *x = deformed(body->mesh, 0.12, 0.05, 21), *force = numbers(count), errors[STEPS] = {0};
  double *moved = numbers(count);
  vsc_totals totals;
  body_force(body, x, NULL, 0, force);
  for (int k = 0; k < DIRECTIONS; k++) {
    double *d = random_array(count, 1, 22 + (uint64_t)k);
    for (int s = 0; s < STEPS; s++) {
      const double h = ldexp(1, -9 - s);
      double energy[2];
      for (int side = 0; side < 2; side++) {
        for (size_t i = 0; i < count; i++) moved[i] = x[i] + (side ? -h : h) * d[i];
        energy[side] = kinds_energy(body, moved, &totals);
      }
      errors[s] += fabs((energy[0] - energy[1]) / (2 * h) + dot_of(force, d, count));
    }
    vsc_free(d);
  }
  for (int s = 0; s + 1 < STEPS; s++) {
    if (fabs(log2(errors[s] / errors[s + 1]) - 2) > 0.05) print_error("%s\n", name);
    assert_close(log2(errors[s] / errors[s + 1]), 2, 0, 0.05);
  }
  vsc_free(x);
  vsc_free(force);
  vsc_free(moved);
}

static void forces_are_gradients(void **state)
{
  (void)state;
  for (int v = 0; v < VARIANTS; v++) {
    random_body body;
    if (!variants[v].gradient) continue;
    open_variant(&body, &variants[v], 3, 10);
    check_gradient(&body, variants[v].name);
    body_close(&body);
  }
}

// The paper's axial springs have a potential.
static void axial_forces_of_the_paper_are_gradients(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    random_body body;
    vsc_material_def material = paper_material();
    memset(material.paper.angular, 0, sizeof material.paper.angular);
    // hexahedra are refused without; so little does not count
    material.paper.volume = 1e-9;
    kinds_open(&body, mesh_of(k == 0 ? ALL_TETS : ALL_HEXES, 3, 10), &material, VSC_VOLUME_NODAL, 11);
    check_gradient(&body, "paper's axial forces");
    body_close(&body);
  }
}

static void sums_of(const double *x, const double *force, size_t nodes, double sum[3],
                    double moment[3], double *size)
{
  memset(sum, 0, 3 * sizeof *sum);
  memset(moment, 0, 3 * sizeof *moment);
  *size = 0;
  for (size_t n = 0; n < nodes; n++) {
    double turning[3];
    vsc_cross(x + 3 * n, force + 3 * n, turning);
    *size += vsc_norm(force + 3 * n);
    for (int i = 0; i < 3; i++) {
      sum[i] += force[3 * n + i];
      moment[i] += turning[i];
    }
  }
}

// Sums of forces and moments vanish to the rounding of adding up some thousand terms; where the
// paper's formulas do not let them, they plainly differ from nothing.
static void forces_and_moments_balance(void **state)
{
  (void)state;
  for (int v = 0; v < VARIANTS; v++) {
    random_body body;
    open_variant(&body, &variants[v], 3, 30);
    const size_t nodes = body.mesh->node_count;
    double *x = deformed(body.mesh, 0.12, 0.05, 31), *w = random_array(3 * nodes, 1, 32);
    double *force = numbers(3 * nodes), sum[3], moment[3], size;
    body_force(&body, x, w, 0, force);
    sums_of(x, force, nodes, sum, moment, &size);
    if (variants[v].balanced_forces)
      assert_true(vsc_norm(sum) <= 1e-14 * size);
    else
      assert_true(vsc_norm(sum) > 1e-4 * size);
    if (variants[v].balanced_moments)
      assert_true(vsc_norm(moment) <= 5e-14 * size);
    else
      assert_true(vsc_norm(moment) > 1e-4 * size);
    vsc_free(x);
    vsc_free(w);
    vsc_free(force);
    body_close(&body);
  }
}

// Rigid motion gives no force, and rigid rotation of a deformed body turns its forces.
static void forces_turn_with_the_body(void **state)
{
  (void)state;
  for (int v = 0; v < VARIANTS; v++) {
    random_body body;
    uint64_t seed = 41;
    double R[9];
    open_variant(&body, &variants[v], 3, 40);
    const size_t nodes = body.mesh->node_count;
    double *x = deformed(body.mesh, 0.1, 0.05, 42), *turned = numbers(3 * nodes);
    double *force = numbers(3 * nodes), *other = numbers(3 * nodes);
    random_rotation(&seed, R);
    body_force(&body, x, NULL, 0, force);
    for (size_t n = 0; n < nodes; n++) {
      rotate_vector(R, x + 3 * n, turned + 3 * n);
      turned[3 * n] += 5;
    }
    body_force(&body, turned, NULL, 0, other);
    const double most = largest_of(force, 3 * nodes);
    for (size_t n = 0; n < nodes; n++) {
      double expected[3];
      rotate_vector(R, force + 3 * n, expected);
      // rounding of positions of size 10 through stiffness over size 1
      for (int i = 0; i < 3; i++) assert_close(other[3 * n + i], expected[i], 0, 1e-12 * most);
    }
    for (size_t n = 0; n < nodes; n++) rotate_vector(R, body.mesh->nodes + 3 * n, turned + 3 * n);
    body_force(&body, turned, NULL, 0, other);
    assert_true(largest_of(other, 3 * nodes) <= 1e-12 * most);
    vsc_free(x);
    vsc_free(turned);
    vsc_free(force);
    vsc_free(other);
    body_close(&body);
  }
}

// Power of the damping forces = - what the observation says is dissipated.
static void damping_dissipates_what_is_observed(void **state)
{
  (void)state;
  for (int v = 0; v < VARIANTS; v++) {
    random_body body;
    open_variant(&body, &variants[v], 3, 50);
    const size_t count = 3 * body.mesh->node_count;
    double *x = deformed(body.mesh, 0.1, 0.05, 51), *w = random_array(count, 1, 52);
    double *damped = numbers(count), *plain = numbers(count);
    vsc_totals totals;
    body_force(&body, x, w, 0, damped);
    body_force(&body, x, NULL, 0, plain);
    to_model(body.model, w, body.state->v);
    kinds_energy(&body, x, &totals);
    const double power = dot_of(damped, w, count) - dot_of(plain, w, count);
    assert_true(totals.dissipation > 0);
    assert_close(power, -totals.dissipation, 1e-11, 0);
    vsc_free(x);
    vsc_free(w);
    vsc_free(damped);
    vsc_free(plain);
    body_close(&body);
  }
}

static void threads_do_not_change_bits(void **state)
{
  (void)state;
  for (int v = 0; v < VARIANTS; v++) {
    double *forces[3];
    size_t count = 0;
    for (int threads = 1; threads <= 3; threads++) {
      random_body body;
      vsc_parallel_set_threads(threads);
      open_variant(&body, &variants[v], 7, 60);
      assert_true(body.model->patch_count > 2);  // else there is nothing to share
      count = 3 * body.mesh->node_count;
      double *x = deformed(body.mesh, 0.1, 0.05, 61), *w = random_array(count, 1, 62);
      forces[threads - 1] = numbers(count);
      body_force(&body, x, w, 0, forces[threads - 1]);
      vsc_free(x);
      vsc_free(w);
      body_close(&body);
    }
    for (int k = 0; k < 2; k++)
      assert_int_equal(memcmp(forces[k], forces[k + 1], count * sizeof(double)), 0);
    for (int k = 0; k < 3; k++) vsc_free(forces[k]);
  }
  vsc_parallel_set_threads(0);
}

// Patch test: an affine deformation of a body of one frame everywhere leaves inner nodes in
// equilibrium, whatever the kinds of the elements round them.
static void constant_stress_is_in_equilibrium(void **state)
{
  (void)state;
  for (int v = 0; v < VARIANTS; v++) {
    if (variants[v].law != VSC_LAW_SPRINGS) continue;
    random_body body;
    uint64_t seed = 71;
    double one[9];
    const size_t n = 4;
    open_variant(&body, &variants[v], n, 70);
    random_rotation(&seed, one);
    for (size_t e = 0; e < body.mesh->element_count; e++) {
      for (int q = 0; q < body.axes->points; q++)
        memcpy(vsc_axes_frame(body.axes, e, q), one, sizeof one);
      body.axes->known[e] = 1;
    }
    vsc_ledger_free(body.ledger);
    vsc_state_free(body.state);
    vsc_model_free(body.model);
    body_build(&body);
    const size_t nodes = body.mesh->node_count;
    double *x = deformed(body.mesh, 0.15, 0, 72), *force = numbers(3 * nodes);
    body_force(&body, x, NULL, 0, force);
    const double most = largest_of(force, 3 * nodes);
    size_t inner = 0;
    for (size_t i = 0; i < nodes; i++) {
      const double *at = body.mesh->nodes + 3 * i;
      bool within = true;
      for (int a = 0; a < 3; a++) within = within && at[a] > 1e-9 && at[a] < (double)n - 1e-9;
      if (!within) continue;
      inner++;
      for (int a = 0; a < 3; a++) assert_close(force[3 * i + (size_t)a], 0, 0, 1e-13 * most);
    }
    assert_true(inner >= 27);
    vsc_free(x);
    vsc_free(force);
    body_close(&body);
  }
}

// Cells whose frames share their volume anyhow do not look at `volume`: the same bits, with a stabilisation of their own
// and with the one that is taken out of the volume modulus.
static void volume_is_a_word_about_linear_tets(void **state)
{
  (void)state;
  static const kinds_mesh kinds[] = {ALL_HEXES, ALL_TETS10};
  for (int k = 0; k < 4; k++) {
    vsc_material_def material = springs_material(NULL, NULL);
    if (k % 2 == 1) {
      material = tissue_law(0);
      material.stabilization = 0;
    }
    double *forces[2], *x = NULL;
    size_t count = 0;
    for (int alone = 0; alone < 2; alone++) {
      random_body body;
      kinds_open(&body, mesh_of(kinds[k / 2], 3, 33), &material, alone ? VSC_VOLUME_ELEMENT : VSC_VOLUME_NODAL, 34);
      assert_true(body.model->materials[0].stabilization > 0);
      count = 3 * body.mesh->node_count;
      if (x == NULL) x = deformed(body.mesh, 0.12, 0.05, 35);
      forces[alone] = numbers(count);
      body_force(&body, x, NULL, 0, forces[alone]);
      body_close(&body);
    }
    assert_true(largest_of(forces[0], count) > 0.1);
    assert_memory_equal(forces[0], forces[1], count * sizeof(double));
    vsc_free(forces[0]);
    vsc_free(forces[1]);
    vsc_free(x);
  }
}

// The number of singular values below 1e-7 of the largest of the tangent at rest of a body, whose mesh
// becomes the body's (differences of forces over 1e-5 mm: rounding 1e-10, third derivatives 1e-10).
static int zero_modes_shared(vsc_mesh *mesh, const vsc_material_def *material, vsc_volume_kind volume, vsc_tets_kind tets)
{
  const size_t size = 3 * mesh->node_count;
  random_body body;
  kinds_open_tets(&body, mesh, material, volume, tets, 90);
  gsl_matrix *K = gsl_matrix_calloc(size, size), *V = gsl_matrix_alloc(size, size);
  gsl_vector *values = gsl_vector_alloc(size), *room = gsl_vector_alloc(size);
  const double h = 1e-5;
  double *force[2] = {numbers(size), numbers(size)}, *x = numbers(size);
  for (size_t j = 0; j < size; j++) {
    for (int side = 0; side < 2; side++) {
      memcpy(x, mesh->nodes, size * sizeof *x);
      x[j] += side ? -h : h;
      body_force(&body, x, NULL, 0, force[side]);
    }
    for (size_t i = 0; i < size; i++)
      gsl_matrix_set(K, i, j, -(force[0][i] - force[1][i]) / (2 * h));
  }
  gsl_linalg_SV_decomp(K, V, values, room);
  int zeros = 0;
  const double most = gsl_vector_max(values);
  for (size_t i = 0; i < size; i++) zeros += gsl_vector_get(values, i) < 1e-7 * most;
  gsl_matrix_free(K);
  gsl_matrix_free(V);
  gsl_vector_free(values);
  gsl_vector_free(room);
  for (int side = 0; side < 2; side++) vsc_free(force[side]);
  vsc_free(x);
  body_close(&body);
  return zeros;
}

static int zero_modes_of(vsc_mesh *mesh, const vsc_material_def *material)
{
  return zero_modes_shared(mesh, material, VSC_VOLUME_ELEMENT, VSC_TETS_PLAIN);
}

// The same of one element.
static int zero_modes(vsc_cell kind, const vsc_material_def *material)
{
  static const double hex[8][3] = {{0, 0, 0}, {1, 0, .1}, {1.1, 1, 0}, {0, 1, 0},
                                   {0, .1, 1}, {1, 0, 1}, {1, 1, 1.2}, {-.1, 1, 1}};
  static const double wedge[6][3] = {{0, 0, 0}, {1, 0, 0}, {.1, 1, 0}, {0, 0, 1}, {1, .1, 1}, {0, 1, 1}};
  static const double pyramid[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1.1, 0}, {0, 1, 0}, {.4, .5, 1}};
  static const double tet[4][3] = {{0, 0, 0}, {1, 0, 0}, {.1, 1, 0}, {0, .2, 1}};
  static const double curved[10][3] = {{0, 0, 0}, {1, 0, 0}, {.1, 1, 0}, {0, .2, 1}, {.5, .1, 0},
                                       {.5, .5, .1}, {0, .5, 0}, {0, .1, .6}, {.6, 0, .5}, {0, .6, .5}};
  static const double(*const corners[VSC_CELLS])[3] = {tet, hex, wedge, pyramid, curved};
  const int count = vsc_cells[kind].corners;
  const uint8_t kinds[1] = {(uint8_t)kind};
  vsc_mesh *mesh = vsc_mesh_create_cells((size_t)count, 1, kinds, 0);
  for (int c = 0; c < count; c++) {
    mesh->corners[c] = (uint32_t)c;
    memcpy(mesh->nodes + 3 * c, corners[kind][c], 3 * sizeof(double));
  }
  return zero_modes_of(mesh, material);
}

// Rigid motions are the only ones without force; the paper's hexahedron has twelve more, as the
// paper says, and still four when its corners are tied to the barycentre.
static void only_rigid_motion_is_free(void **state)
{
  (void)state;
  const vsc_material_def springs = springs_material(NULL, NULL);
  for (int kind = 0; kind < VSC_CELLS; kind++) assert_int_equal(zero_modes((vsc_cell)kind, &springs), 6);
  assert_int_equal(zero_modes_of(mesh_of(ALL_TETS10, 1, 92), &springs), 6);
  vsc_material_def paper = paper_material();
  assert_int_equal(zero_modes(VSC_HEX, &paper), 10);
  paper.paper.volume = 1e-9;
  assert_int_equal(zero_modes(VSC_HEX, &paper), 18);
  assert_int_equal(zero_modes(VSC_TET, &paper), 6);
}

// So it is of patches: elements that hold one another have no motion without force that one alone has not, whatever shares
// volumes and whatever tets see.
static void only_rigid_motion_of_patches_is_free(void **state)
{
  (void)state;
  static const char *const names[] = {"hexahedra", "wedges", "tets", "pyramids", "quadratic tets", "all kinds"};
  const vsc_material_def materials[2] = {springs_material(NULL, NULL), tissue_law(2)};
  for (int patch = 0; patch < 6; patch++)
    for (int way = 0; way < 8; way++) {
      vsc_material_def material = materials[way % 2];
      if (way / 4 && patch != HYBRID_TETS && patch != 5) continue;  // nothing to smooth
      if (way % 2 == 1) material.stabilization = 0;  // by default
      vsc_mesh *mesh = patch < 4 ? hybrid_block_of(2, (hybrid_cut)patch, 0.15, 93)
                       : patch == 4 ? mesh_of(ALL_TETS10, 1, 93) : hybrid_block(2, 0.15, 93);
      const int free = zero_modes_shared(mesh, &material, way / 2 % 2 ? VSC_VOLUME_NODAL : VSC_VOLUME_ELEMENT,
                                         way / 4 ? VSC_TETS_SMOOTHED : VSC_TETS_PLAIN);
      if (free != 6) fail_msg("%s, way %d: %d motions are free", names[patch], way, free);
    }
}

// An edge's middle pushed to a fifth of the edge folds a quadratic tet at its corner, where no frame is inside out.
static void quadratic_tets_are_inside_out_at_nodes_too(void **state)
{
  (void)state;
  const vsc_material_def material = tissue_law(0);
  random_body body;
  vsc_totals totals;
  kinds_open(&body, mesh_of(ALL_TETS10, 1, 3), &material, VSC_VOLUME_ELEMENT, 4);
  double *x = numbers(3 * body.mesh->node_count);
  memcpy(x, body.mesh->nodes, 3 * body.mesh->node_count * sizeof *x);
  kinds_energy(&body, x, &totals);
  assert_true(totals.inverted == 0);
  const uint32_t *corner = vsc_mesh_corners(body.mesh, 0);
  const double *first = body.mesh->nodes + 3 * corner[0], *second = body.mesh->nodes + 3 * corner[1];
  for (int part = 0; part < 2; part++) {
    for (int i = 0; i < 3; i++) x[3 * corner[4] + i] = first[i] + (part ? 0.2 : 0.3) * (second[i] - first[i]);
    kinds_energy(&body, x, &totals);
    assert_true(totals.J_low > 0);
    assert_true(part ? totals.inverted >= 1 : totals.inverted == 0);
  }
  vsc_free(x);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(forces_are_gradients),
      cmocka_unit_test(axial_forces_of_the_paper_are_gradients),
      cmocka_unit_test(forces_and_moments_balance),
      cmocka_unit_test(forces_turn_with_the_body),
      cmocka_unit_test(damping_dissipates_what_is_observed),
      cmocka_unit_test(threads_do_not_change_bits),
      cmocka_unit_test(constant_stress_is_in_equilibrium),
      cmocka_unit_test(volume_is_a_word_about_linear_tets),
      cmocka_unit_test(only_rigid_motion_is_free),
      cmocka_unit_test(only_rigid_motion_of_patches_is_free),
      cmocka_unit_test(quadratic_tets_are_inside_out_at_nodes_too),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
