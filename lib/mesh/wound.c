// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/wound.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "base/vec3.h"

// Sums of angles are not needed. An element, whose angle is below pi, crosses a plane through its edge once or not at all;
// crossings, less those of elements that are inside out, are twice the times that a body lies round an edge inside it. More
// than three take more than 3 pi.
enum { MOST_CROSSINGS = 3 };

// Where the sum has doubled an angle has, and that takes a deformation F whose singular values differ by a factor of 2: in
// a plane tan(angle/2) grows by their ratio at most. Below, (tr C)^3 < (4 + 2.5 + 1)^3/(4 2.5 1) det C, C = F^T F.
#define LEAST_SPREAD 42.1875

enum { MOST_VERTICES = 8, MOST_SPOKES = 4, PIECE = 4096 };

// An edge as its element has it at one end, among vertices of the element: its other end, and the ends of the edges
// beside it, so that other, left, right are right-handed.
typedef struct spoke {
  int other, left, right;
} spoke;

typedef struct spokes {
  int count[MOST_VERTICES];  // 0 where the kind has no such vertex
  spoke items[MOST_VERTICES][MOST_SPOKES];
} spokes;

// An edge seen from the node at which the search is.
typedef struct fan {
  uint32_t other;
  int crossings;
  double along[3], across[3];  // its tangent, the normal of the plane
} fan;

typedef struct search {
  const vsc_mesh *mesh;
  const double *x;
  bool straight;            // all are linear tets: both ends of an edge have the same sum
  uint8_t *corners;         // of each element what its corners are, added up; owned
  uint8_t *near;            // of each node, whether it is a vertex of an element that may have doubled an angle; owned
  size_t *start;            // node_count + 1: of such nodes, i is a vertex of elements[start[i] .. start[i + 1] - 1]; owned
  uint32_t *elements;       // owned
  size_t most;              // edges at a node, at the most
  fan *fans;                // threads x most; owned
  vsc_wound *found;         // of each piece of the nodes; owned
  spokes kinds[VSC_CELLS];
} search;

// ---- what a kind of element is like

// At the first vertex of an edge one of its two faces goes along the edge, the other comes back along it.
static spokes spokes_of(const vsc_cell_kind *kind)
{
  spokes made = {0};
  for (int f = 0; f < kind->face_count; f++) {
    const int *face = kind->faces[f], sides = face[3] < 0 ? 3 : 4;
    for (int i = 0; i < sides; i++) {
      const int at = face[i], other = face[(i + 1) % sides], right = face[(i + sides - 1) % sides];
      for (int g = 0; g < kind->face_count; g++)
        for (int k = 0, count = kind->faces[g][3] < 0 ? 3 : 4; k < count; k++)
          if (kind->faces[g][k] == other && kind->faces[g][(k + 1) % count] == at)
            made.items[at][made.count[at]++] = (spoke){other, kind->faces[g][(k + 2) % count], right};
    }
  }
  return made;
}

// The tangent at vertex `at` of an element of the edge to vertex `other`, of any length, with nodes at `x`.
static void tangent(const search *s, const double *x, size_t element, int at, int other, double along[3])
{
  const uint32_t *corners = vsc_mesh_corners(s->mesh, element);
  const double *here = x + 3 * (size_t)corners[at];
  vsc_subtract(x + 3 * (size_t)corners[other], here, along);
  const int middle = s->straight ? -1 : vsc_cell_middle(vsc_mesh_kind(s->mesh, element), at, other);
  if (middle < 0) return;
  const double *half = x + 3 * (size_t)corners[middle];
  for (int i = 0; i < 3; i++) along[i] = 4 * (half[i] - here[i]) - along[i];
}

// ---- which elements come into question

// Three tangents as columns; their determinant.
static double corner_of(const search *s, const double *x, size_t element, int at, const spoke *spoke, double t[3][3])
{
  double product[3];
  tangent(s, x, element, at, spoke->other, t[0]);
  tangent(s, x, element, at, spoke->left, t[1]);
  tangent(s, x, element, at, spoke->right, t[2]);
  vsc_cross(t[0], t[1], product);
  return vsc_dot(product, t[2]);
}

// What a corner is: an angle there may be twice what it is in the mesh, or it is inside out.
enum { MAY_HAVE_DOUBLED = 1, FOLDED = 2 };

