// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/soft_relaxation.h"

#include "bpm/grain/near_pairs.h"

#include <algorithm>
#include <cmath>

namespace boba {

namespace {

using Eigen::Vector3d;

// The list holds pairs below d + skin and lasts until a node has moved half the skin: about this many steps' way of the
// fastest node, so that the quenched packing has few idle pairs and the melt few new lists.
constexpr double steps_per_list = 100.0;
constexpr double smallest_skin = 0.03; // d
constexpr double largest_skin = 0.35;  // d

class Relaxation {
public:
  Relaxation(std::vector<Vector3d>& position, std::vector<Vector3d>& velocity, const Confinement& confinement,
             double time_step)
      : x_(position), v_(velocity), force_(position.size()), confinement_(confinement), time_step_(time_step),
        shifts_(image_shifts(confinement.period.value_or(Vector3d::Zero()))) {
    rebuild();
  }

  void rebuild() {
    skin_ = std::clamp(2.0 * steps_per_list * time_step_ * largest_speed(), smallest_skin, largest_skin);
    if (confinement_.period) {
      for (Vector3d& x : x_) {
        x = wrapped(x, *confinement_.period);
      }
    }
    pairs_ = near_pairs(x_, 1.0 + skin_, confinement_.period);
    listed_ = x_;
  }

  bool list_is_old() const {
    for (std::size_t n = 0; n < x_.size(); ++n) {
      if ((x_[n] - listed_[n]).squaredNorm() > 0.25 * skin_ * skin_) {
        return true;
      }
    }
    return false;
  }

  void compute_forces() {
    for (std::size_t n = 0; n < x_.size(); ++n) {
      force_[n] = confinement_.wall_force ? confinement_.wall_force(x_[n]) : Vector3d(Vector3d::Zero());
    }
    for (const NearPair& pair : pairs_) {
      const Vector3d difference = x_[pair.i] - x_[pair.j] - shifts_[pair.shift];
      const double r2 = difference.squaredNorm();
      if (r2 >= 1.0) {
        continue;
      }
      const double r = std::sqrt(r2);
      const double smooth = 1.0 - r2 * r2 * r2 * r2;
      const double closing = difference.dot(v_[pair.i] - v_[pair.j]) / r;
      const Vector3d f = ((1.0 - r - smooth * closing) / r) * difference;
      force_[pair.i] += f;
      force_[pair.j] -= f;
    }
  }

  /// One leapfrog step: velocities live half a step behind the positions.
  void step() {
    compute_forces();
    for (std::size_t n = 0; n < x_.size(); ++n) {
      v_[n] += time_step_ * force_[n];
      x_[n] += time_step_ * v_[n];
    }
  }

  double largest_force() const { return largest(force_); }
  double largest_speed() const { return largest(v_); }

private:
  static double largest(const std::vector<Vector3d>& vectors) {
    double square = 0.0;
    for (const Vector3d& value : vectors) {
      square = std::max(square, value.squaredNorm());
    }
    return std::sqrt(square);
  }

  std::vector<Vector3d>& x_;
  std::vector<Vector3d>& v_;
  std::vector<Vector3d> force_;
  const Confinement& confinement_;
  double time_step_;
  double skin_ = largest_skin;
  std::array<Vector3d, 27> shifts_;
  std::vector<NearPair> pairs_;
  std::vector<Vector3d> listed_; // positions when the list was made
};

} // namespace

RelaxationResult relax_soft_nodes(std::vector<Vector3d>& position, std::vector<Vector3d>& velocity,
                                  const Confinement& confinement, const RelaxationSettings& settings) {
  RelaxationResult result;
  if (position.empty()) {
    result.at_rest = true;
    return result;
  }
  Relaxation relaxation(position, velocity, confinement, settings.time_step);
  constexpr int steps_between_checks = 20;
  while (result.steps < settings.max_steps && !result.at_rest) {
    relaxation.step();
    ++result.steps;
    if (relaxation.list_is_old()) {
      relaxation.rebuild();
    }
    if (result.steps % steps_between_checks == 0 || result.steps == settings.max_steps) {
      result.largest_force = relaxation.largest_force();
      result.largest_speed = relaxation.largest_speed();
      result.at_rest = std::max(result.largest_force, result.largest_speed) < settings.rest_force;
    }
  }
  relaxation.rebuild(); // leaves periodic positions inside the cell
  return result;
}

} // namespace boba
