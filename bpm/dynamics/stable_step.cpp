// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/stable_step.h"

#include <cmath>
#include <stdexcept>
#include <vector>

namespace boba {

namespace {

using Vectors = std::vector<Eigen::Vector3d>;

constexpr int power_iterations = 200;

/// The bond network linearised about its undeformed state.
class LinearNetwork {
public:
  LinearNetwork(const GrainTemplate& grain, const Material& material, double alpha)
      : grain_(grain), material_(material), alpha_(alpha),
        volume_(reference_node_volumes(grain.n_nodes(), grain.bonds)) {
    for (const Bond& bond : grain.bonds) {
      Eigen::Vector3d difference = grain.position[bond.i] - grain.position[bond.j];
      if (grain.period) {
        difference -= grain.period->cwiseProduct((difference.cwiseQuotient(*grain.period)).array().round().matrix());
      }
      direction_.push_back(difference.normalized());
    }
  }

  /// Minus the change of the elastic forces under displacements u. With the stretch s = e . (u_i - u_j) of a bond,
  /// df = -(k + alpha / r0) s + alpha (W_i + W_j) / (V0_i + V0_j), W_i = sum over the bonds of i of r0^2 s.
  Vectors stiffness(const Vectors& u) const {
    std::vector<double> swelling(volume_.size(), 0.0);
    if (alpha_ != 0.0) {
      for (std::size_t b = 0; b < grain_.bonds.size(); ++b) {
        const Bond& bond = grain_.bonds[b];
        const double gain = bond.r0 * bond.r0 * direction_[b].dot(u[bond.i] - u[bond.j]);
        swelling[bond.i] += gain;
        swelling[bond.j] += gain;
      }
    }
    Vectors result(u.size(), Eigen::Vector3d::Zero());
    for (std::size_t b = 0; b < grain_.bonds.size(); ++b) {
      const Bond& bond = grain_.bonds[b];
      const double stretch = direction_[b].dot(u[bond.i] - u[bond.j]);
      const double force = (material_.k + alpha_ / bond.r0) * stretch -
                           alpha_ * (swelling[bond.i] + swelling[bond.j]) / (volume_[bond.i] + volume_[bond.j]);
      result[bond.i] += force * direction_[b];
      result[bond.j] -= force * direction_[b];
    }
    return result;
  }

  Vectors damping(const Vectors& v) const {
    Vectors result(v.size(), Eigen::Vector3d::Zero());
    for (std::size_t b = 0; b < grain_.bonds.size(); ++b) {
      const Bond& bond = grain_.bonds[b];
      const Eigen::Vector3d force = material_.gamma * direction_[b].dot(v[bond.i] - v[bond.j]) * direction_[b];
      result[bond.i] += force;
      result[bond.j] -= force;
    }
    return result;
  }

private:
  const GrainTemplate& grain_;
  const Material& material_;
  double alpha_;
  std::vector<double> volume_;
  Vectors direction_;
};

double norm(const Vectors& x) {
  double sum = 0.0;
  for (const Eigen::Vector3d& v : x) {
    sum += v.squaredNorm();
  }
  return std::sqrt(sum);
}

/// Largest eigenvalue of a map whose spectrum is real and not negative.
template <typename Map> double largest_eigenvalue(const Map& map, std::size_t n) {
  Vectors x(n);
  for (std::size_t i = 0; i < n; ++i) { // alternating in space and without symmetry: the stiffest modes look like that
    x[i] = {std::sin(1.0 + 12.9898 * i), std::sin(2.0 + 78.233 * i), std::sin(3.0 + 37.719 * i)};
  }
  double value = 0.0;
  for (int iteration = 0; iteration < power_iterations; ++iteration) {
    const double length = norm(x);
    for (Eigen::Vector3d& v : x) {
      v /= length;
    }
    x = map(x);
    value = norm(x);
    if (!(value > 0.0)) {
      return 0.0;
    }
  }
  return value;
}

} // namespace

double stable_step(const GrainTemplate& grain, const Material& material, double alpha) {
  if (grain.bonds.empty()) {
    throw std::invalid_argument("stable step: the template has no bonds");
  }
  const LinearNetwork network(grain, material, alpha);
  const std::size_t n = grain.position.size();
  const double w2 = largest_eigenvalue([&](const Vectors& u) { return network.stiffness(u); }, n) / material.node_mass;
  const double c = largest_eigenvalue([&](const Vectors& v) { return network.damping(v); }, n) / material.node_mass;
  // The positive root of dt^2 w^2 + 2 dt c = 4.
  return 4.0 / (c + std::sqrt(c * c + 4.0 * w2));
}

} // namespace boba
