// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/surface.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/edges.h"
#include "mesh/face.h"

enum { OFF_PATH = -1 };

// An edge of the caps, against the surface's own.
typedef struct rim_edge {
  uint32_t from, to, middle;
} rim_edge;

// What the tracing of rims works on.
typedef struct tracer {
  size_t edge_count;
  rim_edge *edges;    // by `from`, then `to`
  size_t *next;       // edge_count: at the first edge of each node, its first unused edge
  size_t *path;       // edge_count + 1: first edge of each node on the way
  int64_t *place;     // edge_count: at the first edge of each node, its place on the path
  size_t *start;      // the cavity's rim_start, being filled
  uint32_t *nodes;    // and its rim_nodes
  size_t rims, used;  // how much of them is filled
} tracer;

static int compare_rim_edges(const void *a, const void *b)
{
  const rim_edge *x = a, *y = b;
  if (x->from != y->from) return x->from < y->from ? -1 : 1;
  if (x->to != y->to) return x->to < y->to ? -1 : 1;
  return 0;
}

// Reverses the sides that are left when opposite ones cancel; returns how many there are.
static size_t list_rim_edges(const vsc_surface *surface, const vsc_side *sides, rim_edge *rim)
{
  const size_t count = 3 * surface->count;
  size_t found = 0;
  for (size_t first = 0, end; first < count; first = end) {
    const vsc_side *side = &sides[first];
    const uint32_t middle = surface->mid != NULL ? surface->mid[3 * (size_t)side->triangle + side->corner] : 0;
    int64_t net = 0;
    end = vsc_sides_end(sides, count, first);
    for (size_t k = first; k < end; k++) net += sides[k].rising ? 1 : -1;
    for (; net > 0; net--) rim[found++] = (rim_edge){side->high, side->low, middle};
    for (; net < 0; net++) rim[found++] = (rim_edge){side->low, side->high, middle};
  }
  qsort(rim, found, sizeof *rim, compare_rim_edges);
  return found;
}

// The first edge that leaves `node`; every node of a rim has one.
static size_t first_edge(const tracer *t, uint32_t node)
{
  size_t low = 0, high = t->edge_count;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (t->edges[middle].from < node) low = middle + 1;
    else high = middle;
  }
  return low;
}

static bool has_unused(const tracer *t, size_t first)
{
  const size_t next = t->next[first];
  return next < t->edge_count && t->edges[next].from == t->edges[first].from;
}

// Takes the path from place `from` to its end as a rim; the node at `from` stays on the path.
static void cut_rim(tracer *t, size_t from, size_t length)
{
  for (size_t k = from; k < length; k++) {
    t->nodes[t->used++] = t->edges[t->path[k]].from;
    if (k > from) t->place[t->path[k]] = OFF_PATH;
  }
  t->start[++t->rims] = t->used;
}

// Walks from the node whose first edge is `first` until all that can be reached is cut into rims.
// As many edges enter a node as leave it, so the walk can end only where it began.
static void trace_from(tracer *t, size_t first)
{
  size_t length = 1;
  t->path[0] = first;
  t->place[first] = 0;
  while (has_unused(t, t->path[length - 1])) {
    const size_t taken = t->next[t->path[length - 1]]++;
    const size_t to = first_edge(t, t->edges[taken].to);
    if (t->place[to] == OFF_PATH) {
      t->place[to] = (int64_t)length;
      t->path[length++] = to;
    } else {
      const size_t from = (size_t)t->place[to];
      cut_rim(t, from, length);
      length = from + 1;
    }
  }
  t->place[first] = OFF_PATH;
}

static vsc_status trace_rims(rim_edge *edges, size_t count, vsc_cavity *cavity, vsc_error *error)
{
  tracer t = {.edge_count = count, .edges = edges};
  vsc_status status = VSC_OK;
  if (VSC_NEW(t.next, count) && VSC_NEW(t.path, count + 1) && VSC_NEW(t.place, count) &&
      VSC_NEW(cavity->rim_start, count + 1) && VSC_NEW(cavity->rim_nodes, count)) {
    t.start = cavity->rim_start;
    t.nodes = cavity->rim_nodes;
    for (size_t i = 0; i < count; i++) {
      t.next[i] = i;
      t.place[i] = OFF_PATH;
    }
    for (size_t i = 0; i < count; i++)
      if (i == 0 || edges[i].from != edges[i - 1].from)
        while (has_unused(&t, i)) trace_from(&t, i);
    cavity->rim_count = t.rims;
  } else {
    status = vsc_fail_memory(error, "a cavity's rims");
  }
  vsc_free(t.next);
  vsc_free(t.path);
  vsc_free(t.place);
  return status;
}

// The place after place k of a rim.
static size_t following(const vsc_cavity *cavity, size_t rim, size_t k)
{
  return k + 1 < cavity->rim_start[rim + 1] ? k + 1 : cavity->rim_start[rim];
}

