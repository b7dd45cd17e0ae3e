// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/specimen/nonlinear_network.h"

#include "bpm/grain/near_pairs.h"
#include "bpm/laws/wall.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace boba::calibration {

namespace {

constexpr double stabilising_share = 0.2; // of the elastic spring, taken off across a bond in compression at most

/// The identity without the held components.
Matrix3 free_components(const std::array<bool, 3>& held) {
  return Vector3(!held[0], !held[1], !held[2]).asDiagonal();
}

} // namespace

NonlinearNetwork::NonlinearNetwork(const GrainTemplate& grain, double alpha, NetworkLaws laws)
    : alpha_(alpha), laws_(std::move(laws)), reference_(grain.position), position_(grain.position),
      period_(grain.period), volume0_(reference_node_volumes(grain.n_nodes(), grain.bonds)),
      held_(grain.n_nodes(), Held{false, false, false}) {
  for (const Bond& bond : grain.bonds) {
    Vector3 cells = Vector3::Zero();
    if (period_) {
      cells = (position_[bond.i] - position_[bond.j]).cwiseQuotient(*period_).array().round();
    }
    links_.push_back({bond.i, bond.j, cells, bond.r0, 1.0 / (volume0_[bond.i] + volume0_[bond.j])});
  }
  n_bonds_ = links_.size();
}

void NonlinearNetwork::hold(const std::vector<int>& nodes, const Held& components) {
  for (const int node : nodes) {
    held_.at(node) = components;
  }
}

double NonlinearNetwork::wall_force(int wall, double z, double* stiffness) const {
  const double distance = wall == 0 ? z - (*walls_)[0] : (*walls_)[1] - z;
  if (2.0 * distance >= laws_.contact->range()) {
    return 0.0;
  }
  if (stiffness) {
    *stiffness -= wall_slopes(*laws_.contact, distance, 0.0).by_distance;
  }
  return boba::wall_force(*laws_.contact, distance, 0.0);
}

std::array<double, 2> NonlinearNetwork::wall_loads() const {
  std::array<double, 2> load{};
  for (const Vector3& x : position_) {
    load[0] += wall_force(0, x.z(), nullptr);
    load[1] += wall_force(1, x.z(), nullptr);
  }
  return load;
}

void NonlinearNetwork::linearise(const std::vector<Vector3>& position) {
  linearised_ = states(position);
  wall_spring_.assign(position.size(), 0.0);
  if (walls_) {
    for (std::size_t n = 0; n < position.size(); ++n) {
      wall_force(0, position[n].z(), &wall_spring_[n]);
      wall_force(1, position[n].z(), &wall_spring_[n]);
    }
  }
}

void NonlinearNetwork::deform_cell(const Matrix3& deformation) {
  const Matrix3 change = deformation * deformation_.inverse();
  for (Vector3& x : position_) {
    x = change * x;
  }
  deformation_ = deformation;
}

Matrix3 NonlinearNetwork::cell() const {
  return period_ ? Matrix3(deformation_ * period_->asDiagonal()) : Matrix3(Matrix3::Zero());
}

std::vector<NonlinearNetwork::State> NonlinearNetwork::states(const std::vector<Vector3>& position) const {
  const Matrix3 h = cell();
  std::vector<State> states(links_.size());
  std::vector<double> volume(position.size(), 0.0);
  for (std::size_t b = 0; b < links_.size(); ++b) {
    const Link& link = links_[b];
    const Vector3 difference = position[link.i] - position[link.j] - h * link.cells;
    states[b].r = difference.norm();
    states[b].e = difference / states[b].r;
    if (b < n_bonds_) {
      const double cube = states[b].r * states[b].r * states[b].r;
      volume[link.i] += cube;
      volume[link.j] += cube;
    }
  }
  for (std::size_t b = 0; b < n_bonds_; ++b) {
    const Link& link = links_[b];
    const double root = std::cbrt((volume[link.i] + volume[link.j]) * link.inverse_volume);
    const BondState bond{.alpha = alpha_, .r = states[b].r, .r0 = link.r0, .cbrt_ratio = root};
    const BondSlopes<double> slopes = laws_.bond->slopes(bond);
    states[b].force = laws_.bond->force(bond);
    states[b].many_body = slopes.by_cbrt_ratio * link.inverse_volume / (root * root);
    states[b].spring = -slopes.by_distance;
  }
  for (std::size_t b = n_bonds_; b < links_.size(); ++b) {
    const bool touch = states[b].r < laws_.contact->range();
    states[b].force = touch ? laws_.contact->force(states[b].r, 0.0) : 0.0;
    states[b].many_body = 0.0;
    states[b].spring = touch ? -laws_.contact->slopes(states[b].r, 0.0).by_distance : 0.0;
  }
  return states;
}

