// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/material.h"
#include "bpm/measure/bond_order.h"
#include "bpm/measure/hull_facets.h"
#include "bpm/measure/packing_fraction.h"
#include "bpm/measure/scattering.h"
#include "bpm/measure/template_matching.h"

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace boba {

/// What can be measured on a frame; each kind writes its own tables. Source: docs/formats-measure.md.
enum class MeasureKind { stress, packing_fraction, shape, scattering, order, contacts, motion };

enum class NeighbourRule { solid_angle, voronoi };

/// Which measures are taken, and how.
struct MeasurePlan {
  std::set<MeasureKind> kinds;
  std::set<std::string> outside; ///< names of measures that the program brings of its own (outside_measure.h)
  measure::PackingFractionOptions packing_fraction;
  measure::FacetOptions facets;
  bool facet_sensitivity = false; ///< facets also at other thresholds, into a table of their own
  measure::ScatteringOptions scattering;
  measure::BondOrderOptions order;
  measure::TemplateOptions templates;
  static constexpr double default_rest = 100.0;
  std::optional<double> rest; ///< order is that of a copy after a rest of this time, tau
  NeighbourRule neighbours = NeighbourRule::solid_angle;
  Material material;

  /// Grains of at least this many nodes have a hull.
  static constexpr int fewest_nodes_of_hull = 4;

  bool has(MeasureKind kind) const { return kinds.contains(kind); }
  bool is_empty() const { return kinds.empty() && outside.empty(); }
  /// Order and motion look at neighbours by the grains' volumes.
  bool needs_hull_radii() const {
    return neighbours == NeighbourRule::voronoi && (has(MeasureKind::order) || has(MeasureKind::motion));
  }
  bool needs_hulls() const {
    return has(MeasureKind::shape) || has(MeasureKind::packing_fraction) || needs_hull_radii();
  }
  /// Something is measured that takes long, so that all ranks do a share of it and need the nodes.
  bool needs_all_ranks() const { return needs_hulls() || has(MeasureKind::scattering) || has(MeasureKind::contacts); }
};

/// The names that the command line and scenes use: stress, packing-fraction, shape, scattering, order, contacts,
/// motion, and those of measures that were added.
std::vector<std::string> measure_names();

/// Adds the measures of these names to a plan; "all" means every one.
/// \throws std::invalid_argument for another name, with the names there are.
void choose_measures(MeasurePlan& plan, const std::vector<std::string>& names);

} // namespace boba
