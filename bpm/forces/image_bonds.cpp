// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/image_bonds.h"

#include <cmath>
#include <vector>

namespace boba {

namespace {

Vector3 triple(const double* array, std::int64_t node, int stride) {
  const double* at = array + 3 * node * stride;
  return {at[0], at[stride], at[2 * stride]};
}

/// x_i - (x_j + h n) in one lane.
Vector3 separation(const ImageBond& bond, const Box& box, const double* x, int stride) {
  return triple(x, bond.i, stride) - triple(x, bond.j, stride) - box.h() * bond.n.cast<double>();
}

/// Sum of r^3 per node over all bonds of the template, in one lane.
std::vector<double> all_volumes(const NetworkData& network, const Box& box, const double* x, int stride) {
  std::vector<double> volume(network.n_nodes(), 0.0);
  const kernels::Network view = network.view();
  const auto add = [&](int i, int j, double r) {
    volume[i] += r * r * r;
    volume[j] += r * r * r;
  };
  for (int i = 0; i < view.n_nodes; ++i) {
    for (std::int64_t b = view.first_bond[i]; b < view.first_bond[i + 1]; ++b) {
      const int j = static_cast<int>(view.bonds[b].other);
      add(i, j, (triple(x, i, stride) - triple(x, j, stride)).norm());
    }
  }
  for (const ImageBond& bond : network.image_bonds()) {
    add(bond.i, bond.j, separation(bond, box, x, stride).norm());
  }
  return volume;
}

} // namespace

ImageBondSums add_image_bonds(const NetworkData& network, const BondLaw& law, const Box& box,
                              const Matrix3& residual_rate, bool many_body, kernels::BlockArrays& arrays) {
  ImageBondSums sums{};
  const int stride = arrays.n_lanes;
  for (int lane = 0; lane < stride; ++lane) {
    const double* x = arrays.x + lane;
    const double* v = arrays.v + lane;
    const double alpha = arrays.alpha[lane];
    const std::vector<double> volume =
        many_body ? all_volumes(network, box, x, stride) : std::vector<double>(network.n_nodes(), 0.0);
    for (const ImageBond& bond : network.image_bonds()) {
      const Vector3 d = separation(bond, box, x, stride);
      const double r = d.norm();
      const Vector3 w = triple(v, bond.i, stride) - triple(v, bond.j, stride) - residual_rate * bond.n.cast<double>();
      const double normal_velocity = d.dot(w) / r;
      const double cbrt_ratio = many_body ? std::cbrt((volume[bond.i] + volume[bond.j]) * bond.inverse_volume) : 1.0;
      const double force = law.force(alpha, r, bond.r0, 1.0 / bond.r0, cbrt_ratio, normal_velocity);
      const double s = force / r;
      for (int c = 0; c < 3; ++c) {
        arrays.f[(3 * static_cast<std::int64_t>(bond.i) + c) * stride + lane] += s * d[c];
        arrays.f[(3 * static_cast<std::int64_t>(bond.j) + c) * stride + lane] -= s * d[c];
      }
      const double dyad[6] = {d[0] * d[0], d[1] * d[1], d[2] * d[2], d[0] * d[1], d[0] * d[2], d[1] * d[2]};
      for (int c = 0; c < 6; ++c) {
        sums.virial[c][lane] += s * dyad[c];
      }
      if (many_body) {
        arrays.volume[static_cast<std::int64_t>(bond.i) * stride + lane] += r * r * r;
        arrays.volume[static_cast<std::int64_t>(bond.j) * stride + lane] += r * r * r;
      }
    }
  }
  return sums;
}

} // namespace boba
