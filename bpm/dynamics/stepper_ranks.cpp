// SPDX-License-Identifier: GPL-3.0-or-later
// What a stepper does to spread a packing over ranks: gathering, moving grains, balancing.
#include "bpm/dynamics/stepper.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace boba {

namespace {

/// Grains are moved when the largest share of the work is larger than it could be by more than this.
constexpr double worthwhile_gain = 0.05;

} // namespace

/// Roots: all nodes, on rank 0. Leaves: each rank's own, grain by grain.
std::unique_ptr<StarForest> Stepper::forest_from_root() const {
  const std::vector<std::int64_t> first = packing_.first_nodes();
  std::vector<RootPlace> roots;
  for (const int g : layout_.grains()) {
    for (std::int64_t node = first[g]; node < first[g + 1]; ++node) {
      roots.push_back({0, static_cast<int>(node)});
    }
  }
  return make_star_forest(ranks().is_root() ? static_cast<int>(first.back()) : 0, roots);
}

/// This rank's nodes as they are stored, in the packing's order.
std::vector<std::byte> Stepper::own_nodes() const {
  const std::size_t size = state_.node_bytes();
  std::vector<std::byte> own;
  for (const int g : layout_.grains()) {
    own.resize(own.size() + size * layout_.n_nodes(g));
    state_.pack(g, own.data() + own.size() - size * layout_.n_nodes(g));
  }
  return own;
}

void Stepper::scatter_nodes(const std::vector<std::byte>& all) {
  const std::size_t size = state_.node_bytes();
  std::vector<std::byte> own;
  if (ranks().is_distributed()) {
    own.resize(size * distribution_.ownership.n_nodes_of(ranks().rank()));
    forest_from_root()->copy(size, all.data(), own.data());
  }
  const std::byte* from = ranks().is_distributed() ? own.data() : all.data();
  for (const int g : layout_.grains()) {
    state_.unpack(g, from);
    from += size * layout_.n_nodes(g);
  }
}

void Stepper::gather(std::vector<Vector3>& values) const {
  if (ranks().is_distributed()) {
    std::vector<Vector3> all(ranks().is_root() ? packing_.first_nodes().back() : 0);
    forest_from_root()->collect(sizeof(Vector3), values.data(), all.data());
    values.swap(all);
  }
}

void Stepper::share_grains(std::vector<Vector3>& values) const {
  ranks().share_rows({values.data()->data(), 3 * values.size()}, 3, distribution_.ownership);
}

ForceField::Stretch Stepper::largest_stretch() const {
  ForceField::Stretch largest;
  if (!layout_.grains().empty()) {
    largest = forces_.largest_stretch(state_, box_);
  }
  const double not_a_number = std::isnan(largest.ratio) ? 1.0 : 0.0;
  double values[2] = {not_a_number, not_a_number > 0.0 ? 0.0 : largest.ratio};
  ranks().largest(values);
  const bool is_largest = values[0] > 0.0 ? not_a_number > 0.0 : largest.ratio == values[1];
  // Of several the one whose grain comes first.
  const double grain = ranks().smallest(is_largest ? largest.grain : layout_.n_grains());
  const double node = ranks().smallest(is_largest && largest.grain == grain ? largest.node : 1e15);
  return {values[0] > 0.0 ? std::nan("") : values[1], static_cast<int>(grain), static_cast<int>(node)};
}

Clamp Stepper::nodes_between(double low, double high) const {
  Clamp clamp = clamp_between(low, high, layout_, state_);
  share_clamp(clamp, distribution_, layout_.n_grains());
  return clamp;
}

PlacementInput Stepper::placement_input() const {
  PlacementInput input = {&packing_, ranks().size(), lanes_of_block(options_.precision),
                          std::vector<Vector3>(layout_.n_grains()), std::vector<double>(layout_.n_grains(), 0.0)};
  // The seconds that this rank has worked since the last look, spread over its grains by their nodes.
  const double worked = forces_.bond_seconds + forces_.contact_seconds + forces_.search_seconds + integration_seconds_;
  const double n_nodes = static_cast<double>(distribution_.ownership.n_nodes_of(ranks().rank()));
  for (const int g : layout_.grains()) {
    Vector3 centre = Vector3::Zero();
    for (int node = 0; node < layout_.n_nodes(g); ++node) {
      centre += state_.position(g, node);
    }
    input.fractional[g] = box_.to_fractional(centre / layout_.n_nodes(g));
    input.cost[g] = std::max(worked - worked_until_, 1e-9) * layout_.n_nodes(g) / n_nodes;
  }
  share_grains(input.fractional);
  ranks().share_rows(input.cost, 1, distribution_.ownership);
  return input;
}

void Stepper::rebalance() {
  if (!ranks().is_distributed()) {
    return;
  }
  const PlacementInput input = placement_input();
  worked_until_ = forces_.bond_seconds + forces_.contact_seconds + forces_.search_seconds + integration_seconds_;
  std::vector<int> owner = place_grains(input);
  if (imbalance(input, distribution_.ownership.owners()) > imbalance(input, owner) + worthwhile_gain) {
    move_grains(std::move(owner));
  }
}

void Stepper::move_grains(std::vector<int> owner) {
  if (!ranks().is_distributed()) {
    return;
  }
  const std::size_t size = state_.node_bytes();
  const ForceField::Results results = forces_.shared_results();
  const Ownership before = std::move(distribution_.ownership);
  const std::vector<int> n_nodes = packing_.nodes_of_grains();
  std::vector<Vector3> origins = state_.origins();
  ranks().share_rows({origins.data()->data(), 3 * origins.size()}, 3, before);
  std::vector<std::byte> old_nodes(size * before.n_nodes_of(ranks().rank()));
  for (const int g : layout_.grains()) {
    state_.pack(g, old_nodes.data() + size * before.first_node(g));
  }
  distribution_.ownership = Ownership(std::move(owner), ranks().size(), n_nodes);
  std::vector<RootPlace> roots;
  for (const int g : distribution_.ownership.grains_of(ranks().rank())) {
    for (int node = 0; node < n_nodes[g]; ++node) {
      roots.push_back({before.owner(g), static_cast<int>(before.first_node(g)) + node});
    }
    migrated_grains_ += before.owner(g) != ranks().rank() ? 1 : 0;
  }
  std::vector<std::byte> new_nodes(size * roots.size());
  make_star_forest(static_cast<int>(before.n_nodes_of(ranks().rank())), roots)
      ->copy(size, old_nodes.data(), new_nodes.data());

  layout_ = LaneLayout(packing_, options_.precision, distribution_.ownership.grains_of(ranks().rank()));
  state_.reset(packing_);
  state_.origins() = origins;
  const std::byte* from = new_nodes.data();
  for (const int g : layout_.grains()) {
    state_.unpack(g, from);
    from += size * n_nodes[g];
  }
  forces_.layout_changed();
  forces_.set_results(results);
}

} // namespace boba
