// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/linear_network.h"

#include "bpm/grain/near_pairs.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace boba {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Values at alpha = 0 and their changes per alpha.
struct Coefficients {
  double spring[2], swelling[2], damping;
};

Coefficients coefficients_of(const PlainBond& law, double r0) {
  const auto at = [&](double alpha) { return law.slopes({.alpha = alpha, .r = r0, .r0 = r0}); };
  const BondSlopes<double> zero = at(0.0), one = at(1.0), two = at(2.0);
  const auto is_affine = [](double f0, double f1, double f2) {
    return std::abs(f2 - 2.0 * f1 + f0) <= 1e-12 * (std::abs(f0) + std::abs(f1) + std::abs(f2));
  };
  if (!is_affine(zero.by_distance, one.by_distance, two.by_distance) ||
      !is_affine(zero.by_cbrt_ratio, one.by_cbrt_ratio, two.by_cbrt_ratio)) {
    throw std::invalid_argument("linear network: the derivatives of the bond law are not affine in alpha");
  }
  return {{-zero.by_distance, zero.by_distance - one.by_distance},
          {zero.by_cbrt_ratio, one.by_cbrt_ratio - zero.by_cbrt_ratio},
          -zero.by_normal_velocity};
}

} // namespace

LinearNetwork::LinearNetwork(const GrainTemplate& grain, const PlainBond& law)
    : position_(grain.position), period_(grain.period), volume_(grain.reference_volume) {
  const std::vector<double> node_volume = reference_node_volumes(grain.n_nodes(), grain.bonds);
  bonds_.reserve(grain.bonds.size());
  damping_.reserve(grain.bonds.size());
  for (const Bond& bond : grain.bonds) {
    Vector3d difference = position_[bond.i] - position_[bond.j];
    if (period_) {
      difference = wrapped(difference, *period_);
    }
    const Coefficients c = coefficients_of(law, bond.r0);
    const double volumes = node_volume[bond.i] + node_volume[bond.j];
    bonds_.push_back({bond.i,
                      bond.j,
                      difference.normalized(),
                      bond.r0,
                      {c.spring[0], c.spring[1]},
                      {c.swelling[0] / volumes, c.swelling[1] / volumes}});
    damping_.push_back(c.damping);
  }
}

std::vector<double> LinearNetwork::stretch(const double* u) const {
  std::vector<double> s(bonds_.size());
  for (std::size_t b = 0; b < bonds_.size(); ++b) {
    const LinearBond& bond = bonds_[b];
    const double *ui = u + 3 * bond.i, *uj = u + 3 * bond.j;
    s[b] = bond.e.x() * (ui[0] - uj[0]) + bond.e.y() * (ui[1] - uj[1]) + bond.e.z() * (ui[2] - uj[2]);
  }
  return s;
}

std::vector<double> LinearNetwork::affine_stretch(const Matrix3d& strain) const {
  std::vector<double> s(bonds_.size());
  std::transform(bonds_.begin(), bonds_.end(), s.begin(),
                 [&](const LinearBond& bond) { return bond.r0 * bond.e.dot(strain * bond.e); });
  return s;
}

std::vector<double> LinearNetwork::tension(const std::vector<double>& s, double alpha) const {
  std::vector<double> q(position_.size(), 0.0);
  for (std::size_t b = 0; b < bonds_.size(); ++b) {
    const double share = bonds_[b].r0 * bonds_[b].r0 * s[b];
    q[bonds_[b].i] += share;
    q[bonds_[b].j] += share;
  }
  std::vector<double> t(bonds_.size());
  for (std::size_t b = 0; b < bonds_.size(); ++b) {
    const LinearBond& bond = bonds_[b];
    t[b] = (bond.spring[0] + alpha * bond.spring[1]) * s[b] -
           (bond.swelling[0] + alpha * bond.swelling[1]) * (q[bond.i] + q[bond.j]);
  }
  return t;
}

void LinearNetwork::add_nodal(const std::vector<double>& t, double* f) const {
  for (std::size_t b = 0; b < bonds_.size(); ++b) {
    const LinearBond& bond = bonds_[b];
    for (int c = 0; c < 3; ++c) {
      f[3 * bond.i + c] += t[b] * bond.e[c];
      f[3 * bond.j + c] -= t[b] * bond.e[c];
    }
  }
}

void LinearNetwork::multiply(const double* u, double alpha, double* f) const {
  // Two passes over the bonds: stretches and their nodal sums, then tensions and forces. The scratch arrays are kept
  // because the operator is applied hundreds of times.
  scratch_stretch_.resize(bonds_.size());
  scratch_sum_.assign(position_.size(), 0.0);
  for (std::size_t b = 0; b < bonds_.size(); ++b) {
    const LinearBond& bond = bonds_[b];
    const double *ui = u + 3 * bond.i, *uj = u + 3 * bond.j;
    const double s = bond.e.x() * (ui[0] - uj[0]) + bond.e.y() * (ui[1] - uj[1]) + bond.e.z() * (ui[2] - uj[2]);
    scratch_stretch_[b] = s;
    scratch_sum_[bond.i] += bond.r0 * bond.r0 * s;
    scratch_sum_[bond.j] += bond.r0 * bond.r0 * s;
  }
  std::fill(f, f + 3 * position_.size(), 0.0);
  for (std::size_t b = 0; b < bonds_.size(); ++b) {
    const LinearBond& bond = bonds_[b];
    const double s = scratch_stretch_[b];
    const double t = (bond.spring[0] + alpha * bond.spring[1]) * s -
                     (bond.swelling[0] + alpha * bond.swelling[1]) * (scratch_sum_[bond.i] + scratch_sum_[bond.j]);
    double *fi = f + 3 * bond.i, *fj = f + 3 * bond.j;
    for (int c = 0; c < 3; ++c) {
      fi[c] += t * bond.e[c];
      fj[c] -= t * bond.e[c];
    }
  }
}

void LinearNetwork::damp(const double* v, double* f) const {
  std::vector<double> t = stretch(v);
  std::transform(t.begin(), t.end(), damping_.begin(), t.begin(), std::multiplies<>());
  std::fill(f, f + 3 * position_.size(), 0.0);
  add_nodal(t, f);
}

Matrix3d LinearNetwork::stress(const std::vector<double>& t) const {
  Matrix3d sum = Matrix3d::Zero();
  for (std::size_t b = 0; b < bonds_.size(); ++b) {
    sum += (t[b] * bonds_[b].r0) * bonds_[b].e * bonds_[b].e.transpose();
  }
  return sum / volume_;
}

} // namespace boba
