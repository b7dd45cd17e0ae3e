// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/compare/surface_rule.h"

#include "bpm/laws/wall.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace boba::calibration {

SurfaceRule surface_rule(const GrainTemplate& sphere, double density) {
  if (sphere.period) {
    throw std::invalid_argument("a periodic template has no surface");
  }
  std::vector<double> radius;
  for (const Eigen::Vector3d& x : sphere.position) {
    radius.push_back(x.norm());
  }
  std::sort(radius.begin(), radius.end(), std::greater<>());
  SurfaceRule rule{.nodes_per_area = std::pow(density, 2.0 / 3.0)};
  const ContactLaw law;
  rule.c1 = -wall_slopes(law, 0.5 * law.range(), 0.0).by_distance * rule.nodes_per_area;
  rule.c3 = 8.0 * law.k3 * rule.nodes_per_area;
  double sum = 0.0, mean = 0.0;
  while (rule.n_layer < static_cast<int>(radius.size())) { // until the layer is full at its own mean radius
    sum += radius[rule.n_layer];
    mean = sum / ++rule.n_layer;
    if (rule.n_layer >= rule.nodes_per_area * 4.0 * M_PI * mean * mean) {
      break;
    }
  }
  rule.radius = mean + 0.5;
  return rule;
}

double bond_radius(const GrainTemplate& sphere, const BulkDensity& bulk) {
  double sum = 0.0;
  for (const Bond& bond : sphere.bonds) {
    sum += bond.r0 * bond.r0;
  }
  return std::cbrt(3.0 * sum / (4.0 * M_PI * bulk.bonds));
}

} // namespace boba::calibration
