// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/box.h"

#include <cstdint>
#include <span>
#include <vector>

namespace boba::measure {

/// The nodes of all grains in one array: grain g owns the nodes [first_node[g], first_node[g + 1]).
///
/// A view: it owns nothing. Positions are unwrapped (no grain is torn), in d.
class GrainNodes {
public:
  /// \param positions one entry a node, d
  /// \param first_node size n_grains + 1, ascending, from 0 to the number of nodes
  /// \throws std::invalid_argument when `first_node` does not cut `positions` into ranges.
  GrainNodes(std::span<const Vector3> positions, std::span<const std::int64_t> first_node);

  int n_grains() const { return static_cast<int>(first_node_.size()) - 1; }
  std::size_t n_nodes() const { return positions_.size(); }
  std::span<const Vector3> positions() const { return positions_; }
  std::span<const std::int64_t> first_node() const { return first_node_; }
  std::span<const Vector3> nodes_of(int grain) const {
    return positions_.subspan(first_node_[grain], first_node_[grain + 1] - first_node_[grain]);
  }

private:
  std::span<const Vector3> positions_;
  std::span<const std::int64_t> first_node_;
};

/// Mean position of a grain's nodes, d. \throws std::invalid_argument without nodes.
Vector3 mean_position(std::span<const Vector3> nodes);

/// `mean_position` of every grain.
std::vector<Vector3> grain_centres(const GrainNodes& grains);

} // namespace boba::measure
