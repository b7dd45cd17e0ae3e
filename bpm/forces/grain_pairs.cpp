// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/grain_pairs.h"

#include "bpm/forces/grain_neighbours.h"

#include <algorithm>
#include <compare>
#include <limits>
#include <utility>
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

void GrainPairs::layout_changed() {
  sides_.assign(layout_.n_grains(), {});
  pairs_.clear();
}

void GrainPairs::find(std::vector<TrackedGrain>& grains, const Box& box, bool afresh) {
  const int n_grains = layout_.n_grains();
  std::vector<Bounds> bounds(n_grains);
  for (const int g : layout_.grains()) {
    TrackedGrain& grain = grains[g];
    bounds[g] = grain.grid.bounds().widened(reach_.bounds_margin).mapped(grain.frame).widened(grain.deviation);
    grain.neighbour_frame = grain.frame;
    grain.neighbour_bounds = bounds[g];
    grain.outgrown = false;
  }
  share_bounds(bounds);
  const GrainNeighbours neighbours(std::move(bounds), box, reach_.between() + reach_.neighbour_margin);
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
  if (afresh) {
    pairs_.clear();
  }
  keep_pairs(pairs_, found);
  sides_.assign(n_grains, {});
  for (int index = 0; index < static_cast<int>(pairs_.size()); ++index) {
    const ContactPair& pair = pairs_[index];
    sides_[pair.a].push_back({index, 1.0});
    sides_[pair.b].push_back({index, -1.0});
  }
  for (ContactPair& pair : pairs_) {
    pair.changed = true;
  }
  cell_since_found_ = Matrix3::Identity();
}

void GrainPairs::share_bounds(std::vector<Bounds>& bounds) const {
  std::vector<double> rows;
  for (const Bounds& of_grain : bounds) {
    rows.insert(rows.end(), of_grain.low.begin(), of_grain.low.end());
    rows.insert(rows.end(), of_grain.high.begin(), of_grain.high.end());
  }
  distribution_.ranks->share_rows(rows, 6, distribution_.ownership);
  for (std::size_t g = 0; g < bounds.size(); ++g) {
    bounds[g].low = Eigen::Map<const Vector3>(&rows[6 * g]);
    bounds[g].high = Eigen::Map<const Vector3>(&rows[6 * g + 3]);
  }
}

double GrainPairs::guarantee(const std::vector<TrackedGrain>& grains, const Box& box) const {
  const Matrix3& cell = cell_since_found_;
  const GrainFrame with_cell = {cell, box.origin() - cell * box.origin()};
  double farthest = 0.0;
  for (const int g : layout_.grains()) {
    const TrackedGrain& grain = grains[g];
    if (grain.outgrown) {
      farthest = std::numeric_limits<double>::max();
    }
    const GrainFrame carried = with_cell.after(grain.neighbour_frame);
    grain.grid.bounds().widened(reach_.bounds_margin).for_each_corner([&](const Vector3& x) {
      farthest = std::max(farthest, (grain.frame(x) - carried(x)).norm() + grain.deviation);
    });
  }
  farthest = distribution_.ranks->largest(farthest);
  const double stretch = 1.0 - (cell - Matrix3::Identity()).norm();
  return stretch * (reach_.between() + reach_.neighbour_margin) - 2.0 * farthest;
}

} // namespace boba
