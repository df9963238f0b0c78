// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/shapes_shells.h"

#include <math.h>

#include "base/mem.h"
#include "base/text.h"

// ---- Bent blocks

typedef void place(const void *shape, double x[3]);  // moves a point of the cube from 0 to 1

// A block with other places and names of its sides.
static vsc_status bend(const size_t cells[3], int tets, vsc_block_kind element, place *move,
                       const void *shape, const char *const names[6], vsc_mesh **result,
                       vsc_error *error)
{
  const vsc_block_shape cube = {
      .cells = {cells[0], cells[1], cells[2]}, .size = {1, 1, 1}, .tets_per_cell = tets};
  vsc_mesh *mesh = NULL;
  const vsc_status status = vsc_block_of(&cube, element, &mesh, error);
  if (status != VSC_OK) return status;
  for (size_t i = 0; i < mesh->node_count; i++) move(shape, &mesh->nodes[3 * i]);
  for (size_t a = 0; a < 6; a++) vsc_copy_name(mesh->node_data.items[a].name, names[a]);
  *result = mesh;
  return VSC_OK;
}

// ---- Cook's membrane

vsc_panel_shape vsc_panel_default(void)
{
  return (vsc_panel_shape){.cells = {8, 8, 1}, .thickness = 1, .tets_per_cell = 5};
}

static void place_panel(const void *shape, double x[3])
{
  const vsc_panel_shape *panel = shape;
  const double across = x[0], up = x[1];
  x[0] = 48 * across;
  x[1] = (1 - across) * 44 * up + across * (44 + 16 * up);
  x[2] *= panel->thickness;
}

vsc_status vsc_panel_mesh(const vsc_panel_shape *panel, vsc_mesh **mesh, vsc_error *error)
{
  static const char *const names[6] = {"left", "right", "bottom", "top", "back", "front"};
  if (!(panel->thickness > 0 && isfinite(panel->thickness)))
    return vsc_fail(error, VSC_INPUT, "panel: a thickness of %g mm, must be above 0",
                    panel->thickness);
  return bend(panel->cells, panel->tets_per_cell, panel->element, place_panel, panel, names, mesh,
              error);
}

// ---- Cylinder

vsc_shell_shape vsc_shell_default(void)
{
  return (vsc_shell_shape){
      .inner = 1, .outer = 2, .length = 1, .layers = 4, .around = 4, .along = 1};
}

static vsc_status check_shell(const vsc_shell_shape *shell, vsc_error *error)
{
  if (!(shell->inner > 0 && shell->outer > shell->inner && isfinite(shell->outer) &&
        shell->length > 0 && isfinite(shell->length)))
    return vsc_fail(error, VSC_INPUT,
                    "shell: radii of %g mm inside and %g mm outside and a length of %g mm must be "
                    "above 0, the outer radius the larger one",
                    shell->inner, shell->outer, shell->length);
  if (shell->layers < 1 || shell->layers > 256 || shell->around < 1 || shell->around > 256 ||
      shell->along < 1 || shell->along > 1000)
    return vsc_fail(error, VSC_INPUT,
                    "shell: %zu layers, %zu bricks around, %zu along: must be at least 1, at most 256, "
                    "256 and 1000",
                    shell->layers, shell->around, shell->along);
  return VSC_OK;
}

static void place_cylinder(const void *shape, double x[3])
{
  const vsc_shell_shape *shell = shape;
  const double r = shell->inner + (shell->outer - shell->inner) * x[0], angle = x[1] * M_PI / 2;
  x[0] = x[1] == 1 ? 0 : r * cos(angle);  // cos(pi/2) is not quite 0
  x[1] = r * sin(angle);
  x[2] *= shell->length;
}

vsc_status vsc_cylinder_mesh(const vsc_shell_shape *shell, vsc_mesh **mesh, vsc_error *error)
{
  static const char *const names[6] = {"inner", "outer", "y0", "x0", "z0", "z1"};
  const vsc_status status = check_shell(shell, error);
  if (status != VSC_OK) return status;
  const size_t cells[3] = {shell->layers, shell->around, shell->along};
  return bend(cells, 5, shell->element, place_cylinder, shell, names, mesh, error);
}

// ---- Sphere: the three faces of a cube of n bricks that do not touch its corner at the origin

