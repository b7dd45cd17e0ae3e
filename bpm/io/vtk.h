// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/io/output_file.h"
#include "bpm/packing/snapshot.h"

#include <filesystem>
#include <string>
#include <vector>

namespace boba {

/// Writes the nodes as a VTK PolyData file (.vtp, raw appended data) for ParaView: a vertex a node, with the arrays
/// `grain` (number as in the other files), `species`, `id`, and `velocity` (d/tau) and `force` (k d) when the snapshot
/// has them.
///
/// Grains are drawn whole, each in the image that has its centre in the cell.
/// \throws std::runtime_error when the file exists (FileMode::create) or cannot be written.
/// Source: VTK file formats, "XML file formats", PolyData and appended data.
void write_vtp(const std::filesystem::path& path, const Topology& topology, const Snapshot& snapshot,
               FileMode mode = FileMode::create);

/// Writes a series of .vtp files beside a .pvd that lists them with their times (tau), so that ParaView opens all at
/// once.
///
/// FOLDER/NAME.pvd is rewritten after each frame, by renaming: it is whole at any moment.
class VtkSeries {
public:
  /// Files NAME_STEP.vtp go beside `pvd`. \throws std::runtime_error when `pvd` exists (FileMode::create).
  VtkSeries(const std::filesystem::path& pvd, FileMode mode = FileMode::create);
  /// Continues the frames up to `last_step`; the files of later ones are removed. \throws InputError when `pvd` is
  /// none of ours.
  static VtkSeries go_on(const std::filesystem::path& pvd, std::int64_t last_step);

  void write(const Topology& topology, const Snapshot& snapshot);

private:
  struct Frame {
    std::int64_t step = 0;
    double time = 0.0;
    std::string file;
  };
  void write_list() const;

  std::filesystem::path pvd_;
  std::vector<Frame> frames_;
};

} // namespace boba
