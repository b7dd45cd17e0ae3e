// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/measure/grain_shapes.h"

#include "bpm/measure/parallel_loop.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

FacetSummary summary_of(const measure::Facets& facets) {
  return {facets.n_facets(), facets.faceted_share()};
}

GrainShape grain_shape(const measure::ConvexHull& hull, const measure::FacetOptions& options,
                       std::vector<Facet>* facets) {
  const measure::Facets grown = measure::grown_facets(hull, options);
  for (int f = 0; facets != nullptr && f < grown.n_facets(); ++f) {
    facets->push_back({grown.area[f], grown.normal[f]});
  }
  return {measure::hull_shape(hull), summary_of(grown), summary_of(measure::transitive_facets(hull, options))};
}

std::vector<measure::ConvexHull> grain_hulls(const measure::GrainNodes& grains, const DealtItems& items) {
  std::vector<measure::ConvexHull> hulls(grains.n_grains());
  measure::parallel_loop(items, [&](std::int64_t g) {
    try {
      hulls[g] = measure::convex_hull(grains.nodes_of(static_cast<int>(g)));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("grain {}: {}", g, error.what()));
    }
  });
  return hulls;
}

UndeformedGrains undeformed_grains(const Packing& packing) {
  UndeformedGrains undeformed;
  for (const auto& grain_template : packing.templates) {
    undeformed.nodes.push_back(is_at_rest(*grain_template) ? grain_template->position : std::vector<Vector3>{});
  }
  return undeformed;
}

UndeformedGrains undeformed_grains(const Topology& topology, const Snapshot& snapshot) {
  constexpr double tolerance = 1e-6;
  std::vector<char> strained(topology.n_grains(), 0);
  const std::vector<int> grain_of_node = topology.grain_of_node();
  for (const Topology::Pair& bond : topology.bonds) {
    const double r = (snapshot.position[bond.i] - snapshot.position[bond.j]).norm();
    if (std::abs(r / bond.r0 - 1.0) > tolerance) {
      strained[grain_of_node[bond.i]] = 1;
    }
  }
  UndeformedGrains undeformed;
  const auto& index = topology.template_index;
  undeformed.nodes = topology.undeformed;
  undeformed.nodes.resize(index.empty() ? 0 : *std::max_element(index.begin(), index.end()) + 1);
  for (int grain = 0; grain < topology.n_grains() && !topology.bonds.empty(); ++grain) {
    std::vector<Vector3>& nodes = undeformed.nodes[index[grain]];
    if (nodes.empty() && !strained[grain]) {
      const auto found = snapshot.nodes_of(topology, grain);
      nodes.assign(found.begin(), found.end());
    }
  }
  return undeformed;
}

} // namespace boba
