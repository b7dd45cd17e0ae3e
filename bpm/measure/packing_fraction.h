// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/measure/convex_hull.h"
#include "bpm/measure/grain_nodes.h"
#include "bpm/parallel/ranks.h"

#include <cstdint>
#include <optional>
#include <span>

namespace boba::measure {

struct PackingFractionOptions {
  std::uint64_t seed = 1;
  std::int64_t n_points = 100000; ///< random points; where a target error is given, the first batch at most
  std::optional<double> target_error =
      std::nullopt;           ///< draw points until the standard error of `both` is at most this; 1e-5 .. 0.5
  double node_diameter = 1.0; ///< d
};

/// A share of the box with its standard error.
struct Share {
  double value = 0.0;
  double standard_error = 0.0;
};

struct PackingFraction {
  Share both;  ///< phi: within node_diameter / 2 of a node or inside a hull
  Share nodes; ///< within node_diameter / 2 of a node
  Share hulls; ///< inside a convex hull
  std::int64_t n_points = 0;
};

/// Packing fraction by random points in the box.
///
/// phi = n_hit / n; its standard error is sqrt(p (1 - p) / n) with p = (n_hit + 1) / (n + 2), which does not vanish
/// when all points hit. Point i of a seed is the same on any number of threads and ranks, hence so is the result.
/// \param hulls one a grain, in unwrapped coordinates like the nodes; or none at all, which leaves the nodes
/// \param ranks collective: all call it alike, each looks at what its own grains hit (DealtItems), of which alone it
/// needs the hulls, and all have the result
/// \throws std::invalid_argument for options out of range or a wrong number of hulls.
/// Source: docs/notation.md, "packing fraction".
PackingFraction packing_fraction(const Box& box, const GrainNodes& grains, std::span<const ConvexHull> hulls,
                                 const PackingFractionOptions& options = {}, const Ranks& ranks = Ranks::alone());

/// The cheap measure: volume of the undeformed grains over the volume of the box. It exceeds the packing fraction, and
/// may exceed 1, where grains are compressed.
double reference_packing_fraction(const Box& box, std::span<const double> reference_volumes);

} // namespace boba::measure
