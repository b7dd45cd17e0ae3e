// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/compare/pressed_sphere.h"

#include "bpm/laws/wall.h"
#include "calibration/specimen/nonlinear_network.h"
#include "calibration/specimen/processor_time.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace boba::calibration {

namespace {

constexpr double largest_step = 0.1;     // d, of one contact's approach between two relaxed states
constexpr double force_tolerance = 1e-7; // k d, root mean square residual of a state that is told
constexpr double path_tolerance = 1e-3;  // k d, of the states on the way to it
constexpr int profile_bins = 12;

/// The grain's nodes, then those of a copy when it is pressed against one, apart along z so that they do not touch.
GrainTemplate stacked(const GrainTemplate& sphere, Press press) {
  if (press != Press::mirror && press != Press::twin) {
    return sphere;
  }
  GrainTemplate both = sphere;
  const Eigen::AngleAxisd turn(press == Press::twin ? 1.0 : 0.0, Vector3::UnitZ());
  for (const Vector3& x : sphere.position) {
    both.position.push_back(press == Press::mirror ? Vector3(x.x(), x.y(), -x.z()) : Vector3(turn * x));
  }
  for (const Bond& bond : sphere.bonds) {
    both.bonds.push_back({bond.i + sphere.n_nodes(), bond.j + sphere.n_nodes(), bond.r0});
  }
  return both;
}

struct Extent {
  double low, high;
  double middle() const { return 0.5 * (low + high); }
};
Extent extent(const std::vector<Vector3>& position) {
  const auto [low, high] =
      std::minmax_element(position.begin(), position.end(), [](const auto& a, const auto& b) { return a.z() < b.z(); });
  return {low->z(), high->z()};
}

/// One press: the network, and how its planes are set to a gap a grain.
class Machine {
public:
  Machine(const GrainTemplate& sphere, double alpha, const SurfaceRule& rule, Press press)
      : n_(sphere.n_nodes()), press_(press), rule_(rule), network_(prepared(sphere, press), alpha) {
    reference_ = network_.position();
    const Extent grain = extent(sphere.position);
    centre_ = grain.middle();
    gap_ = std::max(2.0 * rule.radius, grain.high - grain.low + 1.0);
    if (press_ == Press::mirror || press_ == Press::twin) { // the copies meet at z = 0 with their gaps' planes
      std::vector<Vector3> position = reference_;
      const double lower_centre = centre_, upper_centre = press_ == Press::mirror ? -centre_ : centre_;
      for (int n = 0; n < network_.n_nodes(); ++n) {
        position[n].z() += n < n_ ? -0.5 * gap_ - lower_centre : 0.5 * gap_ - upper_centre;
      }
      network_.set_positions(position);
      reference_ = position;
    }
    network_.hold_steady({true, true, press_ == Press::images, true, true, true}, network_.n_nodes() / n_);
  }

  /// Moves the planes to a gap (distance of the two planes of one grain, d) and relaxes.
  void go_to(double gap, double tolerance) {
    const double change = gap - gap_;
    std::vector<Vector3> position = network_.position();
    if (press_ == Press::images) {
      network_.deform_cell(Vector3(1.0, 1.0, gap / *period_).asDiagonal());
      network_.set_positions(position);
    } else if (press_ == Press::walls) {
      network_.set_walls(centre_ - 0.5 * gap, centre_ + 0.5 * gap);
    } else {
      for (int n = 0; n < network_.n_nodes(); ++n) {
        position[n].z() += n < n_ ? -0.5 * change : 0.5 * change;
      }
      network_.set_positions(position);
      network_.set_walls(-gap, gap);
    }
    network_.relax(tolerance);
    gap_ = gap;
  }

  double gap() const { return gap_; }

  SphereState state() const;

private:
  GrainTemplate prepared(const GrainTemplate& sphere, Press press) {
    GrainTemplate grain = stacked(sphere, press);
    if (press == Press::images) {
      const Extent e = extent(sphere.position);
      period_ = e.high - e.low + 2.0;
      grain.period = Vector3(6.0 * rule_.radius, 6.0 * rule_.radius, *period_);
    }
    return grain;
  }
  double force() const;

