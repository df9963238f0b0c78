// SPDX-License-Identifier: GPL-3.0-or-later
// The masses of the nodes.
#include "model/masses.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/jacobian.h"
#include "mesh/topology.h"
#include "model/mixture.h"
#include "model/terms.h"

// ---- the part of a tet that is nearest to a point

// A convex piece of a tet, cut again and again: tets.
enum { MOST_PIECES = 4096 };

typedef struct pieces {
  size_t count;
  double (*tets)[4][3];
} pieces;

static void add_piece(pieces *list, const double *a, const double *b, const double *c,
                      const double *d)
{
  double(*tet)[3] = list->tets[list->count++];
  memcpy(tet[0], a, sizeof tet[0]);
  memcpy(tet[1], b, sizeof tet[1]);
  memcpy(tet[2], c, sizeof tet[2]);
  memcpy(tet[3], d, sizeof tet[3]);
}

// Where the edge from a (height ha) to b (height hb) has height 0.
static void crossing(const double a[3], double ha, const double b[3], double hb, double point[3])
{
  const double part = ha / (ha - hb);
  for (int i = 0; i < 3; i++) point[i] = a[i] + part * (b[i] - a[i]);
}

// Adds the part of `tet` where the heights, linear in it, are not negative.
static void keep_above(const double tet[4][3], const double height[4], pieces *kept)
{
  int above[4], below[4], up = 0, down = 0;
  for (int i = 0; i < 4; i++)
    if (height[i] >= 0)
      above[up++] = i;
    else
      below[down++] = i;
  double cut[4][3];
  int cuts = 0;
  for (int i = 0; i < up; i++)
    for (int j = 0; j < down; j++)
      crossing(tet[above[i]], height[above[i]], tet[below[j]], height[below[j]], cut[cuts++]);
  if (up == 4) add_piece(kept, tet[0], tet[1], tet[2], tet[3]);
  if (up == 1) add_piece(kept, tet[above[0]], cut[0], cut[1], cut[2]);
  // prisms in three tets: (a, c00, c01 | b, c10, c11) and (a, b, c | ca, cb, cc)
  if (up == 2) {
    const double *a = tet[above[0]], *b = tet[above[1]];
    add_piece(kept, a, cut[0], cut[1], b);
    add_piece(kept, cut[0], cut[1], b, cut[2]);
    add_piece(kept, cut[1], b, cut[2], cut[3]);
  }
  if (up == 3) {
    const double *a = tet[above[0]], *b = tet[above[1]], *c = tet[above[2]];
    add_piece(kept, a, b, c, cut[0]);
    add_piece(kept, b, c, cut[0], cut[1]);
    add_piece(kept, c, cut[0], cut[1], cut[2]);
  }
}

static double volume_of(const pieces *list)
{
  double volume = 0;
  for (size_t k = 0; k < list->count; k++)
    volume += fabs(vsc_tet_volume(list->tets[k][0], list->tets[k][1], list->tets[k][2],
                                  list->tets[k][3]));
  return volume;
}

// |x - other|^2 - |x - own|^2, which is linear in x.
static double lead(const double x[3], const double own[3], const double other[3])
{
  double to_own[3], to_other[3];
  vsc_subtract(x, own, to_own);
  vsc_subtract(x, other, to_other);
  return vsc_dot(to_other, to_other) - vsc_dot(to_own, to_own);
}

// The volume of the part of `tet` that is nearer to sites[own] than to the other `count` sites.
static double nearest_part(const double tet[4][3], const double (*sites)[3], int count, int own,
                           pieces memory[2])
{
  int now = 0;
  memory[0].count = 0;
  add_piece(&memory[0], tet[0], tet[1], tet[2], tet[3]);
  for (int s = 0; s < count; s++) {
    if (s == own) continue;
    pieces *from = &memory[now], *to = &memory[1 - now];
    to->count = 0;
    for (size_t k = 0; k < from->count; k++) {
      if (to->count + 3 > MOST_PIECES) return NAN;  // finish_masses refuses it
      double height[4];
      for (int i = 0; i < 4; i++) height[i] = lead(from->tets[k][i], sites[own], sites[s]);
      keep_above((const double(*)[3])from->tets[k], height, to);
    }
    now = 1 - now;
  }
  return volume_of(&memory[now]);
}

