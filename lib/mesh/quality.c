// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/quality.h"

#include <math.h>
#include <stdlib.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/topology.h"

static const double POOR = 0.2;
static const double PERCENTILE = 0.05;

static const double *corner(const vsc_mesh *mesh, size_t tet, int i)
{
  return mesh->nodes + 3 * (size_t)mesh->corners[4 * tet + i];
}

// Squared lengths of the six edges: sum, least and largest.
static void measure_edges(const vsc_mesh *mesh, size_t tet, double *sum, double *least,
                          double *largest)
{
  *sum = 0;
  *least = INFINITY;
  *largest = 0;
  for (int i = 0; i < 4; i++)
    for (int j = i + 1; j < 4; j++) {
      double edge[3];
      vsc_subtract(corner(mesh, tet, j), corner(mesh, tet, i), edge);
      const double squared = vsc_dot(edge, edge);
      *sum += squared;
      *least = fmin(*least, squared);
      *largest = fmax(*largest, squared);
    }
}

// The angle between faces with outward normals m, n is pi - angle(m, n).
static void measure_dihedrals(const vsc_mesh *mesh, size_t tet, vsc_tet_quality *quality)
{
  double normals[4][3], across[3];
  for (int face = 0; face < 4; face++) {
    const int *at = vsc_tet_faces[face];
    double ab[3], ac[3];
    vsc_subtract(corner(mesh, tet, at[1]), corner(mesh, tet, at[0]), ab);
    vsc_subtract(corner(mesh, tet, at[2]), corner(mesh, tet, at[0]), ac);
    vsc_cross(ab, ac, normals[face]);
    vsc_normalize(normals[face]);
  }
  quality->min_dihedral = 180;
  quality->max_dihedral = 0;
  for (int i = 0; i < 4; i++)
    for (int j = i + 1; j < 4; j++) {
      vsc_cross(normals[i], normals[j], across);
      const double angle = atan2(vsc_norm(across), -vsc_dot(normals[i], normals[j])) * 180 / M_PI;
      quality->min_dihedral = fmin(quality->min_dihedral, angle);
      quality->max_dihedral = fmax(quality->max_dihedral, angle);
    }
}

vsc_tet_quality vsc_mesh_tet_quality(const vsc_mesh *mesh, size_t tet)
{
  vsc_tet_quality quality = {.volume = vsc_mesh_element_volume(mesh, tet)};
  double sum, least, largest;
  measure_edges(mesh, tet, &sum, &least, &largest);
  const double root = cbrt(3 * quality.volume);
  quality.mean_ratio = 12 * root * root / sum;
  quality.edge_ratio = sqrt(largest / least);
  measure_dihedrals(mesh, tet, &quality);
  return quality;
}

// Inserts the tet among the worst if it belongs there; of equals the first stays first.
static void rank_tet(const vsc_mesh *mesh, size_t tet, const vsc_tet_quality *quality,
                     vsc_quality_summary *summary)
{
  size_t place = summary->worst_count;
  while (place > 0 && summary->worst[place - 1].mean_ratio > quality->mean_ratio) place--;
  if (place == VSC_WORST_TETS) return;
  if (summary->worst_count < VSC_WORST_TETS) summary->worst_count++;
  for (size_t k = summary->worst_count - 1; k > place; k--) {
    summary->worst[k] = summary->worst[k - 1];
    summary->worst_tet[k] = summary->worst_tet[k - 1];
  }
  summary->worst[place] = *quality;
  summary->worst_tet[place] = tet;
  for (size_t k = place; k < summary->worst_count; k++) {
    summary->worst_source[k] = mesh->element_source[summary->worst_tet[k]];
    vsc_mesh_element_centre(mesh, summary->worst_tet[k], summary->worst_centre[k]);
  }
}

static void add_tet(const vsc_mesh *mesh, size_t tet, const vsc_tet_quality *quality,
                    vsc_quality_summary *summary)
{
  double sum, least, largest;
  measure_edges(mesh, tet, &sum, &least, &largest);
  summary->shortest_edge = fmin(summary->shortest_edge, sqrt(least));
  summary->longest_edge = fmax(summary->longest_edge, sqrt(largest));
  summary->min_dihedral = fmin(summary->min_dihedral, quality->min_dihedral);
  summary->max_dihedral = fmax(summary->max_dihedral, quality->max_dihedral);
  summary->max_edge_ratio = fmax(summary->max_edge_ratio, quality->edge_ratio);
  summary->min_volume = fmin(summary->min_volume, quality->volume);
  summary->max_volume = fmax(summary->max_volume, quality->volume);
  summary->volume += quality->volume;
  summary->mean_ratio_mean += quality->mean_ratio;
  summary->poor += quality->mean_ratio < POOR;
  rank_tet(mesh, tet, quality, summary);
}

static int compare_doubles(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

vsc_status vsc_mesh_quality(const vsc_mesh *mesh, vsc_quality_summary *summary, vsc_error *error)
{
  *summary = (vsc_quality_summary){.element_count = mesh->element_count};
  if (mesh->element_count == 0) return VSC_OK;
  double *ratios;
  if (!VSC_NEW(ratios, mesh->element_count)) return vsc_fail_memory(error, "the mesh's quality");
  summary->min_dihedral = 180;
  summary->shortest_edge = summary->min_volume = INFINITY;
  for (size_t t = 0; t < mesh->element_count; t++) {
    const vsc_tet_quality quality = vsc_mesh_tet_quality(mesh, t);
    add_tet(mesh, t, &quality, summary);
    ratios[t] = quality.mean_ratio;
  }
  summary->mean_ratio_mean /= (double)mesh->element_count;
  qsort(ratios, mesh->element_count, sizeof *ratios, compare_doubles);
  summary->mean_ratio_p5 = ratios[(size_t)(PERCENTILE * (double)(mesh->element_count - 1))];
  vsc_free(ratios);
  return VSC_OK;
}
