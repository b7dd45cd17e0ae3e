// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/measure/grain_shapes.h"
#include "bpm/measure/contact_network.h"
#include "bpm/measure/measure_plan.h"

#include <optional>
#include <span>
#include <vector>

namespace boba {

/// Facets at other thresholds than the plan's.
struct FacetSensitivity {
  measure::FacetOptions options;
  std::vector<FacetSummary> grains;
};

/// Those measures of a frame that take long. Empty where the plan does not ask.
struct FrameMeasures {
  std::vector<double> hull_radii;         ///< per grain: of the ball of the hull's volume, d
  std::vector<GrainShape> shapes;         ///< per grain
  std::vector<std::vector<Facet>> facets; ///< per grain
  std::vector<FacetSensitivity> sensitivity;
  std::optional<measure::PackingFraction> packing_fraction;
  std::vector<measure::ScatteringShell> scattering;
  std::vector<measure::GrainContact> contacts;
};

/// Takes them on all ranks together: each does its own grains and wave vectors (DealtItems), then all have all of it,
/// the same for any number of ranks. Collective.
///
/// \param position of all nodes, on every rank, d  \param first_node of every grain, as in GrainNodes
/// \throws std::invalid_argument for a grain or a cell that cannot be measured; RankError on all when there are
/// several.
FrameMeasures measure_together(const Box& box, std::span<const Vector3> position,
                               std::span<const std::int64_t> first_node, const MeasurePlan& plan, const Ranks& ranks);

} // namespace boba
