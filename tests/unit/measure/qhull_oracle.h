// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/box.h"

#include <set>
#include <span>

namespace boba::test_data {

struct QhullResult {
  double volume = 0.0, area = 0.0;
  std::set<int> vertices; ///< numbers of the points that are hull vertices
};

/// The hull of the points by Qhull: other authors, another algorithm, floating point.
QhullResult qhull(std::span<const Vector3> points);

} // namespace boba::test_data
