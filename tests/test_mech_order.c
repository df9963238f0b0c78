// SPDX-License-Identifier: GPL-3.0-or-later
// What must not matter: threads (to the bit), the order of nodes and elements
// and the hand of the world (to rounding).
#include "base/vec3.h"
#include "close.h"
#include "random_body.h"
#include "solve/explicit.h"

static const vsc_active_kind kinds[] = {VSC_ACTIVE_NONE, VSC_ACTIVE_SPRING, VSC_ACTIVE_TENSION};
static const vsc_volume_kind volumes[] = {VSC_VOLUME_NODAL, VSC_VOLUME_ELEMENT};

// Force and, after some steps, the state's hash and totals with a number of threads.
typedef struct outcome {
  double *force;
  size_t count;
  uint64_t hash;
  vsc_totals totals;
} outcome;

static outcome with_threads(int threads, vsc_active_kind kind, vsc_volume_kind volume)
{
  vsc_parallel_set_threads(threads);
  random_body body;
  vsc_error error;
  random_body_open(&body, 6, kind, volume, 200);
  outcome result = {.count = 3 * body.mesh->node_count};
  result.force = numbers(result.count);
  double *x = deformed(body.mesh, 0.1, 0.05, 201), *w = random_array(result.count, 0.5, 202);
  body_force(&body, x, w, 80, result.force);
  to_model(body.model, x, body.state->x);
  if (vsc_start(body.model, body.state, &error) != VSC_OK) fail_msg("%s", error.text);
  if (vsc_advance(body.model, body.state, 0.5, &error) != VSC_OK) fail_msg("%s", error.text);
  assert_true(body.state->steps >= 3);
  result.hash = vsc_state_hash(body.model, body.state);
  vsc_observe(body.model, body.state, body.ledger, false, &result.totals);
  vsc_free(x);
  vsc_free(w);
  body_close(&body);
  return result;
}

static void the_number_of_threads_does_not_matter(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++)
    for (int v = 0; v < 2; v++) {
      const outcome one = with_threads(1, kinds[k], volumes[v]);
      for (int threads = 2; threads <= 5; threads++) {
        const outcome more = with_threads(threads, kinds[k], volumes[v]);
        assert_int_equal(memcmp(one.force, more.force, one.count * sizeof *one.force), 0);
        assert_true(one.hash == more.hash);
        assert_int_equal(memcmp(&one.totals, &more.totals, sizeof one.totals), 0);
        vsc_free(more.force);
      }
      vsc_free(one.force);
    }
  vsc_parallel_set_threads(1);
}

// Where each node and tet of one mesh is in another, and whether the other is its mirror image.
typedef struct transformation {
  size_t *node, *tet;  // new number of each
  double mirror;       // 1 or -1: factor of x
  int turn;            // corners of each tet are turned by this many of the three even rotations
} transformation;

static size_t *shuffled(size_t count, uint64_t seed)
{
  size_t *order;
  if (!VSC_NEW(order, count)) fail_msg("no memory");
  for (size_t i = 0; i < count; i++) {
    const size_t j = (size_t)(random_part(&seed) * (double)(i + 1));
    order[i] = order[j];
    order[j] = i;
  }
  return order;
}

static vsc_mesh *transform_mesh(const vsc_mesh *mesh, const transformation *to)
{
  vsc_mesh *other = vsc_mesh_create(mesh->node_count, mesh->element_count, 0);
  for (size_t n = 0; n < mesh->node_count; n++) {
    double *x = other->nodes + 3 * to->node[n];
    memcpy(x, mesh->nodes + 3 * n, 3 * sizeof *x);
    x[0] *= to->mirror;
  }
  for (size_t t = 0; t < mesh->element_count; t++) {
    const uint32_t *old = mesh->corners + 4 * t;
    uint32_t corners[4] = {old[0], old[1 + to->turn % 3], old[1 + (to->turn + 1) % 3],
                           old[1 + (to->turn + 2) % 3]};
    if (to->mirror < 0) {
      const uint32_t third = corners[2];
      corners[2] = corners[3];
      corners[3] = third;
    }
    for (int c = 0; c < 4; c++)
      other->corners[4 * to->tet[t] + (size_t)c] = (uint32_t)to->node[corners[c]];
  }
  for (size_t k = 0; k < mesh->element_data.count; k++) {
    const vsc_array *array = &mesh->element_data.items[k];
    double *values = vsc_arrays_add(&other->element_data, array->name, 1, mesh->element_count)->values;
    for (size_t t = 0; t < mesh->element_count; t++) values[to->tet[t]] = array->values[t];
  }
  return other;
}

// A mirrored frame is left-handed; axes have no sign, so its normal is turned round.
static vsc_axes *transform_axes(const vsc_axes *axes, const transformation *to)
{
  vsc_axes *other = vsc_axes_create(axes->count);
  for (size_t t = 0; t < axes->count; t++) {
    double *frame = other->frames + 9 * to->tet[t];
    memcpy(frame, axes->frames + 9 * t, 9 * sizeof *frame);
    for (int a = 0; a < 3; a++) {
      frame[3 * a] *= to->mirror;
      for (int i = 0; a == 2 && i < 3; i++) frame[3 * a + i] *= to->mirror;
    }
    other->known[to->tet[t]] = axes->known[t];
  }
  assert_true(vsc_axes_valid(other));
  return other;
}

