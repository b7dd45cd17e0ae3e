// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/packing.h"

#include <boost/align/aligned_allocator.hpp>

#include <cstdint>
#include <vector>

namespace boba {

/// Lanes of a full block: the doubles of one 512-bit register. Narrower registers take a block in two or four goes.
inline constexpr int block_lanes = 8;

/// One block: up to `n_lanes` grains of one template that advance together.
struct Block {
  int template_index = 0;
  int n_nodes = 0;
  int n_lanes = block_lanes;    ///< block_lanes, or 1 for a network that only one grain has
  std::int64_t offset = 0;      ///< of the block's first number in the arrays of LaneState
  bool many_body = false;       ///< some lane has alpha != 0
  std::vector<int> grain;       ///< per lane; -1 marks an idle lane
  std::vector<double> alpha;    ///< per lane, k d

  int n_grains() const;
};

/// Which lane of which block each grain lives in.
///
/// An array is [block][node][component][lane]; component c of node i of grain g is at
/// first(g) + (3 i + c) stride(g). Blocks hold grains of one template, and grains with alpha = 0 are kept
/// apart from the others, so that a block without many-body forces never computes volumes.
class LaneLayout {
public:
  explicit LaneLayout(const Packing& packing);

  const std::vector<Block>& blocks() const { return blocks_; }
  int n_grains() const { return static_cast<int>(slots_.size()); }
  std::int64_t size() const { return size_; } ///< numbers in one array, idle lanes included
  std::int64_t first(int grain) const { return slots_[grain].first; }
  int stride(int grain) const { return slots_[grain].stride; }
  int n_nodes(int grain) const { return slots_[grain].n_nodes; }
  int block_of(int grain) const { return slots_[grain].block; }
  int lane_of(int grain) const { return slots_[grain].lane; }
  std::int64_t index(int grain, int node, int component) const {
    return slots_[grain].first + (3 * static_cast<std::int64_t>(node) + component) * slots_[grain].stride;
  }
  /// Share of lanes that carry a grain, weighted with nodes (1 when no lane is idle).
  double filled() const;

private:
  struct Slot {
    std::int64_t first = 0;
    int stride = 1, n_nodes = 0, block = 0, lane = 0;
  };
  void add_block(const Packing& packing, const std::vector<int>& grains, int n_lanes);

  std::vector<Block> blocks_;
  std::vector<Slot> slots_;
  std::int64_t size_ = 0;
};

/// Array whose first element lies on a cache line.
using AlignedVector = std::vector<double, boost::alignment::aligned_allocator<double, 64>>;

/// Positions, velocities and forces in the lane layout. `v` holds half-step velocities between steps (see Stepper).
struct LaneState {
  AlignedVector x, v, f;

  /// Copies the packing in; idle lanes get the undeformed template at rest, so that they stay finite and cheap.
  LaneState(const Packing& packing, const LaneLayout& layout);
};

} // namespace boba
