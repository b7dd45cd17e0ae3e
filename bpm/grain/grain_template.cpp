// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/grain_template.h"

#include "bpm/grain/bulk_density.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace boba {

bool is_at_rest(const GrainTemplate& grain) {
  return std::all_of(grain.bonds.begin(), grain.bonds.end(), [&](const Bond& bond) {
    Eigen::Vector3d d = grain.position[bond.i] - grain.position[bond.j];
    if (grain.period) {
      d -= d.cwiseQuotient(*grain.period).array().round().matrix().cwiseProduct(*grain.period);
    }
    return std::abs(d.norm() - bond.r0) <= 1e-6 * bond.r0;
  });
}

double nominal_volume(int n_nodes) {
  return n_nodes == 1 ? std::numbers::pi / 6.0 : n_nodes / bulk_node_density;
}

std::vector<double> reference_node_volumes(int n_nodes, const std::vector<Bond>& bonds) {
  std::vector<double> volume(n_nodes, 0.0);
  for (const Bond& bond : bonds) {
    const double cube = bond.r0 * bond.r0 * bond.r0;
    volume[bond.i] += cube;
    volume[bond.j] += cube;
  }
  return volume;
}

} // namespace boba
