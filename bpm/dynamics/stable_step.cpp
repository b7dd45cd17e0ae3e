// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/stable_step.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace boba {

namespace {

using Vectors = std::vector<Eigen::Vector3d>;

constexpr int most_iterations = 400;
constexpr double tolerance = 1e-13; ///< relative change of the step in one iteration, three times in a row
/// Taken from the operator, whose spectrum reaches from 0 to 4: its largest eigenvalue then stands out more.
constexpr double shift = 1.8;

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

double dot(const Vectors& x, const Vectors& y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += x[i].dot(y[i]);
  }
  return sum;
}

/// A start for power iteration: alternating in space and without symmetry, as the stiffest modes are.
Vectors rough_vectors(std::size_t n) {
  Vectors x(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto s = static_cast<double>(i);
    x[i] = {std::sin(1.0 + 12.9898 * s), std::sin(2.0 + 78.233 * s), std::sin(3.0 + 37.719 * s)};
  }
  return x;
}

} // namespace

double stable_step(const GrainTemplate& grain, const Material& material, double alpha) {
  if (grain.bonds.empty()) {
    throw std::invalid_argument("stable step: the template has no bonds");
  }
  const LinearNetwork network(grain, material, alpha);
  Vectors u = rough_vectors(grain.position.size());
  double dt = 0.0;
  for (int iteration = 0, quiet = 0; iteration < most_iterations && quiet < 3; ++iteration) {
    const double length = std::sqrt(dot(u, u));
    for (Eigen::Vector3d& v : u) {
      v /= length;
    }
    const Vectors stiff = network.stiffness(u), damped = network.damping(u);
    const double w2 = dot(u, stiff) / material.node_mass, c = dot(u, damped) / material.node_mass;
    const double before = dt;
    dt = 4.0 / (c + std::sqrt(c * c + 4.0 * w2)); // the positive root of dt^2 w^2 + 2 dt c = 4
    quiet = std::abs(dt - before) < tolerance * dt ? quiet + 1 : 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      u[i] = (dt * dt * stiff[i] + 2.0 * dt * damped[i]) / material.node_mass - shift * u[i];
    }
  }
  return dt;
}

namespace {

/// Templates looked at when every grain has a network of its own, as in data from elsewhere: they differ little.
constexpr std::size_t most_templates = 8;

} // namespace

std::optional<PackingStep> stable_step(const Packing& packing, const Material& material) {
  std::map<int, std::pair<double, double>> alphas; // smallest and largest, by template
  for (const Grain& grain : packing.grains) {
    const auto [at, is_new] = alphas.try_emplace(grain.template_index, grain.alpha, grain.alpha);
    at->second = {std::min(at->second.first, grain.alpha), std::max(at->second.second, grain.alpha)};
  }
  std::optional<PackingStep> smallest;
  std::size_t n_templates = 0;
  for (const auto& [index, range] : alphas) {
    const GrainTemplate& grain = *packing.templates[index];
    if (grain.bonds.empty() || ++n_templates > most_templates) {
      continue;
    }
    for (const double alpha : std::set{range.first, range.second}) {
      const double step = stable_step(grain, material, alpha);
      if (!smallest || step < smallest->dt) {
        smallest = {step, alpha};
      }
    }
  }
  return smallest;
}

} // namespace boba
