// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/spatial_order.h"

#include "base/bounds.h"
#include "base/hilbert_curve.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

namespace boba {

namespace {

using Eigen::Vector3d;

constexpr int levels = 16;

} // namespace

std::vector<int> hilbert_order(const std::vector<Vector3d>& position) {
  if (position.empty()) {
    return {};
  }
  const Bounds bounds = bounds_of(position);
  const double cells = static_cast<double>(1u << levels);
  const double scale = (cells - 1.0) / std::max(bounds.extent().maxCoeff(), 1e-300);
  std::vector<std::uint64_t> index(position.size());
  for (std::size_t n = 0; n < position.size(); ++n) {
    const Vector3d c = scale * (position[n] - bounds.low);
    index[n] = hilbert_index(
        {static_cast<std::uint32_t>(c.x()), static_cast<std::uint32_t>(c.y()), static_cast<std::uint32_t>(c.z())},
        levels);
  }
  std::vector<int> order(position.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return std::pair(index[a], a) < std::pair(index[b], b); });
  return order;
}

} // namespace boba
