// SPDX-License-Identifier: GPL-3.0-or-later
// Which grains may meet: their pairs, and how long no other pair can.
#include "bpm/forces/contact_list.h"

#include <algorithm>
#include <compare>
#include <limits>
#include <vector>

namespace boba {

namespace {

/// What tells a pair of grains from the others, in the order of the list.
struct PairKey {
  int a, b;
  ImageVector image;
  auto operator<=>(const PairKey&) const = default;
};

PairKey key_of(const ContactPair& pair) {
  return {pair.a, pair.b, pair.image};
}

/// Makes the list one of the `wanted` pairs: those that are in it stay as they are, others come in new. Both are
/// sorted. In place, since a pair is large and a packing of small grains has many.
void keep_pairs(std::vector<ContactPair>& pairs, const std::vector<PairKey>& wanted) {
  std::erase_if(
      pairs, [&](const ContactPair& pair) { return !std::binary_search(wanted.begin(), wanted.end(), key_of(pair)); });
  std::size_t old = pairs.size();
  if (pairs.capacity() < wanted.size()) {
    pairs.reserve(wanted.size() + (pairs.empty() ? 0 : wanted.size() / 16));
  }
  pairs.resize(wanted.size());
  for (std::size_t place = wanted.size(); place > old; --place) { // what is below has its place already
    const PairKey& key = wanted[place - 1];
    if (old > 0 && key_of(pairs[old - 1]) == key) {
      pairs[place - 1] = std::move(pairs[--old]);
    } else {
      pairs[place - 1] = ContactPair{key.a, key.b, key.image};
    }
  }
}

} // namespace

void ContactList::find_neighbours(const Box& box) {
  const int n_grains = layout_.n_grains();
  std::vector<Bounds> bounds(n_grains);
  for (const int g : layout_.grains()) {
    TrackedGrain& grain = grains_[g];
    bounds[g] = grain.grid.bounds().widened(bounds_margin_).mapped(grain.frame).widened(grain.deviation);
    grain.neighbour_frame = grain.frame;
    grain.neighbour_bounds = bounds[g];
    grain.outgrown = false;
  }
  share_bounds(bounds);
  const GrainNeighbours neighbours(std::move(bounds), box, reach_between() + neighbour_margin_);
  std::vector<PairKey> found;
#pragma omp parallel for schedule(dynamic, 8)
  for (const int g : layout_.grains()) {
    std::vector<PairKey> of_grain;
    if (layout_.n_nodes(g) > 1) {
      of_grain.push_back({g, g, {}});
    }
    for (const auto& [other, image] : neighbours.of(g)) {
      if (other > g || (other == g && image > ImageVector{})) {
        of_grain.push_back({g, other, image});
      } else if (other < g && !layout_.holds(other)) { // the other's rank has it the same way round
        of_grain.push_back({other, g, {-image.a, -image.b, -image.c}});
      }
    }
#pragma omp critical
    found.insert(found.end(), of_grain.begin(), of_grain.end());
  }
  std::sort(found.begin(), found.end());
  if (!built_) {
    pairs_.clear();
  }
  keep_pairs(pairs_, found);
  sides_.assign(n_grains, {});
  for (int index = 0; index < static_cast<int>(pairs_.size()); ++index) {
    const ContactPair& pair = pairs_[index];
    sides_[pair.a].push_back({index, 1.0});
    sides_[pair.b].push_back({index, -1.0});
  }
  find_ghosts();
  for (ContactPair& pair : pairs_) {
    pair.changed = true;
  }
  cell_since_neighbours_ = Matrix3::Identity();
}

/// Distance that the nodes of grains which are not neighbours keep: they were farther apart than the reach when the
/// neighbours were found, the cell may have shortened that, and each grain may have moved beyond the cell's motion.
/// Nothing when a grain has a place that was not in its bounds then: a node that left, while the grain as a whole
/// stayed.
double ContactList::neighbour_guarantee(const Box& box) const {
  const Matrix3& cell = cell_since_neighbours_;
  const GrainFrame with_cell = {cell, box.origin() - cell * box.origin()};
  double farthest = 0.0;
  for (const int g : layout_.grains()) {
    const TrackedGrain& grain = grains_[g];
    if (grain.outgrown) {
      farthest = std::numeric_limits<double>::max();
    }
    const GrainFrame carried = with_cell.after(grain.neighbour_frame);
    grain.grid.bounds().widened(bounds_margin_).for_each_corner([&](const Vector3& x) {
      farthest = std::max(farthest, (grain.frame(x) - carried(x)).norm() + grain.deviation);
    });
  }
  farthest = distribution_.ranks->largest(farthest);
  const double stretch = 1.0 - (cell - Matrix3::Identity()).norm();
  return stretch * (reach_between() + neighbour_margin_) - 2.0 * farthest;
}

/// Notes whether a place was outside the bounds that its grain had when the neighbours were found.
void ContactList::compare_with_neighbour_bounds(TrackedGrain& grain, const Vector3& place) {
  grain.outgrown = grain.outgrown || !grain.neighbour_bounds.contains(grain.neighbour_frame(place));
}

} // namespace boba
