// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/io/output_file.h"
#include "bpm/packing/snapshot.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace boba {

/// Bonded nodes as a LAMMPS data file holds them, in the file's row order.
struct LammpsData {
  /// A bond joins two atoms, named by their ids.
  struct Bond {
    std::int64_t i = 0;
    std::int64_t j = 0;
    int type = 1;
  };

  Box box; ///< d, periodic in all directions (a data file does not say)
  std::int64_t timestep = 0;
  bool has_images = false;            ///< positions were unwrapped with the file's image flags
  std::vector<std::int64_t> id;       ///< per row, positive and unique
  std::vector<std::int64_t> molecule; ///< per row, 0 when the style has none
  std::vector<int> type;              ///< per row, from 1
  std::vector<Vector3> position;      ///< d, unwrapped: x + h n with the image flags n
  std::vector<Vector3> velocity;      ///< d/tau; empty when the file has none
  std::vector<Bond> bonds;
  std::vector<double> mass; ///< m, per type (type 1 first); empty when the file has none

  std::int64_t n_nodes() const { return static_cast<std::int64_t>(id.size()); }
  /// The bonds as pairs of rows.
  std::vector<std::array<std::int64_t, 2>> bond_rows() const;
};

/// Reads a LAMMPS data file, plain or gzipped.
///
/// The header may come in any order; sections that are not needed are skipped; ids in any order; type labels are
/// understood. Atom styles atomic, charge, bond, angle, molecular, full, sphere and bpm/sphere are known by the comment
/// behind `Atoms`, and without one atomic, bond (= angle = molecular) and full by the number of columns.
/// \throws InputError with file, line, value and what is allowed.
/// Source: LAMMPS documentation, "read_data command".
LammpsData read_lammps_data(const std::filesystem::path& path);

/// Writes a LAMMPS data file (atom_style bond; molecule = grain, type = species + 1) with 17 digits: wrapped positions
/// and image flags, velocities when the snapshot has them. A name that ends in .gz is compressed.
///
/// r0 is not part of the format: whoever reads the file takes the lengths in it, so give the undeformed positions.
/// \throws std::runtime_error when the file exists (FileMode::create) or cannot be written.
/// Source: LAMMPS documentation, "read_data command".
void write_lammps_data(const std::filesystem::path& path, const Topology& topology, const Snapshot& snapshot,
                       FileMode mode = FileMode::create);

} // namespace boba
