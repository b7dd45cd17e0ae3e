// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/grain_nodes.h"

#include <fmt/format.h>
#include <stdexcept>

namespace boba::measure {

GrainNodes::GrainNodes(std::span<const Vector3> positions, std::span<const std::int64_t> first_node)
    : positions_(positions), first_node_(first_node) {
  if (first_node.size() < 2 || first_node.front() != 0 ||
      first_node.back() != static_cast<std::int64_t>(positions.size())) {
    throw std::invalid_argument(fmt::format(
        "first_node: must run from 0 to the number of nodes ({}) and name at least one grain; it has {} entries",
        positions.size(), first_node.size()));
  }
  for (std::size_t grain = 0; grain + 1 < first_node.size(); ++grain) {
    if (first_node[grain + 1] <= first_node[grain]) {
      throw std::invalid_argument(fmt::format("first_node: grain {} has no nodes", grain));
    }
  }
}

Vector3 mean_position(std::span<const Vector3> nodes) {
  if (nodes.empty()) {
    throw std::invalid_argument("mean position: a grain has no nodes");
  }
  Vector3 offset = Vector3::Zero();
  for (const Vector3& x : nodes) {
    offset += x - nodes.front();
  }
  return nodes.front() + offset / static_cast<double>(nodes.size());
}

std::vector<Vector3> grain_centres(const GrainNodes& grains) {
  std::vector<Vector3> centres(grains.n_grains());
  for (int grain = 0; grain < grains.n_grains(); ++grain) {
    centres[grain] = mean_position(grains.nodes_of(grain));
  }
  return centres;
}

} // namespace boba::measure
