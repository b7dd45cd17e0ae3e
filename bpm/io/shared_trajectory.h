// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/io/shared_file.h"
#include "bpm/io/trajectory.h"
#include "bpm/parallel/ranks.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

namespace boba {

/// A trajectory that all ranks write: each its own grains' nodes, rank 0 everything else. The file is the one that a
/// TrajectoryWriter writes, and with one rank it is one that does. Everything is collective; what goes wrong on any
/// rank all throw (RankError), and the file then stays as after the last frame.
class SharedTrajectory {
public:
  /// `open` makes the writer, on rank 0 alone, with `nodes_by_others` as it is told. `first_node` as in Topology.
  using Open = std::function<TrajectoryWriter(bool nodes_by_others)>;
  SharedTrajectory(const Ranks& ranks, const std::filesystem::path& path, std::vector<std::int64_t> first_node,
                   const Open& open);

  /// The snapshot holds this rank's nodes (Snapshot::grains); which rank has which grain may change between frames.
  /// A frame that cannot be allocated first (compressed, or beyond 4 GiB) rank 0 gathers and writes alone.
  void write(const Snapshot& own);
  void close();
  /// Frames in the file, on rank 0.
  std::int64_t n_frames() const { return writer_ ? writer_->n_frames() : 0; }

private:
  void write_together(const Snapshot& own);
  void write_nodes(const Snapshot& own, const TrajectoryWriter::NodePlaces& places);
  void write_gathered(const Snapshot& own);

  const Ranks& ranks_;
  std::vector<std::int64_t> first_node_;
  std::optional<TrajectoryWriter> writer_; ///< on rank 0
  std::optional<SharedFile> file_;         ///< with several ranks
  bool allocates_frames_ = true;
};

} // namespace boba
