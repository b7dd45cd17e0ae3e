// SPDX-License-Identifier: GPL-3.0-or-later
// A bond law and a contact law from outside the tree: kernels, walls, the contact network, the stable step and the
// linear network follow them. Expected forces are written out here once more.
#include "bpm/dynamics/stable_step.h"
#include "bpm/forces/force_field.h"
#include "bpm/forces/kernels/bond_kernel.h"
#include "bpm/forces/outside_contact_law.h"
#include "bpm/grain/build_template.h"
#include "bpm/grain/random.h"
#include "bpm/measure/contact_network.h"
#include "tests/support/other_laws.h"
#include "tests/support/small_packings.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <gtest/gtest.h>

namespace boba::test {
namespace {

using Eigen::VectorXd;

const bool parabolic_is_known = [] {
  add_contact_law<ParabolicContact>("parabolic",
                                    {{"extra", "k/d", 0.0, 10.0, false, 3.0, "second-order part of the repulsion"}},
                                    [](const Material& m) {
                                      return ParabolicContact{m.k, m.contact_parameters.at(0), m.diameter};
                                    });
  return true;
}();

VectorXd undeformed(const GrainTemplate& grain) {
  VectorXd x(3 * grain.n_nodes());
  for (int i = 0; i < grain.n_nodes(); ++i) {
    x.segment<3>(3 * i) = grain.position[i];
  }
  return x;
}

VectorXd rough(Eigen::Index n, double size, std::uint64_t seed) {
  Random random(seed);
  VectorXd u(n);
  for (double& component : u) {
    component = random.uniform(-size, size);
  }
  return u;
}

/// The law of StiffeningBondOf by plain loops in long double.
VectorXd plain_bond_forces(const GrainTemplate& grain, const VectorXd& x, const VectorXd& v, double alpha) {
  std::vector<long double> volume(grain.n_nodes(), 0), volume0 = volume;
  for (const Bond& bond : grain.bonds) {
    const long double r = (x.segment<3>(3 * bond.i) - x.segment<3>(3 * bond.j)).norm(), r0 = bond.r0;
    for (const int node : {bond.i, bond.j}) {
      volume[node] += r * r * r;
      volume0[node] += r0 * r0 * r0;
    }
  }
  VectorXd f = VectorXd::Zero(x.size());
  for (const Bond& bond : grain.bonds) {
    const Eigen::Vector3d d = x.segment<3>(3 * bond.i) - x.segment<3>(3 * bond.j);
    const Eigen::Vector3d w = v.segment<3>(3 * bond.i) - v.segment<3>(3 * bond.j);
    const long double r = d.norm(), r0 = bond.r0, vn = d.dot(w) / d.norm();
    const long double q = (volume[bond.i] + volume[bond.j]) / (volume0[bond.i] + volume0[bond.j]);
    const long double force =
        2 * (r0 - r) + 7 * (r0 - r) * (r0 - r) * (r0 - r) + alpha * (std::pow(q, 2.0L / 3) - r / r0) - 0.5L * vn;
    f.segment<3>(3 * bond.i) += static_cast<double>(force) * d / d.norm();
    f.segment<3>(3 * bond.j) -= static_cast<double>(force) * d / d.norm();
  }
  return f;
}

/// The same by the kernel of the tree, made for the law here: lane l of a block holds (1 + l / 100) x and (1 + l) v.
std::vector<VectorXd> kernel_bond_forces(const GrainTemplate& grain, const VectorXd& x, const VectorXd& v, double alpha,
                                         int n_lanes) {
  const NetworkData network(grain);
  const auto n = static_cast<std::size_t>(x.size()) * n_lanes;
  std::vector<double> xs(n), vs(n), fs(n, 0.0), volume(n / 3, 0.0), alphas(max_lanes, alpha), none(max_lanes, 0.0);
  for (Eigen::Index c = 0; c < x.size(); ++c) {
    for (int lane = 0; lane < n_lanes; ++lane) {
      xs[c * n_lanes + lane] = (1.0 + 0.01 * lane) * x[c];
      vs[c * n_lanes + lane] = (1.0 + lane) * v[c];
    }
  }
  std::int64_t volumes_done = 0;
  kernels::LaneSums sums;
  const kernels::BondParametersOf<StiffeningBond> parameters{{}, 0.0, 0.0, 1.0, {0.0, 0.0, 0.0}};
  kernels::bond_forces<double, double, StiffeningBond>(
      network.view(), {xs.data(), vs.data(), fs.data(), volume.data(), alphas.data(), none.data(), 0.0, n_lanes},
      parameters, alpha != 0.0, Virial::full, {0, grain.n_nodes(), grain.n_nodes()}, volumes_done, sums);
  std::vector<VectorXd> forces(n_lanes, VectorXd(x.size()));
  for (Eigen::Index c = 0; c < x.size(); ++c) {
    for (int lane = 0; lane < n_lanes; ++lane) {
      forces[lane][c] = fs[c * n_lanes + lane];
    }
  }
  return forces;
}

TEST(OtherBondLaw, KernelsEvaluateIt) {
  const auto grain = small_ball(2.0, 3);
  const VectorXd x = undeformed(*grain) + rough(3 * grain->n_nodes(), 0.05, 1);
  const VectorXd v = rough(x.size(), 0.1, 2);
  for (const int n_lanes : {1, 8}) {
    for (const double alpha : {0.0, 5.0}) {
      const auto ours = kernel_bond_forces(*grain, x, v, alpha, n_lanes);
      for (int lane = 0; lane < n_lanes; ++lane) {
        const VectorXd plain = plain_bond_forces(*grain, (1.0 + 0.01 * lane) * x, (1.0 + lane) * v, alpha);
        EXPECT_LT((ours[lane] - plain).norm(), 1e-13 * plain.norm()) << n_lanes << " lanes, alpha = " << alpha;
      }
    }
  }
}

/// Minus the derivative of the kernel's forces with respect to positions or velocities, about the undeformed grain.
Eigen::MatrixXd kernel_slopes(const GrainTemplate& grain, double alpha, bool by_velocity) {
  const double h = 1e-5;
  const VectorXd x = undeformed(grain), still = VectorXd::Zero(x.size());
  Eigen::MatrixXd slopes(x.size(), x.size());
  for (Eigen::Index c = 0; c < x.size(); ++c) {
    const VectorXd step = h * VectorXd::Unit(x.size(), c);
    const auto force = [&](double sign) {
      const VectorXd moved = sign * step;
      return kernel_bond_forces(grain, by_velocity ? x : VectorXd(x + moved), by_velocity ? moved : still, alpha, 1)[0];
    };
    slopes.col(c) = (force(-1.0) - force(1.0)) / (2.0 * h);
  }
  return slopes;
}

TEST(OtherBondLaw, LinearNetworkAndStableStepFollowIt) {
  const auto grain = small_ball(1.6, 3);
  const LinearNetwork network(*grain, PlainBondOf<StiffeningBond>({}));
  for (const double alpha : {0.0, 5.0}) {
    const Eigen::MatrixXd stiffness = kernel_slopes(*grain, alpha, false), damping = kernel_slopes(*grain, alpha, true);
    const VectorXd u = rough(stiffness.cols(), 1.0, 4);
    VectorXd ours(u.size());
    network.multiply(u.data(), alpha, ours.data());
    EXPECT_LT((ours - stiffness * u).norm(), 1e-7 * ours.norm());
    network.damp(u.data(), ours.data());
    EXPECT_LT((ours - damping * u).norm(), 1e-7 * ours.norm());
    const double dt = stable_step(network, 1.0, alpha);
    const Eigen::EigenSolver<Eigen::MatrixXd> modes(2.0 * dt * damping + dt * dt * stiffness, false);
    EXPECT_NEAR(modes.eigenvalues().real().maxCoeff(), 4.0, 1e-5) << alpha;
    if (alpha == 0.0) { // springs of 2 k instead of k
      EXPECT_LT(dt, 0.95 * stable_step(*grain, Material{.gamma = 0.5}, alpha));
    }
  }
}

/// Two spheres of one node, 0.9 d apart along x, on a plane 0.45 d below: f(0.9) = 0.1 + 3 * 0.1^2.
constexpr double force_at_0_9 = 0.13, energy_at_0_9 = 0.5 * 0.01 + 0.001;
const Material parabolic = {.contact = "parabolic", .contact_parameters = {3.0}};

TEST(OtherContactLaw, ContactsWallsAndTheContactNetworkEvaluateIt) {
  const auto sphere = std::make_shared<const GrainTemplate>(build_template({.n_nodes = 1}));
  const Packing packing = make_packing(Box(Vector3::Zero(), Vector3::Constant(6.0)), {sphere},
                                       {{.centre = {2.0, 3.0, 3.0}}, {.centre = {2.9, 3.0, 3.0}}});
  const LaneLayout layout(packing);
  LaneState state(packing, layout);
  ForceField forces(packing, layout, parabolic, 0.3);
  forces.walls().set({{.point = {0.0, 0.0, 2.55}}});
  forces.evaluate(state, packing.box, {.virial = Virial::full, .keep_forces = true});
  EXPECT_NEAR((state.force(0, 0) - Vector3(-force_at_0_9, 0.0, force_at_0_9)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((state.force(1, 0) - Vector3(force_at_0_9, 0.0, force_at_0_9)).norm(), 0.0, 1e-14);
  EXPECT_NEAR(forces.walls()[0].force, 2.0 * force_at_0_9, 1e-14);
  EXPECT_NEAR(forces.contact_totals().energy, 2.0 * energy_at_0_9, 1e-14); // half of each contact with an image
  const std::vector<std::int64_t> first = {0, 1, 2};
  const auto contacts = measure::contact_network(packing.box, {packing.position, first}, parabolic);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_NEAR(contacts[0].force.norm(), force_at_0_9, 1e-14);
}

// All forces of a packing of balls without damping and many-body terms, by differences of its energy.
TEST(OtherContactLaw, ForcesAreTheDerivativeOfTheEnergy) {
  const Box box({0.0, 0.0, 0.0}, {9.0, 9.0, 9.0});
  Packing packing = small_packing({.box = box, .n_grains = 4, .alpha = 0.0, .speed = 0.0, .least_distance = 4.0});
  Material material = parabolic;
  material.gamma = 0.0;
  const LaneLayout layout(packing);
  const auto evaluated = [&](const auto& look) {
    LaneState state(packing, layout);
    ForceField forces(packing, layout, material, 0.3);
    forces.evaluate(state, packing.box, {.virial = Virial::full, .keep_forces = true});
    return look(forces, state);
  };
  const auto energy = [&] {
    return evaluated([&](ForceField& forces, LaneState& state) {
      return forces.contact_totals().energy + forces.survey(state).energy(packing.box);
    });
  };
  EXPECT_GT(evaluated([](ForceField& forces, LaneState&) { return forces.contact_totals().energy; }), 1e-3);
  const double h = 1e-5;
  for (const int node : {0, 7, 20}) {
    const Vector3 force = evaluated([&](ForceField&, LaneState& state) { return state.force(0, node); });
    for (int c = 0; c < 3; ++c) {
      const double x = packing.position[node][c];
      packing.position[node][c] = x + h;
      const double above = energy();
      packing.position[node][c] = x - h;
      const double below = energy();
      packing.position[node][c] = x;
      EXPECT_NEAR(force[c], -(above - below) / (2.0 * h), 1e-6) << node << " " << c;
    }
  }
}

TEST(OtherContactLaw, NamesAreUnique) {
  const auto make = [](const Material&) { return ParabolicContact{}; };
  EXPECT_THROW(add_contact_law<ParabolicContact>("hertz", {}, make), std::invalid_argument);
  EXPECT_THROW(add_contact_law<ParabolicContact>("new", {{"k3", "", 0.0, 1.0, false, 0.0, ""}}, make),
               std::invalid_argument);
  EXPECT_THROW(contact_model({.contact = "new"}), std::invalid_argument);
  EXPECT_THROW(contact_model({.contact = "parabolic"}), std::invalid_argument); // its parameter is missing
}

} // namespace
} // namespace boba::test
