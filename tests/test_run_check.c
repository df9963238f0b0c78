// SPDX-License-Identifier: GPL-3.0-or-later
// What `viscera check` says about a scene, and which warnings it has for which scenes.
#include "write_tets.h"
#include "block_scene.h"
#include "trap.h"

static int warnings(void)
{
  int count = 0;
  for (const char *at = said; (at = strstr(at, "\nwarning ")) != NULL; at++) count++;
  return count;
}

// Checks the block scene with `options`; there must be one warning, with `part` in it.
static void assert_warns(const char *options, const char *part)
{
  char command[512];
  snprintf(command, sizeof command, "$V check block.yaml -t 1 %s", options);
  must(command);
  assert_string_equal(complained, "");
  if (warnings() != 1) fail_msg("%s: %d warnings in '%s'", options, warnings(), said);
  assert_holds(line_of("warning"), part);
  assert_null(strstr(said, "\nwarnings   none"));
}

// The scene that ships: every line, with the counts of data/README.md, and nothing to warn of.
static void test_the_shipped_beat(void **state)
{
  (void)state;
  must("$V check " VSC_SOURCE_DIR "/data/beat.yaml -t 1");
  assert_string_equal(complained, "");
  assert_true(line_count(said) >= 13 && line_count(said) <= 25);
  assert_holds(line_of("scene"), "/data/beat.yaml");
  assert_holds(line_of("mesh"), "lv.vtu: 2116 nodes, 7680 tetrahedra");
  assert_holds(line_of("mesh"), "1 unit = 1 mm");
  assert_holds(line_of("size"), "70.96 x 70.96 x 93 mm");
  assert_holds(line_of("size"), "tissue 134 ml, 142");
  assert_holds(line_of("quality"), "0 poor");
  assert_holds(line_of("worst"), "element ");
  assert_holds(line_of("surface"), "endo: 1024 triangles");
  assert_holds(line_of("surface"), "open, capped, a cavity of 133");
  assert_holds(said, "closed, surrounds 134 ml");
  assert_holds(line_of("supports"), "base (128 nodes) held in z");
  assert_holds(line_of("fibres"),
               "7680 of 7680 elements (100.0 %), 0 filled from neighbours, 0 passive");
  assert_holds(line_of("angles"), "azimuth");
  assert_holds(line_of("material"), "myocardium: 7680 elements");
  assert_holds(line_of("active"), "tension up to");
  assert_holds(line_of("active"), "period 800 ms");
  assert_holds(line_of("terms"),
               "axial damping; volume of node groups and of each element; active tension");
  assert_holds(line_of("terms"), "pressure on endo up to");
  assert_holds(line_of("step"), "(automatic)");
  assert_holds(line_of("step"), "limited most at node ");
  assert_holds(line_of("cost"), "1600 ms = about");
  assert_holds(line_of("cost"), "on 1 thread (");
  assert_holds(line_of("cost"), "MB of memory; 81 frames");
  assert_string_equal(line_of("warnings"), "warnings   none");
  assert_int_equal(warnings(), 0);
}

// Wedges lock in the plane of their triangles when they keep their volume; with a modulus 20 times the shear they do not.
static void test_wedges_that_lock(void **state)
{
  (void)state;
  must("$V generate block --cells 2,2,2 --element wedge -o wedges.vtu");
  save_text("wedges.yaml", "mesh: {file: wedges.vtu, unit: mm}\n"
                           "node_sets: [{name: foot, node_array: z0, value: 1}]\n"
                           "materials: [{name: rubber, law: neo_hookean, neo_hookean: {shear: 5 kPa}, volume_modulus: 500 kPa}]\n"
                           "supports: [{set: foot, held: [x, y, z]}]\n"
                           "gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]\ntime: {end: 1 s}\n");
  must("$V check wedges.yaml -t 1");
  assert_non_null(strstr(said, "times the shear modulus, and wedges"));
  assert_holds(line_of("terms"), "terms      neo_hookean; volume of each element; gravity");
  must("$V check wedges.yaml -t 1 --set 'materials[0].viscosity=1 Pa s'");
  assert_holds(line_of("terms"), "terms      neo_hookean, viscosity; volume");
  must("$V check wedges.yaml -t 1 --set 'materials[0].volume_modulus=90 kPa'");
  assert_null(strstr(said, "and wedges"));
}