std::vector<Vector3> NonlinearNetwork::forces(const std::vector<Vector3>& position) const {
  std::vector<Vector3> force(position.size(), Vector3::Zero());
  const std::vector<State> bonds = states(position);
  for (std::size_t b = 0; b < links_.size(); ++b) {
    const Vector3 f = bonds[b].force * bonds[b].e;
    force[links_[b].i] += f;
    force[links_[b].j] -= f;
  }
  if (walls_) {
    for (std::size_t n = 0; n < position.size(); ++n) {
      force[n].z() += wall_force(0, position[n].z(), nullptr) - wall_force(1, position[n].z(), nullptr);
    }
  }
  return force;
}

std::vector<Vector3> NonlinearNetwork::force_derivative(const std::vector<Vector3>& displacement) const {
  std::vector<State> fresh;
  if (linearised_.empty()) {
    fresh = states(position_);
  }
  const std::vector<State>& bonds = linearised_.empty() ? fresh : linearised_;
  std::vector<double> sum(position_.size(), 0.0), stretch(links_.size());
  for (std::size_t b = 0; b < links_.size(); ++b) {
    const Link& link = links_[b];
    stretch[b] = bonds[b].e.dot(displacement[link.i] - displacement[link.j]);
    if (b < n_bonds_) {
      const double share = bonds[b].r * bonds[b].r * stretch[b];
      sum[link.i] += share;
      sum[link.j] += share;
    }
  }
  std::vector<Vector3> derivative(position_.size(), Vector3::Zero());
  for (std::size_t b = 0; b < links_.size(); ++b) {
    const Link& link = links_[b];
    const State& bond = bonds[b];
    const double along = bond.many_body * (sum[link.i] + sum[link.j]) - bond.spring * stretch[b];
    const Vector3 turned = displacement[link.i] - displacement[link.j] - stretch[b] * bond.e;
    const Vector3 f = along * bond.e + bond.force / bond.r * turned;
    derivative[link.i] += f;
    derivative[link.j] -= f;
  }
  if (walls_ && !wall_spring_.empty()) {
    for (std::size_t n = 0; n < derivative.size(); ++n) {
      derivative[n].z() -= wall_spring_[n] * displacement[n].z();
    }
  }
  return derivative;
}

std::vector<Matrix3> NonlinearNetwork::node_virials() const {
  std::vector<Matrix3> virial(position_.size(), Matrix3::Zero());
  const std::vector<State> pairs = states(position_);
  for (std::size_t b = 0; b < links_.size(); ++b) {
    const Matrix3 half = -0.5 * pairs[b].force * pairs[b].r * pairs[b].e * pairs[b].e.transpose();
    virial[links_[b].i] += half;
    virial[links_[b].j] += half;
  }
  return virial;
}

Matrix3 NonlinearNetwork::stress() const {
  Matrix3 sum = Matrix3::Zero();
  for (const State& bond : states(position_)) {
    sum -= bond.force * bond.r * bond.e * bond.e.transpose();
  }
  return sum / (deformation_.determinant() * period_.value_or(Vector3::Ones()).prod());
}

