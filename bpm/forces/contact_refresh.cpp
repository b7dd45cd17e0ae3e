// SPDX-License-Identifier: GPL-3.0-or-later
// How a contact list stays valid while nodes move: the part of ContactList that runs between builds.
#include "bpm/forces/contact_list.h"

#include <algorithm>
#include <cmath>

namespace boba {

namespace {

/// Share of nodes with new references above which a build is cheaper than going on.
constexpr double largest_moved_share = 0.15;
/// Nodes beyond this share of the allowed displacement get a new reference at a go, so that the rest has room.
constexpr double refresh_share = 0.7;

} // namespace

/// A pair outside the list has references at least diameter + skin apart; the cell's deformation shortens that by its
/// smallest stretch (at least 1 - |F - 1|), and each of the two nodes may have come nearer by its displacement.
double ContactList::allowed_displacement() const {
  const double stretch = 1.0 - (deformation_ - Matrix3::Identity()).norm();
  return 0.5 * (stretch * (diameter_ + skin_) - diameter_);
}

bool ContactList::update(const LaneState& state, const Box& box,
                         const std::vector<const NetworkData*>& network_of_grain) {
  const double allowed = allowed_displacement();
  if (built_ && bound_ <= allowed) {
    return false;
  }
  if (built_ && allowed > 0.25 * skin_) {
    const Displacements displacements = measure(state, refresh_share * allowed);
    const auto n_moved = static_cast<double>(n_moved_ + static_cast<std::int64_t>(displacements.moved.size()));
    if (n_moved <= largest_moved_share * static_cast<double>(n_nodes_) &&
        refresh(displacements.moved, state, network_of_grain)) {
      bound_ = displacements.largest_rest;
      return !displacements.moved.empty();
    }
  }
  build(state, box, network_of_grain);
  return true;
}

ContactList::Displacements ContactList::measure(const LaneState& state, double threshold) const {
  const Matrix3& m = deformation_;
  const Vector3 shift = origin_ - m * origin_;
  const double threshold2 = threshold * threshold;
  const std::vector<Block>& blocks = layout_.blocks();
  std::vector<Displacements> of_block(blocks.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (int b = 0; b < static_cast<int>(blocks.size()); ++b) {
    const Block& block = blocks[b];
    const int stride = block.n_lanes;
    double rest2 = 0.0;
    for (std::int32_t node = 0; node < block.n_nodes; ++node) {
      const double* x = state.x.data() + block.offset + 3 * static_cast<std::int64_t>(node) * stride;
      const double* r = reference_.data() + block.offset + 3 * static_cast<std::int64_t>(node) * stride;
      double distance2[block_lanes];
      for (int l = 0; l < stride; ++l) {
        const double rx = r[l], ry = r[l + stride], rz = r[l + 2 * stride];
        const double dx = x[l] - (m(0, 0) * rx + m(0, 1) * ry + m(0, 2) * rz + shift[0]);
        const double dy = x[l + stride] - (m(1, 1) * ry + m(1, 2) * rz + shift[1]);
        const double dz = x[l + 2 * stride] - (m(2, 2) * rz + shift[2]);
        distance2[l] = dx * dx + dy * dy + dz * dz;
      }
      for (int l = 0; l < stride; ++l) {
        if (distance2[l] <= threshold2) {
          rest2 = std::max(rest2, distance2[l]);
        } else if (block.grain[l] >= 0) {
          of_block[b].moved.push_back({block.grain[l], node});
        }
      }
    }
    of_block[b].largest_rest = std::sqrt(rest2);
  }
  Displacements all;
  for (const Displacements& part : of_block) {
    all.moved.insert(all.moved.end(), part.moved.begin(), part.moved.end());
    all.largest_rest = std::max(all.largest_rest, part.largest_rest);
  }
  return all;
}

Vector3 ContactList::reference_of(int grain, int node) const {
  const std::int64_t at = layout_.index(grain, node, 0), stride = layout_.stride(grain);
  return {reference_[at], reference_[at + stride], reference_[at + 2 * stride]};
}

/// Puts a node's reference where the node is, seen in the frame of the build. False when it has left its grain's bounds.
bool ContactList::set_reference(const MovedNode& moved, const LaneState& state) {
  const std::int64_t at = layout_.index(moved.grain, moved.node, 0), stride = layout_.stride(moved.grain);
  const Vector3 x(state.x[at], state.x[at + stride], state.x[at + 2 * stride]);
  const Vector3 reference = origin_ + deformation_.inverse() * (x - origin_);
  const Bounds& bounds = bounds_[moved.grain];
  if (!((reference - bounds.low).minCoeff() >= -bounds_margin && (bounds.high - reference).minCoeff() >= -bounds_margin)) {
    return false;
  }
  for (int c = 0; c < 3; ++c) {
    reference_[at + c * stride] = reference[c];
  }
  grids_[moved.grain].insert(moved.node, reference);
  ++n_moved_;
  return true;
}

void ContactList::find_pairs(const MovedNode& moved, const NetworkData& network,
                             std::vector<std::vector<SortedPair>>& found) const {
  const int g = moved.grain;
  const std::int32_t i = moved.node;
  const Vector3 x = reference_of(g, i);
  // Nodes that have moved since the build are also found where they were: listed too often, never too rarely.
  std::vector<std::int32_t> nodes;
  const auto add = [&](int other, std::int32_t j, const ImageVector& n) {
    found[g].push_back(pair_of(g, i, other, j, image_index(n)));
    found[other].push_back(pair_of(other, j, g, i, image_index({-n.a, -n.b, -n.c})));
  };
  for (const NeighbourGrain& neighbour : neighbours_[g]) {
    const ImageVector& n = neighbour.image;
    nodes.clear();
    add_nodes_near(grids_[neighbour.other], x - cell_ * Vector3(n.a, n.b, n.c), nodes);
    for (const std::int32_t j : nodes) {
      if (neighbour.other != g || !network.bonded_across(i, j, {n.a, n.b, n.c})) {
        add(neighbour.other, j, n);
      }
    }
  }
  nodes.clear();
  add_nodes_near(grids_[g], x, nodes);
  for (const std::int32_t j : nodes) {
    if (j != i && !std::binary_search(network.partners_begin(i), network.partners_end(i), j)) {
      add(g, j, {});
    }
  }
}

void ContactList::merge_rows(int grain, std::vector<SortedPair>& added) {
  std::vector<SortedPair> merged;
  const Rows& rows = rows_[grain];
  merged.reserve(rows.own.size() + added.size());
  for (std::size_t e = 0; e < rows.own.size(); ++e) {
    merged.push_back({node_of_slot_[rows.own[e]], node_of_slot_[rows.other[e]], rows.image[e]});
  }
  const auto middle = static_cast<std::ptrdiff_t>(merged.size());
  std::sort(added.begin(), added.end());
  merged.insert(merged.end(), added.begin(), added.end());
  std::inplace_merge(merged.begin(), merged.begin() + middle, merged.end());
  merged.erase(std::unique(merged.begin(), merged.end()), merged.end());
  set_rows(grain, merged);
}

bool ContactList::refresh(const std::vector<MovedNode>& moved, const LaneState& state,
                          const std::vector<const NetworkData*>& network_of_grain) {
  for (const MovedNode& node : moved) {
    if (!set_reference(node, state)) {
      return false;
    }
  }
  std::vector<std::vector<SortedPair>> found(layout_.n_grains());
  for (const MovedNode& node : moved) {
    find_pairs(node, *network_of_grain[node.grain], found);
  }
  std::vector<std::size_t> n_sorted;
  for (const auto& sources : sources_) {
    n_sorted.push_back(sources.size());
  }
  for (int g = 0; g < layout_.n_grains(); ++g) {
    if (!add_slots(g, found[g])) {
      return false;
    }
  }
  for (std::size_t b = 0; b < sources_.size(); ++b) {
    const auto middle = sources_[b].begin() + static_cast<std::ptrdiff_t>(n_sorted[b]);
    std::sort(middle, sources_[b].end(), by_place);
    std::inplace_merge(sources_[b].begin(), middle, sources_[b].end(), by_place);
  }
#pragma omp parallel for schedule(dynamic, 1)
  for (int g = 0; g < layout_.n_grains(); ++g) {
    if (!found[g].empty()) {
      merge_rows(g, found[g]);
    }
  }
  n_refreshed_ += static_cast<std::int64_t>(moved.size());
  return true;
}

} // namespace boba