  int n_;
  Press press_;
  SurfaceRule rule_;
  std::optional<double> period_;
  NonlinearNetwork network_;
  std::vector<Vector3> reference_;
  double centre_ = 0.0, gap_ = 0.0;
};

double Machine::force() const {
  if (press_ == Press::images) { // force through the cell's faces: -stress * area
    const Matrix3 stress = network_.stress();
    return -stress(2, 2) * std::pow(6.0 * rule_.radius, 2);
  }
  const auto load = network_.wall_loads();
  return 0.5 * (load[0] + load[1]);
}

/// Force-weighted size of the contact with the upper wall, on the undeformed grain.
void measure_contact(const std::vector<Vector3>& reference, const std::vector<Vector3>& position, double wall,
                     SphereState& state) {
  double force = 0.0, moment = 0.0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (std::size_t n = 0; n < position.size(); ++n) {
    const double z = wall - position[n].z();
    if (z < 0.5) {
      const double f = wall_force(ContactLaw{}, z, 0.0);
      force += f;
      centre += f * reference[n].head<2>();
      moment += f * reference[n].head<2>().squaredNorm();
      ++state.n_touching;
    }
  }
  if (force > 0.0) {
    centre /= force;
    state.contact_radius = std::sqrt(2.5 * std::max(0.0, moment / force - centre.squaredNorm()));
  }
}

/// u_r at the equator of the surface, from a smooth fit over the equatorial belt.
double equatorial_bulge(const std::vector<Vector3>& x, const std::vector<Vector3>& u, double radius) {
  std::vector<int> belt;
  for (std::size_t n = 0; n < x.size(); ++n) {
    if (std::abs(x[n].z()) < 0.35 * radius && x[n].head<2>().norm() > 0.5 * radius) {
      belt.push_back(static_cast<int>(n));
    }
  }
  Eigen::MatrixXd terms(belt.size(), 5);
  Eigen::VectorXd value(belt.size());
  for (std::size_t b = 0; b < belt.size(); ++b) {
    const Vector3 &at = x[belt[b]], &by = u[belt[b]];
    const double rho = at.head<2>().norm(), depth = (radius - rho) / radius, z = at.z() / radius;
    terms.row(b) << 1.0, depth, z * z, depth * depth, depth * z * z;
    value[b] = at.head<2>().dot(by.head<2>()) / rho;
  }
  return terms.colPivHouseholderQr().solve(value)[0];
}

std::vector<SurfacePoint> surface_profile(const std::vector<Vector3>& x, const std::vector<Vector3>& u, double radius) {
  std::vector<SurfacePoint> profile(profile_bins);
  for (std::size_t n = 0; n < x.size(); ++n) {
    if (x[n].norm() > radius - 1.0) {
      const double rho = x[n].head<2>().norm(), sine = std::abs(x[n].z()) / x[n].norm();
      // Bins of equal area, so equally many nodes.
      SurfacePoint& point = profile[std::min(profile_bins - 1, static_cast<int>(sine * profile_bins))];
      point.angle += std::asin(sine);
      point.radial += x[n].head<2>().dot(u[n].head<2>()) / std::max(rho, 1e-9);
      point.axial += u[n].z() * (x[n].z() > 0.0 ? 1.0 : -1.0);
      ++point.n_nodes;
    }
  }
  for (SurfacePoint& point : profile) {
    const double n = std::max(1, point.n_nodes);
    point = {point.angle / n, point.radial / n, point.axial / n, point.n_nodes};
  }
  return profile;
}

SphereState Machine::state() const {
  SphereState state{.approach = rule_.radius - 0.5 * gap_, .force = force()};
  // The first grain's nodes about its own centre; displacements without their mean, which is the machine's.
  Vector3 mean = Vector3::Zero(), mean_u = Vector3::Zero();
  std::vector<Vector3> x(n_), u(n_);
  for (int n = 0; n < n_; ++n) {
    mean += reference_[n] / n_;
    mean_u += (network_.position()[n] - reference_[n]) / n_;
  }
  for (int n = 0; n < n_; ++n) {
    x[n] = reference_[n] - mean;
    u[n] = network_.position()[n] - reference_[n] - mean_u;
  }
  const double body = rule_.body > 0.0 ? rule_.body : rule_.radius;
  state.bulge = equatorial_bulge(x, u, body);
  state.profile = surface_profile(x, u, body);
  if (press_ == Press::walls) {
    const auto load = network_.wall_loads();
    state.imbalance = std::abs(load[1] - load[0]) / std::max(1e-12, state.force);
    measure_contact(reference_, network_.position(), centre_ + 0.5 * gap_, state);
  }
  state.position = std::vector<Vector3>(network_.position().begin(), network_.position().begin() + n_);
  state.virial = network_.node_virials();
  state.virial.resize(n_);
  return state;
}

} // namespace

std::vector<SphereState> press_sphere(const GrainTemplate& sphere, double alpha, const SurfaceRule& rule,
                                      const std::vector<double>& approaches, Press press) {
  Machine machine(sphere, alpha, rule, press);
  // Nodes that face a copy's slip sideways from a start that is not at rest: there every state is relaxed fully.
  const double on_the_way = press == Press::walls ? path_tolerance : force_tolerance;
  std::vector<SphereState> states;
  for (const double approach : approaches) {
    const double start = processor_seconds();
    const double goal = 2.0 * (rule.radius - approach), from = machine.gap();
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(goal - from) / (2.0 * largest_step))));
    for (int s = 1; s <= steps; ++s) {
      machine.go_to(from + (goal - from) * s / steps, s < steps ? on_the_way : force_tolerance);
    }
    states.push_back(machine.state());
    states.back().seconds = processor_seconds() - start;
  }
  return states;
}

} // namespace boba::calibration
