// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/contact_list.h"
#include "bpm/forces/kernels/kernels.h"
#include "bpm/parallel/distribution.h"
#include "bpm/parallel/star_forest.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace boba {

/// Copies of other ranks' nodes that may touch ours, positions and velocities: all that stand in a candidate of this
/// rank while the list is brought up to date, and between updates those that may touch before the next. Rebuilt with
/// the list.
class ContactHalo {
public:
  enum class Nodes { listed, near };
  /// Finds out which nodes are to be had from whom, and which of ours others want. Collective.
  void rebuild(const ContactList& list, const LaneLayout& layout, const Distribution& distribution, Nodes which);
  /// The layout holds other grains than before: all but the counts of traffic is forgotten.
  void clear();
  bool is_built() const { return forest_ != nullptr; } ///< the same on all ranks
  /// Asks for the nodes of others, `own` being those of this rank's grains, one grain after the other.
  void begin(const kernels::ContactNode* own);
  void end();

  /// Node 0 of another rank's grain.
  kernels::ContactNode* nodes_of(int ghost) { return nodes_.get() + first_node_[ghost]; }
  /// Nodes of an own grain that are listed (or near) here or on another rank, ascending.
  std::span<const std::int32_t> listed(int grain) const { return listed_[grain]; }
  std::span<const std::int32_t> near(int grain) const { return near_[grain]; }

  /// What this rank has received so far.
  struct Traffic {
    std::int64_t exchanges = 0, messages = 0, bytes = 0, rebuilds = 0;
  };
  const Traffic& traffic() const { return traffic_; }
  std::size_t bytes() const;

private:
  std::unique_ptr<StarForest> forest_;
  StarForest::Traffic each_;
  std::vector<int> ghosts_;
  std::vector<std::int64_t> first_node_;          ///< per grain, of the ghosts alone
  std::unique_ptr<kernels::ContactNode[]> nodes_; ///< of whole ghosts; only pages with listed nodes are ever touched
  std::int64_t n_nodes_ = 0;
  std::vector<std::vector<std::int32_t>> listed_, near_; ///< per grain
  Traffic traffic_;
};

} // namespace boba
