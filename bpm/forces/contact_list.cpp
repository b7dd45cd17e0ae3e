// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/contact_list.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace boba {

namespace {

/// Margins for packings of single nodes, where wide ones would make neighbours of everybody, d.
constexpr double bounds_margin_of_nodes = 0.02, neighbour_margin_of_nodes = 0.2;

ContactReach reach_for(const LaneLayout& layout, const ContactRanges& ranges, double skin) {
  ContactReach reach(ranges, skin);
  bool only_nodes = true; // all grains of the packing: every rank must decide alike
  for (int g = 0; g < layout.n_grains(); ++g) {
    only_nodes = only_nodes && layout.n_nodes(g) == 1;
  }
  if (only_nodes) {
    reach.bounds_margin = bounds_margin_of_nodes;
    reach.neighbour_margin = neighbour_margin_of_nodes;
  }
  return reach;
}

/// Distance that two nodes keep at least which were `distance` apart, once the cell has been mapped and each node has
/// moved by `moved` beyond that.
double kept_distance(double distance, const Matrix3& cell, double moved) {
  return (1.0 - (cell - Matrix3::Identity()).norm()) * distance - 2.0 * moved;
}

} // namespace

ContactList::ContactList(const LaneLayout& layout, const kernels::KernelTable& table, const ContactRanges& ranges,
                         double skin, const Distribution& distribution)
    : layout_(layout), distribution_(distribution), reach_(reach_for(layout, ranges, skin)),
      tracking_(layout, table, reach_), search_(layout, reach_, tracking_.grains()),
      grain_pairs_(layout, reach_, distribution), ghosts_(layout, reach_, distribution) {
  layout_changed();
  for (const Block& block : layout.blocks()) {
    if (static_cast<std::int64_t>(block.n_nodes) * block.n_lanes > std::numeric_limits<std::int32_t>::max()) {
      throw std::invalid_argument("contact list: a grain has more than 2.6e8 nodes, the most that are handled");
    }
  }
}

void ContactList::layout_changed() {
  tracking_.layout_changed();
  search_.layout_changed();
  grain_pairs_.layout_changed();
  ghosts_.layout_changed();
  listed_.assign(layout_.n_grains(), {});
  near_.assign(layout_.n_grains(), {});
  near_sides_.assign(layout_.n_grains(), {});
  invalidate();
}

bool ContactList::holds() const {
  return built_ && kept_distance(guaranteed_, cell_since_update_, motion_since_update_) >= reach_.diameter() &&
         kept_distance(followed_guaranteed_, cell_since_update_, motion_of_followed_) >= reach_.diameter();
}

bool ContactList::update(const LaneState& state, const Box& box, const Networks& network_of_grain) {
  if (holds()) {
    if (!broken_changed_) {
      return false;
    }
    list_broken();
    return true;
  }
  tracking_.look(state, !built_);
  double guaranteed = built_ ? grain_pairs_.guarantee(tracking_.grains(), box) : 0.0;
  if (guaranteed < reach_.between()) {
    grain_pairs_.find(tracking_.grains(), box, !built_);
    ghosts_.find(pairs(), tracking_.grains(), !built_);
    guaranteed = grain_pairs_.guarantee(tracking_.grains(), box);
  }
  ghosts_.follow(tracking_);
  guaranteed = std::min(guaranteed, bring_pairs_up_to_date(box, network_of_grain));
  relist_all();
  note_counts();
  tracking_.choose_fast_motion();
  tracking_.forget_news();
  begin_bounds(guaranteed);
  return true;
}

/// From now on motion counts against what the pairs of this rank and of all others keep.
void ContactList::begin_bounds(double guaranteed) {
  double lost[2] = {-tracking_.followed_guarantee(), -guaranteed};
  distribution_.ranks->largest(lost);
  followed_guaranteed_ = -lost[0];
  guaranteed_ = -std::max(lost[0], lost[1]);
  motion_since_update_ = 0.0;
  motion_of_followed_ = 0.0;
  cell_since_update_ = Matrix3::Identity();
  built_ = true;
  broken_changed_ = false;
}

