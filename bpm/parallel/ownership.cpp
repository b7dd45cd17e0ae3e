// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/parallel/ownership.h"

namespace boba {

Ownership::Ownership(std::vector<int> owner, int n_ranks, std::span<const int> n_nodes)
    : owner_(std::move(owner)), place_(owner_.size()), first_node_(owner_.size()), n_nodes_(n_ranks, 0),
      grains_(n_ranks) {
  for (int grain = 0; grain < n_grains(); ++grain) {
    const int rank = owner_[grain];
    place_[grain] = static_cast<int>(grains_[rank].size());
    first_node_[grain] = n_nodes_[rank];
    grains_[rank].push_back(grain);
    n_nodes_[rank] += n_nodes[grain];
  }
}

} // namespace boba
