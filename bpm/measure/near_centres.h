// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/measure/point_grid.h"

#include <span>
#include <vector>

namespace boba::measure {

/// A grain's centre near another one, or a periodic copy of it.
struct NearCentre {
  double distance = 0.0; ///< d
  int grain = 0;
  Vector3 vector; ///< from the grain that is looked from
  bool operator<(const NearCentre& other) const { return distance < other.distance; }
};

/// Finds all centres within a distance of one of them, periodic copies included.
class NearCentres {
public:
  /// \throws std::invalid_argument without centres.
  NearCentres(const Box& box, std::span<const Vector3> centres);
  NearCentres(const NearCentres&) = delete; // the grid looks at `wrapped_`
  NearCentres& operator=(const NearCentres&) = delete;

  double spacing() const { return spacing_; } ///< (volume / number)^(1/3), d
  double span() const { return span_; }       ///< no two centres of an open cell are farther apart, d

  /// Those within `reach` of `grain`, nearest first. \throws std::invalid_argument for one at the same place.
  std::vector<NearCentre> within(int grain, double reach) const;

private:
  std::vector<Vector3> wrapped_;
  double spacing_ = 0.0, span_ = 0.0;
  PointGrid grid_;
};

} // namespace boba::measure