// Keeps the sites that are nearest somewhere in `tet` as far as pairs of them tell: one that is
// farther than another at all four corners is so throughout. kept[k] is the site's former number.
static int compete(const double tet[4][3], const double (*sites)[3], int count, int *kept)
{
  int left = 0;
  for (int s = 0; s < count; s++) {
    bool beaten = false;
    for (int o = 0; o < count && !beaten; o++) {
      if (o == s) continue;
      beaten = true;
      for (int i = 0; i < 4; i++) beaten = beaten && lead(tet[i], sites[s], sites[o]) < 0;
    }
    if (!beaten) kept[left++] = s;
  }
  return left;
}

// ---- what an element gives to its corners

static void corners_of(const vsc_mesh *mesh, size_t element, double x[VSC_MOST_CORNERS][3])
{
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  for (int c = 0; c < vsc_mesh_kind(mesh, element)->corners; c++)
    memcpy(x[c], mesh->nodes + 3 * (size_t)corner[c], sizeof x[c]);
}

VSC_CLONED void vsc_lumped_volumes(const vsc_mesh *mesh, const vsc_cell_rule *rule, size_t element,
                                   double volumes[VSC_MOST_CORNERS])
{
  vsc_four x[VSC_MOST_CORNERS];
  const int corners = vsc_mesh_kind(mesh, element)->corners;
  for (int c = 0; c < corners; c++) volumes[c] = 0;
  if (mesh->kinds[element] == VSC_TET10) {
    // the row sums of corners would be negative: int N_c^2 dV, scaled
    const double volume = vsc_mesh_volume_by(mesh, element, rule);
    for (int c = 0; c < corners; c++) volumes[c] = volume * (c < 4 ? 1.0 / 36 : 4.0 / 27);
    return;
  }
  vsc_cell_places(mesh->nodes, vsc_mesh_corners(mesh, element), corners, x);
  for (int q = 0; q < rule->points; q++) {
    double J[3][4], dual[3];
    vsc_cell_jacobian(rule, q, corners, x, J);
    vsc_cross(J[1], J[2], dual);
    const double part = rule->weight[q] * vsc_dot(J[0], dual);
    for (int c = 0; c < corners; c++) volumes[c] += part * rule->N[q][c];
  }
}

double vsc_quadratic_mass(int i, int j)
{
  // corners first
  const int low = i < j ? i : j, high = i < j ? j : i;
  if (high < 4) return (low == high ? 6 : 1) / 420.0;
  const int *edge = vsc_cells[VSC_TET10].edges[high - 4];
  if (low < 4) return (low == edge[0] || low == edge[1] ? -4 : -6) / 420.0;
  if (low == high) return 32 / 420.0;
  const int *other = vsc_cells[VSC_TET10].edges[low - 4];
  const bool meet = edge[0] == other[0] || edge[0] == other[1] || edge[1] == other[0] ||
                    edge[1] == other[1];
  return (meet ? 16 : 8) / 420.0;
}

