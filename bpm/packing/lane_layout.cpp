// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/lane_layout.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace boba {

int Block::n_grains() const {
  return static_cast<int>(std::count_if(grain.begin(), grain.end(), [](int g) { return g >= 0; }));
}

namespace {

std::vector<int> all_grains(const Packing& packing) {
  std::vector<int> grains(packing.grains.size());
  std::iota(grains.begin(), grains.end(), 0);
  return grains;
}

/// One grain alone costs less as scalars than as one of eight lanes; up to eight of sixteen fill half a register. The
/// width decides how roots are computed, and so the last bits: it must not depend on who else is on a rank.
int lanes_for(int grains_in_group, int block_lanes) {
  return grains_in_group == 1 ? 1 : grains_in_group <= 8 ? 8 : block_lanes;
}

} // namespace

LaneLayout::LaneLayout(const Packing& packing, Precision precision)
    : LaneLayout(packing, precision, all_grains(packing)) {}

LaneLayout::LaneLayout(const Packing& packing, Precision precision, std::span<const int> grains_in_order)
    : precision_(precision), slots_(packing.grains.size()), grains_(grains_in_order.begin(), grains_in_order.end()) {
  std::sort(grains_.begin(), grains_.end());
  for (int g = 0; g < packing.n_grains(); ++g) {
    slots_[g].n_nodes = packing.template_of(g).n_nodes();
  }
  const auto group_of = [&](int g) {
    return std::pair(packing.grains[g].template_index, packing.grains[g].alpha != 0.0);
  };
  std::map<std::pair<int, bool>, int> size_of_group; // in the whole packing: every rank must decide alike
  for (int g = 0; g < packing.n_grains(); ++g) {
    ++size_of_group[group_of(g)];
  }
  std::map<std::pair<int, bool>, std::vector<int>> groups;
  for (const int g : grains_in_order) {
    groups[group_of(g)].push_back(g);
  }
  for (const auto& [key, members] : groups) {
    const int n_lanes = lanes_for(size_of_group.at(key), lanes_of_block(precision));
    for (std::size_t begin = 0; begin < members.size(); begin += n_lanes) {
      const std::size_t end = std::min<std::size_t>(begin + n_lanes, members.size());
      add_block(packing, {members.begin() + begin, members.begin() + end}, n_lanes);
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
  size_ += (numbers + 15) / 16 * 16; // every block starts on a cache line
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

} // namespace boba
