// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/network/linear_network.h"

#include "bpm/grain/bond_network.h"
#include "bpm/grain/near_pairs.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::calibration {

LinearNetwork::LinearNetwork(const GrainTemplate& grain)
    : position_(grain.position), period_(grain.period), volume_(grain.reference_volume) {
  if (const auto reason = floating_part(grain)) {
    throw std::invalid_argument("the network is not rigid: " + *reason);
  }
  const std::vector<double> node_volume = reference_node_volumes(grain.n_nodes(), grain.bonds);
  bonds_.reserve(grain.bonds.size());
  for (const Bond& bond : grain.bonds) {
    Vector3 difference = position_[bond.i] - position_[bond.j];
    if (period_) {
      difference = wrapped(difference, *period_);
    }
    bonds_.push_back(
        {bond.i, bond.j, difference / bond.r0, bond.r0, 1.0 / (node_volume[bond.i] + node_volume[bond.j])});
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

std::vector<double> LinearNetwork::affine_stretch(const Matrix3& strain) const {
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
    t[b] = s[b] + alpha * (s[b] / bond.r0 - (q[bond.i] + q[bond.j]) * bond.inverse_volume);
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
    const double many_body = (scratch_sum_[bond.i] + scratch_sum_[bond.j]) * bond.inverse_volume;
    const double t = s + alpha * (s / bond.r0 - many_body);
    double *fi = f + 3 * bond.i, *fj = f + 3 * bond.j;
    for (int c = 0; c < 3; ++c) {
      fi[c] += t * bond.e[c];
      fj[c] -= t * bond.e[c];
    }
  }
}

Matrix3 LinearNetwork::stress(const std::vector<double>& t) const {
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t b = 0; b < bonds_.size(); ++b) {
    sum += (t[b] * bonds_[b].r0) * bonds_[b].e * bonds_[b].e.transpose();
  }
  return sum / volume_;
}

} // namespace boba::calibration
