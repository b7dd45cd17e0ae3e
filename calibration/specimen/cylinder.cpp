// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/specimen/cylinder.h"

#include "bpm/dynamics/simulation.h"
#include "bpm/stages/hold.h"
#include "bpm/stages/press.h"
#include "calibration/specimen/nonlinear_network.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <stdexcept>

namespace boba::calibration {

namespace {

/// The nodes of the slabs and what is between them.
struct Slabs {
  double low = 0.0, high = 0.0; // edges of the free part, z
  std::vector<int> lower, upper;
  double free_height() const { return high - low; }
};

Slabs find_slabs(const GrainTemplate& cylinder, double thickness) {
  const auto by_z = [](const Vector3& a, const Vector3& b) { return a.z() < b.z(); };
  const auto [bottom, top] = std::minmax_element(cylinder.position.begin(), cylinder.position.end(), by_z);
  Slabs slabs;
  slabs.low = bottom->z() + thickness;
  slabs.high = top->z() - thickness;
  if (!(thickness > 0.0 && slabs.free_height() > 2.0)) {
    throw std::invalid_argument(
        fmt::format("clamp thickness = {} d must be positive and leave more than 2 d of the height {:.4g} d", thickness,
                    top->z() - bottom->z()));
  }
  for (int n = 0; n < cylinder.n_nodes(); ++n) {
    if (cylinder.position[n].z() <= slabs.low) {
      slabs.lower.push_back(n);
    } else if (cylinder.position[n].z() >= slabs.high) {
      slabs.upper.push_back(n);
    }
  }
  return slabs;
}

/// Strains of the middle third by least squares over its nodes, and the areas.
CylinderResult measure(const GrainTemplate& cylinder, const std::vector<Vector3>& position, const Slabs& slabs,
                       const BulkDensity& bulk, double force) {
  const std::vector<Vector3>& reference = cylinder.position;
  const double third = slabs.free_height() / 3.0, low = slabs.low + third, high = slabs.high - third;
  std::vector<int> middle;
  Vector3 mean = Vector3::Zero(), mean_u = Vector3::Zero();
  for (int n = 0; n < static_cast<int>(reference.size()); ++n) {
    if (reference[n].z() > low && reference[n].z() < high) {
      middle.push_back(n);
      mean += reference[n];
      mean_u += position[n] - reference[n];
    }
  }
  const auto count = static_cast<double>(middle.size());
  mean /= count;
  mean_u /= count;
  CylinderResult result{
      .force = force, .free_height = slabs.free_height(), .density_area = count / (bulk.nodes * third)};
  for (const Bond& bond : cylinder.bonds) {
    const double z = 0.5 * (reference[bond.i].z() + reference[bond.j].z());
    result.bond_area += z > low && z < high ? bond.r0 * bond.r0 / (bulk.bonds * third) : 0.0;
  }
  double zz = 0.0, uz = 0.0, rr = 0.0, ur = 0.0;
  for (const int n : middle) {
    const Vector3 x = reference[n] - mean, u = position[n] - reference[n] - mean_u;
    zz += x.z() * x.z();
    uz += u.z() * x.z();
    rr += x.head<2>().squaredNorm();
    ur += u.head<2>().dot(x.head<2>());
    result.centre_radius = std::max(result.centre_radius, x.head<2>().norm());
  }
  result.axial_strain = uz / zz;
  result.lateral_strain = ur / rr;
  return result;
}

} // namespace

CylinderResult static_cylinder(const GrainTemplate& cylinder, const CylinderTest& test, const BulkDensity& bulk) {
  const Slabs slabs = find_slabs(cylinder, test.clamp_thickness);
  NonlinearNetwork network(cylinder, test.alpha);
  network.hold(slabs.lower);
  network.hold(slabs.upper);
  const double centre = 0.5 * (slabs.low + slabs.high);
  for (int n = 0; n < cylinder.n_nodes(); ++n) { // linear between the slabs, rigid in them
    const double z = std::clamp(cylinder.position[n].z(), slabs.low, slabs.high);
    network.move(n, {0.0, 0.0, -test.strain * (z - centre)});
  }
  network.relax(1e-9);
  const std::vector<Vector3> forces = network.forces(network.position());
  double force = 0.0; // the network's push on both slabs, halved
  for (const int n : slabs.upper) {
    force += 0.5 * forces[n].z();
  }
  for (const int n : slabs.lower) {
    force -= 0.5 * forces[n].z();
  }
  return measure(cylinder, network.position(), slabs, bulk, force);
}

CylinderResult dynamic_cylinder(const GrainTemplate& cylinder, const CylinderTest& test, const BulkDensity& bulk,
                                double velocity, double settle) {
  const Slabs slabs = find_slabs(cylinder, test.clamp_thickness);
  Vector3 reach = Vector3::Zero();
  for (const Vector3& x : cylinder.position) {
    reach = reach.cwiseMax(x.cwiseAbs());
  }
  const Vector3 half = reach + Vector3::Constant(10.0);
  Packing packing =
      make_packing(Box(-half, 2.0 * half, Vector3::Zero(), {false, false, false}),
                   {std::make_shared<GrainTemplate>(cylinder)}, {Placement{.grain = {.alpha = test.alpha}}});
  Simulation simulation(std::move(packing), Material{}, SimulationOptions{});
  simulation.run(0,
                 PressDriver({.ends = PressStage::Ends::clamps,
                              .velocity = velocity,
                              .strain = test.strain,
                              .clamp_thickness = test.clamp_thickness}),
                 {});
  simulation.run(1, HoldDriver({.time = settle, .barostat = {}}), {});
  const auto ends = simulation.end_forces();
  return measure(cylinder, simulation.snapshot().position, slabs, bulk, 0.5 * (ends[0] + ends[1]));
}

} // namespace boba::calibration
