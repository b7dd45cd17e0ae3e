// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/elasticity/hyperelastic.h"

#include <Eigen/Dense>
#include <fmt/format.h>
#include <limits>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>
#include <utility>

namespace boba::continuum {
namespace {

/// Parameters of a term: mu / E, alpha, and t with nu = -1/4 + 3/4 tanh(t), so that every t is allowed.
std::vector<FoamTerm> terms_of(const Eigen::VectorXd& x, double young) {
  std::vector<FoamTerm> terms;
  for (Eigen::Index k = 0; k + 2 < x.size(); k += 3) {
    terms.push_back({x[k] * young, x[k + 1], -0.25 + 0.7499 * std::tanh(x[k + 2])});
  }
  return terms;
}

/// Residuals of the fit in the form that Eigen's Levenberg-Marquardt method wants.
struct Misfit {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const std::vector<UniaxialState>& states;
  double young;
  int n_parameters;

  int inputs() const { return n_parameters; }
  int values() const { return 2 * int(states.size()); }
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residual) const {
    try {
      const Foam foam(terms_of(x, young));
      for (std::size_t i = 0; i < states.size(); ++i) {
        const auto& s = states[i];
        const auto w = foam.response({s.axial_stretch, s.lateral_stretch, s.lateral_stretch}).first;
        residual[2 * Eigen::Index(i)] = (w[0] - s.stress) / young;
        residual[2 * Eigen::Index(i) + 1] = w[1] / young;
      }
    } catch (const std::invalid_argument&) {
      residual.setConstant(1e3); // not a foam: the search turns back
    }
    return 0;
  }
};

/// The end of a search that starts with the given exponents and the moduli of small strain.
Eigen::VectorXd searched(const std::vector<UniaxialState>& states, const Material& material, int n_terms,
                         std::pair<double, double> exponents) {
  Eigen::VectorXd x(3 * n_terms);
  const double t = std::atanh((material.poisson + 0.25) / 0.75);
  for (int k = 0; k < n_terms; ++k) {
    x.segment<3>(3 * k) << material.shear() / material.young / n_terms, k == 0 ? exponents.first : exponents.second, t;
  }
  const Misfit misfit{states, material.young, int(x.size())};
  Eigen::NumericalDiff<Misfit, Eigen::Central> differentiated(misfit);
  Eigen::LevenbergMarquardt<Eigen::NumericalDiff<Misfit, Eigen::Central>> search(differentiated);
  search.parameters.maxfev = 4000;
  search.parameters.ftol = search.parameters.xtol = 1e-14;
  search.minimize(x);
  return x;
}

} // namespace

std::vector<FoamTerm> fitted_foam(const std::vector<UniaxialState>& states, const Material& material, int n_terms) {
  check(material);
  if (n_terms < 1 || n_terms > 2 || 2 * int(states.size()) < 3 * n_terms) {
    throw std::invalid_argument(fmt::format("terms = {} with {} states is not allowed: 1 or 2 terms, and at least 3 "
                                            "numbers (2 a state) for each term",
                                            n_terms, states.size()));
  }
  // Several starts: the misfit has more than one valley in the exponents.
  constexpr std::pair<double, double> starts[] = {{2, -4}, {2, -8}, {4, -2}, {8, 2}, {8, -8}, {-4, -12}};
  Eigen::VectorXd best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& exponents : starts) {
    const Eigen::VectorXd x = searched(states, material, n_terms, exponents);
    Eigen::VectorXd residual(2 * Eigen::Index(states.size()));
    Misfit{states, material.young, int(x.size())}(x, residual);
    if (residual.norm() < least) {
      least = residual.norm();
      best = x;
    }
  }
  return terms_of(best, material.young);
}

} // namespace boba::continuum
