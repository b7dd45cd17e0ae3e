// SPDX-License-Identifier: GPL-3.0-or-later
#include "nearest.h"

#include <algorithm>
#include <limits>

using namespace boba;

std::vector<MeasureTable> Nearest::tables() const {
  return {{.name = "nearest", .columns = {"nearest_smallest_d", "nearest_mean_d"}, .is_averaged = true}};
}

void Nearest::add(const Snapshot& frame, const Topology&, const WriteMeasureRow& write) const {
  const std::vector<Vector3>& centre = frame.grain_centre;
  double smallest = std::numeric_limits<double>::infinity(), sum = 0.0;
  for (std::size_t a = 0; a < centre.size(); ++a) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t b = 0; b < centre.size(); ++b) {
      if (a != b) {
        nearest = std::min(nearest, frame.box.minimum_image(centre[b] - centre[a]).norm());
      }
    }
    smallest = std::min(smallest, nearest);
    sum += nearest;
  }
  write("nearest", {smallest, sum / static_cast<double>(centre.size())});
}
