// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace boba::calibration {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

/// A bond as the linearised law sees it.
struct LinearBond {
  int i = 0;
  int j = 0;
  Vector3 e;                   ///< unit vector from node j (nearest image) to node i
  double r0 = 0.0;             ///< d
  double inverse_volume = 0.0; ///< 1 / (V0_i + V0_j), d^-3
};

/// The bond force law linearised about the undeformed network, for k = 1.
///
/// With the stretch s_b = r - r0 of every bond its tension (minus the force of the law) is
///
///     t_b = s_b + alpha ( s_b / r0_b - ( q_i + q_j ) / (V0_i + V0_j) ),   q_i = sum over bonds b of i of r0_b^2 s_b
///
/// (the last term is the derivative of [(V_i + V_j)/(V0_i + V0_j)]^(1/3)). So all operators are T0 + alpha T1, and
/// the stiffness is A = B^T (T0 + alpha T1) B with s = B u, s_b = e . (u_i - u_j). T1 is not symmetric.
/// Units: k = d = 1. Source: Clemmer, Hackney & Grest, bond force.
class LinearNetwork {
public:
  /// \throws std::invalid_argument when a node floats or the network is in pieces (see boba::floating_part).
  explicit LinearNetwork(const GrainTemplate& grain);

  int n_nodes() const { return static_cast<int>(position_.size()); }
  const std::vector<LinearBond>& bonds() const { return bonds_; }
  const std::vector<Vector3>& position() const { return position_; }
  const std::optional<Vector3>& period() const { return period_; }
  double volume() const { return volume_; } ///< d^3

  /// B u: stretches from displacements, u[3 n + component].
  std::vector<double> stretch(const double* u) const;
  /// Stretches of the affine field u = strain x.
  std::vector<double> affine_stretch(const Matrix3& strain) const;
  /// (T0 + alpha T1) s.
  std::vector<double> tension(const std::vector<double>& s, double alpha) const;
  /// f += B^T t with f of 3 n entries: the nodal forces that resist, minus the forces of the law.
  void add_nodal(const std::vector<double>& t, double* f) const;
  /// f = B^T (T0 + alpha T1) B u in one go; not for two threads at once.
  void multiply(const double* u, double alpha, double* f) const;
  /// Stress sum_b t_b r0_b e e^T / volume, tension positive (k/d).
  Matrix3 stress(const std::vector<double>& t) const;

private:
  std::vector<Vector3> position_;
  std::optional<Vector3> period_;
  std::vector<LinearBond> bonds_;
  double volume_ = 0.0;
  mutable std::vector<double> scratch_stretch_, scratch_sum_;
};

} // namespace boba::calibration
