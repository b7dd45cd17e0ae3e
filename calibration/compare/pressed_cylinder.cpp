// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/compare/pressed_cylinder.h"

#include "calibration/specimen/nonlinear_network.h"
#include "calibration/specimen/processor_time.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::calibration {

namespace {

constexpr double largest_strain_step = 0.02;   // of strain
constexpr double state_tolerance = 1e-7;       // k d, root mean square residual of a state that is told
constexpr double strain_path_tolerance = 1e-4; // k d, of the states on the way to it
constexpr int bins = 8;                        // of |z|

/// How far behind the face at height z0 the slab beyond it acts; `side` is -1 for the lower slab, +1 for the upper.
double hold_depth(const GrainTemplate& cylinder, double z0, double side) {
  double depth = 0.0, weight = 0.0;
  for (const Bond& bond : cylinder.bonds) {
    const Vector3 &a = cylinder.position[bond.i], &b = cylinder.position[bond.j];
    const double held = side * std::max(side * a.z(), side * b.z()), free = side * std::min(side * a.z(), side * b.z());
    if (side * held >= side * z0 && side * free < side * z0) {
      const double w = std::pow((a.z() - b.z()) / bond.r0, 2);
      depth += w * side * (held - z0);
      weight += w;
    }
  }
  return depth / weight;
}

} // namespace

CylinderPress::CylinderPress(const GrainTemplate& cylinder, const BulkDensity& bulk, double slab)
    : cylinder_(cylinder) {
  const auto [bottom, top] = std::minmax_element(cylinder.position.begin(), cylinder.position.end(),
                                                 [](const Vector3& a, const Vector3& b) { return a.z() < b.z(); });
  low_ = bottom->z() + slab;
  high_ = top->z() - slab;
  if (!(slab > 0.0 && high_ - low_ > 2.0)) {
    throw std::invalid_argument(
        fmt::format("slab = {} d leaves too little of the height {:.4g} d", slab, top->z() - bottom->z()));
  }
  for (int n = 0; n < cylinder.n_nodes(); ++n) {
    if (cylinder.position[n].z() <= low_) {
      lower_.push_back(n);
    } else if (cylinder.position[n].z() >= high_) {
      upper_.push_back(n);
    }
  }
  const double third = (high_ - low_) / 3.0;
  double area = 0.0;
  for (const Bond& bond : cylinder.bonds) {
    const double z = 0.5 * (cylinder.position[bond.i].z() + cylinder.position[bond.j].z());
    area += z > low_ + third && z < high_ - third ? bond.r0 * bond.r0 / (bulk.bonds * third) : 0.0;
  }
  body_.radius = std::sqrt(area / M_PI);
  body_.height = high_ - low_ + hold_depth(cylinder, low_, -1.0) + hold_depth(cylinder, high_, 1.0);
}

CylinderState CylinderPress::measure(const std::vector<Vector3>& position, double strain) const {
  CylinderState state{.strain = strain};
  const double centre = 0.5 * (low_ + high_), half = 0.5 * (high_ - low_);
  Vector3 mean_u = Vector3::Zero(), axis = Vector3::Zero();
  int count = 0;
  for (int n = 0; n < cylinder_.n_nodes(); ++n) { // of the free part
    if (std::abs(cylinder_.position[n].z() - centre) < half) {
      mean_u += position[n] - cylinder_.position[n];
      axis += cylinder_.position[n];
      ++count;
    }
  }
  mean_u /= count;
  axis /= count;
  std::vector<double> ur(bins, 0.0), rr(bins, 0.0), z(bins, 0.0);
  std::vector<int> nodes(bins, 0);
  double middle_ur = 0.0, middle_rr = 0.0;
  for (int n = 0; n < cylinder_.n_nodes(); ++n) {
    const Eigen::Vector2d x = (cylinder_.position[n] - axis).head<2>();
    const Eigen::Vector2d u = (position[n] - cylinder_.position[n] - mean_u).head<2>();
    const double height = std::abs(cylinder_.position[n].z() - centre);
    if (height < 0.15 * half) { // u_r is nearly linear in r there
      middle_ur += u.dot(x);
      middle_rr += x.squaredNorm();
    }
    if (height < half && x.norm() > body_.radius - 2.0) {
      const int bin = std::min(bins - 1, static_cast<int>(bins * height / half));
      ur[bin] += u.dot(x);
      rr[bin] += x.squaredNorm();
      z[bin] += height;
      ++nodes[bin];
    }
  }
  state.poisson = middle_ur / middle_rr / strain;
  Vector3 apart = Vector3::Zero();
  for (const int n : upper_) {
    apart += (position[n] - cylinder_.position[n]) / static_cast<double>(upper_.size());
  }
  for (const int n : lower_) {
    apart -= (position[n] - cylinder_.position[n]) / static_cast<double>(lower_.size());
  }
  state.sway = apart.head<2>().norm();
  for (int b = 0; b < bins; ++b) {
    if (nodes[b] > 0) {
      state.z.push_back(z[b] / nodes[b]);
      state.u_r.push_back(ur[b] / rr[b] * body_.radius);
    }
  }
  return state;
}

std::vector<CylinderState> CylinderPress::squeeze(double alpha, CylinderEnds ends,
                                                  const std::vector<double>& strains) const {
  NonlinearNetwork network(cylinder_, alpha);
  const NonlinearNetwork::Held held = ends == CylinderEnds::bonded ? NonlinearNetwork::Held{true, true, true}
                                                                   : NonlinearNetwork::Held{false, false, true};
  network.hold(lower_, held);
  network.hold(upper_, held);
  if (ends == CylinderEnds::sliding) {
    network.hold_steady({true, true, false, false, false, true});
  }
  const double centre = 0.5 * (low_ + high_), half = 0.5 * body_.height;
  std::vector<CylinderState> states;
  double at = 0.0;
  for (const double goal : strains) {
    const double start = processor_seconds();
    const int steps = std::max(1, static_cast<int>(std::ceil((goal - at) / largest_strain_step - 1e-9)));
    const double change = (goal - at) / steps;
    for (int s = 0; s < steps; ++s) {
      for (int n = 0; n < cylinder_.n_nodes(); ++n) {
        double z = cylinder_.position[n].z() - centre;
        if (ends == CylinderEnds::bonded) { // rigid slabs, which move by half the shortening each
          z = cylinder_.position[n].z() <= low_ ? -half : cylinder_.position[n].z() >= high_ ? half : z;
        }
        network.move(n, {0.0, 0.0, -change * z});
      }
      network.relax(s + 1 < steps ? strain_path_tolerance : state_tolerance);
    }
    at = goal;
    CylinderState state = measure(network.position(), goal);
    const std::vector<Vector3> forces = network.forces(network.position());
    for (const int n : upper_) { // the network pushes the slabs apart
      state.force += 0.5 * forces[n].z();
    }
    for (const int n : lower_) {
      state.force -= 0.5 * forces[n].z();
    }
    state.position = network.position();
    state.virial = network.node_virials();
    state.seconds = processor_seconds() - start;
    states.push_back(std::move(state));
  }
  return states;
}

} // namespace boba::calibration
