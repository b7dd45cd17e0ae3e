// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/lane_layout.h"

#include <algorithm>
#include <map>
#include <utility>

namespace boba {

int Block::n_grains() const {
  return static_cast<int>(std::count_if(grain.begin(), grain.end(), [](int g) { return g >= 0; }));
}

LaneLayout::LaneLayout(const Packing& packing) : slots_(packing.grains.size()) {
  std::map<std::pair<int, bool>, std::vector<int>> groups;
  for (int g = 0; g < packing.n_grains(); ++g) {
    const Grain& grain = packing.grains[g];
    groups[{grain.template_index, grain.alpha != 0.0}].push_back(g);
  }
  for (const auto& [key, members] : groups) {
    for (std::size_t begin = 0; begin < members.size(); begin += block_lanes) {
      const std::size_t end = std::min(begin + block_lanes, members.size());
      const std::vector<int> grains(members.begin() + begin, members.begin() + end);
      // One grain alone costs less as scalars than as one of eight lanes.
      add_block(packing, grains, grains.size() == 1 ? 1 : block_lanes);
    }
  }
}

void LaneLayout::add_block(const Packing& packing, const std::vector<int>& grains, int n_lanes) {
  Block block;
  block.template_index = packing.grains[grains.front()].template_index;
  block.n_nodes = packing.template_of(grains.front()).n_nodes();
  block.n_lanes = n_lanes;
  block.offset = size_;
  block.many_body = packing.grains[grains.front()].alpha != 0.0;
  block.grain.assign(n_lanes, -1);
  block.alpha.assign(n_lanes, packing.grains[grains.front()].alpha);
  for (int lane = 0; lane < static_cast<int>(grains.size()); ++lane) {
    const int g = grains[lane];
    block.grain[lane] = g;
    block.alpha[lane] = packing.grains[g].alpha;
    slots_[g] = {block.offset + lane, n_lanes, block.n_nodes, static_cast<int>(blocks_.size()), lane};
  }
  const std::int64_t numbers = 3 * static_cast<std::int64_t>(block.n_nodes) * n_lanes;
  size_ += (numbers + 7) / 8 * 8; // every block starts on a cache line
  blocks_.push_back(std::move(block));
}

double LaneLayout::filled() const {
  double used = 0.0, all = 0.0;
  for (const Block& block : blocks_) {
    used += static_cast<double>(block.n_grains()) * block.n_nodes;
    all += static_cast<double>(block.n_lanes) * block.n_nodes;
  }
  return used / all;
}

LaneState::LaneState(const Packing& packing, const LaneLayout& layout)
    : x(layout.size(), 0.0), v(layout.size(), 0.0), f(layout.size(), 0.0) {
  for (const Block& block : layout.blocks()) {
    const GrainTemplate& undeformed = *packing.templates[block.template_index];
    for (int node = 0; node < block.n_nodes; ++node) {
      for (int c = 0; c < 3; ++c) {
        for (int lane = 0; lane < block.n_lanes; ++lane) {
          x[block.offset + (3 * static_cast<std::int64_t>(node) + c) * block.n_lanes + lane] =
              undeformed.position[node][c];
        }
      }
    }
  }
  const std::vector<std::int64_t> first = packing.first_nodes();
  for (int g = 0; g < layout.n_grains(); ++g) {
    for (int node = 0; node < layout.n_nodes(g); ++node) {
      for (int c = 0; c < 3; ++c) {
        x[layout.index(g, node, c)] = packing.position[first[g] + node][c];
        v[layout.index(g, node, c)] = packing.velocity[first[g] + node][c];
      }
    }
  }
}

} // namespace boba
