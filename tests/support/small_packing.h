// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/snapshot.h"

namespace boba::test {

/// Two grains of 3 and 2 nodes with numbers that all differ, for files.
inline Topology small_topology() {
  Topology topology;
  topology.first_node = {0, 3, 5};
  topology.id = {11, 7, 3, 8, 2};
  topology.molecule = {4, 9};
  topology.species = {1, 0};
  topology.alpha = {2.0, -0.8};
  topology.template_index = {0, 1};
  topology.bonds = {{0, 1, 1.01}, {1, 2, 0.97}, {3, 4, 1.3}};
  return topology;
}

/// The state of small_topology() at a step, by formulas that tests/support/read_trajectory.py repeats:
/// x_i = (1.7 i + 0.01 s, 3 i - 20, 0.5 - 2 i), v_i = (i, 0.1 s, -i), a tilted cell that grows with s.
inline Snapshot small_snapshot(std::int64_t step) {
  const double s = static_cast<double>(step);
  Snapshot snapshot;
  snapshot.step = step;
  snapshot.time = 0.1 * s;
  snapshot.strain = 0.001 * s;
  snapshot.box = Box(Vector3(0.5, -2, 1), Vector3(10 + 0.1 * s, 9, 8), Vector3(2.5, -1.5, 0.75));
  for (int i = 0; i < 5; ++i) {
    snapshot.position.emplace_back(1.7 * i + 0.01 * s, 3.0 * i - 20.0, 0.5 - 2.0 * i);
    snapshot.velocity.emplace_back(i, 0.1 * s, -i);
    snapshot.force.emplace_back(0.25 * i, s, 1.0);
  }
  snapshot.grain_centre = {Vector3(1, 2, s), Vector3(-1, -2, -s)};
  snapshot.grain_stress = {{1, 2, 3, 4, 5, s}, {-1, -2, -3, -4, -5, -s}};
  return snapshot;
}

} // namespace boba::test