// The tets into which an element is cut: its centre and the triangles of its faces, four-cornered
// ones cut from their own middle, so that the element's symmetries stay.
static int cut_element(const vsc_cell_kind *kind, double (*x)[3], double tets[24][4][3])
{
  int count = 0;
  double centre[3] = {0};
  if (kind->corners == 4) {
    memcpy(tets[0], x, sizeof tets[0]);
    return 1;
  }
  for (int c = 0; c < kind->corners; c++)
    for (int i = 0; i < 3; i++) centre[i] += x[c][i] / kind->corners;
  for (int f = 0; f < kind->face_count; f++) {
    const int *v = kind->faces[f], sides = v[3] < 0 ? 3 : 4;
    double middle[3] = {0};
    for (int s = 0; s < sides; s++)
      for (int i = 0; i < 3; i++) middle[i] += x[v[s]][i] / sides;
    for (int s = 0; s < sides; s++, count++) {
      memcpy(tets[count][0], x[v[s]], sizeof centre);
      memcpy(tets[count][1], x[v[(s + 1) % sides]], sizeof centre);
      memcpy(tets[count][2], middle, sizeof centre);
      memcpy(tets[count][3], centre, sizeof centre);
    }
  }
  return count;
}

enum { MOST_SITES = VSC_MOST_CORNERS * (1 + VSC_MOST_FACES) };

// Nodes that may be nearest somewhere in an element: its corners and its neighbours'.
static int list_sites(const vsc_mesh *mesh, const vsc_topology *topology, size_t element,
                      uint32_t sites[MOST_SITES])
{
  int count = 0;
  for (int f = -1; f < vsc_mesh_kind(mesh, element)->face_count; f++) {
    const int32_t other = f < 0 ? (int32_t)element : topology->neighbours[element][f];
    if (other < 0) continue;
    const uint32_t *corner = vsc_mesh_corners(mesh, (size_t)other);
    for (int c = 0; c < vsc_mesh_kind(mesh, (size_t)other)->corners; c++) {
      int known = 0;
      while (known < count && sites[known] != corner[c]) known++;
      if (known == count) sites[count++] = corner[c];
    }
  }
  return count;
}

// Adds the masses of one element.
static void share_element(const vsc_mesh *mesh, const vsc_topology *topology, size_t element,
                          double density, pieces memory[2], double *masses)
{
  double x[VSC_MOST_CORNERS][3], tets[24][4][3], sites[MOST_SITES][3], parts[MOST_SITES] = {0};
  uint32_t nodes[MOST_SITES];
  double sum = 0;
  corners_of(mesh, element, x);
  const int count = list_sites(mesh, topology, element, nodes);
  for (int s = 0; s < count; s++) memcpy(sites[s], mesh->nodes + 3 * (size_t)nodes[s], sizeof sites[s]);
  const int cut = cut_element(vsc_mesh_kind(mesh, element), x, tets);
  for (int t = 0; t < cut; t++) {
    int kept[MOST_SITES];
    double rivals[MOST_SITES][3];
    const double(*tet)[3] = (const double(*)[3])tets[t];
    const int left = compete(tet, (const double(*)[3])sites, count, kept);
    for (int s = 0; s < left; s++) memcpy(rivals[s], sites[kept[s]], sizeof rivals[s]);
    for (int s = 0; s < left; s++)
      parts[kept[s]] += nearest_part(tet, (const double(*)[3])rivals, left, s, memory);
  }
  for (int s = 0; s < count; s++) sum += parts[s];
  // bilinear faces and the cut differ by little: the element's own volume is shared out
  const double factor = density * vsc_mesh_element_volume(mesh, element) / sum;
  for (int s = 0; s < count; s++) masses[nodes[s]] += factor * parts[s];
}

vsc_status vsc_voronoi_masses(const vsc_mesh *mesh, const double *density, double *masses,
                              vsc_error *error)
{
  pieces memory[2] = {{0}};
  vsc_topology topology;
  const vsc_status status = vsc_topology_make(mesh, &topology, error);
  if (status != VSC_OK) return status;
  const bool room =
      VSC_NEW(memory[0].tets, MOST_PIECES) && VSC_NEW(memory[1].tets, MOST_PIECES);
  for (size_t n = 0; n < mesh->node_count; n++) masses[n] = 0;
  for (size_t e = 0; room && e < mesh->element_count; e++)
    share_element(mesh, &topology, e, density[e], memory, masses);
  vsc_free(memory[0].tets);
  vsc_free(memory[1].tets);
  vsc_topology_free(&topology);
  return room ? VSC_OK : vsc_fail_memory(error, "Voronoi volumes");
}

