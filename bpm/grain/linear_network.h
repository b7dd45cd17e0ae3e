// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"
#include "bpm/laws/plain_laws.h"

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace boba {

/// A bond as the linearised law sees it. Coefficients are (value at alpha = 0, change per alpha).
struct LinearBond {
  int i = 0;
  int j = 0;
  Eigen::Vector3d e;  ///< unit vector from node j (nearest image) to node i
  double r0 = 0.0;    ///< d
  double spring[2];   ///< -df/dr at r0, k and 1/d
  double swelling[2]; ///< df/d(q^(1/3)) / (V0_i + V0_j), k/d^2 and 1/d^3
};

/// A bond law linearised about the undeformed network.
///
/// With the stretch s_b = r - r0 of every bond its tension (minus the force of the law) is
///
///     t_b = spring s_b - swelling ( q_i + q_j ),   q_i = sum over bonds b of i of r0_b^2 s_b
///
/// where spring = -df/dr and swelling = df/d(q^(1/3)) / (V0_i + V0_j) are the law's own derivatives (BondSlopes), since
/// q^(1/3) changes by (q_i + q_j) / (V0_i + V0_j). For BondLaw spring = k + alpha / r0 and df/d(q^(1/3)) = alpha. All
/// operators are T0 + alpha T1, so the law's derivatives must be affine in alpha; the stiffness is
/// A = B^T (T0 + alpha T1) B with s = B u, s_b = e . (u_i - u_j). T1 is not symmetric.
/// Source: Clemmer, Hackney & Grest, bond force.
class LinearNetwork {
public:
  /// \throws std::invalid_argument when the law's derivatives are not affine in alpha.
  explicit LinearNetwork(const GrainTemplate& grain, const PlainBond& law = PlainBondOf<BondLaw>({}));

  int n_nodes() const { return static_cast<int>(position_.size()); }
  const std::vector<LinearBond>& bonds() const { return bonds_; }
  const std::vector<Eigen::Vector3d>& position() const { return position_; }
  const std::optional<Eigen::Vector3d>& period() const { return period_; }
  double volume() const { return volume_; } ///< d^3

  /// B u: stretches from displacements, u[3 n + component].
  std::vector<double> stretch(const double* u) const;
  /// Stretches of the affine field u = strain x.
  std::vector<double> affine_stretch(const Eigen::Matrix3d& strain) const;
  /// (T0 + alpha T1) s.
  std::vector<double> tension(const std::vector<double>& s, double alpha) const;
  /// f += B^T t with f of 3 n entries: the nodal forces that resist, minus the forces of the law.
  void add_nodal(const std::vector<double>& t, double* f) const;
  /// f = B^T (T0 + alpha T1) B u at once; not for two threads at the same time. 28 operations for each bond.
  void multiply(const double* u, double alpha, double* f) const;
  /// f = B^T D B v, the nodal forces that resist velocities v; D = -df/d(e . v) of each bond at alpha = 0.
  void damp(const double* v, double* f) const;
  /// Stress sum_b t_b r0_b e e^T / volume, tension positive (k/d).
  Eigen::Matrix3d stress(const std::vector<double>& t) const;

private:
  std::vector<Eigen::Vector3d> position_;
  std::optional<Eigen::Vector3d> period_;
  std::vector<LinearBond> bonds_;
  std::vector<double> damping_; ///< of each bond, sqrt(k m)
  double volume_ = 0.0;
  mutable std::vector<double> scratch_stretch_, scratch_sum_;
};

} // namespace boba
