// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/scaling/count_halo.h"

#include "bpm/dynamics/take_snapshot.h"
#include "bpm/parallel/placement.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace boba::bench {

namespace {

PlacementInput placement_of(const Stepper& stepper, int n_ranks) {
  const Packing& packing = stepper.packing();
  const Snapshot snapshot = take_snapshot(stepper.moving(), {});
  PlacementInput input = {&packing, n_ranks, lanes_of_block(stepper.options().precision), {}, {}};
  for (int g = 0; g < packing.n_grains(); ++g) {
    input.fractional.push_back(snapshot.box.to_fractional(snapshot.grain_centre[g]));
    input.cost.push_back(packing.template_of(g).n_nodes());
  }
  return input;
}

} // namespace

HaloCount count_halo(const Stepper& stepper, int n_ranks) {
  const PlacementInput input = placement_of(stepper, n_ranks);
  const std::vector<int> owner = place_grains(input);
  // Per rank and ghost: which of its nodes stand in a candidate.
  std::vector<std::map<int, std::set<std::int32_t>>> wanted(n_ranks);
  for (const ContactPair& pair : stepper.forces().contact_list().pairs()) {
    const int of_a = owner[pair.a], of_b = owner[pair.b];
    for (const kernels::NodePair& nodes : pair.candidates) {
      if (of_a != of_b) {
        wanted[of_a][pair.b].insert(nodes.j);
        wanted[of_b][pair.a].insert(nodes.i);
      }
    }
  }
  HaloCount count;
  count.n_ranks = n_ranks;
  count.imbalance = imbalance(input, owner);
  for (const auto& ghosts : wanted) {
    std::set<int> from;
    double nodes = 0.0;
    for (const auto& [ghost, listed] : ghosts) {
      from.insert(owner[ghost]);
      nodes += static_cast<double>(listed.size());
    }
    count.mean_messages += static_cast<double>(from.size()) / n_ranks;
    count.mean_nodes += nodes / n_ranks;
    count.most_nodes = std::max(count.most_nodes, nodes);
    count.mean_ghosts += static_cast<double>(ghosts.size()) / n_ranks;
  }
  return count;
}

} // namespace boba::bench