typedef struct octant {
  const vsc_shell_shape *shell;
  size_t n;
  uint32_t *number;  // (n + 1)^3: of the nodes (i, j, k) with one of them n
  vsc_wall wall;
} octant;

static size_t cube_place(const octant *o, const size_t at[3])
{
  return at[0] + (o->n + 1) * (at[1] + (o->n + 1) * at[2]);
}

// Places one node in all layers: equal angles on the cube's faces, then onto the spheres.
static void place_ray(const octant *o, vsc_mesh *mesh, const size_t at[3], size_t node)
{
  double ray[3], square = 0;
  for (int a = 0; a < 3; a++) {
    ray[a] = at[a] == o->n ? 1 : tan((double)at[a] / (double)o->n * M_PI / 4);
    square += ray[a] * ray[a];
  }
  for (size_t layer = 0; layer <= o->shell->layers; layer++) {
    const double t = (double)layer / (double)o->shell->layers;
    const double r = (1 - t) * o->shell->inner + t * o->shell->outer;
    const size_t place = layer * o->wall.per_layer + node;
    for (size_t a = 0; a < 3; a++) {
      mesh->nodes[3 * place + a] = r * ray[a] / sqrt(square);
      mesh->node_data.items[2 + a].values[place] = at[a] == 0;
    }
    mesh->node_data.items[0].values[place] = layer == 0;
    mesh->node_data.items[1].values[place] = layer == o->shell->layers;
  }
}

static void place_octant(octant *o, vsc_mesh *mesh)
{
  uint32_t count = 0;
  size_t at[3];
  for (at[2] = 0; at[2] <= o->n; at[2]++)
    for (at[1] = 0; at[1] <= o->n; at[1]++)
      for (at[0] = 0; at[0] <= o->n; at[0]++) {
        if (at[0] < o->n && at[1] < o->n && at[2] < o->n) continue;
        o->number[cube_place(o, at)] = count;
        place_ray(o, mesh, at, count++);
      }
}

// The bricks over the face on which coordinate a is n; b and c follow it, so that bricks are
// right-handed.
static void cut_octant(const octant *o, vsc_mesh *mesh)
{
  static const size_t steps[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  size_t column = 0;
  for (size_t a = 0; a < 3; a++)
    for (size_t i = 0; i < o->n; i++)
      for (size_t j = 0; j < o->n; j++) {
        uint32_t quad[4];
        for (int c = 0; c < 4; c++) {
          size_t at[3];
          at[a] = o->n;
          at[(a + 1) % 3] = i + steps[c][0];
          at[(a + 2) % 3] = j + steps[c][1];
          quad[c] = o->number[cube_place(o, at)];
        }
        vsc_wall_cut(&o->wall, mesh, column++, quad, o->n + i + j);
      }
}

static vsc_status fill_octant(octant *o, vsc_mesh *mesh, vsc_error *error)
{
  static const char *const names[5] = {"inner", "outer", "x0", "y0", "z0"};
  for (int a = 0; a < 5; a++)
    if (vsc_arrays_add(&mesh->node_data, names[a], 1, mesh->node_count) == NULL)
      return vsc_fail_memory(error, "the sphere's arrays");
  if (!vsc_region_add(mesh)) return vsc_fail_memory(error, "the sphere's arrays");
  place_octant(o, mesh);
  cut_octant(o, mesh);
  vsc_shape_finish(mesh);
  return VSC_OK;
}

vsc_status vsc_octant_mesh(const vsc_shell_shape *shell, vsc_mesh **result, vsc_error *error)
{
  vsc_status status = check_shell(shell, error);
  if (status != VSC_OK) return status;
  if (shell->element == VSC_BLOCK_MIXED)
    return vsc_fail(error, VSC_INPUT, "sphere: no mixed elements, use tets, hexes or wedges");
  const size_t n = shell->around;
  octant o = {.shell = shell,
              .n = n,
              .wall = {3 * n * n + 3 * n + 1, 3 * n * n, shell->layers, shell->element}};
  vsc_mesh *mesh = vsc_wall_create(&o.wall, 0);
  if (mesh == NULL || !VSC_NEW(o.number, (n + 1) * (n + 1) * (n + 1)))
    status = vsc_fail_memory(error, "the sphere's mesh");
  if (status == VSC_OK) status = fill_octant(&o, mesh, error);
  vsc_free(o.number);
  if (status == VSC_OK)
    *result = mesh;
  else
    vsc_mesh_free(mesh);
  return status;
}