// The same at three edges: S = det(rest)^2 tr C.
static unsigned judge_corner(const search *s, size_t element, int at, const spoke *spoke)
{
  double rest[3][3], now[3][3], cofactor[3][3], S = 0;
  const double whole = corner_of(s, s->mesh->nodes, element, at, spoke, rest);
  const double left = corner_of(s, s->x, element, at, spoke, now);
  if (!(whole > 0)) return MAY_HAVE_DOUBLED;
  if (left <= 0) return FOLDED;
  for (int i = 0; i < 3; i++) vsc_cross(rest[(i + 1) % 3], rest[(i + 2) % 3], cofactor[i]);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) {
      const double part = now[0][i] * cofactor[0][k] + now[1][i] * cofactor[1][k] + now[2][i] * cofactor[2][k];
      S += part * part;
    }
  return S * S * S < LEAST_SPREAD * left * left * whole * whole * whole * whole ? 0 : MAY_HAVE_DOUBLED;
}

static unsigned judge_element(const search *s, size_t element)
{
  const spokes *kind = &s->kinds[s->mesh->kinds[element]];
  const int corners = s->straight ? 1 : MOST_VERTICES;  // those of a linear tet are alike
  unsigned all = 0;
  for (int at = 0; at < corners; at++) {
    const int different = kind->count[at] == 3 ? 1 : kind->count[at];
    for (int i = 0; i < different; i++) all |= judge_corner(s, element, at, &kind->items[at][i]);
  }
  return vsc_mesh_kind(s->mesh, element)->vertices == 4 ? all & MAY_HAVE_DOUBLED : all;
}

static void judge_piece(void *context, size_t piece, int thread)
{
  (void)thread;
  const search *s = context;
  for (size_t e = piece * PIECE; e < (piece + 1) * PIECE && e < s->mesh->element_count; e++)
    s->corners[e] = (uint8_t)judge_element(s, e);
}

static void count_folded(const search *s, vsc_wound *wound)
{
  for (size_t e = 0; e < s->mesh->element_count; e++)
    if (s->corners[e] & FOLDED && wound->folded++ == 0) wound->element = (uint32_t)e;
}

// Marks the vertices of elements that may have doubled an angle; whether there are any.
static bool mark_near(search *s)
{
  bool any = false;
  for (size_t e = 0; e < s->mesh->element_count; e++) {
    if (!(s->corners[e] & MAY_HAVE_DOUBLED)) continue;
    any = true;
    for (int i = 0; i < vsc_mesh_kind(s->mesh, e)->vertices; i++) s->near[vsc_mesh_corners(s->mesh, e)[i]] = 1;
  }
  return any;
}

// Lists the elements of the nodes that are marked.
static bool list_elements(search *s)
{
  const vsc_mesh *mesh = s->mesh;
  size_t count = 0;
  if (!VSC_NEW(s->start, mesh->node_count + 1)) return false;
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int i = 0; i < vsc_mesh_kind(mesh, e)->vertices; i++) {
      const uint32_t node = vsc_mesh_corners(mesh, e)[i];
      s->start[node] += s->near[node];
    }
  for (size_t n = 0; n <= mesh->node_count; n++) {
    const size_t of_node = s->start[n];
    s->most = of_node > s->most ? of_node : s->most;
    s->start[n] = count += of_node;
  }
  s->most *= MOST_SPOKES;
  if (!VSC_NEW(s->elements, count)) return false;
  // from behind: the places of a node's elements end at the sum, and begin there when all are filled
  for (size_t e = mesh->element_count; e-- > 0;)
    for (int i = 0; i < vsc_mesh_kind(mesh, e)->vertices; i++) {
      const uint32_t node = vsc_mesh_corners(mesh, e)[i];
      if (s->near[node]) s->elements[--s->start[node]] = (uint32_t)e;
    }
  return true;
}

// ---- how often elements lie round an edge

// Across the edge and one of the axes of space, the farthest from it.
static void cut_fan(fan *fan)
{
  double axis[3] = {0};
  int least = 0;
  for (int i = 1; i < 3; i++)
    if (fabs(fan->along[i]) < fabs(fan->along[least])) least = i;
  axis[least] = 1;
  vsc_cross(fan->along, axis, fan->across);
}

