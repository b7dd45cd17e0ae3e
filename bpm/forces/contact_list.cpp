// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of grains: what they list and how long that lasts. Which pairs there are is in contact_neighbours.cpp; grains
// are followed in contact_tracking.cpp.
#include "bpm/forces/contact_list.h"

#include "bpm/forces/node_pairs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace boba {

namespace {

/// Margins for packings of single nodes, where wide ones would make neighbours of everybody, d.
constexpr double bounds_margin_of_nodes = 0.02, neighbour_margin_of_nodes = 0.2;

Vector3 lattice_vector(const Box& box, const ImageVector& n) {
  return box.h() * Vector3(n.a, n.b, n.c);
}

} // namespace

ContactList::ContactList(const LaneLayout& layout, const kernels::KernelTable& table, const ContactRanges& ranges,
                         double skin, const Distribution& distribution)
    : layout_(layout), table_(table), diameter_(ranges.between), inner_diameter_(ranges.inside), skin_(skin),
      skin_between_(between_share * skin), fast_motion_(0.1 * reserve()), distribution_(distribution) {
  layout_changed();
  for (const Block& block : layout.blocks()) {
    if (static_cast<std::int64_t>(block.n_nodes) * block.n_lanes > std::numeric_limits<std::int32_t>::max()) {
      throw std::invalid_argument("contact list: a grain has more than 2.6e8 nodes, the most that are handled");
    }
  }
  bool only_nodes = true; // all grains of the packing: every rank must decide alike
  for (int g = 0; g < layout.n_grains(); ++g) {
    only_nodes = only_nodes && layout.n_nodes(g) == 1;
  }
  if (only_nodes) {
    bounds_margin_ = bounds_margin_of_nodes;
    neighbour_margin_ = neighbour_margin_of_nodes;
  }
}

void ContactList::layout_changed() {
  place_.assign(layout_.size(), 0.0f);
  grains_.assign(layout_.n_grains(), {});
  sides_.assign(layout_.n_grains(), {});
  near_sides_.assign(layout_.n_grains(), {});
  pairs_.clear();
  ghosts_.clear();
  invalidate();
}

/// Distance that two nodes keep at least which were `distance` apart, once the cell has been mapped and each node has
/// moved by `moved` beyond that.
double ContactList::kept_distance(double distance, const Matrix3& cell, double moved) {
  return (1.0 - (cell - Matrix3::Identity()).norm()) * distance - 2.0 * moved;
}

bool ContactList::update(const LaneState& state, const Box& box, const Networks& network_of_grain) {
  if (built_ && kept_distance(guaranteed_, cell_since_tracking_, motion_since_update_) >= diameter_ &&
      kept_distance(followed_guaranteed_, cell_since_tracking_, motion_of_followed_) >= diameter_) {
    if (!broken_changed_) {
      return false;
    }
    list_broken();
    return true;
  }
  track(state);
  double guaranteed = built_ ? neighbour_guarantee(box) : 0.0;
  if (guaranteed < reach_between()) {
    find_neighbours(box);
    guaranteed = neighbour_guarantee(box);
  }
  follow_ghosts();
  guaranteed = std::min(guaranteed, bring_pairs_up_to_date(box, network_of_grain));
  relist_all();
  note_counts();
  choose_fast_motion();
  for (TrackedGrain& grain : grains_) {
    grain.all_noted = false;
    grain.moved.clear();
    grain.moved_to.clear();
  }
  double lost[2] = {-followed_guarantee(), -guaranteed};
  distribution_.ranks->largest(lost);
  followed_guaranteed_ = -lost[0];
  guaranteed_ = -std::max(lost[0], lost[1]);
  motion_since_update_ = 0.0;
  motion_of_followed_ = 0.0;
  cell_since_tracking_ = Matrix3::Identity();
  built_ = true;
  broken_changed_ = false;
  return true;
}

