// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/io/output_file.h"
#include "bpm/packing/snapshot.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace boba {

/// One frame of a LAMMPS text dump, in the file's row order.
struct LammpsFrame {
  std::int64_t timestep = 0;
  std::optional<double> time; ///< tau, from ITEM: TIME
  Box box;                    ///< d
  bool is_unwrapped = false;  ///< positions come from xu yu zu, or from image flags
  std::vector<std::int64_t> id;
  std::vector<std::int64_t> molecule; ///< empty without a column `mol`
  std::vector<int> type;              ///< empty without a column `type`
  std::vector<Vector3> position;      ///< d
  std::vector<Vector3> velocity;      ///< d/tau; empty without vx vy vz
  std::vector<Vector3> force;         ///< k d; empty without fx fy fz
  std::string cut_off;                ///< why what follows the whole frames of the file is none; empty: nothing does

  std::int64_t n_nodes() const { return static_cast<std::int64_t>(id.size()); }
};

/// Reads one frame of a LAMMPS text dump, plain or gzipped: the last one, or the one of a time step.
///
/// Columns may come in any order and others are skipped; positions are x y z, scaled xs ys zs, or unwrapped xu yu zu,
/// xsu ysu zsu, and are unwrapped with ix iy iz when these are there. The bounding limits of a tilted cell are turned
/// into the cell. Of a file that was cut off the whole frames count, and LammpsFrame::cut_off says so. Columns `mass`,
/// `diameter` and `radius` must be those of the model. \throws InputError with file, line, value and what is allowed;
/// also when no frame is whole, or two are of that time step. Source: LAMMPS documentation, "dump command" and "Howto
/// triclinic".
LammpsFrame read_lammps_dump(const std::filesystem::path& path, std::optional<std::int64_t> timestep = std::nullopt);

/// The same for a frame by its place in the file: 0, 1, ... or, from the end, -1 (the last), -2, ...
LammpsFrame read_lammps_dump_frame(const std::filesystem::path& path, std::int64_t number);

/// Time steps of all whole frames of a dump, in the file's order. \throws InputError as read_lammps_dump.
std::vector<std::int64_t> lammps_dump_timesteps(const std::filesystem::path& path);

/// Row of the frame for each of the wanted ids, so that x[i] = frame.position[rows[i]].
/// \throws InputError naming `path` unless the two sets of ids are the same.
std::vector<std::int64_t> rows_of_ids(const LammpsFrame& frame, std::span<const std::int64_t> wanted,
                                      const std::filesystem::path& path);

/// What a row of a written dump holds.
enum class DumpLayout {
  viewer, ///< id mol type x y z ix iy iz, and vx vy vz when the snapshot has velocities; 10 digits. For OVITO.
  forces  ///< id x y z vx vy vz fx fy fz, sorted by id, 17 digits; needs velocities and forces
};

/// Writes frames of a LAMMPS text dump with wrapped positions; `mol` is the grain, `type` the species + 1.
///
/// A cell with a periodic direction is written as a tilted one, with its bounding limits, whether it leans or not. A
/// name that ends in .gz is compressed. \throws std::runtime_error when the file cannot be written. Source: LAMMPS
/// documentation, "dump command" and "Howto triclinic".
class LammpsDumpWriter {
public:
  LammpsDumpWriter(const std::filesystem::path& path, DumpLayout layout, FileMode mode = FileMode::create);
  /// Appends a frame and hands it to the operating system.
  void write(const Topology& topology, const Snapshot& snapshot);
  void close() { file_.close(); }

private:
  OutputFile file_;
  DumpLayout layout_;
};

/// Removes the frames after `last_step` and one that is cut off, for going on from a checkpoint. Returns the number of
/// frames kept; a missing file has none. \throws InputError when the file is not a plain text dump.
std::int64_t truncate_lammps_dump(const std::filesystem::path& path, std::int64_t last_step);

} // namespace boba