// The end of the block is 10 x 10 mm.
static void test_beds_and_moved_supports(void **state)
{
  (void)state;
  must("$V check block.yaml -t 1 --set 'robin=[{surface: end, stiffness: 2 kPa/mm, damping: 5e3 Pa s/m, "
       "direction: normal}]' --set 'supports[0].motion=[1 mm, 0 mm, 0.5 mm]'");
  assert_holds(line_of("robin"), "end: 32 triangles, 1 cm2, along the normal; stiffness 2 kPa/mm, in "
                                 "all 200 mN/mm; damping 5 kPa ms/mm, in all 500 mN ms/mm");
  assert_holds(line_of("supports"), "left (25 nodes) held in x y z, moved by (1, 0, 0.5) mm; 25 of");
  assert_int_equal(warnings(), 0);
  must("$V check block.yaml -t 1 --set 'materials[0].damping={f: 0 Pa s, s: 0 Pa s, n: 0 Pa s}' --set "
       "'robin=[{surface: end, damping: 1 Pa s/m}]'");
  assert_null(strstr(said, "axial damping"));
  assert_holds(line_of("robin"), "in all directions");
}

// The numbers of the step and of the cost are those of the run.
static void test_step_and_cost_are_those_of_the_run(void **state)
{
  (void)state;
  double step, steps, frames, disk;
  must("$V check block.yaml -t 1");
  assert_int_equal(warnings(), 0);
  assert_int_equal(sscanf(line_of("step"), "step %lf ms", &step), 1);
  assert_int_equal(sscanf(line_of("cost"), "cost 20 ms = about %lf steps", &steps), 1);
  assert_close(steps, 20 / step, 1e-3, 0.5);
  assert_int_equal(
      sscanf(strstr(line_of("cost"), "memory; ") + 8, "%lf frames, about %lf", &frames, &disk), 2);
  assert_close(frames, 11, 0, 0);
  must("$V run block.yaml -t 1 -o r && cat r/frames/* | wc -c");
  double bytes = 0, done = 0;
  const char *last = strchr(said, '\n');
  assert_int_equal(sscanf(last, "%lf", &bytes), 1);
  assert_int_equal(sscanf(strstr(said, " ms in "), " ms in %lf steps", &done), 1);
  assert_close(done, steps, 0.5, 0);  // contraction makes steps shorter
  assert_close(1e-6 * bytes, disk, 0.5, 0);
}

static void test_given_step(void **state)
{
  (void)state;
  must("$V check block.yaml --set 'time.step=0.01 ms'");
  assert_holds(line_of("step"), "step       0.01 ms (given)");
  assert_holds(line_of("cost"), "about 2000 steps");
  assert_int_equal(shell("$V check block.yaml --set 'time.step=1 ms'"), 2);
  assert_int_equal(line_count(complained), 1);
  assert_holds(complained, "1 ms is above the stable step of 0.0");
}