// ---- masses

static void lumped_masses(const vsc_mesh *mesh, const vsc_cell_rule rules[VSC_CELLS], const double *density,
                          double *masses)
{
  for (size_t e = 0; e < mesh->element_count; e++) {
    double volumes[VSC_MOST_CORNERS];
    const uint32_t *corner = vsc_mesh_corners(mesh, e);
    vsc_mesh_prefetch(mesh, e);
    vsc_lumped_volumes(mesh, &rules[mesh->kinds[e]], e, volumes);
    for (int c = 0; c < vsc_mesh_kind(mesh, e)->corners; c++)
      masses[corner[c]] += density[e] * volumes[c];
  }
}

// A third of each triangle of a membrane to each corner.
static void add_membranes(const vsc_model *model, double *masses)
{
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (patch->family != VSC_TRIANGLES) continue;
    const double density = model->membranes[patch->material].density;
    const vsc_triangle_pack *packs = vsc_triangles_of(model, patch);
    for (size_t k = 0; k < patch->pack_count; k++)
      for (int i = 0; i < 3; i++)
        for (int l = 0; l < VSC_WIDTH; l++)
          masses[model->mesh_node[vsc_node_of(model, patch, packs[k].node[i][l])]] +=
              density * packs[k].V[l] / 3;
  }
}

static vsc_status finish_masses(const vsc_mesh *mesh, const double *masses, vsc_model *model, vsc_error *error)
{
  for (size_t n = 0; n < model->node_count; n++) {
    model->mass[n] = masses[model->mesh_node[n]];
    model->total_mass += model->mass[n];
  }
  for (size_t n = 0; n < model->node_count; n++) {
    if (model->masses == VSC_MASS_EQUAL)
      model->mass[n] = model->total_mass / (double)model->node_count;
    if (!(model->mass[n] > 0))
      return vsc_fail(error, VSC_INPUT,
                      "masses: node %u would have no mass: nothing is nearest to it, or an element "
                      "beside it is too distorted; use masses: lumped",
                      mesh->node_source[model->mesh_node[n]]);
    for (int i = 0; i < 3; i++) model->inverse_mass[4 * n + i] = 1 / model->mass[n];
  }
  return VSC_OK;
}

vsc_status vsc_terms_masses(const vsc_mesh *mesh, const vsc_definition *definition,
                            const uint32_t *material_of, vsc_model *model, vsc_error *error)
{
  const size_t nodes = model->node_count;
  double *masses = NULL, *density = NULL;
  vsc_status status = VSC_OK;
  if (!VSC_NEW(masses, nodes) || !VSC_NEW(density, mesh->element_count) ||
      !VSC_NEW(model->rest, 4 * nodes) || !VSC_NEW(model->mass, nodes) ||
      !VSC_NEW(model->inverse_mass, 4 * nodes)) {
    vsc_free(masses);
    vsc_free(density);
    return vsc_fail_memory(error, "the nodes");
  }
  for (size_t n = 0; n < nodes; n++)
    memcpy(model->rest + 4 * n, mesh->nodes + 3 * (size_t)model->mesh_node[n], 3 * sizeof(double));
  status = vsc_mixture_densities(mesh, definition, material_of, density, error);
  if (status == VSC_OK && model->masses == VSC_MASS_VORONOI)
    status = vsc_voronoi_masses(mesh, density, masses, error);
  else if (status == VSC_OK)
    lumped_masses(mesh, model->rules, density, masses);
  add_membranes(model, masses);
  if (status == VSC_OK) status = finish_masses(mesh, masses, model, error);
  vsc_free(masses);
  vsc_free(density);
  return status;
}
