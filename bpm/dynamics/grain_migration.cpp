// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/grain_migration.h"

#include "bpm/dynamics/node_exchange.h"
#include "bpm/parallel/placement.h"
#include "bpm/parallel/star_forest.h"

#include <algorithm>
#include <cstring>
#include <memory>

namespace boba {

namespace {

/// Grains are moved when the largest share of the work is larger than it could be by more than this.
constexpr double worthwhile_gain = 0.05;

double seconds_worked(const MovingPacking& moving) {
  const ForceField::Seconds& seconds = moving.forces.seconds();
  return seconds.bonds + seconds.contacts + seconds.search + moving.integration_seconds;
}

/// Where the grains are and what they cost; `worked`: seconds that this rank spent on its grains, spread by their
/// nodes.
PlacementInput placement_input(const MovingPacking& moving, double worked) {
  const LaneLayout& layout = moving.layout;
  PlacementInput input = {&moving.packing, moving.ranks().size(), lanes_of_block(moving.options.precision),
                          std::vector<Vector3>(layout.n_grains()), std::vector<double>(layout.n_grains(), 0.0)};
  const auto n_nodes = static_cast<double>(moving.distribution.ownership.n_nodes_of(moving.ranks().rank()));
  for (const int g : layout.grains()) {
    Vector3 centre = Vector3::Zero();
    for (int node = 0; node < layout.n_nodes(g); ++node) {
      centre += moving.state.position(g, node);
    }
    input.fractional[g] = moving.cell.box().to_fractional(centre / layout.n_nodes(g));
    input.cost[g] = std::max(worked, 1e-9) * layout.n_nodes(g) / n_nodes;
  }
  share_grains(moving, input.fractional);
  moving.ranks().share_rows(input.cost, 1, moving.distribution.ownership);
  return input;
}

/// Rows of `size` bytes, one for each node of the grains that `now` gives to this rank, grain by grain, from their
/// owners before, where pack(grain, to) writes them.
template <class Pack>
std::vector<std::byte> fetch_rows(const MovingPacking& moving, std::size_t size, const Ownership& before,
                                  const Ownership& now, Pack&& pack) {
  std::vector<std::byte> old_nodes(size * before.n_nodes_of(moving.ranks().rank()));
  for (const int g : moving.layout.grains()) {
    pack(g, old_nodes.data() + size * before.first_node(g));
  }
  const std::vector<int> n_nodes = moving.packing.nodes_of_grains();
  std::vector<RootPlace> roots;
  for (const int g : now.grains_of(moving.ranks().rank())) {
    for (int node = 0; node < n_nodes[g]; ++node) {
      roots.push_back({before.owner(g), static_cast<int>(before.first_node(g)) + node});
    }
  }
  std::vector<std::byte> new_nodes(size * roots.size());
  make_star_forest(static_cast<int>(before.n_nodes_of(moving.ranks().rank())), roots)
      ->copy(size, old_nodes.data(), new_nodes.data());
  return new_nodes;
}

} // namespace

void LoadBalance::rebalance(MovingPacking& moving) {
  if (!moving.ranks().is_distributed()) {
    return;
  }
  const double worked = seconds_worked(moving);
  const PlacementInput input = placement_input(moving, worked - worked_until_);
  worked_until_ = worked;
  std::vector<int> owner = place_grains(input);
  if (imbalance(input, moving.distribution.ownership.owners()) > imbalance(input, owner) + worthwhile_gain) {
    move_grains(moving, std::move(owner));
  }
}

void move_grains(MovingPacking& moving, std::vector<int> owner) {
  if (!moving.ranks().is_distributed()) {
    return;
  }
  const ForceSums sums = moving.forces.shared_sums();
  std::vector<Vector3> origins = moving.state.origins();
  share_grains(moving, origins);
  const int rank = moving.ranks().rank();
  Ownership now(std::move(owner), moving.ranks().size(), moving.packing.nodes_of_grains());
  const Ownership& before = moving.distribution.ownership;
  const std::vector<std::byte> nodes = fetch_rows(moving, moving.state.node_bytes(), before, now,
                                                  [&](int g, std::byte* to) { moving.state.pack(g, to); });
  const std::size_t memory_bytes = sizeof(double) * static_cast<std::size_t>(moving.layout.memory_slots());
  std::vector<std::byte> memory;
  if (memory_bytes > 0) {
    memory = fetch_rows(moving, memory_bytes, before, now, [&](int g, std::byte* to) {
      const std::vector<double> rows = moving.state.memory_rows(g);
      std::memcpy(to, rows.data(), rows.size() * sizeof(double));
    });
  }
  for (const int g : now.grains_of(rank)) {
    moving.migrated_grains += moving.distribution.ownership.owner(g) != rank ? 1 : 0;
  }
  moving.distribution.ownership = std::move(now);

  moving.layout = LaneLayout(moving.packing, moving.options.precision, moving.distribution.ownership.grains_of(rank));
  moving.state.reset(moving.packing);
  moving.state.origins() = origins;
  const std::byte* from = nodes.data();
  for (const int g : moving.layout.grains()) {
    moving.state.unpack(g, from);
    from += moving.state.node_bytes() * moving.layout.n_nodes(g);
  }
  std::size_t row = 0;
  for (const int g : moving.layout.grains()) {
    if (memory_bytes > 0) {
      std::vector<double> rows(memory_bytes / sizeof(double) * moving.layout.n_nodes(g));
      std::memcpy(rows.data(), memory.data() + memory_bytes * row, rows.size() * sizeof(double));
      moving.state.set_memory_rows(g, rows.data());
      row += moving.layout.n_nodes(g);
    }
  }
  moving.forces.layout_changed();
  moving.forces.set_sums(sums);
}

} // namespace boba
