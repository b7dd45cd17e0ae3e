// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace boba {

/// Which rank owns which grain. Grains are whole, so bonds never cross ranks.
class Ownership {
public:
  Ownership() = default;
  /// `owner` per grain, 0 .. n_ranks - 1; `n_nodes` of every grain.
  Ownership(std::vector<int> owner, int n_ranks, std::span<const int> n_nodes);

  int n_grains() const { return static_cast<int>(owner_.size()); }
  int owner(int grain) const { return owner_[grain]; }
  const std::vector<int>& owners() const { return owner_; }
  /// Grains of a rank, ascending.
  std::span<const int> grains_of(int rank) const { return grains_[rank]; }
  /// How many of its owner's grains come before this one.
  int place(int grain) const { return place_[grain]; }
  /// How many nodes those have together.
  std::int64_t first_node(int grain) const { return first_node_[grain]; }
  std::int64_t n_nodes_of(int rank) const { return n_nodes_[rank]; }

private:
  std::vector<int> owner_, place_;
  std::vector<std::int64_t> first_node_, n_nodes_;
  std::vector<std::vector<int>> grains_;
};

} // namespace boba
