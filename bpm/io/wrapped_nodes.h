// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/snapshot.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace boba {

/// A snapshot's positions as files store them: wrapped into the cell, d, and the image of each, three numbers a node.
struct WrappedNodes {
  std::vector<Vector3> position;
  std::vector<std::int32_t> image;

  explicit WrappedNodes(const Snapshot& snapshot)
      : position(snapshot.position.size()), image(3 * snapshot.position.size()) {
    for (std::size_t node = 0; node < position.size(); ++node) {
      const Eigen::Vector3i n = snapshot.box.image_of(snapshot.position[node]);
      position[node] = snapshot.position[node] - snapshot.box.h() * n.cast<double>();
      std::copy(n.begin(), n.end(), image.begin() + static_cast<std::ptrdiff_t>(3 * node));
    }
  }
};

} // namespace boba
