// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/contact_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>

namespace boba {

ContactList::ContactList(const LaneLayout& layout, double diameter, double skin)
    : layout_(layout), diameter_(diameter), skin_(skin), grids_(layout.n_grains()), bounds_(layout.n_grains()),
      neighbours_(layout.n_grains()), rows_(layout.n_grains()), pairs_(layout.n_grains()),
      first_slot_(layout.n_grains() + 1, 0), n_slots_(layout.n_grains(), 0), sources_(layout.blocks().size()) {
  for (int g = 0; g < layout.n_grains(); ++g) {
    first_node_.push_back(static_cast<std::int32_t>(n_nodes_));
    n_nodes_ += layout.n_nodes(g);
  }
  slot_of_node_.assign(n_nodes_, -1);
  if (layout.size() > std::numeric_limits<std::int32_t>::max()) {
    throw std::invalid_argument("contact list: the packing has more than 7e8 nodes, the most that one process handles");
  }
}

void ContactList::sort_into_grids(const LaneState& state) {
  reference_ = state.x;
#pragma omp parallel for schedule(dynamic, 1)
  for (int g = 0; g < layout_.n_grains(); ++g) {
    thread_local std::vector<Vector3> nodes;
    nodes.resize(layout_.n_nodes(g));
    Bounds bounds;
    for (int node = 0; node < layout_.n_nodes(g); ++node) {
      for (int c = 0; c < 3; ++c) {
        nodes[node][c] = state.x[layout_.index(g, node, c)];
      }
      bounds.low = bounds.low.cwiseMin(nodes[node]);
      bounds.high = bounds.high.cwiseMax(nodes[node]);
    }
    bounds_[g] = bounds;
    grids_[g] = GrainGrid(nodes, bounds, diameter_ + skin_);
  }
}

void ContactList::collect_images() {
  std::set<ImageVector> distinct = {ImageVector{}};
  for (const std::vector<NeighbourGrain>& list : neighbours_) {
    for (const NeighbourGrain& neighbour : list) {
      const ImageVector& n = neighbour.image;
      distinct.insert(n);
      distinct.insert({-n.a, -n.b, -n.c});
    }
  }
  images_.assign(distinct.begin(), distinct.end());
}

std::int32_t ContactList::image_index(const ImageVector& image) const {
  return static_cast<std::int32_t>(std::lower_bound(images_.begin(), images_.end(), image) - images_.begin());
}

void ContactList::build(const LaneState& state, const Box& box,
                        const std::vector<const NetworkData*>& network_of_grain) {
  sort_into_grids(state);
  const int n_grains = layout_.n_grains();
#pragma omp parallel for schedule(dynamic, 8)
  for (int g = 0; g < n_grains; ++g) {
    // Nodes with a new reference may leave their grain's bounds by the margin.
    neighbours_[g] = neighbour_grains(g, bounds_, box, diameter_ + skin_ + 2.0 * bounds_margin);
  }
  collect_images();
  origin_ = box.origin();
  cell_ = box.h();
  deformation_ = Matrix3::Identity();
#pragma omp parallel for schedule(dynamic, 1)
  for (int g = 0; g < n_grains; ++g) {
    build_rows(g, *network_of_grain[g]);
  }
  assign_slots();
#pragma omp parallel for schedule(dynamic, 1)
  for (int g = 0; g < n_grains; ++g) {
    set_rows(g, pairs_[g]);
    pairs_[g] = {};
  }
  n_moved_ = 0;
  bound_ = 0.0;
  built_ = true;
  ++n_builds_;
}

ContactList::SortedPair ContactList::pair_of(int grain, int node, int other, int other_node,
                                             std::int32_t image) const {
  return {first_node_[grain] + node, first_node_[other] + other_node, image};
}

void ContactList::build_rows(int grain, const NetworkData& network) {
  thread_local std::vector<CandidatePair> pairs;
  std::vector<SortedPair>& sorted = pairs_[grain];
  const std::vector<NeighbourGrain>& neighbours = neighbours_[grain];
  pairs.clear();
  sorted.clear();
  for (int k = 0; k < static_cast<int>(neighbours.size()); ++k) {
    const ImageVector& n = neighbours[k].image;
    add_pairs_between(grids_[grain], grids_[neighbours[k].other], cell_ * Vector3(n.a, n.b, n.c), k, pairs);
  }
  add_pairs_inside(grids_[grain], network, pairs);
  for (const CandidatePair& pair : pairs) {
    const bool inside = pair.neighbour < 0;
    const NeighbourGrain neighbour = inside ? NeighbourGrain{grain, {}} : neighbours[pair.neighbour];
    const ImageVector& n = neighbour.image;
    if (inside || neighbour.other != grain || !network.bonded_across(pair.own, pair.node, {n.a, n.b, n.c})) {
      sorted.push_back(pair_of(grain, pair.own, neighbour.other, pair.node, image_index(neighbour.image)));
    }
  }
  std::sort(sorted.begin(), sorted.end());
}

void ContactList::assign_slots() {
  const auto other_node = [](const SortedPair& a, const SortedPair& b) { return a.own != b.own; };
  std::fill(slot_of_node_.begin(), slot_of_node_.end(), -1);
  std::fill(n_slots_.begin(), n_slots_.end(), 0);
  for (int g = 0; g < layout_.n_grains(); ++g) {
    const std::vector<SortedPair>& pairs = pairs_[g];
    const auto needed = pairs.empty() ? 0 : 1 + std::transform_reduce(pairs.begin() + 1, pairs.end(), pairs.begin(), 0,
                                                                      std::plus<>(), other_node);
    first_slot_[g + 1] = first_slot_[g] + std::min(needed + needed / 4 + 16, layout_.n_nodes(g));
  }
  node_of_slot_.assign(first_slot_.back(), -1);
  for (std::size_t b = 0; b < sources_.size(); ++b) {
    std::vector<kernels::ContactSource>& sources = sources_[b];
    sources.clear();
    for (const int g : layout_.blocks()[b].grain) {
      if (g >= 0) {
        add_slots(g, pairs_[g]);
      }
    }
    std::sort(sources.begin(), sources.end(), by_place);
  }
}

/// Gives slots to those of a grain's own nodes that have none. False when there is no room left.
bool ContactList::add_slots(int grain, const std::vector<SortedPair>& pairs) {
  for (const SortedPair& pair : pairs) {
    if (slot_of_node_[pair.own] >= 0) {
      continue;
    }
    const std::int32_t slot = first_slot_[grain] + n_slots_[grain];
    if (slot == first_slot_[grain + 1]) {
      return false;
    }
    ++n_slots_[grain];
    slot_of_node_[pair.own] = slot;
    node_of_slot_[slot] = pair.own;
    const std::int64_t from = layout_.index(grain, pair.own - first_node_[grain], 0);
    sources_[layout_.block_of(grain)].push_back({static_cast<std::int32_t>(from), slot});
  }
  return true;
}

void ContactList::set_rows(int grain, const std::vector<SortedPair>& sorted) {
  Rows& rows = rows_[grain];
  rows.own.resize(sorted.size());
  rows.other.resize(sorted.size());
  rows.image.resize(sorted.size());
  for (std::size_t e = 0; e < sorted.size(); ++e) {
    rows.own[e] = slot_of_node_[sorted[e].own];
    rows.other[e] = slot_of_node_[sorted[e].other];
    rows.image[e] = sorted[e].image;
  }
}

void ContactList::note_motion(const Matrix3& cell_map, double displacement) {
  if (built_) {
    deformation_ = cell_map * deformation_;
    bound_ = bound_ * (1.0 + (cell_map - Matrix3::Identity()).norm()) + displacement;
  }
}

kernels::ContactRows ContactList::rows(int grain) const {
  const Rows& rows = rows_[grain];
  return {static_cast<std::int64_t>(rows.own.size()), rows.own.data(), rows.other.data(), rows.image.data()};
}

std::int64_t ContactList::n_candidates() const {
  std::int64_t n = 0;
  for (const Rows& rows : rows_) {
    n += static_cast<std::int64_t>(rows.own.size());
  }
  return n;
}

std::size_t ContactList::bytes() const {
  std::size_t bytes = reference_.capacity() * sizeof(double) +
                      (slot_of_node_.capacity() + node_of_slot_.capacity()) * sizeof(std::int32_t);
  for (const std::vector<kernels::ContactSource>& sources : sources_) {
    bytes += sources.capacity() * sizeof(kernels::ContactSource);
  }
  for (const GrainGrid& grid : grids_) {
    bytes += grid.bytes();
  }
  for (const Rows& rows : rows_) {
    bytes += (rows.own.capacity() + rows.other.capacity() + rows.image.capacity()) * sizeof(std::int32_t);
  }
  return bytes;
}

} // namespace boba
