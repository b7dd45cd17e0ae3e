// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/farthest_nodes.h"

#include "bpm/measure/vector_clones.h"

#include <algorithm>
#include <limits>

namespace boba::measure {

namespace {

/// Largest reach along a direction; `reach` keeps that of every node.
BOBA_VECTOR_CLONES
double reaches(const double* x, const double* y, const double* z, std::size_t n, double dx, double dy, double dz,
               double* reach) {
  double farthest = std::numeric_limits<double>::lowest();
  for (std::size_t i = 0; i < n; ++i) {
    reach[i] = x[i] * dx + y[i] * dy + z[i] * dz;
    farthest = reach[i] > farthest ? reach[i] : farthest;
  }
  return farthest;
}

} // namespace

std::vector<int> farthest_nodes(std::span<const Vector3> nodes, std::span<const Vector3> directions) {
  const std::size_t n = nodes.size();
  std::vector<double> numbers(4 * n);
  double* const x = numbers.data();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      x[c * n + i] = nodes[i][static_cast<Eigen::Index>(c)];
    }
  }
  double* const reach = x + 3 * n;
  std::vector<int> found;
  for (const Vector3& direction : directions) {
    const double farthest = reaches(x, x + n, x + 2 * n, n, direction[0], direction[1], direction[2], reach);
    found.push_back(static_cast<int>(std::find(reach, reach + n, farthest) - reach));
  }
  return found;
}

} // namespace boba::measure