static void test_warnings_about_materials(void **state)
{
  (void)state;
  assert_warns("--set volume=element --set 'materials[0].stabilization=0 kPa'", "linear tets lock");
  assert_warns("--set 'materials[0].stabilization=0 kPa'",
               "stabilization to about the shear modulus (10 kPa)");
  assert_warns("--set 'materials[0].volume_modulus=15 kPa'", "below the stiffest axial modulus");
  assert_warns("--set 'materials[0].damping={f: 0 Pa s, s: 0 Pa s, n: 0 Pa s}'",
               "vibrations never die away");
  must("$V check block.yaml --set 'materials[0].damping={f: 0 Pa s, s: 0 Pa s, n: 0 Pa s}' "
       "--set 'materials[0].prony=[{modulus: 0.5, time: 5 ms}]'");
  assert_int_equal(warnings(), 0);
  assert_warns(
      "--set 'materials[1].name=ghost' --set 'materials[1].regions=[9]' "
      "--set 'materials[1].axial={f: 1 kPa, s: 1 kPa, n: 1 kPa}' --set 'materials[1].angular={fs: "
      "1 kPa, "
      "sn: 1 kPa, nf: 1 kPa}' --set 'materials[1].volume_modulus=50 kPa' "
      "--set 'materials[1].stabilization=1 kPa'",
      "ghost: no element has its regions");
  // element-wise volume with a low modulus does not lock
  must("$V check block.yaml --set volume=element --set 'materials[0].volume_modulus=150 kPa' "
       "--set 'materials[0].stabilization=0 kPa'");
  assert_int_equal(warnings(), 0);
  assert_warns("--set volume=element --set 'materials[0].volume_modulus=150 kPa'",
               "stabilization does nothing with volume: element");
  must("$V generate block --cells 6,4,4 --size 20,10,10 --element hex -o bricks.vtu");
  must("$V check block.yaml --set mesh.file=bricks.vtu --set 'fibers={source: constant, constant: {fiber: [1, 0, 0]}}' --set volume=element");
  assert_true(strstr(said, "stabilization does nothing") == NULL);
  assert_holds(said, "own K of a frame 10 kPa");
}

static void test_warnings_about_the_setting(void **state)
{
  (void)state;
  // the block's 20 mm are read as metres, or as micrometres
  assert_warns("--set mesh.unit=m", "is mesh.unit right?");
  assert_warns("--set mesh.unit=um", "is mesh.unit right?");
  assert_warns("--set 'supports=[]'", "nothing is held");
  assert_warns(
      "--set 'supports=[]' --set 'pressures=[]' --set 'gravity=[0 m/s2, 0 m/s2, -9.81 m/s2]'",
      "nothing is held");
  assert_warns("--set 'pressures=[]' --set 'materials[0].active.kind=none'", "nothing will move");
  assert_warns("--set solve=equilibrium --set 'supports[0].held=[x]' --set 'obstacles=[{kind: plane, point: [0 mm, 0 mm, "
               "0 mm], normal: [0, 0, 1]}]'", "never balance, unless it touches obstacles from the start: hold it by");
  assert_warns("--set solver.rho=0.2 --set solver.accuracy=1e-5",
               "solve: explicit: solver.rho, solver.accuracy have no effect");
  assert_warns("--set solve=equilibrium --set 'time.step=0.01 ms'", "solve: equilibrium: time.step has no effect");
  must("$V check block.yaml --set 'supports=[]' --set 'pressures=[]'");  // a free muscle carries
                                                                         // nothing away
  assert_int_equal(warnings(), 0);
}

#define CYCLE "--set time.end='1 s' --set time.cycle='80 ms' "
#define PERIODIC "curve: {kind: half_sine, duration: 20 ms, period: 100 ms}}]'"

// What begins anew each 100 ms does not repeat itself after 80 ms; a period of 40 or 80 ms does.
static void test_cycles_and_periods(void **state)
{
  (void)state;
  assert_warns(CYCLE "--set 'materials[0].active.curve.period=100 ms'",
               "time.cycle: 80 ms is no multiple of the period of material muscle, 100 ms");
  assert_warns(CYCLE "--set 'pressures=[{surface: end, peak: 1 kPa, " PERIODIC, "the period of pressures[0], 100 ms");
  assert_warns(CYCLE "--set 'supports=[{set: left, held: [x, y, z], motion: [1 mm, 0 mm, 0 mm], " PERIODIC,
               "the period of the support of left, 100 ms");
  assert_warns(CYCLE "--set 'obstacles=[{kind: sphere, point: [50 mm, 0 mm, 0 mm], radius: 5 mm, motion: [1 mm, 0 mm, 0 "
               "mm], " PERIODIC, "the period of obstacles[0], 100 ms");
  assert_warns(CYCLE "--set 'materials[0].active.curve.period=160 ms'", "the period of material muscle, 160 ms");
  const char *const fine[2] = {"40 ms", "80 ms"};
  for (int k = 0; k < 2; k++) {
    char command[512];
    snprintf(command, sizeof command, "$V check block.yaml " CYCLE "--set 'materials[0].active.curve.period=%s'", fine[k]);
    must(command);
    assert_int_equal(warnings(), 0);
  }
}