double NonlinearNetwork::pair_spring(const Link& link, const State& bond) const {
  constexpr double lowest_alpha = -0.7; // keeps every spring of the preconditioner positive for r0 > 0.7
  const BondState state{.alpha = std::max(alpha_, lowest_alpha), .r = bond.r, .r0 = link.r0};
  return -laws_.bond->slopes(state).by_distance;
}

void NonlinearNetwork::fill_pair_matrix(Mat matrix) const {
  check(MatZeroEntries(matrix), "MatZeroEntries");
  for (std::size_t b = 0; b < links_.size(); ++b) {
    const Link& link = links_[b];
    const State& bond = linearised_[b];
    const double spring = b < n_bonds_ ? pair_spring(link, bond) : bond.spring;
    const double across = std::max(-bond.force / bond.r, -stabilising_share * spring);
    const Matrix3 along = bond.e * bond.e.transpose();
    const Matrix3 block = spring * along + across * (Matrix3::Identity() - along), minus = -block;
    const PetscInt i = link.i, j = link.j;
    const Matrix3 free_i = free_components(held_[i]), free_j = free_components(held_[j]);
    const Matrix3 ii = free_i * block * free_i, jj = free_j * block * free_j, ij = free_i * minus * free_j,
                  ji = free_j * minus * free_i;
    check(MatSetValuesBlocked(matrix, 1, &i, 1, &i, ii.data(), ADD_VALUES), "MatSetValuesBlocked");
    check(MatSetValuesBlocked(matrix, 1, &j, 1, &j, jj.data(), ADD_VALUES), "MatSetValuesBlocked");
    check(MatSetValuesBlocked(matrix, 1, &i, 1, &j, ij.data(), ADD_VALUES), "MatSetValuesBlocked");
    check(MatSetValuesBlocked(matrix, 1, &j, 1, &i, ji.data(), ADD_VALUES), "MatSetValuesBlocked");
  }
  for (PetscInt n = 0; n < n_nodes(); ++n) {
    Matrix3 diagonal = Matrix3::Identity() - free_components(held_[n]);
    if (!wall_spring_.empty() && !held_[n][2]) {
      diagonal(2, 2) += wall_spring_[n];
    }
    check(MatSetValuesBlocked(matrix, 1, &n, 1, &n, diagonal.data(), ADD_VALUES), "MatSetValuesBlocked");
  }
  check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY), "MatAssemblyBegin");
  check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY), "MatAssemblyEnd");
}

void NonlinearNetwork::find_contacts() {
  links_.resize(n_bonds_);
  // The search knows cuboids; the cells of these specimens keep their axes.
  std::optional<Vector3> period;
  std::vector<Vector3> position = position_;
  if (period_) {
    period = cell().diagonal();
    for (Vector3& x : position) {
      x = wrapped(x, *period);
    }
  }
  const auto bonded = [&](const NearPair& pair) {
    const auto at = std::lower_bound(
        links_.begin(), links_.begin() + static_cast<std::ptrdiff_t>(n_bonds_), pair,
        [](const Link& link, const NearPair& p) { return std::pair(link.i, link.j) < std::pair(p.i, p.j); });
    return at != links_.begin() + static_cast<std::ptrdiff_t>(n_bonds_) && at->i == pair.i && at->j == pair.j;
  };
  for (const NearPair& pair : near_pairs(position, laws_.contact->range() + contact_margin, period)) {
    if (!bonded(pair)) {
      Vector3 cells = Vector3::Zero();
      if (period) {
        cells = (position_[pair.i] - position_[pair.j]).cwiseQuotient(*period).array().round();
      }
      links_.push_back({pair.i, pair.j, cells, 0.0, 0.0});
    }
  }
}

int NonlinearNetwork::n_contacts() const {
  const std::vector<State> pairs = states(position_);
  return static_cast<int>(std::count_if(pairs.begin() + static_cast<std::ptrdiff_t>(n_bonds_), pairs.end(),
                                        [&](const State& pair) { return pair.r < laws_.contact->range(); }));
}

} // namespace boba::calibration
