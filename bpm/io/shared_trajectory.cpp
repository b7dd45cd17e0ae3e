// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/shared_trajectory.h"

#include "bpm/io/node_runs.h"
#include "bpm/io/wrapped_nodes.h"

#include <algorithm>
#include <stdexcept>

namespace boba {

namespace {

/// `values`: `per_node` for each node of the runs.
template <class T>
void write_rows(SharedFile& file, std::uint64_t place, const std::vector<NodeRun>& runs, const T* values,
                int per_node) {
  const std::uint64_t width = per_node * sizeof(T);
  const char* from = reinterpret_cast<const char*>(values);
  for (const NodeRun& run : runs) {
    file.write(place + run.first * width, from, run.n * width);
    from += run.n * width;
  }
}

/// Rows of the ranks' nodes, one rank's after the other, in the packing's order.
std::vector<Vector3> in_order(const std::vector<Vector3>& rows, const std::vector<NodeRun>& runs,
                              std::int64_t n_nodes) {
  std::vector<Vector3> result(n_nodes);
  auto from = rows.begin();
  for (const NodeRun& run : runs) {
    std::copy_n(from, run.n, result.begin() + run.first);
    from += run.n;
  }
  return result;
}

} // namespace

SharedTrajectory::SharedTrajectory(const Ranks& ranks, const std::filesystem::path& path,
                                   std::vector<std::int64_t> first_node, const Open& open)
    : ranks_(ranks), first_node_(std::move(first_node)) {
  ranks.on_root([&] {
    writer_.emplace(open(ranks.is_distributed()));
    allocates_frames_ = writer_->can_allocate_frames();
  });
  if (ranks.is_distributed()) {
    ranks.broadcast(allocates_frames_);
    ranks.collectively([&] { file_.emplace(path); });
  }
}

void SharedTrajectory::write(const Snapshot& own) {
  if (!ranks_.is_distributed()) {
    writer_->write(own);
    return;
  }
  try {
    write_together(own);
  } catch (const RankError&) {
    if (writer_) {
      writer_->give_up();
    }
    throw;
  }
}

void SharedTrajectory::write_together(const Snapshot& own) {
  struct {
    TrajectoryWriter::NodePlaces places;
    bool is_new = false;
  } frame;
  ranks_.on_root([&] {
    frame.is_new = writer_->is_new(own);
    if (frame.is_new && allocates_frames_) {
      frame.places = writer_->allocate_frame(own);
    }
  });
  ranks_.broadcast(frame);
  if (!frame.is_new) {
    return;
  }
  if (!allocates_frames_) {
    write_gathered(own);
    return;
  }
  ranks_.collectively([&] { write_nodes(own, frame.places); });
  ranks_.on_root([&] { writer_->finish(own); });
}

void SharedTrajectory::write_nodes(const Snapshot& own, const TrajectoryWriter::NodePlaces& places) {
  const std::vector<NodeRun> runs = node_runs(own.grains, first_node_);
  std::size_t n = 0;
  for (const NodeRun& run : runs) {
    n += static_cast<std::size_t>(run.n);
  }
  if (own.position.size() != n || (places.velocity > 0 && own.velocity.size() != n)) {
    throw std::invalid_argument("trajectory: the snapshot does not hold the nodes of this rank's grains");
  }
  const WrappedNodes nodes(own);
  write_rows(*file_, places.image, runs, nodes.image.data(), 3);
  if (places.velocity > 0) {
    write_rows(*file_, places.velocity, runs, own.velocity.data(), 1);
  }
  write_rows(*file_, places.position, runs, nodes.position.data(), 1);
}

void SharedTrajectory::write_gathered(const Snapshot& own) {
  const std::vector<int> grains = ranks_.gathered(own.grains);
  std::vector<Vector3> position = ranks_.gathered(own.position), velocity = ranks_.gathered(own.velocity);
  ranks_.on_root([&] {
    const std::vector<NodeRun> runs = node_runs(grains, first_node_);
    Snapshot whole = own;
    whole.position = in_order(position, runs, first_node_.back());
    whole.velocity = velocity.empty() ? velocity : in_order(velocity, runs, first_node_.back());
    writer_->write(whole);
  });
}

void SharedTrajectory::close() {
  ranks_.collectively([&] {
    if (file_) {
      file_->close();
    }
  });
  ranks_.collectively([&] {
    if (writer_) {
      writer_->close();
    }
  });
}

} // namespace boba
