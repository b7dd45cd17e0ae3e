// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/pair_search.h"

#include "bpm/forces/node_pairs.h"

#include <algorithm>

namespace boba {

namespace {

using NodePairs = std::vector<kernels::NodePair>;

Vector3 lattice_vector(const Box& box, const ImageVector& n) {
  return box.h() * Vector3(n.a, n.b, n.c);
}

/// Adds the unbonded pairs of a node with those of its grain that are near a place where it is seen.
void add_partners_inside(const TrackedGrain& grain, std::int32_t i, const Vector3& place, double radius,
                         const NetworkData& network, NodePairs& pairs) {
  thread_local std::vector<std::int32_t> nodes;
  nodes.clear();
  add_nodes_near(grain.grid, place, radius, nodes);
  for (const std::int32_t j : nodes) {
    if (j != i && !std::binary_search(network.partners_begin(i), network.partners_end(i), j)) {
      pairs.push_back({std::min(i, j), std::max(i, j)});
    }
  }
}

/// Strikes out pairs that are bonded across the cell's boundary.
void remove_bonded(const ContactPair& pair, NodePairs& list, const NetworkData& network) {
  if (pair.a == pair.b && !pair.inside()) {
    const Eigen::Vector3i n(pair.image.a, pair.image.b, pair.image.c);
    std::erase_if(list, [&](const kernels::NodePair& nodes) { return network.bonded_across(nodes.i, nodes.j, n); });
  }
}

/// Adds pairs in any order to the candidates; `found` keeps those that are new.
void add_candidates(ContactPair& pair, NodePairs& found, const NetworkData& network) {
  remove_bonded(pair, found, network);
  insert_pairs(pair.candidates, found);
  pair.changed = pair.changed || !found.empty();
}

} // namespace

PairSearch::Kept PairSearch::update(ContactPair& pair, const Box& box, const NetworkData& network) const {
  Kept kept = {holds(pair) ? guarantee(pair, box) : 0.0, false};
  if (kept.distance < reach_.diameter() + reach_.reserve()) {
    search(pair, box, network);
    kept = {guarantee(pair, box), true};
  } else {
    add_moved(pair, network);
  }
  add_followed(pair, box, network);
  add_broken(pair);
  return kept;
}

/// False when places have changed in a way that the pair has to be searched again: all of a grain's are other ones, or
/// some have come into the gap that the search has found. (Where there is none, new places are looked up one by one.)
bool PairSearch::holds(const ContactPair& pair) const {
  const TrackedGrain &a = grains_[pair.a], &b = grains_[pair.b];
  if (!pair.searched || a.all_noted || b.all_noted) {
    return false;
  }
  const Gap& gap = pair.gap;
  if (gap.width() <= reach_.between()) {
    return true;
  }
  return std::all_of(a.moved_to.begin(), a.moved_to.end(),
                     [&](const Vector3& place) { return gap.normal.dot(pair.frame_a(place)) <= gap.last_of_a; }) &&
         std::all_of(b.moved_to.begin(), b.moved_to.end(),
                     [&](const Vector3& place) { return gap.normal.dot(pair.frame_b(place)) >= gap.first_of_b; });
}

/// Distance that the pair's unlisted nodes keep at present; nodes of the same grain reach_.later_inside() less.
///
/// A pair of nodes at the distance s >= apart when searched is now at least s (1 - e) - R - the two deviations,
/// with e the shortening of b's frame since then and R the largest relative displacement of the two frames where the
/// grains meet.
double PairSearch::guarantee(const ContactPair& pair, const Box& box) const {
  const TrackedGrain &a = grains_[pair.a], &b = grains_[pair.b];
  const GrainFrame moved_b = second_frame(pair, box).after(pair.frame_b.inverse());
  const double e = shortening(moved_b.linear);
  if (pair.inside()) {
    return pair.apart * (1.0 - e) - 2.0 * a.deviation + reach_.later_inside();
  }
  const GrainFrame moved_a = a.frame.after(pair.frame_a.inverse());
  double slid = 0.0;
  pair.zone.for_each_corner([&](const Vector3& x) { slid = std::max(slid, (moved_a(x) - moved_b(x)).norm()); });
  return pair.apart * (1.0 - e) - slid - a.deviation - b.deviation;
}

/// Radius that finds all nodes closer than the reach in space, where a frame has mapped the places that are searched.
double PairSearch::radius_in(const GrainFrame& frame) const {
  return reach_.between() / (1.0 - shortening(frame.linear));
}

GrainFrame PairSearch::second_frame(const ContactPair& pair, const Box& box) const {
  return grains_[pair.b].frame.displaced(lattice_vector(box, pair.image));
}

void PairSearch::search(ContactPair& pair, const Box& box, const NetworkData& network) const {
  const TrackedGrain &a = grains_[pair.a], &b = grains_[pair.b];
  pair.frame_a = a.frame;
  pair.frame_b = second_frame(pair, box);
  pair.searched = true;
  pair.changed = pair.changed || !pair.candidates.empty();
  pair.candidates.clear();
  if (pair.inside()) {
    pair.apart = reach_.inside();
    add_pairs_inside(a.grid, network, reach_.inside(), pair.candidates);
  } else {
    pair.gap = gap_between(a.grid, pair.frame_a, b.grid, pair.frame_b);
    pair.apart = std::max(reach_.between(), pair.gap.width());
    const Bounds of_a = a.grid.bounds().widened(reach_.bounds_margin).mapped(pair.frame_a);
    const Bounds of_b = b.grid.bounds().widened(reach_.bounds_margin).mapped(pair.frame_b);
    pair.bounds_a = of_a.widened(pair.apart);
    pair.bounds_b = of_b.widened(pair.apart);
    pair.zone = {of_a.low.cwiseMax(pair.bounds_b.low), of_a.high.cwiseMin(pair.bounds_b.high)};
    const bool meet = (pair.zone.high - pair.zone.low).minCoeff() > 0.0;
    if (meet && pair.apart <= reach_.between()) {
      add_pairs_between(a.grid, b.grid, pair.frame_a.inverse().after(pair.frame_b), radius_in(pair.frame_a),
                        pair.candidates);
    } else if (!meet) {
      pair.zone = of_a;
    }
  }
  remove_bonded(pair, pair.candidates, network);
  sort_pairs(pair.candidates, layout_.n_nodes(pair.a));
  pair.changed = pair.changed || !pair.candidates.empty();
}

void PairSearch::add_moved(ContactPair& pair, const NetworkData& network) const {
  thread_local std::vector<kernels::NodePair> found;
  found.clear();
  pair.inside() ? add_moved_inside(pair, network, found) : add_moved_between(pair, found);
  if (!found.empty()) {
    add_candidates(pair, found, network);
  }
}

void PairSearch::add_moved_inside(const ContactPair& pair, const NetworkData& network, NodePairs& found) const {
  const TrackedGrain& grain = grains_[pair.a];
  for (std::size_t k = 0; k < grain.moved.size(); ++k) {
    add_partners_inside(grain, grain.moved[k], grain.moved_to[k], reach_.inside(), network, found);
  }
}

void PairSearch::add_moved_between(const ContactPair& pair, NodePairs& found) const {
  thread_local std::vector<std::int32_t> nodes;
  /// Calls add(node, other node) for the grain's moved nodes and the other grain's nodes near them.
  const auto look_up = [&](int grain, const GrainFrame& frame, int other, const GrainFrame& other_frame,
                           const Bounds& other_bounds, const auto& add) {
    for (std::size_t k = 0; k < grains_[grain].moved.size(); ++k) {
      const std::int32_t node = grains_[grain].moved[k];
      const Vector3 x = frame(grains_[grain].moved_to[k]);
      if (other_bounds.contains(x)) {
        nodes.clear();
        add_nodes_near(grains_[other].grid, other_frame.inverse()(x), radius_in(other_frame), nodes);
        for (const std::int32_t near : nodes) {
          add(node, near);
        }
      }
    }
  };
  look_up(pair.a, pair.frame_a, pair.b, pair.frame_b, pair.bounds_b, [&](std::int32_t i, std::int32_t j) {
    found.push_back({i, j});
  });
  look_up(pair.b, pair.frame_b, pair.a, pair.frame_a, pair.bounds_a, [&](std::int32_t j, std::int32_t i) {
    found.push_back({i, j});
  });
}

void PairSearch::add_broken(ContactPair& pair) const {
  const NodePairs& broken = broken_[pair.a];
  if (!pair.inside() || broken.empty()) {
    return;
  }
  thread_local NodePairs found;
  found.assign(broken.begin(), broken.end());
  insert_pairs(pair.candidates, found);
  pair.changed = pair.changed || !found.empty();
  if (!grains_[pair.a].followed.empty()) {
    found.assign(broken.begin(), broken.end());
    insert_pairs(pair.followed, found);
  }
}

void PairSearch::add_followed(ContactPair& pair, const Box& box, const NetworkData& network) const {
  pair.followed.clear();
  pair.inside() ? add_followed_inside(pair, network) : add_followed_between(pair, box);
  if (pair.followed.empty()) {
    return;
  }
  remove_bonded(pair, pair.followed, network);
  sort_pairs(pair.followed, layout_.n_nodes(pair.a));
  thread_local NodePairs found;
  found.assign(pair.followed.begin(), pair.followed.end());
  add_candidates(pair, found, network);
}

void PairSearch::add_followed_inside(ContactPair& pair, const NetworkData& network) const {
  const TrackedGrain& grain = grains_[pair.a];
  for (std::size_t k = 0; k < grain.followed.size(); ++k) {
    add_partners_inside(grain, grain.followed[k], grain.followed_at[k], radius_in(grain.frame), network, pair.followed);
  }
}

void PairSearch::add_followed_between(ContactPair& pair, const Box& box) const {
  thread_local std::vector<std::int32_t> nodes;
  const GrainFrame frame_a = grains_[pair.a].frame, frame_b = second_frame(pair, box);
  /// Calls add(node, other node) for the followed nodes of one grain and the nodes of the other near them.
  const auto look_up = [&](int grain, const GrainFrame& frame, int other, const GrainFrame& other_frame,
                           const auto& add) {
    if (grains_[grain].followed.empty()) {
      return;
    }
    const GrainFrame to_other = other_frame.inverse().after(frame);
    const double radius = radius_in(other_frame);
    const Bounds bounds = grains_[other].grid.bounds().widened(reach_.bounds_margin + radius);
    for (std::size_t k = 0; k < grains_[grain].followed.size(); ++k) {
      const Vector3 x = to_other(grains_[grain].followed_at[k]);
      if (bounds.contains(x)) {
        nodes.clear();
        add_nodes_near(grains_[other].grid, x, radius, nodes);
        for (const std::int32_t near : nodes) {
          add(grains_[grain].followed[k], near);
        }
      }
    }
  };
  look_up(pair.a, frame_a, pair.b, frame_b, [&](std::int32_t i, std::int32_t j) { pair.followed.push_back({i, j}); });
  look_up(pair.b, frame_b, pair.a, frame_a, [&](std::int32_t j, std::int32_t i) { pair.followed.push_back({i, j}); });
}

} // namespace boba
