// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/node_exchange.h"

#include "bpm/parallel/star_forest.h"

#include <memory>

namespace boba {

namespace {

/// Roots: all nodes, on rank 0. Leaves: each rank's own, grain by grain.
std::unique_ptr<StarForest> forest_from_root(const MovingPacking& moving) {
  const std::vector<std::int64_t> first = moving.packing.first_nodes();
  std::vector<RootPlace> roots;
  for (const int g : moving.layout.grains()) {
    for (std::int64_t node = first[g]; node < first[g + 1]; ++node) {
      roots.push_back({0, static_cast<int>(node)});
    }
  }
  return make_star_forest(moving.ranks().is_root() ? static_cast<int>(first.back()) : 0, roots);
}

} // namespace

std::vector<std::byte> own_nodes(const MovingPacking& moving) {
  const std::size_t size = moving.state.node_bytes();
  std::vector<std::byte> own;
  for (const int g : moving.layout.grains()) {
    own.resize(own.size() + size * moving.layout.n_nodes(g));
    moving.state.pack(g, own.data() + own.size() - size * moving.layout.n_nodes(g));
  }
  return own;
}

void scatter_nodes(MovingPacking& moving, const std::vector<std::byte>& all) {
  const std::size_t size = moving.state.node_bytes();
  const bool is_distributed = moving.ranks().is_distributed();
  std::vector<std::byte> own;
  if (is_distributed) {
    own.resize(size * moving.distribution.ownership.n_nodes_of(moving.ranks().rank()));
    forest_from_root(moving)->copy(size, all.data(), own.data());
  }
  const std::byte* from = is_distributed ? own.data() : all.data();
  for (const int g : moving.layout.grains()) {
    moving.state.unpack(g, from);
    from += size * moving.layout.n_nodes(g);
  }
}

void gather_nodes(const MovingPacking& moving, std::vector<Vector3>& values) {
  if (moving.ranks().is_distributed()) {
    std::vector<Vector3> all(moving.ranks().is_root() ? moving.packing.first_nodes().back() : 0);
    forest_from_root(moving)->collect(sizeof(Vector3), values.data(), all.data());
    values.swap(all);
  }
}

void gather_rows(const MovingPacking& moving, int width, std::vector<double>& rows) {
  if (moving.ranks().is_distributed()) {
    const std::int64_t n_nodes = moving.ranks().is_root() ? moving.packing.first_nodes().back() : 0;
    std::vector<double> all(static_cast<std::size_t>(width * n_nodes));
    forest_from_root(moving)->collect(static_cast<std::size_t>(width) * sizeof(double), rows.data(), all.data());
    rows.swap(all);
  }
}

void share_grains(const MovingPacking& moving, std::vector<Vector3>& values) {
  moving.ranks().share_rows({values.data()->data(), 3 * values.size()}, 3, moving.distribution.ownership);
}

} // namespace boba
