// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/near_centres.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::measure {

namespace {

std::vector<Vector3> wrapped_into(const Box& box, std::span<const Vector3> centres) {
  if (centres.empty()) {
    throw std::invalid_argument("neighbours: there are no grains");
  }
  std::vector<Vector3> wrapped(centres.size());
  std::transform(centres.begin(), centres.end(), wrapped.begin(), [&](const Vector3& x) { return box.wrapped(x); });
  return wrapped;
}

} // namespace

NearCentres::NearCentres(const Box& box, std::span<const Vector3> centres)
    : wrapped_(wrapped_into(box, centres)), spacing_(std::cbrt(box.volume() / static_cast<double>(centres.size()))),
      span_(box.h().colwise().norm().sum()), grid_(box, wrapped_, spacing_) {}

std::vector<NearCentre> NearCentres::within(int grain, double reach) const {
  std::vector<NearCentre> found;
  const Vector3& centre = wrapped_[grain];
  grid_.visit_near(centre, reach, [&](std::int64_t other, const Vector3& image) {
    const Vector3 vector = image - centre;
    const double distance = vector.norm();
    if (distance > reach) {
      return;
    }
    // The grain itself sits at rounding distance; its periodic copies are far.
    if (distance < 1e-9 * reach) {
      if (other != grain) {
        throw std::invalid_argument(fmt::format("neighbours: grains {} and {} have the same centre", grain, other));
      }
      return;
    }
    found.push_back({distance, static_cast<int>(other), vector});
  });
  std::sort(found.begin(), found.end());
  return found;
}

} // namespace boba::measure
