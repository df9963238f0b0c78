// SPDX-License-Identifier: GPL-3.0-or-later
// Scene files to read, good or broken on purpose, in a folder of their own.
#ifndef VSC_TESTS_SCENE_FILES_H
#define VSC_TESTS_SCENE_FILES_H

#include "close.h"
#include "io/scene.h"
#include "scratch.h"

static char scene_file[256];

// Group set-up: the folder and the files that the scenes below name.
static inline int make_files(void **state)
{
  if (scratch_open(state) != 0) return 1;
  snprintf(scene_file, sizeof scene_file, "%s", scratch("scene.yaml"));
  scratch_text("lv.vtu", "mesh");
  scratch_text("angles.vti", "map");
  scratch_text("curve.csv", "# a beat\ntime,value\n0,0\r\n 1 , 1\n\n2;0.25\n3 0\n");
  return 0;
}

static inline vsc_scene *read_good(const char *name, const char *const *settings, size_t count)
{
  vsc_scene *scene = NULL;
  vsc_error error = {.text = ""};
  if (vsc_scene_read(scratch(name), settings, count, &scene, &error) != VSC_OK)
    fail_msg("%s", error.text);
  return scene;
}

// clang-format off
// Every key; test_io_scene_broken.c counts the lines.
static const char full[] =
    "mesh: {file: lv.vtu, unit: 0.1 mm, region_array: region}\n"                        // 1
    "surfaces:\n"                                                                       // 2
    "  - {name: endo, node_array: endo, value: 1}\n"                                    // 3
    "  - {name: epi, triangle_array: surface, range: [1.5, 2.5]}\n"                     // 4
    "  - {name: skin, boundary: true}\n"                                                // 5
    "node_sets:\n"                                                                      // 6
    "  - {name: base, box: {low: [0 mm, 0 mm, 0 mm], high: [1 cm, 2 cm, 3 cm]}}\n"      // 7
    "  - name: top\n"                                                                   // 8
    "    plane: {point: [0 mm, 0 mm, 9 mm], normal: [0, 0, 1], tolerance: 0.1 mm}\n"    // 9
    "  - {name: inside, surface: endo}\n"                                               // 10
    "fibers:\n"                                                                         // 11
    "  source: map\n"                                                                   // 12
    "  fill: true\n"                                                                    // 13
    "  map: {file: angles.vti, length_unit: cm, azimuth: az_x10, elevation: el_x10,\n"  // 14
    "        angle_unit: 0.1 deg, azimuth_zero: 90 deg, azimuth_sense: clockwise,\n"    // 15
    "        elevation_sense: down, axes: world, mask: tissue, weight: coherence}\n"    // 16
    "  helix: {endo: endo, epi: epi, endo_angle: 70 deg, epi_angle: -50 deg}\n"         // 17
    "  pitch: 20 deg\n"                                                                 // 18
    "  seed: 7\n"                                                                       // 19
    "materials:\n"                                                                      // 20
    "  - name: myocardium\n"                                                            // 21
    "    regions: [1, 2]\n"                                                             // 22
    "    density: 1050 kg/m3\n"                                                         // 23
    "    axial:   {f: 10 kPa, s: 5 kPa, n: 4 kPa}\n"                                    // 24
    "    angular: {fs: 3 kPa, sn: 2 kPa, nf: 1 kPa}\n"                                  // 25
    "    damping: {f: 10 Pa s, s: 20 Pa s, n: 30 Pa s}\n"                               // 26
    "    volume_modulus: 1 MPa\n"                                                       // 27
    "    stabilization: 10 kPa\n"                                                       // 28
    "    active:\n"                                                                     // 29
    "      kind: tension\n"                                                             // 30
    "      tension: 450 mmHg\n"                                                         // 31
    "      delay: 5 ms\n"                                                               // 32
    "      amplitude_array: amp\n"                                                      // 33
    "      delay_array: lat\n"                                                          // 34
    "      delay_unit: 1 s\n"                                                           // 35
    "      curve: {kind: half_sine, start: 0.1 s, duration: 300 ms, period: 800 ms}\n"  // 36
    "  - name: scar\n"                                                                  // 37
    "    axial:   {f: 40 kPa, s: 40 kPa, n: 40 kPa}\n"                                  // 38
    "    angular: {fs: 9 kPa, sn: 9 kPa, nf: 9 kPa}\n"                                  // 39
    "    volume_modulus: 2 MPa\n"                                                       // 40
    "    active:\n"                                                                     // 41
    "      kind: spring\n"                                                              // 42
    "      stiffness: 200 kPa\n"                                                        // 43
    "      rest_stretch: 0.8\n"                                                         // 44
    "      curve:\n"                                                                    // 45
    "        kind: table\n"                                                             // 46
    "        file: curve.csv\n"                                                         // 47
    "        time_unit: 0.1 s\n"                                                           // 48
    "volume: element\n"                                                                 // 49
    "supports:\n"                                                                       // 50
    "  - {set: base, motion: [0 mm, 0 mm, 1 cm], curve: {kind: ramp}, held: [x, z]}\n"  // 51
    "gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]\n"                                           // 52
    "pressures:\n"                                                                      // 53
    "  - {surface: endo, peak: 120 mmHg, curve: {kind: tanh_pair, start: 50 ms}}\n"     // 54
    "  - {surface: boundary, peak: 1 kPa}\n"                                            // 55
    "time: {end: 1.6 s, step: 0.01 ms, safety: 0.7}\n"                                  // 56
    "output:\n"                                                                         // 57
    "  frames: 20 ms\n"                                                                 // 58
    "  precision: double\n"                                                             // 59
    "  arrays: [displacement, fiber]\n"                                                 // 60
    "  signals: 2 ms\n"                                                                 // 61
    "  cavities: [endo, skin]\n"                                                        // 62
    "  checkpoint: 0.1 s\n"                                                             // 63
    "robin:\n"                                                                          // 64
    "  - {surface: endo, stiffness: 1e8 Pa/m, damping: 5e3 Pa s/m, direction: normal}\n" // 65
    "  - {surface: boundary, stiffness: 2 kPa/mm}\n";                                    // 66

// clang-format on

static const char minimal[] =
    "mesh: {file: lv.vtu, unit: mm}\n"
    "materials:\n"
    "  - name: tissue\n"
    "    axial: {f: 10 kPa, s: 5 kPa, n: 5 kPa}\n"
    "    angular: {fs: 3 kPa, sn: 3 kPa, nf: 3 kPa}\n"
    "    volume_modulus: 1 MPa\n"
    "time: {end: 10 ms}\n";

#endif
