// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/io/lammps_dump.h"
#include "bpm/io/lammps_packing.h"

#include <array>
#include <string>
#include <vector>

namespace boba::test {

/// A file of tests/data.
std::filesystem::path test_data(const std::string& name);

/// A LAMMPS file of tests/data/forces.
std::filesystem::path force_data(const std::string& name);

/// The packing of `name` (ortho or tri) in the state of a dump, all grains with this alpha.
LammpsPacking fixture_packing(const std::string& name, const std::string& state, double alpha);

/// Pressure tensor pxx pyy pzz pxy pxz pyz that LAMMPS printed at a step ("step0", "step10", "step100").
std::array<double, 6> lammps_pressure(const std::string& file, const std::string& step);

/// Largest difference of any component between our array (packing order) and the frame's (its own order).
double largest_difference(const LammpsPacking& packing, const std::vector<Vector3>& ours, const LammpsFrame& frame,
                          const std::vector<Vector3>& theirs);

/// The same for positions, modulo the lattice of `box`.
double largest_position_difference(const LammpsPacking& packing, const std::vector<Vector3>& ours,
                                   const LammpsFrame& frame, const Box& box);

double largest_norm(const std::vector<Vector3>& vectors);

} // namespace boba::test
