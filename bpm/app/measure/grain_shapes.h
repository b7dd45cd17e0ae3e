// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/measure/convex_hull.h"
#include "bpm/measure/grain_nodes.h"
#include "bpm/measure/hull_facets.h"
#include "bpm/measure/hull_shape.h"
#include "bpm/packing/packing.h"

#include <optional>
#include <vector>

namespace boba {

/// Shape of one grain by every definition that is reported.
struct GrainShape {
  measure::HullShape shape;
  measure::Facets grown;      ///< robust rule
  measure::Facets transitive; ///< published rule
};

GrainShape grain_shape(const measure::ConvexHull& hull, const measure::FacetOptions& options);

/// Hulls of all grains, on all threads. \throws std::invalid_argument naming the grain whose nodes have no volume.
std::vector<measure::ConvexHull> grain_hulls(const measure::GrainNodes& grains);

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