// The block with cell arrays: one direction everywhere; one for each element; the same with holes;
// sheets at 45 degrees to the second; zeros.
static void write_fibres(void)
{
  enum { SAME, TURNING, HOLES, SLANTED, NOTHING, KINDS };
  vsc_mesh *mesh = block_for_scene();
  double *v[KINDS];
  for (int k = 0; k < KINDS; k++) v[k] = calloc(3 * mesh->element_count, sizeof *v[k]);
  for (size_t t = 0; t < mesh->element_count; t++) {
    const double angle[KINDS] = {0, (double)t, (double)t, (double)t + M_PI / 4};
    for (int k = 0; k < NOTHING; k++) {
      if (k == HOLES && t % 20 == 0) continue;
      v[k][3 * t] = k == HOLES && t % 20 == 10 ? NAN : cos(angle[k]);
      v[k][3 * t + 1] = sin(angle[k]);
    }
  }
  const vsc_vtk_array arrays[] = {
      {"x0", 1, vsc_arrays_find(&mesh->node_data, "x0")->values, VSC_ON_NODES, false},
      {"x1", 1, vsc_arrays_find(&mesh->node_data, "x1")->values, VSC_ON_NODES, false},
      {"region", 1, vsc_arrays_find(&mesh->element_data, "region")->values, VSC_ON_ELEMENTS, true},
      {"same", 3, v[SAME], VSC_ON_ELEMENTS, false},
      {"turning", 3, v[TURNING], VSC_ON_ELEMENTS, false},
      {"holes", 3, v[HOLES], VSC_ON_ELEMENTS, false},
      {"slanted", 3, v[SLANTED], VSC_ON_ELEMENTS, false},
      {"nothing", 3, v[NOTHING], VSC_ON_ELEMENTS, false}};
  trap_off();  // VTK compares NaN for their range
  assert_int_equal(write_tets(in_folder("fibres.vtu"), mesh->node_count, mesh->nodes,
                                      mesh->element_count, mesh->corners, 0, NULL, 8, arrays, true, NULL),
                   VSC_OK);
  trap_on();
  for (int k = 0; k < KINDS; k++) free(v[k]);
  vsc_mesh_free(mesh);
}

static void test_warnings_about_fibres(void **state)
{
  (void)state;
  write_fibres();
  assert_warns("--set mesh.file=fibres.vtu --set fibers.arrays.fiber=same", "perhaps a dummy");
  assert_warns("--set mesh.file=fibres.vtu --set fibers.arrays.fiber=holes",
               "48 of 480 elements have no fibre and stay passive; `fill: true`");
  assert_holds(line_of("fibres"),
               "432 of 480 elements (90.0 %), 0 filled from neighbours, 48 passive");
  assert_warns("--set mesh.file=fibres.vtu --set 'fibers.arrays={fiber: turning, sheet: slanted}'",
               "up to 45 degrees off a right angle");
  must(
      "$V check block.yaml --set mesh.file=fibres.vtu --set fibers.arrays.fiber=holes --set "
      "fibers.fill=true");
  assert_int_equal(warnings(), 0);
  assert_holds(line_of("fibres"),
               "432 of 480 elements (90.0 %), 48 filled from neighbours, 0 passive");
  // passive elements are nothing to warn of where nothing is active; constant by the scene's wish
  // neither
  must(
      "$V check block.yaml --set mesh.file=fibres.vtu --set fibers.arrays.fiber=holes "
      "--set 'materials[0].active.kind=none'");
  assert_int_equal(warnings(), 0);
  must("$V check block.yaml --set 'fibers={source: constant, constant: {fiber: [1, 0, 0]}}'");
  assert_int_equal(warnings(), 0);
}

#define STIFF_FIBRES " --set 'materials[0].axial={f: 90 kPa, s: 20 kPa, n: 20 kPa}' "
#define PASSIVE " --set 'materials[0].active.kind=none' "

