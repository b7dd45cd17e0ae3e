// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/stable_step.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace boba {

namespace {

constexpr int most_iterations = 400;
constexpr double tolerance = 1e-13; ///< relative change of the step in one iteration, three times in a row
/// Taken from the operator, whose spectrum reaches from 0 to 4: its largest eigenvalue then stands out more.
constexpr double shift = 1.8;

double dot(const std::vector<double>& x, const std::vector<double>& y) {
  return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
}

/// A start for power iteration: alternating in space and without symmetry, as the stiffest modes are.
std::vector<double> rough_vector(int n_nodes) {
  std::vector<double> x;
  for (int i = 0; i < n_nodes; ++i) {
    x.insert(x.end(), {std::sin(1.0 + 12.9898 * i), std::sin(2.0 + 78.233 * i), std::sin(3.0 + 37.719 * i)});
  }
  return x;
}

} // namespace

double stable_step(const LinearNetwork& network, double node_mass, double alpha) {
  if (network.bonds().empty()) {
    throw std::invalid_argument("stable step: the template has no bonds");
  }
  std::vector<double> u = rough_vector(network.n_nodes()), stiff(u.size()), damped(u.size());
  double dt = 0.0;
  for (int iteration = 0, quiet = 0; iteration < most_iterations && quiet < 3; ++iteration) {
    const double length = std::sqrt(dot(u, u));
    for (double& component : u) {
      component /= length;
    }
    network.multiply(u.data(), alpha, stiff.data());
    network.damp(u.data(), damped.data());
    const double w2 = dot(u, stiff) / node_mass, c = dot(u, damped) / node_mass;
    const double before = dt;
    dt = 4.0 / (c + std::sqrt(c * c + 4.0 * w2)); // the positive root of dt^2 w^2 + 2 dt c = 4
    quiet = std::abs(dt - before) < tolerance * dt ? quiet + 1 : 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      u[i] = (dt * dt * stiff[i] + 2.0 * dt * damped[i]) / node_mass - shift * u[i];
    }
  }
  return dt;
}

double stable_step(const GrainTemplate& grain, const Material& material, double alpha) {
  return stable_step(LinearNetwork(grain, PlainBondOf(bond_law(material))), material.node_mass, alpha);
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