static void find_rim_middles(const rim_edge *edges, size_t count, vsc_cavity *cavity)
{
  for (size_t rim = 0; rim < cavity->rim_count; rim++)
    for (size_t k = cavity->rim_start[rim]; k < cavity->rim_start[rim + 1]; k++) {
      const rim_edge wanted = {cavity->rim_nodes[k],
                               cavity->rim_nodes[following(cavity, rim, k)], 0};
      const rim_edge *found = bsearch(&wanted, edges, count, sizeof wanted, compare_rim_edges);
      cavity->rim_mid[k] = found->middle;
    }
}

static vsc_status find_rims(const vsc_surface *surface, vsc_cavity *cavity, vsc_error *error)
{
  vsc_side *sides;
  rim_edge *rim;
  if (!VSC_NEW(rim, 3 * surface->count)) return vsc_fail_memory(error, "a cavity's edges");
  vsc_status status = vsc_sides_list(surface->triangles, 3, surface->count, &sides, error);
  if (status == VSC_OK) {
    const size_t count = list_rim_edges(surface, sides, rim);
    status = trace_rims(rim, count, cavity, error);
    if (status == VSC_OK && surface->mid != NULL && !VSC_NEW(cavity->rim_mid, count))
      status = vsc_fail_memory(error, "a cavity's rims");
    if (status == VSC_OK && surface->mid != NULL) find_rim_middles(rim, count, cavity);
  }
  vsc_free(sides);
  vsc_free(rim);
  return status;
}

vsc_status vsc_cavity_make(const vsc_surface *surface, size_t node_count, vsc_cavity *cavity,
                           vsc_error *error)
{
  *cavity = (vsc_cavity){0};
  vsc_copy_name(cavity->name, surface->name);
  if (surface->count == 0)
    return vsc_fail(error, VSC_INPUT, "surface %s has no triangles: it encloses no volume",
                    surface->name);
  for (size_t i = 0; i < 3 * surface->count; i++)
    if (surface->triangles[i] >= node_count ||
        (surface->mid != NULL && surface->mid[i] >= node_count))
      return vsc_fail(error, VSC_INPUT,
                      "surface %s: triangle %zu names node %u, the mesh has nodes 0 to %zu: make "
                      "the surface from this mesh",
                      surface->name, i / 3,
                      surface->triangles[i] >= node_count ? surface->triangles[i] : surface->mid[i],
                      node_count - 1);
  vsc_status status = vsc_facets_make(surface, &cavity->facets, error);
  if (status == VSC_OK) status = find_rims(surface, cavity, error);
  if (status != VSC_OK) vsc_cavity_free(cavity);
  return status;
}

static void renumber(uint32_t *nodes, size_t count, const uint32_t *number)
{
  for (size_t k = 0; k < count && nodes != NULL; k++) nodes[k] = number[nodes[k]];
}

void vsc_cavity_renumber(vsc_cavity *cavity, const uint32_t *number)
{
  const size_t rim = cavity->rim_start[cavity->rim_count];
  vsc_facets_renumber(&cavity->facets, number);
  renumber(cavity->rim_nodes, rim, number);
  renumber(cavity->rim_mid, rim, number);
}

void vsc_cavity_free(vsc_cavity *cavity)
{
  vsc_facets_free(&cavity->facets);
  vsc_free(cavity->rim_start);
  vsc_free(cavity->rim_nodes);
  vsc_free(cavity->rim_mid);
  *cavity = (vsc_cavity){0};
}

static void rim_centre(const vsc_cavity *cavity, size_t rim, const double *positions, size_t stride,
                       double centre[3])
{
  const size_t first = cavity->rim_start[rim], last = cavity->rim_start[rim + 1];
  for (int axis = 0; axis < 3; axis++) {
    double sum = 0;
    for (size_t k = first; k < last; k++) sum += positions[stride * cavity->rim_nodes[k] + axis];
    centre[axis] = sum / (double)(last - first);
  }
}

// The volume between `origin` and a face of six nodes: int (x - origin) . (t_1 x t_2) / 3, which is of
// degree 4 and so summed exactly.
static double curved_volume(const vsc_face_rule *rule, const double origin[3],
                            double x[VSC_FACE_NODES][3])
{
  double volume = 0;
  for (int q = 0; q < rule->points; q++) {
    double t1[3], t2[3], normal[3], at[3] = {0};
    vsc_face_tangents(rule, q, (const double(*)[3])x, t1, t2, normal);
    for (int i = 0; i < rule->nodes; i++)
      for (int a = 0; a < 3; a++) at[a] += rule->N[q][i] * (x[i][a] - origin[a]);
    volume += rule->weight[q] * vsc_dot(at, normal) / 3;
  }
  return volume;
}

