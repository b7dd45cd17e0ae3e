// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/measure/convex_hull.h"

#include <vector>

namespace boba::measure {

/// Thresholds of the facet rules. The defaults are those of the definition.
struct FacetOptions {
  double min_cosine = 0.99;     ///< triangles belong together while n . n' is above this; within (-1, 1)
  double min_area_share = 0.01; ///< robust rule only: smallest facet as a share of the hull's area; within [0, 1)
};

/// The flat parts of a hull.
struct Facets {
  std::vector<int> facet_of_triangle; ///< number of the facet, or -1 for a triangle in a curved part
  std::vector<double> area;           ///< per facet, descending, d^2
  std::vector<Vector3> normal;        ///< per facet: area-weighted mean of its triangles' normals, unit length
  double hull_area = 0.0;             ///< d^2

  int n_facets() const { return static_cast<int>(area.size()); }
  double faceted_share() const; ///< share of the hull's area in facets; the rest is curved
};

/// Facets by the published rule: triangles joined across edges while n_i . n_j > min_cosine, transitively; a triangle
/// that joins with none of its neighbours is curved.
///
/// Transitive joining can run round a smooth hull: an undeformed grain with fine triangles is one single facet.
/// \throws std::invalid_argument for thresholds out of range.
/// Source: Clemmer, Hackney, Grest, "Shear and crystallization in deformable granular packings", facets of the hull.
Facets transitive_facets(const ConvexHull& hull, const FacetOptions& options = {});

/// Facets by the robust rule: connected regions of triangles whose normal is within min_cosine of the *seed's* normal,
/// taken largest region first (over all possible seeds, then again among what is left); those of at least
/// min_area_share of the hull's area are facets, everything else is curved.
///
/// \throws std::invalid_argument for thresholds out of range.
/// Source: docs/notation.md, "facet, robust rule".
Facets grown_facets(const ConvexHull& hull, const FacetOptions& options = {});

} // namespace boba::measure
