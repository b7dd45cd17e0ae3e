// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/max_lanes.h"
#include "bpm/packing/packing.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace boba {

/// How positions, velocities and forces are stored while a packing moves.
enum class Precision {
  full, ///< doubles
  mixed ///< positions in 32-bit fixed point from their grain's origin, the rest in floats
};

/// Lanes of a full block: the doubles or floats of one 512-bit register. Narrower registers take a block in several
/// goes.
constexpr int lanes_of_block(Precision precision) {
  return precision == Precision::full ? 8 : 16;
}

/// One block: up to `n_lanes` grains of one template that advance together.
struct Block {
  int template_index = 0;
  int n_nodes = 0;
  int n_lanes = 8;           ///< 16, 8, or 1 for a network that only one grain has
  std::int64_t offset = 0;   ///< of the block's first number in the arrays of LaneState
  bool many_body = false;    ///< some lane has alpha != 0
  std::vector<int> grain;    ///< per lane; -1 marks an idle lane
  std::vector<double> alpha; ///< per lane, k d
  Breaking breaking;         ///< of its bonds, but for the strains, which each bond of each lane remembers
  Yielding yielding;         ///< of its bonds
  int n_remembered = 0;      ///< numbers that each bond of each lane remembers
  std::int64_t memory = 0;   ///< of the block's first number in the array of what bonds remember

  int n_grains() const;
};

/// Which lane of which block each grain lives in. A block's lanes are as many for all grains that can share blocks,
/// whoever else is there: a grain's numbers must not depend on that.
///
/// An array is [block][node][component][lane]; component c of node i of grain g is at
/// first(g) + (3 i + c) stride(g). Blocks hold grains of one template, and grains with alpha = 0 are kept
/// apart from the others, so that a block without many-body forces never computes volumes. So are grains whose bonds
/// break or yield, by how they do: what bonds remember is an array [block][bond][number][lane] of such blocks alone.
class LaneLayout {
public:
  explicit LaneLayout(const Packing& packing, Precision precision = Precision::full);
  /// Of these grains of the packing alone, which fill blocks in the order given; the others have no lane.
  LaneLayout(const Packing& packing, Precision precision, std::span<const int> grains);

  Precision precision() const { return precision_; }

  const std::vector<Block>& blocks() const { return blocks_; }
  int n_grains() const { return static_cast<int>(slots_.size()); } ///< of the packing
  /// Grains that have a lane, ascending: all of them, or those of one rank.
  const std::vector<int>& grains() const { return grains_; }
  bool holds(int grain) const { return slots_[grain].block >= 0; }
  std::int64_t size() const { return size_; } ///< numbers in one array, idle lanes included
  std::int64_t first(int grain) const { return slots_[grain].first; }
  int stride(int grain) const { return slots_[grain].stride; }
  int n_nodes(int grain) const { return slots_[grain].n_nodes; }
  int block_of(int grain) const { return slots_[grain].block; }
  int lane_of(int grain) const { return slots_[grain].lane; }
  std::int64_t index(int grain, int node, int component) const {
    return slots_[grain].first + (3 * static_cast<std::int64_t>(node) + component) * slots_[grain].stride;
  }
  /// Numbers that bonds remember, idle lanes included.
  std::int64_t memory_size() const { return memory_size_; }
  /// The bonds of a grain remember something.
  bool remembers(int grain) const { return slots_[grain].memory >= 0; }
  /// Numbers that each bond of a grain remembers.
  int n_remembered(int grain) const { return slots_[grain].n_remembered; }
  /// Place of one of a bond's numbers; `bond` counts those of the template.
  std::int64_t memory_index(int grain, std::int64_t bond, int number) const {
    return slots_[grain].memory + (bond * slots_[grain].n_remembered + number) * slots_[grain].stride;
  }
  /// First bond of each node of a grain that remembers, and their number at last (size n + 1).
  const std::vector<std::int64_t>& first_bonds(int grain) const {
    return first_bonds_.at(slots_[grain].template_index);
  }
  /// Most numbers that the bonds remember which any node is the first of, in the whole packing; 0 when none does.
  int memory_slots() const { return memory_slots_; }
  /// Bytes of the layout itself.
  std::size_t bytes() const;
  /// Share of lanes that carry a grain, weighted with nodes (1 when no lane is idle).
  double filled() const;

private:
  struct Slot {
    std::int64_t first = 0;
    int stride = 1, n_nodes = 0, block = -1, lane = 0, template_index = 0, n_remembered = 0;
    std::int64_t memory = -1;
  };
  void count_bonds(const Packing& packing);
  void add_block(const Packing& packing, const std::vector<int>& grains, int n_lanes);

  Precision precision_;
  std::vector<Block> blocks_;
  std::vector<Slot> slots_;
  std::vector<int> grains_;
  std::int64_t size_ = 0, memory_size_ = 0;
  int memory_slots_ = 0;
  std::map<int, std::vector<std::int64_t>> first_bonds_; ///< by template, of those that remember
};

} // namespace boba
