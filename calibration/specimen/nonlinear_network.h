// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"
#include "bpm/laws/plain_laws.h"
#include "calibration/network/petsc_handle.h"

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boba::calibration {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

/// The laws of a network at rest; those of the engine (bpm/laws) in its units unless told otherwise.
struct NetworkLaws {
  std::shared_ptr<const PlainBond> bond = std::make_shared<PlainBondOf<BondLaw>>(BondLaw{});
  std::shared_ptr<const PlainContact> contact = std::make_shared<PlainContactOf<ContactLaw>>(ContactLaw{});
};

/// A network at finite strain under the engine's laws at rest, k = 1.
///
/// Positions of the nodes and, for a periodic network, the cell matrix h = F diag(period); some nodes may be held.
/// `relax` finds the positions at which no free node feels a force: PETSc SNES with the analytic Jacobian. Contacts are
/// those of unbonded nodes within the range of the contact law, and of nodes at two walls across z (bpm/laws/wall.h).
class NonlinearNetwork {
public:
  static constexpr double contact_margin = 0.3; ///< d; pairs closer than d + margin are watched during a solve
  using Held = std::array<bool, 3>;

  NonlinearNetwork(const GrainTemplate& grain, double alpha, NetworkLaws laws = {});

  int n_nodes() const { return static_cast<int>(position_.size()); }
  const std::vector<Vector3>& position() const { return position_; }
  const std::vector<Vector3>& reference() const { return reference_; }
  /// Moves the cell from its present deformation to F, all nodes with it.
  void deform_cell(const Matrix3& deformation);
  void move(int node, const Vector3& displacement) { position_[node] += displacement; }
  void set_positions(std::vector<Vector3> position) { position_ = std::move(position); }
  void hold(const std::vector<int>& nodes, const Held& components = {true, true, true});
  /// Rigid planes across z at the heights low and high (d).
  void set_walls(double low, double high) { walls_ = {low, high}; }
  /// Forces on the lower and on the upper wall, away from the body (k d).
  std::array<double, 2> wall_loads() const;
  /// Holds back rigid motions without a force at any single node: their part of the forces is taken out. What is held:
  /// x, y, z, then the turns about them; of each of `n_bodies` equal runs of nodes.
  void hold_steady(const std::array<bool, 6>& motions, int n_bodies = 1) {
    steady_ = motions;
    n_bodies_ = n_bodies;
  }

  /// Forces of the bonds on every node at the given positions (k d).
  std::vector<Vector3> forces(const std::vector<Vector3>& position) const;
  /// Takes the present positions as those about which `force_derivative` is evaluated, walls included.
  void linearise() { linearise(position_); }
  /// Derivative of the forces along a displacement.
  std::vector<Vector3> force_derivative(const std::vector<Vector3>& displacement) const;
  /// Cauchy stress -(1/Vol) sum f r e e^T over the volume of the deformed cell, tension positive (k/d).
  Matrix3 stress() const;

  /// Each node's share (half of every pair) of -sum f r e e^T (k d): its stress times its volume, tension positive.
  std::vector<Matrix3> node_virials() const;

  /// Unbonded pairs closer than d at present.
  int n_contacts() const;

  /// Newton's method; where it fails (a node snaps through to another place), damped motion first and Newton again.
  /// \throws std::runtime_error (with the residual history's end) when that does not converge either.
  void relax(double tolerance = 1e-8);
  /// Moves the free nodes by damped motion of unit masses for a number of steps of 0.1 tau.
  void creep(int steps);
  /// How often relax() needed damped motion so far.
  int n_creeps() const { return n_creeps_; }

private:
  struct Link {
    int i, j;
    Vector3 cells; // image of j in cell vectors
    double r0, inverse_volume;
  };
  struct State { // of each bond at the positions of the last `update`
    Vector3 e;
    double r, force;
    double many_body; // df/d(q^(1/3)) q^(-2/3) / (V0_i + V0_j); 0 for a contact
    double spring;    // -df/dr at constant volumes
  };
  std::vector<State> states(const std::vector<Vector3>& position) const;
  void linearise(const std::vector<Vector3>& position);
  /// Force of a wall (0 lower, 1 upper) on a node at height z, away from the wall; adds its slope to *stiffness.
  double wall_force(int wall, double z, double* stiffness) const;
  void fill_pair_matrix(Mat matrix) const;
  /// Of a bond in the preconditioner, positive for every alpha.
  double pair_spring(const Link& link, const State& bond) const;
  /// Unbonded pairs closer than d + margin as links without reference length, appended behind the bonds.
  void find_contacts();
  void newton(double tolerance);
  Matrix3 cell() const;
  friend struct SnesGlue;

  double alpha_;
  NetworkLaws laws_;
  std::vector<Vector3> reference_, position_;
  std::optional<Vector3> period_;
  Matrix3 deformation_ = Matrix3::Identity();
  std::vector<Link> links_; // n_bonds_ bonds sorted by (i, j), then the pairs that may touch
  std::size_t n_bonds_ = 0;
  std::vector<double> volume0_;
  std::vector<Held> held_;
  std::optional<std::array<double, 2>> walls_;
  std::array<bool, 6> steady_{};
  int n_bodies_ = 1;
  int n_creeps_ = 0;
  std::vector<State> linearised_; // where the Jacobian was taken
  std::vector<double> wall_spring_;
};

} // namespace boba::calibration
