// SPDX-License-Identifier: GPL-3.0-or-later
// Which rigid motions supports and springs on surfaces leave free.
#include "small_body.h"
#include "model/free_motions.h"

static void free_to(const char *set, const char *other, const int held[3], const int more[3], int count,
                    const char *words)
{
  small_body body;
  char text[128];
  body_open(&body, block_of(3, 2, 2, 1, 0.1), 50);
  if (set != NULL) body_hold(&body, set, held[0], held[1], held[2]);
  if (other != NULL) body_hold(&body, other, more[0], more[1], more[2]);
  body_build(&body);
  assert_int_equal(vsc_free_motions(body.model, text, sizeof text), count);
  assert_string_equal(text, words);
  body_close(&body);
}

static void supports_leave_what_they_do_not_hold(void **state)
{
  (void)state;
  free_to(NULL, NULL, NULL, NULL, 6, "move along x, y, z and turn about x, y, z");
  free_to("x0", NULL, (int[3]){1, 1, 1}, NULL, 0, "");
  free_to("x0", NULL, (int[3]){1, 0, 0}, NULL, 3, "move along y, z and turn about x");
  free_to("x0", NULL, (int[3]){1, 1, 0}, NULL, 1, "move along z");
  free_to("x0", "y0", (int[3]){1, 0, 0}, (int[3]){0, 1, 0}, 1, "move along z");
  // along x, and about an upright axis in the face that it is held at, which goes not through its middle
  free_to("x0", "z0", (int[3]){0, 1, 0}, (int[3]){0, 0, 1}, 2, "move in 2 ways as one rigid thing");
}

static void springs_on_a_surface_hold_too(void **state)
{
  (void)state;
  for (int normal = 0; normal < 2; normal++) {
    small_body body;
    char text[128];
    vsc_selector surface = {.kind = VSC_SELECT_NODE_ARRAY, .low = 1, .high = 1};
    vsc_robin_def robin = {.stiffness = 1, .normal = normal};
    body_open(&body, block_of(3, 2, 2, 1, 0), 50);
    vsc_copy_name(surface.name, "end");
    vsc_copy_name(surface.array, "x1");
    vsc_copy_name(robin.surface, "end");
    body.definition.surfaces = &surface;
    body.definition.surface_count = 1;
    body.definition.robins = &robin;
    body.definition.robin_count = 1;
    body_build(&body);
    assert_int_equal(vsc_free_motions(body.model, text, sizeof text), normal ? 3 : 0);
    assert_string_equal(text, normal ? "move along y, z and turn about x" : "");
    body_close(&body);
  }
}

// The same springs on the end of a bar that lies askew: three ways, none along an axis, and turns are turns.
static void an_oblique_bar_slides_and_turns(void **state)
{
  (void)state;
  small_body body;
  char text[128];
  vsc_selector surface = {.kind = VSC_SELECT_NODE_ARRAY, .name = "end", .array = "x1", .low = 1, .high = 1};
  vsc_robin_def robin = {.surface = "end", .stiffness = 1, .normal = true};
  vsc_mesh *mesh = block_of(3, 2, 2, 1, 0);
  for (size_t n = 0; n < mesh->node_count; n++) {
    double *x = mesh->nodes + 3 * n, at[3] = {x[0], x[1], x[2]};
    x[0] = sqrt(0.5) * (at[0] - at[1]);
    x[1] = sqrt(0.5) * (at[0] + at[1]);
  }
  body_open(&body, mesh, 50);
  body.definition.surfaces = &surface;
  body.definition.surface_count = 1;
  body.definition.robins = &robin;
  body.definition.robin_count = 1;
  body_build(&body);
  assert_int_equal(vsc_free_motions(body.model, text, sizeof text), 3);
  assert_string_equal(text, "move in 3 ways as one rigid thing");
  body_close(&body);
}

// Two blocks of 2 mm, 5 mm between them. Node arrays: `held` is 1 on all of the first, `all` on a side of each.
static vsc_mesh *two_blocks(void)
{
  vsc_mesh *one = block_of(2, 2, 2, 1, 0), *both;
  const size_t nodes = one->node_count, tets = one->element_count;
  both = vsc_mesh_create(2 * nodes, 2 * tets, 0);
  vsc_arrays_add(&both->node_data, "held", 1, 2 * nodes);
  vsc_arrays_add(&both->node_data, "all", 1, 2 * nodes);
  for (size_t n = 0; n < 2 * nodes; n++) {
    double *x = both->nodes + 3 * n;
    memcpy(x, one->nodes + 3 * (n % nodes), 3 * sizeof *x);
    if (n >= nodes) x[0] += 7;
    both->node_data.items[0].values[n] = n < nodes;
    both->node_data.items[1].values[n] = x[0] == 0 || x[0] == 7;
  }
  for (size_t k = 0; k < 8 * tets; k++)
    both->corners[k] = one->corners[k % (4 * tets)] + (uint32_t)(k < 4 * tets ? 0 : nodes);
  vsc_mesh_free(one);
  if (vsc_mesh_clean(both, "blocks", NULL) != VSC_OK) fail_msg("two blocks");
  return both;
}

// One that nothing holds beside one that is held; each held for itself.
static void a_loose_part_is_found(void **state)
{
  (void)state;
  for (int both = 0; both < 2; both++) {
    small_body body;
    char text[VSC_FREE_TEXT];
    body_open(&body, two_blocks(), 50);
    body_hold(&body, both ? "all" : "held", 1, 1, 1);
    body_build(&body);
    assert_int_equal(vsc_free_motions(body.model, text, sizeof text), both ? 0 : 6);
    static const char words[] = "move along x, y, z and turn about x, y, z in a part of it, 48 elements with node ";
    if (both)
      assert_string_equal(text, "");
    else if (strncmp(text, words, strlen(words)) != 0 || strstr(text, " that is joined to nothing else") == NULL)
      fail_msg("\"%s\"", text);
    size_t parts;
    double x = 0;
    assert_int_equal(vsc_loose_parts(body.model, &parts, text, sizeof text), both ? 0 : 1);
    assert_int_equal(parts, 2);
    if (both)
      assert_string_equal(text, "");
    else if (sscanf(text, "48 elements with node %*u at (%lf, ", &x) != 1 || x < 7)
      fail_msg("\"%s\"", text);
    body_close(&body);
  }
}

// A part that is held in one direction is not loose, and a body that is whole is one part.
static void what_is_held_somehow_is_not_loose(void **state)
{
  (void)state;
  for (int held = 0; held < 2; held++) {
    small_body body;
    char text[VSC_FREE_TEXT];
    size_t parts;
    body_open(&body, block_of(2, 2, 2, 1, 0), 50);
    if (held) body_hold(&body, "x0", 0, 1, 0);
    body_build(&body);
    assert_int_equal(vsc_loose_parts(body.model, &parts, text, sizeof text), !held);
    assert_int_equal(parts, 1);
    body_close(&body);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(supports_leave_what_they_do_not_hold),
      cmocka_unit_test(springs_on_a_surface_hold_too),
      cmocka_unit_test(an_oblique_bar_slides_and_turns),
      cmocka_unit_test(a_loose_part_is_found),
      cmocka_unit_test(what_is_held_somehow_is_not_loose),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