// Passive tissue that depends on direction needs fibres, too.
static void test_directions_that_nobody_gave(void **state)
{
  (void)state;
  write_fibres();
  assert_warns("--set mesh.file=fibres.vtu --set fibers.arrays.fiber=holes" STIFF_FIBRES PASSIVE,
               "48 of 480 elements have no fibre; `fill: true` takes them from their neighbours; in 48 of them the "
               "material depends on direction, and its f, s, n are global x, y, z");
  assert_holds(line_of("fibres"), "48 passive; of 48 the fibre vector is zero or not finite");
  assert_warns("--set mesh.file=fibres.vtu --set fibers.arrays.fiber=holes" STIFF_FIBRES,
               "48 of 480 elements have no fibre and stay passive; `fill: true` takes them from their neighbours; in 48 ");
  assert_warns("--set 'fibers={source: none}'" STIFF_FIBRES PASSIVE,
               "480 of 480 elements have no fibre; where that is meant, fibers.source: constant says so; in 480 of them");
  must("$V check block.yaml --set mesh.file=fibres.vtu --set fibers.arrays.fiber=holes --set fibers.fill=true" STIFF_FIBRES
       PASSIVE);
  assert_int_equal(warnings(), 0);
  must("$V check block.yaml --set mesh.file=fibres.vtu --set fibers.arrays.fiber=nothing" PASSIVE);
  assert_int_equal(warnings(), 0);  // isotropic
  assert_holds(line_of("fibres"), "480 passive; of 480 the fibre vector is zero or not finite");
  assert_int_equal(
      shell("$V check block.yaml --set mesh.file=fibres.vtu --set fibers.arrays.fiber=nothing" STIFF_FIBRES PASSIVE), 2);
  assert_int_equal(line_count(complained), 1);
  assert_holds(complained, "none of the vectors of 'nothing' is a direction (of 480 elements they are zero or not finite)");
}

static void test_sheets_that_are_none(void **state)
{
  (void)state;
  write_fibres();
  assert_warns("--set mesh.file=fibres.vtu --set 'fibers.arrays={fiber: turning, sheet: nothing}'",
               "the sheet vectors of 480 of 480 elements are zero, not finite or along the fibre");
  // 48 are zero or not finite, and 45 degrees off where they are not
  must("$V check block.yaml --set mesh.file=fibres.vtu --set 'fibers.arrays={fiber: slanted, sheet: holes}'");
  assert_holds(said, "the sheet vectors of 48 of 480 elements are zero");
}

// The block, and a copy of it at its end face that is not joined to it; or the block with its first tet twice.
static void write_torn(const char *file, bool copied)
{
  vsc_mesh *mesh = block_for_scene();
  const size_t nodes = mesh->node_count, tets = mesh->element_count, more = copied ? tets : 1;
  const size_t all = copied ? 2 * nodes : nodes;
  double *x = calloc(3 * all, sizeof *x), *face[2], *region = calloc(tets + more, sizeof *region);
  double *fiber = calloc(3 * (tets + more), sizeof *fiber);
  uint32_t *corner = calloc(4 * (tets + more), sizeof *corner);
  for (int a = 0; a < 2; a++) {
    face[a] = calloc(all, sizeof(double));
    for (size_t n = 0; n < nodes; n++)
      face[a][n] = vsc_arrays_find(&mesh->node_data, a ? "x1" : "x0")->values[n];
  }
  for (size_t n = 0; n < all; n++)
    for (size_t a = 0; a < 3; a++) x[3 * n + a] = mesh->nodes[3 * (n % nodes) + a];
  for (size_t n = nodes; n < all; n++) x[3 * n] = 40 - x[3 * n];  // mirrored, so that the faces fit
  for (size_t e = 0; e < tets + more; e++) {
    for (int c = 0; c < 4; c++)
      corner[4 * e + (size_t)c] = mesh->corners[4 * (e % tets) + (size_t)c] + (uint32_t)(copied && e >= tets ? nodes : 0);
    region[e] = 1;
    fiber[3 * e] = 1;
    fiber[3 * e + 1] = 0.1 * (double)(e % 7);
  }
  const vsc_vtk_array arrays[] = {{"x0", 1, face[0], VSC_ON_NODES, false},
                                  {"x1", 1, face[1], VSC_ON_NODES, false},
                                  {"region", 1, region, VSC_ON_ELEMENTS, true},
                                  {"direction", 3, fiber, VSC_ON_ELEMENTS, false}};
  assert_int_equal(write_tets(in_folder(file), all, x, tets + more, corner, 0, NULL, 4, arrays, true, NULL), VSC_OK);
  free(x);
  free(face[0]);
  free(face[1]);
  free(region);
  free(fiber);
  free(corner);
  vsc_mesh_free(mesh);
}

