// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/quality.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/mem.h"
#include "base/sort.h"
#include "base/vec3.h"

static const double POOR = 0.2;
static const double PERCENTILE = 0.05;

static const double *corner(const vsc_mesh *mesh, size_t element, int i)
{
  return mesh->nodes + 3 * (size_t)vsc_mesh_corners(mesh, element)[i];
}

// Squared lengths of the edges: sum, least and largest.
static void measure_edges(const vsc_mesh *mesh, size_t element, double *sum, double *least,
                          double *largest)
{
  const vsc_cell_kind *kind = vsc_mesh_kind(mesh, element);
  *sum = 0;
  *least = INFINITY;
  *largest = 0;
  for (int k = 0; k < kind->edge_count; k++) {
    double edge[3];
    vsc_subtract(corner(mesh, element, kind->edges[k][1]), corner(mesh, element, kind->edges[k][0]),
                 edge);
    const double squared = vsc_dot(edge, edge);
    *sum += squared;
    *least = fmin(*least, squared);
    *largest = fmax(*largest, squared);
  }
}

// The outward unit normal of a face; of a quadrilateral the mean one, its diagonals' product.
static void face_normal(const vsc_mesh *mesh, size_t element, const int at[4], double normal[3])
{
  double first[3], second[3];
  const bool triangle = at[3] < 0;
  vsc_subtract(corner(mesh, element, at[triangle ? 1 : 2]), corner(mesh, element, at[0]), first);
  vsc_subtract(corner(mesh, element, at[triangle ? 2 : 3]),
               corner(mesh, element, at[triangle ? 0 : 1]), second);
  vsc_cross(first, second, normal);
  vsc_normalize(normal);
}

static bool has_edge(const int at[4], const int edge[2])
{
  int found = 0;
  for (int i = 0; i < 4; i++) found += at[i] == edge[0] || at[i] == edge[1];
  return found == 2;
}

// The angle between faces with outward normals m, n is pi - angle(m, n).
static void measure_dihedrals(const vsc_mesh *mesh, size_t element, vsc_element_quality *quality)
{
  const vsc_cell_kind *kind = vsc_mesh_kind(mesh, element);
  double normals[VSC_MOST_FACES][3], across[3];
  for (int f = 0; f < kind->face_count; f++)
    face_normal(mesh, element, kind->faces[f], normals[f]);
  quality->min_dihedral = 180;
  quality->max_dihedral = 0;
  for (int k = 0; k < kind->edge_count; k++) {
    const double *pair[2];
    int found = 0;
    for (int f = 0; f < kind->face_count; f++)
      if (has_edge(kind->faces[f], kind->edges[k])) pair[found++] = normals[f];
    vsc_cross(pair[0], pair[1], across);
    const double angle = atan2(vsc_norm(across), -vsc_dot(pair[0], pair[1])) * 180 / M_PI;
    quality->min_dihedral = fmin(quality->min_dihedral, angle);
    quality->max_dihedral = fmax(quality->max_dihedral, angle);
  }
}

// det of the unit vectors from one corner to three others
static double corner_determinant(const vsc_mesh *mesh, size_t element, const int at[4])
{
  double to[3][3], normal[3];
  for (int k = 0; k < 3; k++) {
    vsc_subtract(corner(mesh, element, at[k + 1]), corner(mesh, element, at[0]), to[k]);
    vsc_normalize(to[k]);
  }
  vsc_cross(to[0], to[1], normal);
  return vsc_dot(normal, to[2]);
}

static double scaled_jacobian(const vsc_mesh *mesh, size_t element)
{
  // a corner and the other ends of its edges, right-handed; the apex of a pyramid has four triples
  static const int corners[VSC_CELLS][8][4] = {
      [VSC_HEX] = {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7},
                   {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}},
      [VSC_WEDGE] = {{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5},
                     {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}},
      [VSC_PYRAMID] = {{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4},
                       {4, 2, 1, 0}, {4, 3, 2, 1}, {4, 0, 3, 2}, {4, 1, 0, 3}}};
  static const struct {
    int corners;
    double ideal;  // with equal edges: 1, sin 60, sin 45
  } facts[VSC_CELLS] = {
      [VSC_HEX] = {8, 1}, [VSC_WEDGE] = {6, 0.8660254037844386}, [VSC_PYRAMID] = {8, M_SQRT1_2}};
  const uint8_t kind = mesh->kinds[element];
  double least = INFINITY;
  for (int i = 0; i < facts[kind].corners; i++)
    least = fmin(least, corner_determinant(mesh, element, corners[kind][i]));
  return least / facts[kind].ideal;
}