/// Searches the pairs whose candidates no longer hold, and adds what moved, what is followed and what broke to all.
/// Returns the least distance that unlisted nodes of any pair keep, d.
double ContactList::bring_pairs_up_to_date(const Box& box, const Networks& network_of_grain) {
  const int n_pairs = static_cast<int>(pairs_.size());
  double guaranteed = std::numeric_limits<double>::infinity();
  std::int64_t searched = 0;
#pragma omp parallel for schedule(dynamic, 4) reduction(min : guaranteed) reduction(+ : searched)
  for (int p = 0; p < n_pairs; ++p) {
    ContactPair& pair = pairs_[p];
    double kept = search_holds(pair) ? guarantee(pair, box) : 0.0;
    if (kept < diameter_ + reserve()) {
      search(pair, box, *network_of_grain[pair.a]);
      kept = guarantee(pair, box);
      ++searched;
    } else {
      add_moved(pair, *network_of_grain[pair.a]);
    }
    add_followed(pair, box, *network_of_grain[pair.a]);
    add_broken(pair);
    guaranteed = std::min(guaranteed, kept);
  }
  counts_.pairs += searched;
  return guaranteed;
}

/// The nodes in candidates of every grain whose pairs changed, those of other ranks included.
void ContactList::relist_all() {
#pragma omp parallel for schedule(dynamic, 1)
  for (const int g : layout_.grains()) {
    relist(g);
  }
#pragma omp parallel for schedule(dynamic, 1)
  for (const int g : ghosts_) {
    relist(g);
  }
  for (ContactPair& pair : pairs_) {
    pair.changed = false;
  }
}

void ContactList::note_counts() {
  ++counts_.updates;
  for (const int g : layout_.grains()) {
    counts_.grains += grains_[g].all_noted ? 1 : 0;
    counts_.nodes += static_cast<std::int64_t>(grains_[g].moved.size());
    counts_.followed += static_cast<std::int64_t>(grains_[g].followed.size());
  }
}

/// Broken bonds of a grain are always candidates. With nodes that move fast they are always near too, since that is
/// what followed nodes are not watched for.
void ContactList::add_broken(ContactPair& pair) {
  const TrackedGrain& grain = grains_[pair.a];
  if (!pair.inside() || grain.broken.empty()) {
    return;
  }
  thread_local NodePairs found;
  found.assign(grain.broken.begin(), grain.broken.end());
  insert_pairs(pair.candidates, found);
  pair.changed = pair.changed || !found.empty();
  if (!grain.followed.empty()) {
    found.assign(grain.broken.begin(), grain.broken.end());
    insert_pairs(pair.followed, found);
  }
}

/// The same while all else of the list holds.
void ContactList::list_broken() {
  for (ContactPair& pair : pairs_) {
    add_broken(pair);
  }
  relist_all();
  broken_changed_ = false;
}

void ContactList::note_motion(const Matrix3& cell_map, double farthest, double common) {
  if (built_) {
    cell_since_tracking_ = cell_map * cell_since_tracking_;
    cell_since_neighbours_ = cell_map * cell_since_neighbours_;
    cell_since_near_ = cell_map * cell_since_near_;
    const double change = (cell_map - Matrix3::Identity()).norm(), stretch = 1.0 + change;
    last_approach_ = change * diameter_ + 2.0 * common;
    motion_since_near_ = motion_since_near_ * stretch + common;
    motion_since_update_ = motion_since_update_ * stretch + common;
    motion_of_followed_ = motion_of_followed_ * stretch + farthest;
  }
}

GrainFrame ContactList::second_frame(const ContactPair& pair, const Box& box) const {
  return grains_[pair.b].frame.displaced(lattice_vector(box, pair.image));
}