// A part that nothing holds is told of whatever the method; in a run too.
static void test_bodies_in_parts(void **state)
{
  (void)state;
  static const char words[] = "the body is in 2 parts that are not joined, and nothing holds 1 of them, as 480 elements with";
  write_torn("torn.vtu", true);
  assert_warns("--set mesh.file=torn.vtu", words);
  assert_string_equal(line_of("parts"), "parts      2 separate; 50 nodes lie where another one does, not joined to it");
  assert_warns("--set mesh.file=torn.vtu --set solve=implicit", words);
  assert_warns("--set mesh.file=torn.vtu --set solve=equilibrium", "in a part of it, 480 elements with node");
  must("$V run block.yaml -o torn --set mesh.file=torn.vtu --set 'time.end=0.1 ms'");
  assert_int_equal(line_count(complained), 1);
  assert_holds(complained, words);
  must("$V check block.yaml -t 1");
  assert_null(strstr(said, "\nparts "));
}

static void test_overlapping_elements(void **state)
{
  (void)state;
  write_torn("twice.vtu", false);
  assert_warns("--set mesh.file=twice.vtu", "mesh: three elements or more share a face, ");
  // of two tets one has its tip on the wrong side of the face between them: turned right it lies in the other
  save_text("fold.vtk", "# vtk DataFile Version 3.0\nfold\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n"
                        "0 0 0 10 0 0 0 10 0 2 2 5 3 3 8\nCELLS 2 10\n4 0 1 2 3\n4 0 2 1 4\nCELL_TYPES 2\n10 10\n"
                        "POINT_DATA 5\n");
  save_text("fold.yaml", "mesh: {file: fold.vtk, unit: mm}\n"
                         "materials: [{name: a, axial: {f: 10 kPa, s: 10 kPa, n: 10 kPa}, angular: {fs: 5 kPa, sn: 5 kPa, nf: 5 kPa},\n"
                         "  volume_modulus: 100 kPa}]\ngravity: [0 m/s2, 0 m/s2, -9.81 m/s2]\ntime: {end: 0.1 ms}\n");
  static const char words[] = "mesh: two elements lie on the same side of a face that they share, 1 times, as with element 1: ";
  must("$V check fold.yaml -t 1");
  assert_holds(said, words);
  must("$V run fold.yaml -o fold");
  assert_holds(complained, words);
}

// `boundary` may be the epicardium: what it has beside the endocardium, which is told where they meet.
static void test_a_boundary_as_epicardium(void **state)
{
  (void)state;
  assert_warns("--set 'fibers={source: helix, helix: {endo: end, epi: boundary}}'", "endo and epi meet at 16 nodes");
  assert_warns("--set 'fibers={source: helix, helix: {endo: end, epi: skin}}'", "endo and epi meet at 16 nodes");
  assert_int_equal(shell("$V check block.yaml --set 'fibers={source: helix, helix: {endo: end, epi: end}}'"), 2);
  assert_holds(complained, "let epi name the outside of the wall");
  assert_int_equal(shell("$V check block.yaml --set 'fibers={source: helix, helix: {endo: end, epi: epi}}'"), 2);
  assert_holds(complained, "no surface is named");
}

