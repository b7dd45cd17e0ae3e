// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/packing.h"
#include "bpm/packing/snapshot.h"

#include <cstdint>
#include <memory>

namespace boba::test {

/// A small disordered ball of nodes with bonds shorter than 1.5 d: enough of a grain for a test, made in microseconds.
/// Nodes are placed one by one at random within `radius`, at least 0.8 d apart, until 200 tries in a row fail.
std::shared_ptr<const GrainTemplate> small_ball(double radius, std::uint64_t seed);

/// `n` small balls at random places and rotations in a cell, overlaps allowed; random velocities of size `speed`
/// and displacements of size `jitter`.
struct SmallPackingSpec {
  Box box;
  int n_grains = 8;
  double radius = 2.5;
  double alpha = 2.0;
  double jitter = 0.05;
  double speed = 0.05;
  double least_distance = 4.5; ///< between the centres, d
  std::uint64_t seed = 1;
};
Packing small_packing(const SmallPackingSpec& spec);

/// Two grains of 3 and 2 nodes with numbers that all differ, for files.
Topology small_topology();

/// The state of small_topology() at a step, by formulas that tests/support/read_trajectory.py repeats:
/// x_i = (1.7 i + 0.01 s, 3 i - 20, 0.5 - 2 i), v_i = (i, 0.1 s, -i), a tilted cell that grows with s.
Snapshot small_snapshot(std::int64_t step);

} // namespace boba::test
