// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/grain_neighbours.h"

#include <algorithm>
#include <cmath>

namespace boba {

namespace {

/// Most bins along an edge of the cell: more would be empty for the most part.
constexpr int most_bins = 64;

/// Integers n with |offset + n period| <= reach; {0, 0} along a direction that is not periodic and within reach.
struct Interval {
  int first, last;
};

Interval images_within(double offset, double period, double reach, bool periodic) {
  if (!periodic) {
    return std::abs(offset) <= reach ? Interval{0, 0} : Interval{0, -1};
  }
  return {static_cast<int>(std::ceil((-reach - offset) / period)),
          static_cast<int>(std::floor((reach - offset) / period))};
}

} // namespace

GrainNeighbours::GrainNeighbours(std::vector<Bounds> bounds, const Box& box, double reach)
    : bounds_(std::move(bounds)), box_(box), reach_(reach) {
  Vector3 largest = Vector3::Zero();
  for (const Bounds& of_grain : bounds_) {
    largest = largest.cwiseMax(of_grain.high - of_grain.low);
  }
  // No two grains within reach have fractional coordinates farther apart than this, but for whole numbers.
  const Vector3 apart = box.h_inverse().cwiseAbs() * (largest + Vector3::Constant(reach));
  for (int axis = 0; axis < 3; ++axis) {
    const double n = std::min(0.999 / apart[axis], static_cast<double>(most_bins));
    n_bins_[axis] = n >= 3.0 ? static_cast<int>(n) : 1;
  }
  in_bin_.resize(n_bins_.prod());
  for (int g = 0; g < static_cast<int>(bounds_.size()); ++g) {
    const Eigen::Vector3i bin = bin_of(g);
    in_bin_[(bin[2] * n_bins_[1] + bin[1]) * n_bins_[0] + bin[0]].push_back(g);
  }
}

Eigen::Vector3i GrainNeighbours::bin_of(int g) const {
  const Vector3 s = box_.to_fractional(centre(g));
  Eigen::Vector3i bin;
  for (int axis = 0; axis < 3; ++axis) {
    const double in_cell = box_.periodic()[axis] ? s[axis] - std::floor(s[axis]) : std::clamp(s[axis], 0.0, 1.0);
    bin[axis] = std::min(static_cast<int>(in_cell * n_bins_[axis]), n_bins_[axis] - 1);
  }
  return bin;
}

/// The grains in the bins around g's, its own included, ascending.
std::vector<int> GrainNeighbours::around(int g) const {
  const Eigen::Vector3i middle = bin_of(g);
  std::vector<int> bins[3];
  for (int axis = 0; axis < 3; ++axis) {
    const int n = n_bins_[axis];
    for (int bin = n == 1 ? 0 : middle[axis] - 1; bin <= (n == 1 ? 0 : middle[axis] + 1); ++bin) {
      if (box_.periodic()[axis]) {
        bins[axis].push_back((bin + n) % n);
      } else if (bin >= 0 && bin < n) {
        bins[axis].push_back(bin);
      }
    }
  }
  std::vector<int> grains;
  for (const int z : bins[2]) {
    for (const int y : bins[1]) {
      for (const int x : bins[0]) {
        const std::vector<int>& here = in_bin_[(z * n_bins_[1] + y) * n_bins_[0] + x];
        grains.insert(grains.end(), here.begin(), here.end());
      }
    }
  }
  std::sort(grains.begin(), grains.end());
  return grains;
}

std::vector<NeighbourGrain> GrainNeighbours::of(int g) const {
  std::vector<NeighbourGrain> found;
  const Matrix3& h = box_.h();
  const auto& periodic = box_.periodic();
  for (const int other : around(g)) {
    const Vector3 distance = centre(other) - centre(g);
    const Vector3 touching =
        (0.5 * (bounds_[other].high - bounds_[other].low + bounds_[g].high - bounds_[g].low)).array() + reach_;
    const Interval c = images_within(distance[2], h(2, 2), touching[2], periodic[2]);
    for (int nc = c.first; nc <= c.last; ++nc) {
      const Interval b = images_within(distance[1] + nc * h(1, 2), h(1, 1), touching[1], periodic[1]);
      for (int nb = b.first; nb <= b.last; ++nb) {
        const double x = distance[0] + nb * h(0, 1) + nc * h(0, 2);
        const Interval a = images_within(x, h(0, 0), touching[0], periodic[0]);
        for (int na = a.first; na <= a.last; ++na) {
          const Vector3 between(x + na * h(0, 0), distance[1] + nb * h(1, 1) + nc * h(1, 2),
                                distance[2] + nc * h(2, 2));
          const Vector3 gap = (between.cwiseAbs() - (touching.array() - reach_).matrix()).cwiseMax(0.0);
          const bool is_near = gap.squaredNorm() <= reach_ * reach_; // not so at the corners of the boxes
          if (is_near && (other != g || na != 0 || nb != 0 || nc != 0)) {
            found.push_back({other, {na, nb, nc}});
          }
        }
      }
    }
  }
  return found;
}

} // namespace boba
