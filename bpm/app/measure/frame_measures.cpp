// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/measure/frame_measures.h"

#include "bpm/measure/parallel_loop.h"

#include <cmath>
#include <numbers>

namespace boba {

using namespace measure;

namespace {

std::vector<double> hull_radii(const std::vector<ConvexHull>& hulls, const DealtItems& items) {
  std::vector<double> radii(hulls.size());
  parallel_loop(items, [&](std::int64_t g) {
    radii[g] = std::cbrt(3.0 * hull_shape(hulls[g]).volume / (4.0 * std::numbers::pi));
  });
  items.share(radii);
  return radii;
}

void find_shapes(const std::vector<ConvexHull>& hulls, const FacetOptions& options, const DealtItems& items,
                 FrameMeasures& found) {
  found.shapes.resize(hulls.size());
  found.facets.resize(hulls.size());
  parallel_loop(items, [&](std::int64_t g) { found.shapes[g] = grain_shape(hulls[g], options, &found.facets[g]); });
  items.share(found.shapes);
  items.share(found.facets);
}

FacetSensitivity facet_sensitivity(const std::vector<ConvexHull>& hulls, const FacetOptions& options,
                                   const DealtItems& items) {
  FacetSensitivity result{options, std::vector<FacetSummary>(hulls.size())};
  parallel_loop(items, [&](std::int64_t g) { result.grains[g] = summary_of(grown_facets(hulls[g], options)); });
  items.share(result.grains);
  return result;
}

/// The other thresholds at which facets are counted.
std::vector<FacetOptions> sensitivity_thresholds() {
  std::vector<FacetOptions> thresholds;
  for (const double cosine : {0.98, 0.985, 0.99, 0.995}) {
    for (const double area_share : {0.005, 0.01, 0.02}) {
      thresholds.push_back({cosine, area_share});
    }
  }
  return thresholds;
}

} // namespace

FrameMeasures measure_together(const Box& box, std::span<const Vector3> position,
                               std::span<const std::int64_t> first_node, const MeasurePlan& plan, const Ranks& ranks) {
  using enum MeasureKind;
  FrameMeasures found;
  if (!plan.needs_all_ranks()) {
    return found;
  }
  const GrainNodes grains(position, first_node);
  const DealtItems items(ranks, grains.n_grains());
  std::vector<ConvexHull> hulls; // of this rank's grains
  if (plan.needs_hulls()) {
    hulls = grain_hulls(grains, items);
  }
  if (plan.needs_hull_radii()) {
    found.hull_radii = hull_radii(hulls, items);
  }
  if (plan.has(packing_fraction)) {
    found.packing_fraction = measure::packing_fraction(box, grains, hulls, plan.packing_fraction, ranks);
  }
  if (plan.has(shape)) {
    find_shapes(hulls, plan.facets, items, found);
  }
  if (plan.has(shape) && plan.facet_sensitivity) {
    for (const FacetOptions& options : sensitivity_thresholds()) {
      found.sensitivity.push_back(facet_sensitivity(hulls, options, items));
    }
  }
  if (plan.has(scattering)) {
    found.scattering = measure::scattering(box, grains, plan.scattering, ranks);
  }
  if (plan.has(contacts)) {
    found.contacts = contact_network(box, grains, plan.material, ranks);
  }
  return found;
}

} // namespace boba