vsc_element_quality vsc_mesh_element_quality(const vsc_mesh *mesh, size_t element)
{
  vsc_element_quality quality = {.volume = vsc_mesh_element_volume(mesh, element)};
  double sum, least, largest;
  measure_edges(mesh, element, &sum, &least, &largest);
  const double root = cbrt(3 * vsc_tet_volume(corner(mesh, element, 0), corner(mesh, element, 1),
                                              corner(mesh, element, 2), corner(mesh, element, 3)));
  const bool tet = vsc_mesh_kind(mesh, element)->vertices == 4;
  quality.shape = tet ? 12 * root * root / sum : scaled_jacobian(mesh, element);
  quality.edge_ratio = sqrt(largest / least);
  measure_dihedrals(mesh, element, &quality);
  return quality;
}

// Inserts the element among the worst if it belongs there; of equals the first stays first.
static void rank_element(const vsc_mesh *mesh, size_t element, const vsc_element_quality *quality,
                     vsc_quality_summary *summary)
{
  size_t place = summary->worst_count;
  while (place > 0 && summary->worst[place - 1].shape > quality->shape) place--;
  if (place == VSC_WORST_ELEMENTS) return;
  if (summary->worst_count < VSC_WORST_ELEMENTS) summary->worst_count++;
  for (size_t k = summary->worst_count - 1; k > place; k--) {
    summary->worst[k] = summary->worst[k - 1];
    summary->worst_element[k] = summary->worst_element[k - 1];
  }
  summary->worst[place] = *quality;
  summary->worst_element[place] = element;
  for (size_t k = place; k < summary->worst_count; k++) {
    summary->worst_source[k] = mesh->element_source[summary->worst_element[k]];
    vsc_mesh_element_centre(mesh, summary->worst_element[k], summary->worst_centre[k]);
  }
}

static void add_element(const vsc_mesh *mesh, size_t element, const vsc_element_quality *quality,
                    vsc_quality_summary *summary)
{
  double sum, least, largest;
  measure_edges(mesh, element, &sum, &least, &largest);
  summary->shortest_edge = fmin(summary->shortest_edge, sqrt(least));
  summary->longest_edge = fmax(summary->longest_edge, sqrt(largest));
  summary->min_dihedral = fmin(summary->min_dihedral, quality->min_dihedral);
  summary->max_dihedral = fmax(summary->max_dihedral, quality->max_dihedral);
  summary->max_edge_ratio = fmax(summary->max_edge_ratio, quality->edge_ratio);
  summary->min_volume = fmin(summary->min_volume, quality->volume);
  summary->max_volume = fmax(summary->max_volume, quality->volume);
  summary->volume += quality->volume;
  summary->shape_mean += quality->shape;
  summary->poor += quality->shape < POOR;
  rank_element(mesh, element, quality, summary);
}

vsc_status vsc_mesh_quality(const vsc_mesh *mesh, vsc_quality_summary *summary, vsc_error *error)
{
  *summary = (vsc_quality_summary){.element_count = mesh->element_count};
  if (mesh->element_count == 0) return VSC_OK;
  double *shapes;
  if (!VSC_NEW(shapes, mesh->element_count)) return vsc_fail_memory(error, "the mesh's quality");
  summary->min_dihedral = 180;
  summary->shortest_edge = summary->min_volume = INFINITY;
  for (size_t e = 0; e < mesh->element_count; e++) {
    const vsc_element_quality quality = vsc_mesh_element_quality(mesh, e);
    add_element(mesh, e, &quality, summary);
    shapes[e] = quality.shape;
  }
  summary->shape_mean /= (double)mesh->element_count;
  qsort(shapes, mesh->element_count, sizeof *shapes, vsc_compare_doubles);
  summary->shape_p5 = shapes[(size_t)(PERCENTILE * (double)(mesh->element_count - 1))];
  vsc_free(shapes);
  return VSC_OK;
}