/// False when places have changed in a way that the pair has to be searched again: all of a grain's are other ones, or
/// some have come into the gap that the search has found. (Where there is none, new places are looked up one by one.)
bool ContactList::search_holds(const ContactPair& pair) const {
  const TrackedGrain &a = grains_[pair.a], &b = grains_[pair.b];
  if (!pair.searched || a.all_noted || b.all_noted) {
    return false;
  }
  const Gap& gap = pair.gap;
  if (gap.width() <= reach_between()) {
    return true;
  }
  return std::all_of(a.moved_to.begin(), a.moved_to.end(),
                     [&](const Vector3& place) { return gap.normal.dot(pair.frame_a(place)) <= gap.last_of_a; }) &&
         std::all_of(b.moved_to.begin(), b.moved_to.end(),
                     [&](const Vector3& place) { return gap.normal.dot(pair.frame_b(place)) >= gap.first_of_b; });
}

/// Distance that the pair's unlisted nodes keep at present; nodes of the same grain later_inside() less.
///
/// A pair of nodes at the distance s >= apart when searched is now at least s (1 - e) - R - the two deviations,
/// with e the shortening of b's frame since then and R the largest relative displacement of the two frames where the
/// grains meet.
double ContactList::guarantee(const ContactPair& pair, const Box& box) const {
  const TrackedGrain &a = grains_[pair.a], &b = grains_[pair.b];
  const GrainFrame moved_b = second_frame(pair, box).after(pair.frame_b.inverse());
  const double e = shortening(moved_b.linear);
  if (pair.inside()) {
    return pair.apart * (1.0 - e) - 2.0 * a.deviation + later_inside();
  }
  const GrainFrame moved_a = a.frame.after(pair.frame_a.inverse());
  double slid = 0.0;
  pair.zone.for_each_corner([&](const Vector3& x) { slid = std::max(slid, (moved_a(x) - moved_b(x)).norm()); });
  return pair.apart * (1.0 - e) - slid - a.deviation - b.deviation;
}

/// Radius that finds all nodes closer than the reach in space, where a frame has mapped the places that are searched.
double ContactList::radius_in(const GrainFrame& frame) const {
  return reach_between() / (1.0 - shortening(frame.linear));
}