static double *transform_nodes(const double *values, size_t nodes, const transformation *to)
{
  double *other = numbers(3 * nodes);
  for (size_t n = 0; n < nodes; n++)
    for (int i = 0; i < 3; i++)
      other[3 * to->node[n] + (size_t)i] = values[3 * n + (size_t)i] * (i == 0 ? to->mirror : 1);
  return other;
}

// The axes of smoothed tets' edges are eigenvectors, of eigenvalues that may be some 1e-2 apart.
static void compare_transformed(const transformation *to, vsc_active_kind kind,
                                vsc_volume_kind volume, vsc_tets_kind tets)
{
  random_body body, other;
  const double tolerance = tets == VSC_TETS_SMOOTHED ? 1e-12 : 1e-14;
  vsc_mesh *mesh = random_block(5, 220);
  body_define(&body, mesh, random_axes(mesh->element_count, 221), kind, volume);
  body.definition.tets = tets;
  body_build(&body);
  body_define(&other, transform_mesh(body.mesh, to), transform_axes(body.axes, to), kind, volume);
  other.definition.gravity[0] *= to->mirror;
  other.definition.tets = tets;
  body_build(&other);
  const size_t nodes = body.mesh->node_count;
  double *x = deformed(body.mesh, 0.15, 0.2, 221), *w = random_array(3 * nodes, 1, 222);
  double *other_x = transform_nodes(x, nodes, to), *other_w = transform_nodes(w, nodes, to);
  double *force = numbers(3 * nodes), *other_force = numbers(3 * nodes);
  body_force(&body, x, w, 60, force);
  body_force(&other, other_x, other_w, 60, other_force);
  double *expected = transform_nodes(force, nodes, to);
  const double size = largest_of(force, 3 * nodes);
  for (size_t i = 0; i < 3 * nodes; i++) assert_close(other_force[i], expected[i], 0, tolerance * size);
  double *arrays[] = {x, w, other_x, other_w, force, other_force, expected};
  for (int i = 0; i < 7; i++) vsc_free(arrays[i]);
  body_close(&body);
  body_close(&other);
}

enum { NODES = 6 * 6 * 6, TETS = 6 * 5 * 5 * 5 };

static void the_order_of_nodes_and_elements_does_not_matter(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++)
    for (int v = 0; v < 2; v++) {
      const transformation to = {shuffled(NODES, 230 + (uint64_t)k),
                                 shuffled(TETS, 240 + (uint64_t)k), 1, k};
      compare_transformed(&to, kinds[k], volumes[v], VSC_TETS_PLAIN);
      compare_transformed(&to, kinds[k], volumes[v], VSC_TETS_SMOOTHED);
      vsc_free(to.node);
      vsc_free(to.tet);
    }
}

static void a_mirror_image_has_mirrored_forces(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++)
    for (int v = 0; v < 2; v++) {
      const transformation to = {shuffled(NODES, 250), shuffled(TETS, 251), -1, k};
      compare_transformed(&to, kinds[k], volumes[v], VSC_TETS_PLAIN);
      compare_transformed(&to, kinds[k], volumes[v], VSC_TETS_SMOOTHED);
      vsc_free(to.node);
      vsc_free(to.tet);
    }
}

// Pressure 3 kPa on the face x = 4 of a block at rest pushes by -3 . 16 mm^2 along x, on that face
// only; when the face has turned, along its new normal.
static void pressure_follows_its_face(void **state)
{
  (void)state;
  random_body body;
  vsc_selector face = {
      .name = "end", .kind = VSC_SELECT_NODE_ARRAY, .array = "x1", .low = 1, .high = 1};
  vsc_mesh *mesh = random_block(4, 260);
  body_define(&body, mesh, random_axes(mesh->element_count, 261), VSC_ACTIVE_NONE, VSC_VOLUME_NODAL);
  memset(body.definition.gravity, 0, sizeof body.definition.gravity);
  body.definition.surfaces = &face;
  body.definition.surface_count = 1;
  vsc_copy_name(body.pressure.surface, "end");
  body_build(&body);
  const size_t nodes = mesh->node_count;
  double R[9], sum[3] = {0}, normal[3], *x = numbers(3 * nodes), *force = numbers(3 * nodes);
  const double x_axis[3] = {1, 0, 0};
  uint64_t seed = 262;
  random_rotation(&seed, R);
  rotate_vector(R, x_axis, normal);
  for (size_t n = 0; n < nodes; n++) rotate_vector(R, mesh->nodes + 3 * n, x + 3 * n);
  body_force(&body, x, NULL, 2 * RAMP_TIME, force);
  for (size_t n = 0; n < nodes; n++) {
    // elsewhere: the rounding of the springs' forces at rest
    if (mesh->nodes[3 * n] < 4 - 1e-9) assert_close(vsc_norm(force + 3 * n), 0, 0, 1e-12);
    for (int i = 0; i < 3; i++) sum[i] += force[3 * n + (size_t)i];
  }
  for (int i = 0; i < 3; i++) assert_close(sum[i], -48 * normal[i], 0, 48e-14);
  vsc_free(x);
  vsc_free(force);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_number_of_threads_does_not_matter),
      cmocka_unit_test(the_order_of_nodes_and_elements_does_not_matter),
      cmocka_unit_test(a_mirror_image_has_mirrored_forces),
      cmocka_unit_test(pressure_follows_its_face),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
