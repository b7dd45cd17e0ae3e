// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/io/output_file.h"
#include "bpm/packing/snapshot.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace boba {

/// What a trajectory says about where it comes from; stored under /parameters.
struct TrajectoryOrigin {
  std::string scene; ///< text of the scene file
  std::uint64_t seed = 0;
  std::string version;
  std::string git_hash;
  std::string author = "unknown"; ///< H5MD wants a name
};

struct TrajectoryOptions {
  bool velocity = false;        ///< store velocities; every snapshot then needs them
  int compression = 0;          ///< 0 (none, fastest) .. 9 of the node data
  bool nodes_by_others = false; ///< nodes of frames are put into the file by several ranks, see allocate_frame
  bool damage = false;          ///< store the share of broken bonds of each node; every snapshot then needs it
  bool bonds_yield = false;     ///< note that frames do not tell the state of bonds
};

/// Writes an H5MD 1.1 file frame by frame: positions and images, box, each grain's centre and stress, strain, and once
/// the bonds, the grains and the origin. docs/formats.md describes every dataset.
///
/// The file can be read after each write(), also by another process and also when this one is killed. A frame whose
/// step is the last one's is skipped, so the end of one stage and the begin of the next may both be offered. Source: P.
/// de Buyl, P. H. Colberg & F. Hoefling, Comput. Phys. Commun. 185, 1546 (2014); H5MD 1.1.
class TrajectoryWriter {
public:
  /// \throws std::runtime_error when the file exists (FileMode::create) or cannot be written.
  TrajectoryWriter(const std::filesystem::path& path, const Topology& topology, const TrajectoryOrigin& origin,
                   const TrajectoryOptions& options = {}, FileMode mode = FileMode::create);
  /// Continues a file after its last frame up to `last_step`; later frames and a torn one are removed.
  /// A file that was not closed (its run was killed) is copied frame by frame, which takes its size in disk space once
  /// more. \throws std::runtime_error when the file is missing, damaged, or of another packing.
  static TrajectoryWriter go_on(const std::filesystem::path& path, const Topology& topology, std::int64_t last_step,
                                bool nodes_by_others = false);

  TrajectoryWriter(TrajectoryWriter&&) noexcept;
  TrajectoryWriter& operator=(TrajectoryWriter&&) noexcept;
  ~TrajectoryWriter();

  /// \throws std::invalid_argument when the snapshot lacks a part or goes back in time, std::runtime_error when writing
  /// fails.
  void write(const Snapshot& snapshot);
  std::int64_t n_frames() const;

  /// Where a frame's values of nodes lie in the file, bytes: node after node, three numbers each (doubles; images are
  /// 32-bit integers).
  struct NodePlaces {
    std::uint64_t position = 0, image = 0, velocity = 0; ///< 0 for velocities that are not stored
  };
  /// write() in two halves, for nodes that others put there in between; only of a file made or opened with
  /// `nodes_by_others` that can_allocate_frames(), and only of a frame that is new. The snapshot's nodes are not looked
  /// at.
  NodePlaces allocate_frame(const Snapshot& snapshot);
  void finish(const Snapshot& snapshot);
  /// False for the step that was written last. \throws std::invalid_argument when it goes back in time.
  bool is_new(const Snapshot& snapshot) const;
  /// Are a frame's nodes one piece of the file as they lie in memory? Otherwise one writer must put them there.
  bool can_allocate_frames() const;
  /// From now on nothing reaches the file any more: it stays as it was last flushed.
  void give_up();

  void close();

private:
  struct Impl;
  explicit TrajectoryWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Reads what TrajectoryWriter wrote, also from a run that goes on or was killed: only frames that are complete count.
class TrajectoryReader {
public:
  /// \throws InputError when the file is missing, damaged or not a trajectory of Boba.
  explicit TrajectoryReader(const std::filesystem::path& path);
  TrajectoryReader(TrajectoryReader&&) noexcept;
  TrajectoryReader& operator=(TrajectoryReader&&) noexcept;
  ~TrajectoryReader();

  std::int64_t n_frames() const { return static_cast<std::int64_t>(steps_.size()); }
  const std::vector<std::int64_t>& steps() const { return steps_; }
  const Topology& topology() const { return topology_; }
  const TrajectoryOrigin& origin() const { return origin_; }
  bool has_velocity() const { return has_velocity_; }
  /// True when bonds yield: frames do not tell how far.
  bool bonds_yield() const { return bonds_yield_; }

  /// Frame 0 .. n_frames() - 1, or counted from the end: -1 is the last. Positions are unwrapped.
  /// \throws InputError for a frame that is not there.
  Snapshot snapshot(std::int64_t frame) const;
  /// Strain of such a frame, without reading its nodes.
  double strain_of(std::int64_t frame) const;
  /// The frame of this step. \throws InputError when there is none.
  std::int64_t frame_of_step(std::int64_t step) const;

private:
  struct Impl;
  /// Its number from the begin. \throws InputError when it is not there.
  std::int64_t frame_number(std::int64_t frame) const;
  std::unique_ptr<Impl> impl_;
  std::vector<std::int64_t> steps_;
  Topology topology_;
  TrajectoryOrigin origin_;
  bool has_velocity_ = false, bonds_yield_ = false;
};

} // namespace boba
