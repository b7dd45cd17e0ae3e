// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/measure/convex_hull.h"
#include "bpm/measure/grain_nodes.h"
#include "bpm/measure/hull_facets.h"
#include "bpm/measure/hull_shape.h"
#include "bpm/packing/packing.h"
#include "bpm/parallel/dealt_items.h"

#include <optional>
#include <vector>

namespace boba {

/// How flat a grain is by one rule.
struct FacetSummary {
  int n_facets = 0;
  double faceted_share = 0.0; ///< of the hull's area
};
FacetSummary summary_of(const measure::Facets& facets);

/// Size and shape of one grain by every definition that is reported.
struct GrainShape {
  measure::HullShape shape;
  FacetSummary grown;      ///< robust rule
  FacetSummary transitive; ///< published rule
};

/// A facet by the robust rule.
struct Facet {
  double area = 0.0;                ///< d^2
  Vector3 normal = Vector3::Zero(); ///< unit, outwards
};

/// The facets are also told one by one where `facets` is given: largest first.
GrainShape grain_shape(const measure::ConvexHull& hull, const measure::FacetOptions& options,
                       std::vector<Facet>* facets = nullptr);

/// Hulls of the grains dealt out to this rank, on all threads; the others' stay empty. Collective.
/// \throws std::invalid_argument (RankError on several ranks) naming the grain whose nodes have no volume.
std::vector<measure::ConvexHull> grain_hulls(const measure::GrainNodes& grains, const DealtItems& items);

/// Nodes of an undeformed grain of each template: the baseline of every shape. Empty where it is not known (a template
/// whose bonds are not at their rest length).
struct UndeformedGrains {
  std::vector<std::vector<Vector3>> nodes; ///< by template index
};

UndeformedGrains undeformed_grains(const Packing& packing);

/// The same from a trajectory: as stored, else from its first frame for templates of which some grain has all its bonds
/// at their rest length (within 1e-6); the others stay empty.
UndeformedGrains undeformed_grains(const Topology& topology, const Snapshot& snapshot);

} // namespace boba