static void cross_fan(const search *s, size_t element, int at, const spoke *spoke, fan *fan)
{
  double left[3], right[3], product[3];
  tangent(s, s->x, element, at, spoke->left, left);
  tangent(s, s->x, element, at, spoke->right, right);
  const bool from = vsc_dot(fan->across, left) >= 0, to = vsc_dot(fan->across, right) >= 0;
  if (from == to) return;
  vsc_cross(left, right, product);
  fan->crossings += vsc_dot(fan->along, product) > 0 ? 1 : -1;
}

// Fills the fans at a node, with `only` that of the edge to this node alone, and returns how many there are. Of
// straight edges those to higher nodes will do.
static size_t fill_fans(const search *s, uint32_t node, const uint32_t *only, fan *fans)
{
  size_t count = 0;
  for (size_t k = s->start[node]; k < s->start[node + 1]; k++) {
    const size_t element = s->elements[k];
    const uint32_t *corners = vsc_mesh_corners(s->mesh, element);
    const spokes *kind = &s->kinds[s->mesh->kinds[element]];
    int at = 0;
    while (corners[at] != node) at++;
    for (int i = 0; i < kind->count[at]; i++) {
      const spoke *spoke = &kind->items[at][i];
      const uint32_t other = corners[spoke->other];
      if (only != NULL ? other != *only : s->straight && other < node) continue;
      size_t f = 0;
      while (f < count && fans[f].other != other) f++;
      if (f == count) {
        fans[count++] = (fan){.other = other};
        tangent(s, s->x, element, at, spoke->other, fans[f].along);
        cut_fan(&fans[f]);
      }
      cross_fan(s, element, at, spoke, &fans[f]);
    }
  }
  return count;
}

// Each edge once: from its lower end, or from the other where only that end has the sum.
static void search_node(const search *s, uint32_t node, fan *fans, vsc_wound *found)
{
  const size_t count = fill_fans(s, node, NULL, fans);
  for (size_t f = 0; f < count; f++) {
    const uint32_t other = fans[f].other;
    fan there;
    if (fans[f].crossings <= MOST_CROSSINGS) continue;
    if (other < node && fill_fans(s, other, &node, &there) == 1 && there.crossings > MOST_CROSSINGS) continue;
    if (found->count++ > 0) continue;
    found->ends[0] = node < other ? node : other;
    found->ends[1] = node < other ? other : node;
  }
}

static void search_piece(void *context, size_t piece, int thread)
{
  const search *s = context;
  const size_t first = piece * PIECE, behind = first + PIECE;
  for (size_t n = first; n < behind && n < s->mesh->node_count; n++)
    search_node(s, (uint32_t)n, s->fans + (size_t)thread * s->most, &s->found[piece]);
}

// False when memory is short.
static bool search_all(search *s, vsc_wound *wound)
{
  const size_t pieces = (s->mesh->node_count + PIECE - 1) / PIECE;
  if (!VSC_NEW(s->corners, s->mesh->element_count) || !VSC_NEW(s->near, s->mesh->node_count)) return false;
  vsc_parallel_for((s->mesh->element_count + PIECE - 1) / PIECE, judge_piece, s);
  count_folded(s, wound);
  if (!mark_near(s)) return true;
  if (!list_elements(s) || !VSC_NEW(s->fans, (size_t)vsc_parallel_threads() * s->most) || !VSC_NEW(s->found, pieces))
    return false;
  vsc_parallel_for(pieces, search_piece, s);
  for (size_t p = 0; p < pieces; p++) {
    if (wound->count == 0) memcpy(wound->ends, s->found[p].ends, sizeof wound->ends);
    wound->count += s->found[p].count;
  }
  return true;
}

vsc_status vsc_wound_find(const vsc_mesh *mesh, const double *x, vsc_wound *wound, vsc_error *error)
{
  search s = {.mesh = mesh, .x = x, .straight = true};
  *wound = (vsc_wound){0};
  if (mesh->element_count == 0) return VSC_OK;
  for (int kind = 0; kind < VSC_CELLS; kind++) s.kinds[kind] = spokes_of(&vsc_cells[kind]);
  for (size_t e = 0; e < mesh->element_count && s.straight; e++) s.straight = mesh->kinds[e] == VSC_TET;
  const bool done = search_all(&s, wound);
  vsc_free(s.corners);
  vsc_free(s.near);
  vsc_free(s.start);
  vsc_free(s.elements);
  vsc_free(s.fans);
  vsc_free(s.found);
  return done ? VSC_OK : vsc_fail_memory(error, "the search for wound edges");
}