// A vessel of springs that goes through a tissue of another law.
static void test_a_vessel_in_another_law(void **state)
{
  (void)state;
  save_text("line.vtk", "# vtk DataFile Version 3.0\nl\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n-1 5 5 21 5 5\n"
                        "LINES 1 3\n2 0 1\n");
  for (int springs = 1; springs >= 0; springs--) {
    char scene[1024];
    snprintf(scene, sizeof scene,
             "mesh: {file: block.vtu, unit: mm}\n"
             "fibers: {source: constant, constant: {fiber: [1, 0, 0]}}\n"
             "materials:\n"
             "  - {name: liver, %s, volume_modulus: 50 kPa, stabilization: 5 kPa}\n"
             "  - {name: wall, axial: {f: 60 kPa, s: 60 kPa, n: 60 kPa}, angular: {fs: 9 kPa, sn: 9 kPa, nf: 9 kPa},\n"
             "     volume_modulus: 90 kPa, stabilization: 5 kPa}\n"
             "vessels:\n  - {name: vein, file: line.vtk, unit: mm, radius: 2 mm, material: wall}\n"
             "gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]\ntime: {end: 5 ms}\noutput: {frames: 5 ms, signals: 5 ms}\n",
             springs ? "axial: {f: 5 kPa, s: 5 kPa, n: 5 kPa}, angular: {fs: 5 kPa, sn: 5 kPa, nf: 5 kPa}"
                     : "law: neo_hookean, neo_hookean: {shear: 5 kPa}");
    save_text("vein.yaml", scene);
    if (shell("$V check vein.yaml") != (springs ? 0 : 2)) fail_msg("%s", complained);
  }
  assert_holds(complained, "materials[0].law: inclusions and vessels (wall) make up ");
  assert_holds(complained, " of material liver, and only springs are mixed by volume: use law: springs");
}

static void test_active_without_fibres_is_an_error(void **state)
{
  (void)state;
  assert_int_equal(shell("$V check block.yaml --set fibers.source=none"), 2);
  assert_int_equal(line_count(complained), 1);
  assert_holds(complained, "no element has a fibre");
}

// Relaxation has no tangent, and springs on edges need none.
static void test_relaxation_of_any_law(void **state)
{
  (void)state;
  static const char options[] =
      "block.yaml --set 'materials=[{name: m, law: classical, classical: {stiffness: 20 N/m, damping: 0.01 N s/m}}]' "
      "--set 'pressures=[{surface: end, peak: 0.1 kPa}]' --set solve=equilibrium --set solver.method=relaxation";
  char command[400];
  snprintf(command, sizeof command, "$V check %s", options);
  must(command);
  assert_holds(line_of("solve"), "equilibrium at each frame and signal; relaxation to ");
  snprintf(command, sizeof command, "$V run -q -o slack %s --set 'time.end=1 ms'", options);
  must(command);
  snprintf(command, sizeof command, "$V check %s --set solver.method=newton", options);
  assert_int_equal(shell(command), 2);
}

// The same warnings come before a run, unless it is to be quiet; the run goes on.
static void test_run_warns_too(void **state)
{
  (void)state;
  must("$V run block.yaml -o w --set volume=element --set 'time.end=1 ms'");
  assert_int_equal(line_count(complained), 2);
  assert_holds(complained, "viscera: warning: material muscle: ");
  must("$V run block.yaml -o w -q --set volume=element --set 'time.end=1 ms'");
  assert_string_equal(complained, "");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_the_shipped_beat),
      cmocka_unit_test(test_wedges_that_lock),
      cmocka_unit_test(test_beds_and_moved_supports),
      cmocka_unit_test(test_step_and_cost_are_those_of_the_run),
      cmocka_unit_test(test_given_step),
      cmocka_unit_test(test_warnings_about_materials),
      cmocka_unit_test(test_warnings_about_the_setting),
      cmocka_unit_test(test_cycles_and_periods),
      cmocka_unit_test(test_warnings_about_fibres),
      cmocka_unit_test(test_directions_that_nobody_gave),
      cmocka_unit_test(test_sheets_that_are_none),
      cmocka_unit_test(test_bodies_in_parts),
      cmocka_unit_test(test_overlapping_elements),
      cmocka_unit_test(test_a_boundary_as_epicardium),
      cmocka_unit_test(test_a_vessel_in_another_law),
      cmocka_unit_test(test_active_without_fibres_is_an_error),
      cmocka_unit_test(test_relaxation_of_any_law),
      cmocka_unit_test(test_run_warns_too),
  };
  return cmocka_run_group_tests(tests, block_open, program_close);
}
