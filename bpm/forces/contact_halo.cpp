// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/contact_halo.h"

#include <algorithm>
#include <iterator>

namespace boba {

void ContactHalo::rebuild(const ContactList& list, const LaneLayout& layout, const Distribution& distribution,
                          Nodes which) {
  if (ghosts_ != list.ghosts() || first_node_.empty()) {
    ghosts_ = list.ghosts();
    first_node_.assign(layout.n_grains(), 0);
    n_nodes_ = 0;
    for (const int g : ghosts_) {
      first_node_[g] = n_nodes_;
      n_nodes_ += layout.n_nodes(g);
    }
    nodes_ = std::make_unique_for_overwrite<kernels::ContactNode[]>(n_nodes_);
  }
  const auto nodes_here = [&](int g) { return which == Nodes::listed ? list.listed(g) : list.near(g); };
  const Ownership& ownership = distribution.ownership;
  std::vector<RootPlace> from;
  std::vector<int> to;
  for (const int g : ghosts_) {
    for (const std::int32_t node : nodes_here(g)) {
      from.push_back({ownership.owner(g), static_cast<int>(ownership.first_node(g)) + node});
      to.push_back(static_cast<int>(first_node_[g]) + node);
    }
  }
  forest_ = make_star_forest(static_cast<int>(ownership.n_nodes_of(distribution.ranks->rank())), from, to);
  each_ = forest_->incoming();
  ++traffic_.rebuilds;

  // Both sides search by the same rules but from grids of different age: others may list nodes that we do not.
  const std::vector<int> wanted = forest_->wanted();
  std::vector<std::vector<std::int32_t>>& nodes = which == Nodes::listed ? listed_ : near_;
  nodes.assign(layout.n_grains(), {});
  std::vector<std::int32_t> asked;
  for (const int g : layout.grains()) {
    asked.clear();
    const std::int64_t first = ownership.first_node(g), end = first + layout.n_nodes(g);
    for (auto next = std::lower_bound(wanted.begin(), wanted.end(), first); next != wanted.end() && *next < end;
         ++next) {
      asked.push_back(static_cast<std::int32_t>(*next - first));
    }
    const std::span<const std::int32_t> own = nodes_here(g);
    std::set_union(own.begin(), own.end(), asked.begin(), asked.end(), std::back_inserter(nodes[g]));
  }
}

void ContactHalo::clear() {
  const Traffic traffic = traffic_;
  *this = {};
  traffic_ = traffic;
}

void ContactHalo::begin(const kernels::ContactNode* own) {
  forest_->begin(sizeof(kernels::ContactNode), own, nodes_.get());
  ++traffic_.exchanges;
  traffic_.messages += each_.messages;
  traffic_.bytes += each_.items * static_cast<std::int64_t>(sizeof(kernels::ContactNode));
}

void ContactHalo::end() {
  forest_->end();
}

std::size_t ContactHalo::bytes() const {
  return static_cast<std::size_t>(n_nodes_) * sizeof(kernels::ContactNode);
}

} // namespace boba
