// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes that a contact list follows by themselves. One node in a thousand, loosely bonded at a surface, moves several
// times farther in a step than the rest. Were it to count as all do, the list would have to be brought up to date
// several times as often: these nodes are looked up from where they are, with all of the reach, and have a bound of
// their own.
#include "bpm/forces/grain_tracking.h"

#include <algorithm>

namespace boba {

namespace {

/// Share of a grain's nodes above which none of it is followed: then they all move far.
constexpr double largest_followed_share = 0.02;
/// Updates of the list for which a node is followed after it moved far.
constexpr int updates_followed = 10;
/// Shares of the nodes between which the number of followed ones is to stay, and what moves it there.
constexpr double few_followed = 0.002, many_followed = 0.004, adjustment = 1.15;
/// Steps for which a list can stay at best: to follow more nodes than it takes for that would be in vain.
constexpr double longest_stay = 40.0;
/// How often the same nodes are written down before the rest is left out.
constexpr std::size_t records_per_node = 64;

std::size_t most_followed(int n_nodes) {
  return static_cast<std::size_t>(largest_followed_share * n_nodes);
}

} // namespace

bool GrainTracking::follows(int grain, std::int32_t node) const {
  return std::binary_search(grains_[grain].followed.begin(), grains_[grain].followed.end(), node);
}

void GrainTracking::note_fast_node(int g, std::int32_t node) {
  TrackedGrain& grain = grains_[g];
  if (grain.fast.size() < records_per_node * (most_followed(layout_.n_nodes(g)) + 1)) {
    grain.fast.push_back(node);
  }
}

/// Chooses the nodes of a grain that are followed until the next update, and finds out where they are.
void GrainTracking::follow(int g, const LaneState& state) {
  TrackedGrain& grain = grains_[g];
  std::sort(grain.fast.begin(), grain.fast.end());
  grain.fast.erase(std::unique(grain.fast.begin(), grain.fast.end()), grain.fast.end());
  std::vector<std::int32_t> nodes = grain.fast;
  std::vector<int> left(nodes.size(), updates_followed);
  for (std::size_t k = 0; k < grain.followed.size(); ++k) {
    if (grain.updates_left[k] > 1 && !std::binary_search(grain.fast.begin(), grain.fast.end(), grain.followed[k])) {
      const auto at = std::lower_bound(nodes.begin(), nodes.end(), grain.followed[k]);
      left.insert(left.begin() + (at - nodes.begin()), grain.updates_left[k] - 1);
      nodes.insert(at, grain.followed[k]);
    }
  }
  grain.fast.clear();
  if (nodes.size() > most_followed(layout_.n_nodes(g))) {
    grain.too_many_fast = true;
    nodes.clear();
    left.clear();
  }
  grain.followed = std::move(nodes);
  grain.updates_left = std::move(left);
  const GrainFrame back = grain.frame.inverse();
  grain.followed_at.clear();
  for (const std::int32_t node : grain.followed) {
    grain.followed_at.push_back(back(state.position(g, node)));
  }
}

void GrainTracking::choose_fast_motion() {
  double followed = 0.0, nodes = 0.0;
  for (const int g : layout_.grains()) {
    followed += grains_[g].too_many_fast ? layout_.n_nodes(g) : static_cast<double>(grains_[g].followed.size());
    nodes += layout_.n_nodes(g);
    grains_[g].too_many_fast = false;
  }
  if (followed > many_followed * nodes) {
    fast_motion_ *= adjustment;
  } else if (followed < few_followed * nodes) {
    fast_motion_ = std::max(fast_motion_ / adjustment, 0.5 * reach_.reserve() / longest_stay);
  }
}

double GrainTracking::followed_guarantee() const {
  double deviation = 0.0;
  for (const TrackedGrain& grain : grains_) {
    deviation = std::max(deviation, grain.deviation);
  }
  return reach_.between() - deviation;
}

} // namespace boba