// The triangle of a cap on the edge from rim place k, curved as that edge is.
static double curved_cap(const vsc_cavity *cavity, const vsc_face_rule *rule, size_t rim, size_t k,
                         const double origin[3], const double centre[3], const double *positions,
                         size_t stride)
{
  double x[VSC_FACE_NODES][3];
  memcpy(x[0], positions + stride * cavity->rim_nodes[k], sizeof x[0]);
  memcpy(x[1], positions + stride * cavity->rim_nodes[following(cavity, rim, k)], sizeof x[1]);
  memcpy(x[2], centre, sizeof x[2]);
  memcpy(x[3], positions + stride * cavity->rim_mid[k], sizeof x[3]);
  for (int a = 0; a < 3; a++) {
    x[4][a] = 0.5 * (x[1][a] + x[2][a]);
    x[5][a] = 0.5 * (x[2][a] + x[0][a]);
  }
  return curved_volume(rule, origin, x);
}

static double cap_volume(const vsc_cavity *cavity, const vsc_face_rule *rule, size_t rim,
                         const double origin[3], const double *positions, size_t stride)
{
  double centre[3], volume = 0;
  rim_centre(cavity, rim, positions, stride, centre);
  for (size_t k = cavity->rim_start[rim]; k < cavity->rim_start[rim + 1]; k++)
    volume -= cavity->rim_mid != NULL
                  ? curved_cap(cavity, rule, rim, k, origin, centre, positions, stride)
                  : vsc_tet_volume(origin, positions + stride * cavity->rim_nodes[k],
                                   positions + stride * cavity->rim_nodes[following(cavity, rim, k)],
                                   centre);
  return volume;
}

double vsc_cavity_volume(const vsc_cavity *cavity, const double *positions, size_t stride)
{
  const vsc_facets *facets = &cavity->facets;
  const double *origin = positions + stride * facets->corners[0];
  const vsc_face_rule rule = vsc_face_rule_of(6, VSC_FACE_FLUX);
  double volume = 0;
  for (size_t k = 0; k < facets->count; k++) {
    const uint32_t *node = facets->corners + 3 * k;
    if (facets->mid != NULL) {
      double x[VSC_FACE_NODES][3];
      vsc_face_places(node, facets->mid + 3 * k, positions, stride, x);
      volume -= curved_volume(&rule, origin, x);
      continue;
    }
    volume -= vsc_facet_weight(facets, k) *
              vsc_tet_volume(origin, positions + stride * node[0], positions + stride * node[1],
                             positions + stride * node[2]);
  }
  for (size_t rim = 0; rim < cavity->rim_count; rim++)
    volume += cap_volume(cavity, &rule, rim, origin, positions, stride);
  return volume;
}

vsc_status vsc_surface_flatten(vsc_surface *surface, vsc_error *error)
{
  static const int parts[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  uint32_t *flat;
  if (surface->mid == NULL) return VSC_OK;
  if (!VSC_NEW(flat, 12 * surface->count)) return vsc_fail_memory(error, "a surface");
  for (size_t t = 0; t < surface->count; t++)
    for (int part = 0; part < 4; part++)
      for (int i = 0; i < 3; i++) {
        const int node = parts[part][i];
        flat[12 * t + 3 * (size_t)part + (size_t)i] =
            node < 3 ? surface->triangles[3 * t + (size_t)node] : surface->mid[3 * t + (size_t)node - 3];
      }
  vsc_free(surface->triangles);
  vsc_free(surface->mid);
  surface->triangles = flat;
  surface->mid = NULL;
  surface->count *= 4;
  return VSC_OK;
}

static double triangle_area(const uint32_t node[3], const double *positions, size_t stride)
{
  double ab[3], ac[3], normal[3];
  vsc_subtract(positions + stride * node[1], positions + stride * node[0], ab);
  vsc_subtract(positions + stride * node[2], positions + stride * node[0], ac);
  vsc_cross(ab, ac, normal);
  return vsc_norm(normal) / 2;
}

static double quadrilateral_area(const uint32_t halves[6], const double *positions, size_t stride)
{
  uint32_t facets[4][3];
  double area = 0;
  vsc_facets_of_halves(halves, facets);
  for (int k = 0; k < 4; k++) area += 0.5 * triangle_area(facets[k], positions, stride);
  return area;
}

static double curved_area(const vsc_face_rule *rule, double x[VSC_FACE_NODES][3])
{
  double area = 0;
  for (int q = 0; q < rule->points; q++) {
    double t1[3], t2[3], normal[3];
    vsc_face_tangents(rule, q, (const double(*)[3])x, t1, t2, normal);
    area += rule->weight[q] * vsc_norm(normal);
  }
  return area;
}

double vsc_surface_area(const vsc_surface *surface, const double *positions, size_t stride)
{
  const vsc_face_rule rule = vsc_face_rule_of(6, VSC_FACE_FLUX);
  double area = 0;
  for (size_t t = 0; t < surface->count; t++) {
    const uint32_t *node = surface->triangles + 3 * t;
    if (surface->mid != NULL) {
      double x[VSC_FACE_NODES][3];
      vsc_face_places(node, surface->mid + 3 * t, positions, stride, x);
      area += curved_area(&rule, x);
      continue;
    }
    if (surface->paired != NULL && surface->paired[t]) {
      area += quadrilateral_area(node, positions, stride);
      t++;
      continue;
    }
    area += triangle_area(node, positions, stride);
  }
  return area;
}