void ContactList::search(ContactPair& pair, const Box& box, const NetworkData& network) {
  const TrackedGrain &a = grains_[pair.a], &b = grains_[pair.b];
  pair.frame_a = a.frame;
  pair.frame_b = second_frame(pair, box);
  pair.searched = true;
  pair.changed = pair.changed || !pair.candidates.empty();
  pair.candidates.clear();
  if (pair.inside()) {
    pair.apart = reach_inside();
    add_pairs_inside(a.grid, network, reach_inside(), pair.candidates);
  } else {
    pair.gap = gap_between(a.grid, pair.frame_a, b.grid, pair.frame_b);
    pair.apart = std::max(reach_between(), pair.gap.width());
    const Bounds of_a = a.grid.bounds().widened(bounds_margin_).mapped(pair.frame_a);
    const Bounds of_b = b.grid.bounds().widened(bounds_margin_).mapped(pair.frame_b);
    pair.bounds_a = of_a.widened(pair.apart);
    pair.bounds_b = of_b.widened(pair.apart);
    pair.zone = {of_a.low.cwiseMax(pair.bounds_b.low), of_a.high.cwiseMin(pair.bounds_b.high)};
    const bool meet = (pair.zone.high - pair.zone.low).minCoeff() > 0.0;
    if (meet && pair.apart <= reach_between()) {
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

void ContactList::add_moved(ContactPair& pair, const NetworkData& network) {
  thread_local std::vector<kernels::NodePair> found;
  found.clear();
  pair.inside() ? add_moved_inside(pair, network, found) : add_moved_between(pair, found);
  if (!found.empty()) {
    add_candidates(pair, found, network);
  }
}

void ContactList::add_moved_inside(const ContactPair& pair, const NetworkData& network, NodePairs& found) const {
  const TrackedGrain& grain = grains_[pair.a];
  for (std::size_t k = 0; k < grain.moved.size(); ++k) {
    add_partners_inside(grain, grain.moved[k], grain.moved_to[k], reach_inside(), network, found);
  }
}

void ContactList::add_partners_inside(const TrackedGrain& grain, std::int32_t i, const Vector3& place, double radius,
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

void ContactList::add_moved_between(const ContactPair& pair, NodePairs& found) const {
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

/// Strikes out pairs that are bonded across the cell's boundary.
void ContactList::remove_bonded(const ContactPair& pair, NodePairs& list, const NetworkData& network) {
  if (pair.a == pair.b && !pair.inside()) {
    const Eigen::Vector3i n(pair.image.a, pair.image.b, pair.image.c);
    std::erase_if(list, [&](const kernels::NodePair& nodes) { return network.bonded_across(nodes.i, nodes.j, n); });
  }
}

/// Adds pairs in any order to the candidates; `found` keeps those that are new.
void ContactList::add_candidates(ContactPair& pair, NodePairs& found, const NetworkData& network) {
  remove_bonded(pair, found, network);
  insert_pairs(pair.candidates, found);
  pair.changed = pair.changed || !found.empty();
}

void ContactList::relist(int g) {
  if (std::any_of(sides_[g].begin(), sides_[g].end(),
                  [&](const ContactSide& side) { return pairs_[side.pair].changed; })) {
    grains_[g].listed = nodes_in(g, &ContactPair::candidates);
  }
}

/// Nodes of a grain in one of the lists of its pairs, ascending.
std::vector<std::int32_t> ContactList::nodes_in(int g, std::vector<kernels::NodePair> ContactPair::*list) const {
  thread_local std::vector<std::uint64_t> in_list; // one bit a node
  in_list.assign((layout_.n_nodes(g) + 63) / 64, 0);
  for (const ContactSide& side : sides_[g]) {
    for (const kernels::NodePair& nodes : pairs_[side.pair].*list) {
      const std::int32_t node = side.sign > 0.0 ? nodes.i : nodes.j;
      in_list[node / 64] |= std::uint64_t{1} << (node % 64);
    }
  }
  std::vector<std::int32_t> nodes;
  for (std::size_t word = 0; word < in_list.size(); ++word) {
    for (std::uint64_t left = in_list[word]; left != 0; left &= left - 1) {
      nodes.push_back(static_cast<std::int32_t>(64 * word) + std::countr_zero(left));
    }
  }
  return nodes;
}

bool ContactList::near_holds() const {
  return kept_distance(near_reach_, cell_since_near_, motion_since_near_) >= diameter_;
}

void ContactList::begin_near() {
  near_reach_ = std::min(guaranteed_, diameter_ + std::max(least_near_margin, near_steps * last_approach_));
  motion_since_near_ = 0.0;
  cell_since_near_ = Matrix3::Identity();
}

void ContactList::list_near() {
#pragma omp parallel for schedule(dynamic, 1)
  for (const int g : layout_.grains()) {
    grains_[g].near = nodes_in(g, &ContactPair::near);
    near_sides_[g].clear();
    std::copy_if(sides_[g].begin(), sides_[g].end(), std::back_inserter(near_sides_[g]),
                 [&](const ContactSide& side) { return !pairs_[side.pair].near.empty(); });
  }
  for (const int g : ghosts_) {
    grains_[g].near = nodes_in(g, &ContactPair::near);
  }
}

std::int64_t ContactList::n_candidates() const {
  std::int64_t n = 0;
  for (const ContactPair& pair : pairs_) {
    n += static_cast<std::int64_t>(pair.candidates.size());
  }
  return n;
}

std::size_t ContactList::bytes() const {
  std::size_t bytes = place_.capacity() * sizeof(float);
  for (const TrackedGrain& grain : grains_) {
    bytes += grain.grid.bytes() + (grain.listed.capacity() + grain.near.capacity()) * sizeof(std::int32_t);
  }
  for (const ContactPair& pair : pairs_) {
    bytes += (pair.candidates.capacity() + pair.near.capacity()) * sizeof(kernels::NodePair) +
             pair.touches.capacity() * sizeof(kernels::Touch);
  }
  return bytes;
}

} // namespace boba