/// Returns the least distance that unlisted nodes of any pair keep, d.
double ContactList::bring_pairs_up_to_date(const Box& box, const Networks& network_of_grain) {
  std::vector<ContactPair>& pairs = grain_pairs_.pairs();
  const int n_pairs = static_cast<int>(pairs.size());
  double guaranteed = std::numeric_limits<double>::infinity();
  std::int64_t searched = 0;
#pragma omp parallel for schedule(dynamic, 4) reduction(min : guaranteed) reduction(+ : searched)
  for (int p = 0; p < n_pairs; ++p) {
    const PairSearch::Kept kept = search_.update(pairs[p], box, *network_of_grain[pairs[p].a]);
    guaranteed = std::min(guaranteed, kept.distance);
    searched += kept.is_searched ? 1 : 0;
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
  for (const int g : ghosts()) {
    relist(g);
  }
  for (ContactPair& pair : pairs()) {
    pair.changed = false;
  }
}

void ContactList::relist(int g) {
  if (std::any_of(sides(g).begin(), sides(g).end(),
                  [&](const ContactSide& side) { return pairs()[side.pair].changed; })) {
    listed_[g] = nodes_in(g, &ContactPair::candidates);
  }
}

/// Nodes of a grain in one of the lists of its pairs, ascending.
std::vector<std::int32_t> ContactList::nodes_in(int g, std::vector<kernels::NodePair> ContactPair::*list) const {
  thread_local std::vector<std::uint64_t> in_list; // one bit a node
  in_list.assign((layout_.n_nodes(g) + 63) / 64, 0);
  for (const ContactSide& side : sides(g)) {
    for (const kernels::NodePair& nodes : pairs()[side.pair].*list) {
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

void ContactList::note_counts() {
  ++counts_.updates;
  for (const int g : layout_.grains()) {
    counts_.grains += tracking_[g].all_noted ? 1 : 0;
    counts_.nodes += static_cast<std::int64_t>(tracking_[g].moved.size());
    counts_.followed += static_cast<std::int64_t>(tracking_[g].followed.size());
  }
}

/// The candidates of broken bonds, while all else of the list holds.
void ContactList::list_broken() {
  for (ContactPair& pair : pairs()) {
    search_.add_broken(pair);
  }
  relist_all();
  broken_changed_ = false;
}

void ContactList::note_motion(const Matrix3& cell_map, double farthest, double common) {
  if (built_) {
    cell_since_update_ = cell_map * cell_since_update_;
    grain_pairs_.note_motion(cell_map);
    cell_since_near_ = cell_map * cell_since_near_;
    const double change = (cell_map - Matrix3::Identity()).norm(), stretch = 1.0 + change;
    last_approach_ = change * reach_.diameter() + 2.0 * common;
    motion_since_near_ = motion_since_near_ * stretch + common;
    motion_since_update_ = motion_since_update_ * stretch + common;
    motion_of_followed_ = motion_of_followed_ * stretch + farthest;
  }
}

bool ContactList::near_holds() const {
  return kept_distance(near_reach_, cell_since_near_, motion_since_near_) >= reach_.diameter();
}

void ContactList::begin_near() {
  near_reach_ = std::min(guaranteed_, reach_.diameter() + std::max(least_near_margin, near_steps * last_approach_));
  motion_since_near_ = 0.0;
  cell_since_near_ = Matrix3::Identity();
}

void ContactList::list_near() {
#pragma omp parallel for schedule(dynamic, 1)
  for (const int g : layout_.grains()) {
    near_[g] = nodes_in(g, &ContactPair::near);
    near_sides_[g].clear();
    std::copy_if(sides(g).begin(), sides(g).end(), std::back_inserter(near_sides_[g]),
                 [&](const ContactSide& side) { return !pairs()[side.pair].near.empty(); });
  }
  for (const int g : ghosts()) {
    near_[g] = nodes_in(g, &ContactPair::near);
  }
}

std::int64_t ContactList::n_candidates() const {
  std::int64_t n = 0;
  for (const ContactPair& pair : pairs()) {
    n += static_cast<std::int64_t>(pair.candidates.size());
  }
  return n;
}

std::size_t ContactList::bytes() const {
  std::size_t bytes = tracking_.bytes();
  for (std::size_t g = 0; g < listed_.size(); ++g) {
    bytes += (listed_[g].capacity() + near_[g].capacity()) * sizeof(std::int32_t);
  }
  for (const ContactPair& pair : pairs()) {
    bytes += (pair.candidates.capacity() + pair.near.capacity()) * sizeof(kernels::NodePair) +
             pair.touches.capacity() * sizeof(kernels::Touch);
  }
  return bytes;
}

} // namespace boba
