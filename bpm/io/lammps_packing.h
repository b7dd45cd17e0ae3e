// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/network_grouping.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace boba {

/// Where a state to start from stands.
struct LammpsSource {
  std::filesystem::path reference;            ///< data file of the undeformed grains: bonds and r0
  std::optional<std::filesystem::path> state; ///< dump or data file of the present state; absent: the reference
  std::optional<std::int64_t> timestep = {};  ///< frame of a dump; absent: the last
  std::optional<std::int64_t> frame = {};     ///< the same by number, from 0, or from the end when negative
};

/// A packing read from LAMMPS files: r0, bonds and grains from the reference, box, positions and velocities from the
/// state.
struct LammpsPacking {
  Packing packing;               ///< alpha = 0; grains whole; templates hold the reference arrangement
  std::vector<std::int64_t> row; ///< per node of the packing: its row in the reference file
  std::int64_t timestep = 0;     ///< of the state
  std::string warning;           ///< what deserves a word: the state's file was cut off
};

/// Reads both files and joins them by atom id; see group_network() for what becomes a grain and what a template.
///
/// Velocities are zero when the state has none.
/// \throws InputError with the file's name when a file is wrong, the two do not hold the same atoms, a mass is not 1,
/// or group_network() or whole_positions() refuse.
LammpsPacking read_lammps_packing(const LammpsSource& source);

} // namespace boba
