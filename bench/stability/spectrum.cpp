// SPDX-License-Identifier: GPL-3.0-or-later
// The many-body law has no energy, so its linearised operator is not symmetric: without damping a pair of complex
// frequencies is a vibration that grows. How fast, and how much damping stops it.
#include "bench/stability/cases.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>

namespace boba::bench {

namespace {

using Eigen::MatrixXd;

struct Operators {
  MatrixXd stiffness0; ///< of the springs
  MatrixXd stiffness1; ///< of the many-body term, for alpha = 1
  MatrixXd damping;    ///< for gamma = 1
};

/// df = -(k + alpha / r0) s + alpha (W_i + W_j) / (V0_i + V0_j), W_i = sum of r0^2 s, s the stretch of a bond.
Operators operators_of(const GrainTemplate& grain) {
  const Eigen::Index n = 3 * grain.n_nodes(), n_bonds = static_cast<Eigen::Index>(grain.bonds.size());
  const std::vector<double> volume = reference_node_volumes(grain.n_nodes(), grain.bonds);
  MatrixXd stretch = MatrixXd::Zero(n_bonds, n), swelling = MatrixXd::Zero(grain.n_nodes(), n);
  for (Eigen::Index b = 0; b < n_bonds; ++b) {
    const Bond& bond = grain.bonds[b];
    const Eigen::RowVector3d e = (grain.position[bond.i] - grain.position[bond.j]).normalized().transpose();
    stretch.block<1, 3>(b, 3 * bond.i) = e;
    stretch.block<1, 3>(b, 3 * bond.j) = -e;
    for (const int node : {bond.i, bond.j}) {
      swelling.block<1, 3>(node, 3 * bond.i) += bond.r0 * bond.r0 * e;
      swelling.block<1, 3>(node, 3 * bond.j) -= bond.r0 * bond.r0 * e;
    }
  }
  MatrixXd tension = stretch;
  for (Eigen::Index b = 0; b < n_bonds; ++b) {
    const Bond& bond = grain.bonds[b];
    tension.row(b) =
        stretch.row(b) / bond.r0 - (swelling.row(bond.i) + swelling.row(bond.j)) / (volume[bond.i] + volume[bond.j]);
  }
  const MatrixXd pull = stretch.transpose();
  return {pull * stretch, pull * tension, pull * stretch};
}

struct Growth {
  double rate = 0.0;      ///< of the fastest growing vibration, 1/tau
  double frequency = 0.0; ///< of that vibration, 1/tau
  int n_complex = 0;      ///< modes that grow or decay
};

Growth undamped_growth(const MatrixXd& stiffness) {
  const Eigen::VectorXcd w2 = Eigen::EigenSolver<MatrixXd>(stiffness, false).eigenvalues();
  Growth growth;
  for (const std::complex<double>& value : w2) {
    const std::complex<double> w = std::sqrt(value);
    growth.n_complex += std::abs(value.imag()) > 1e-9;
    if (std::abs(value) > 1e-9 && std::abs(w.imag()) > growth.rate) {
      growth.rate = std::abs(w.imag());
      growth.frequency = w.real();
    }
  }
  return growth;
}

/// Largest real part of the modes of x'' = -A x - gamma C x'.
double damped_growth(const MatrixXd& stiffness, const MatrixXd& damping, double gamma) {
  const Eigen::Index n = stiffness.rows();
  MatrixXd companion = MatrixXd::Zero(2 * n, 2 * n);
  companion.topRightCorner(n, n).setIdentity();
  companion.bottomLeftCorner(n, n) = -stiffness;
  companion.bottomRightCorner(n, n) = -gamma * damping;
  double largest = -1e300;
  const Eigen::VectorXcd exponents = Eigen::EigenSolver<MatrixXd>(companion, false).eigenvalues();
  for (const std::complex<double>& s : exponents) {
    if (std::abs(s) > 1e-3) { // rigid motions are zero up to the square root of rounding
      largest = std::max(largest, s.real());
    }
  }
  return largest;
}

/// The damping at which nothing grows any more, between 0 and 1 (to 5 %).
double sufficient_damping(const MatrixXd& stiffness, const MatrixXd& damping) {
  if (damped_growth(stiffness, damping, 1.0) > 1e-9) {
    return INFINITY;
  }
  double low = 1e-6, high = 1.0;
  while (high / low > 1.05) {
    const double middle = std::sqrt(low * high);
    (damped_growth(stiffness, damping, middle) > 1e-9 ? low : high) = middle;
  }
  return high;
}

} // namespace

void spectrum(const Folder& folder) {
  OutputFile file =
      csv(folder, "spectrum", "nodes,alpha_kd,rate_per_tau,frequency_per_tau,n_complex,n_modes,sufficient_gamma");
  for (const int n : {40, 100, 250}) {
    const Operators operators = operators_of(*ball(n));
    for (const double alpha : n < 200 ? alphas : std::vector<double>{-0.8, 2.0, 12.0}) {
      const MatrixXd stiffness = operators.stiffness0 + alpha * operators.stiffness1;
      const Growth growth = undamped_growth(stiffness);
      const double gamma = n < 50 ? sufficient_damping(stiffness, operators.damping) : NAN;
      file.print("{},{},{:.3e},{:.4f},{},{},{:.3e}\n", n, alpha, growth.rate, growth.frequency, growth.n_complex,
                 stiffness.rows(), gamma);
      file.flush();
    }
  }
  file.close();
}

} // namespace boba::bench
