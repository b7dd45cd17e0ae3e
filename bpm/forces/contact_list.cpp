// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/contact_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace boba {

ContactList::ContactList(const LaneLayout& layout, double diameter, double skin)
    : layout_(layout), diameter_(diameter), skin_(skin), grids_(layout.n_grains()), bounds_(layout.n_grains()),
      rows_(layout.n_grains()) {
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

void ContactList::collect_images(const std::vector<std::vector<NeighbourGrain>>& neighbours) {
  std::set<ImageVector> distinct = {ImageVector{}};
  for (const std::vector<NeighbourGrain>& list : neighbours) {
    for (const NeighbourGrain& neighbour : list) {
      distinct.insert(neighbour.image);
    }
  }
  images_.assign(distinct.begin(), distinct.end());
}

void ContactList::build(const LaneState& state, const Box& box,
                        const std::vector<const NetworkData*>& network_of_grain) {
  sort_into_grids(state);
  const int n_grains = layout_.n_grains();
  const double reach = diameter_ + skin_;
  std::vector<std::vector<NeighbourGrain>> neighbours(n_grains);
#pragma omp parallel for schedule(dynamic, 8)
  for (int g = 0; g < n_grains; ++g) {
    neighbours[g] = neighbour_grains(g, bounds_, box, reach);
  }
  collect_images(neighbours);
#pragma omp parallel for schedule(dynamic, 1)
  for (int g = 0; g < n_grains; ++g) {
    build_rows(g, neighbours[g], box, *network_of_grain[g]);
  }
  origin_ = box.origin();
  deformation_ = Matrix3::Identity();
  bound_ = 0.0;
  built_ = true;
  ++n_builds_;
}

namespace {

/// A row of the list before it is split into columns; sorted by the members in this order.
struct SortedPair {
  bool narrow;
  std::int32_t own, other, image;
  auto operator<=>(const SortedPair&) const = default;
};

/// True when own node i and node j displaced by n are bonded across the boundary of a periodic template.
bool bonded_across(const NetworkData& network, const CandidatePair& pair, const ImageVector& n) {
  const Eigen::Vector3i image(n.a, n.b, n.c);
  return std::any_of(network.image_bonds().begin(), network.image_bonds().end(), [&](const ImageBond& bond) {
    return (bond.i == pair.own && bond.j == pair.node && bond.n == image) ||
           (bond.j == pair.own && bond.i == pair.node && bond.n == -image);
  });
}

} // namespace

void ContactList::build_rows(int grain, const std::vector<NeighbourGrain>& neighbours, const Box& box,
                             const NetworkData& network) {
  thread_local std::vector<CandidatePair> pairs;
  pairs.clear();
  std::vector<std::int32_t> image_index;
  for (int k = 0; k < static_cast<int>(neighbours.size()); ++k) {
    const ImageVector& n = neighbours[k].image;
    const Vector3 shift = box.h() * Vector3(n.a, n.b, n.c);
    add_pairs_between(grids_[grain], grids_[neighbours[k].other], shift, k, pairs);
    image_index.push_back(
        static_cast<std::int32_t>(std::lower_bound(images_.begin(), images_.end(), n) - images_.begin()));
  }
  add_pairs_inside(grids_[grain], network, pairs);
  const auto own_image =
      static_cast<std::int32_t>(std::lower_bound(images_.begin(), images_.end(), ImageVector{}) - images_.begin());

  thread_local std::vector<SortedPair> sorted;
  sorted.clear();
  sorted.reserve(pairs.size());
  for (const CandidatePair& pair : pairs) {
    const bool own = pair.neighbour < 0;
    const int other = own ? grain : neighbours[pair.neighbour].other;
    if (!own && other == grain && !network.image_bonds().empty() &&
        bonded_across(network, pair, neighbours[pair.neighbour].image)) {
      continue;
    }
    sorted.push_back({layout_.stride(other) == 1, pair.own * 3 * layout_.stride(grain),
                      static_cast<std::int32_t>(layout_.index(other, pair.node, 0)),
                      own ? own_image : image_index[pair.neighbour]});
  }
  std::sort(sorted.begin(), sorted.end());

  Rows& rows = rows_[grain];
  rows.own.resize(sorted.size());
  rows.other.resize(sorted.size());
  rows.image.resize(sorted.size());
  rows.n_wide = std::count_if(sorted.begin(), sorted.end(), [](const SortedPair& pair) { return !pair.narrow; });
  for (std::size_t e = 0; e < sorted.size(); ++e) {
    rows.own[e] = sorted[e].own;
    rows.other[e] = sorted[e].other;
    rows.image[e] = sorted[e].image;
  }
}

void ContactList::note_motion(const Matrix3& cell_map, double displacement) {
  if (built_) {
    deformation_ = cell_map * deformation_;
    bound_ = bound_ * (1.0 + (cell_map - Matrix3::Identity()).norm()) + displacement;
  }
}

double ContactList::largest_displacement(const LaneState& state) const {
  const Matrix3& m = deformation_;
  const Vector3 shift = origin_ - m * origin_;
  const std::vector<Block>& blocks = layout_.blocks();
  double largest2 = 0.0;
#pragma omp parallel for schedule(dynamic, 1) reduction(max : largest2)
  for (int b = 0; b < static_cast<int>(blocks.size()); ++b) {
    const int stride = blocks[b].n_lanes;
    for (std::int64_t node = 0; node < blocks[b].n_nodes; ++node) {
      const double* x = state.x.data() + blocks[b].offset + 3 * node * stride;
      const double* r = reference_.data() + blocks[b].offset + 3 * node * stride;
      for (int l = 0; l < stride; ++l) {
        const double rx = r[l], ry = r[l + stride], rz = r[l + 2 * stride];
        const double dx = x[l] - (m(0, 0) * rx + m(0, 1) * ry + m(0, 2) * rz + shift[0]);
        const double dy = x[l + stride] - (m(1, 1) * ry + m(1, 2) * rz + shift[1]);
        const double dz = x[l + 2 * stride] - (m(2, 2) * rz + shift[2]);
        largest2 = std::max(largest2, dx * dx + dy * dy + dz * dz);
      }
    }
  }
  return std::sqrt(largest2);
}

bool ContactList::expired(const LaneState& state) {
  if (!built_) {
    return true;
  }
  // A pair outside the list was at least diameter + skin apart; the cell's deformation shortens that by its smallest
  // stretch (bounded from below by 1 - |F - 1|), and each of the two nodes may have come nearer by its displacement.
  const double stretch = 1.0 - (deformation_ - Matrix3::Identity()).norm();
  const double allowed = 0.5 * (stretch * (diameter_ + skin_) - diameter_);
  if (bound_ > allowed && allowed > 0.0) {
    bound_ = largest_displacement(state);
  }
  return !(bound_ <= allowed);
}

kernels::ContactRows ContactList::rows(int grain, int other_stride) const {
  const Rows& rows = rows_[grain];
  const bool wide = other_stride == block_lanes;
  const std::int64_t from = wide ? 0 : rows.n_wide;
  const std::int64_t to = wide ? rows.n_wide : static_cast<std::int64_t>(rows.own.size());
  return {to - from,           rows.own.data() + from, rows.other.data() + from, rows.image.data() + from,
          layout_.stride(grain), other_stride};
}

std::int64_t ContactList::n_candidates() const {
  std::int64_t n = 0;
  for (const Rows& rows : rows_) {
    n += static_cast<std::int64_t>(rows.own.size());
  }
  return n;
}

std::size_t ContactList::bytes() const {
  std::size_t bytes = reference_.capacity() * sizeof(double);
  for (const GrainGrid& grid : grids_) {
    bytes += grid.bytes();
  }
  for (const Rows& rows : rows_) {
    bytes += (rows.own.capacity() + rows.other.capacity() + rows.image.capacity()) * sizeof(std::int32_t);
  }
  return bytes;
}

} // namespace boba
