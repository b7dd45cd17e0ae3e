// SPDX-License-Identifier: GPL-3.0-or-later
// Which grains may meet: their pairs, and how long no other pair can.
#include "bpm/forces/contact_list.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <tuple>

namespace boba {

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
  std::vector<ContactPair> found;
#pragma omp parallel for schedule(dynamic, 8)
  for (const int g : layout_.grains()) {
    std::vector<ContactPair> of_grain = {ContactPair{g, g, {}}};
    for (const auto& [other, image] : neighbours.of(g)) {
      if (other > g || (other == g && image > ImageVector{})) {
        of_grain.push_back({g, other, image});
      } else if (other < g && !layout_.holds(other)) { // the other's rank has it the same way round
        of_grain.push_back({other, g, {-image.a, -image.b, -image.c}});
      }
    }
#pragma omp critical
    std::move(of_grain.begin(), of_grain.end(), std::back_inserter(found));
  }
  const auto key = [](const ContactPair& pair) { return std::make_tuple(pair.a, pair.b, pair.image); };
  std::sort(found.begin(), found.end(), [&](const ContactPair& x, const ContactPair& y) { return key(x) < key(y); });
  for (auto old = pairs_.begin(); ContactPair & pair : found) { // both are sorted
    while (old != pairs_.end() && key(*old) < key(pair)) {
      ++old;
    }
    if (built_ && old != pairs_.end() && key(*old) == key(pair)) {
      pair = std::move(*old++);
    }
  }
  pairs_ = std::move(found);
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
