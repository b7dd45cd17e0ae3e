// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/build_template.h"

#include "bpm/grain/arrangement.h"
#include "bpm/grain/bond_network.h"
#include "bpm/grain/near_pairs.h"
#include "bpm/grain/outline.h"
#include "bpm/grain/random.h"
#include "bpm/grain/spatial_order.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace boba {

namespace {

using Eigen::Vector3d;
using Shape = TemplateSpec::Shape;
using Surface = TemplateSpec::Surface;

constexpr double wall_compaction = 1.41 / bulk_node_density; // density inside the wall's outline over that of the bulk
constexpr int cut_attempts = 200;
constexpr int wall_attempts = 10;

void centre(std::vector<Vector3d>& position) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& x : position) {
    mean += x;
  }
  mean /= static_cast<double>(position.size());
  for (Vector3d& x : position) {
    x -= mean;
  }
}

/// Sorts the nodes in space and bonds them; a free grain is centred first.
GrainTemplate bonded(const std::vector<Vector3d>& nodes, const TemplateSpec& spec,
                     const std::optional<Vector3d>& period) {
  GrainTemplate grain;
  for (const int n : hilbert_order(nodes)) {
    grain.position.push_back(nodes[n]);
  }
  if (!period) {
    centre(grain.position);
  }
  grain.period = period;
  grain.bonds = bonds_closer_than(grain.position, spec.bond_cutoff, period);
  grain.reference_volume = period ? period->prod() : grain.n_nodes() / spec.density;
  return grain;
}

GrainTemplate build_periodic(const TemplateSpec& spec, Random& random) {
  Outline outline(spec, 1.0);
  const int n = spec.n_nodes.value_or(static_cast<int>(std::lround(spec.density * outline.volume())));
  if (spec.n_nodes) {
    outline = Outline::with_volume(spec, n / spec.density);
  }
  const Vector3d period = 2.0 * outline.half_lengths();
  GrainTemplate box = bonded(bulk_arrangement(period, n, random), spec, period);
  if (const auto floating = floating_part(box)) {
    throw std::runtime_error(fmt::format("grain template \"{}\": {}", canonical_text(spec), *floating));
  }
  return box;
}

/// A bulk cuboid of whole fcc cells, at least as long as `lengths`.
std::pair<std::vector<Vector3d>, Vector3d> bulk_around(const Vector3d& lengths, double density, Random& random) {
  constexpr int fewest_cells = 6; // so that a small grain's bulk is no crystal by its own images
  const double edge = std::cbrt(4.0 / density);
  const Eigen::Vector3i cells = (lengths / edge).array().ceil().cast<int>().max(fewest_cells);
  const Vector3d period = edge * cells.cast<double>();
  return {bulk_arrangement(period, 4 * cells.prod(), random), period};
}

/// The nodes of a bulk inside the outline about `point`, as difference vectors to it.
std::vector<Vector3d> cut(const std::vector<Vector3d>& bulk, const Vector3d& period, const Vector3d& point,
                          const Outline& outline, std::optional<int> n_nodes) {
  std::vector<std::pair<double, int>> reach(bulk.size());
  std::vector<Vector3d> relative(bulk.size());
  for (std::size_t n = 0; n < bulk.size(); ++n) {
    relative[n] = wrapped(bulk[n] - point, period);
    reach[n] = {outline.reach(relative[n]), static_cast<int>(n)};
  }
  std::sort(reach.begin(), reach.end());
  const auto outside = std::find_if(reach.begin(), reach.end(), [](const auto& node) { return node.first > 1.0; });
  const std::ptrdiff_t count = n_nodes ? *n_nodes : outside - reach.begin();
  std::vector<Vector3d> inside;
  for (std::ptrdiff_t n = 0; n < count; ++n) {
    inside.push_back(relative[reach[n].second]);
  }
  return inside;
}

GrainTemplate build_cut(const TemplateSpec& spec, Random& random) {
  const Outline outline = spec.n_nodes ? Outline::with_volume(spec, *spec.n_nodes / spec.density) : Outline(spec, 1.0);
  // Room for a count below its mean, which makes the outline of an exact number of nodes grow a little.
  const auto [bulk, period] = bulk_around(2.0 * outline.half_lengths() + Vector3d::Constant(1.0), spec.density, random);
  std::string reason;
  for (int attempt = 0; attempt < cut_attempts; ++attempt) {
    const Vector3d point = period.cwiseProduct(random.vector(0.5));
    GrainTemplate grain = bonded(cut(bulk, period, point, outline, spec.n_nodes), spec, std::nullopt);
    const auto floating = floating_part(grain);
    if (!floating) {
      return grain;
    }
    reason = *floating;
  }
  throw std::runtime_error(fmt::format("grain template \"{}\": none of {} random cuts left a rigid grain; last: {}",
                                       canonical_text(spec), cut_attempts, reason));
}

GrainTemplate build_walled(const TemplateSpec& spec, Random& random) {
  const double nominal = Outline(spec, 1.0).volume();
  const int n = spec.n_nodes.value_or(static_cast<int>(std::lround(spec.density * nominal)));
  const Outline outline = Outline::with_volume(spec, n / (wall_compaction * spec.density));
  std::string reason;
  for (int attempt = 0; attempt < wall_attempts; ++attempt) {
    GrainTemplate grain = bonded(walled_arrangement(outline, n, random), spec, std::nullopt);
    const auto floating = floating_part(grain);
    if (!floating) {
      return grain;
    }
    reason = *floating;
  }
  throw std::runtime_error(fmt::format("grain template \"{}\": none of {} relaxations left a rigid grain; last: {}",
                                       canonical_text(spec), wall_attempts, reason));
}

/// One node is a whole sphere: it stands for the volume of a sphere of diameter d.
GrainTemplate single_node() {
  GrainTemplate grain;
  grain.position = {Vector3d::Zero()};
  grain.reference_volume = std::numbers::pi / 6.0;
  return grain;
}

} // namespace

GrainTemplate build_template(const TemplateSpec& spec) {
  validate(spec);
  if (is_single_node(spec)) {
    return single_node();
  }
  Random random(spec.seed);
  if (spec.shape == Shape::periodic_box) {
    return build_periodic(spec, random);
  }
  return spec.surface == Surface::cut ? build_cut(spec, random) : build_walled(spec, random);
}

} // namespace boba
