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

/// Grains of one group share blocks: those of one template, with or without many-body forces, whose bonds break alike.
struct Group {
  int template_index;
  bool many_body, breaks, in_tension_only, smooth;
  double yield_strain, hardening;
  auto operator<=>(const Group&) const = default;
};

Group group_of(const Grain& grain) {
  const Breaking& breaking = grain.breaking;
  const bool breaks = breaking.is_possible();
  return {grain.template_index,
          grain.alpha != 0.0,
          breaks,
          breaks && breaking.in_tension_only,
          breaks && breaking.smooth,
          grain.yielding.strain,
          grain.yielding.hardening};
}

/// First bond of each node, and their number at last.
std::vector<std::int64_t> first_bonds_of(const GrainTemplate& grain) {
  std::vector<std::int64_t> first(grain.n_nodes() + 1, 0);
  for (const Bond& bond : grain.bonds) {
    ++first[bond.i + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  return first;
}

} // namespace

LaneLayout::LaneLayout(const Packing& packing, Precision precision)
    : LaneLayout(packing, precision, all_grains(packing)) {}

LaneLayout::LaneLayout(const Packing& packing, Precision precision, std::span<const int> grains_in_order)
    : precision_(precision), slots_(packing.grains.size()), grains_(grains_in_order.begin(), grains_in_order.end()) {
  std::sort(grains_.begin(), grains_.end());
  for (int g = 0; g < packing.n_grains(); ++g) {
    slots_[g].n_nodes = packing.template_of(g).n_nodes();
    slots_[g].template_index = packing.grains[g].template_index;
  }
  count_bonds(packing);
  std::map<Group, int> size_of_group; // in the whole packing: every rank must decide alike
  for (const Grain& grain : packing.grains) {
    ++size_of_group[group_of(grain)];
  }
  std::map<Group, std::vector<int>> groups;
  for (const int g : grains_in_order) {
    groups[group_of(packing.grains[g])].push_back(g);
  }
  for (const auto& [key, members] : groups) {
    const int n_lanes = lanes_for(size_of_group.at(key), lanes_of_block(precision));
    for (std::size_t begin = 0; begin < members.size(); begin += n_lanes) {
      const std::size_t end = std::min<std::size_t>(begin + n_lanes, members.size());
      add_block(packing, {members.begin() + begin, members.begin() + end}, n_lanes);
    }
  }
}

void LaneLayout::count_bonds(const Packing& packing) {
  std::map<int, std::int64_t> most_bonds; // of any node of a template
  for (const Grain& grain : packing.grains) {
    const int t = grain.template_index;
    if (grain.n_remembered() == 0) {
      continue;
    }
    if (!first_bonds_.contains(t)) {
      const std::vector<std::int64_t>& first =
          first_bonds_.emplace(t, first_bonds_of(*packing.templates[t])).first->second;
      for (std::size_t i = 1; i < first.size(); ++i) {
        most_bonds[t] = std::max(most_bonds[t], first[i] - first[i - 1]);
      }
    }
    memory_slots_ = std::max(memory_slots_, grain.n_remembered() * static_cast<int>(most_bonds[t]));
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
  block.breaking = packing.grains[grains.front()].breaking;
  block.yielding = packing.grains[grains.front()].yielding;
  block.n_remembered = packing.grains[grains.front()].n_remembered();
  block.memory = memory_size_;
  for (int lane = 0; lane < static_cast<int>(grains.size()); ++lane) {
    const int g = grains[lane];
    block.grain[lane] = g;
    block.alpha[lane] = packing.grains[g].alpha;
    slots_[g] = {block.offset + lane,
                 n_lanes,
                 block.n_nodes,
                 static_cast<int>(blocks_.size()),
                 lane,
                 block.template_index,
                 block.n_remembered,
                 block.n_remembered > 0 ? memory_size_ + lane : -1};
  }
  if (block.n_remembered > 0) {
    const auto n_bonds = static_cast<std::int64_t>(packing.templates[block.template_index]->bonds.size());
    memory_size_ += (n_bonds * block.n_remembered * n_lanes + 15) / 16 * 16;
  }
  const std::int64_t numbers = 3 * static_cast<std::int64_t>(block.n_nodes) * n_lanes;
  size_ += (numbers + 15) / 16 * 16; // every block starts on a cache line
  blocks_.push_back(std::move(block));
}

std::size_t LaneLayout::bytes() const {
  std::size_t bytes = slots_.capacity() * sizeof(Slot) + grains_.capacity() * sizeof(int);
  for (const Block& block : blocks_) {
    bytes += sizeof(Block) + block.grain.capacity() * sizeof(int) + block.alpha.capacity() * sizeof(double);
  }
  return bytes;
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
