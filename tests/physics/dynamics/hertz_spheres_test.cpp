// SPDX-License-Identifier: GPL-3.0-or-later
// Packings of one-node grains under Hertz's law against closed forms.
#include "bpm/dynamics/elastic_probe.h"
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/grain/build_template.h"

#include <cmath>
#include <gtest/gtest.h>

namespace boba::test {
namespace {

constexpr double E = 3.0;
const Material rigid = {.contact = "hertz", .contact_parameters = {E}};

/// Spheres of diameter 1 on a simple cubic lattice, n^3 of them, in a cell that leans by whole lattice vectors.
Packing cubic_lattice(int n, double spacing) {
  auto sphere = std::make_shared<const GrainTemplate>(build_template({.n_nodes = 1}));
  std::vector<Placement> placements;
  for (int i = 0; i < n * n * n; ++i) {
    const Eigen::Vector3i cell(i % n, i / n % n, i / (n * n));
    placements.push_back({.centre = spacing * (cell.cast<double>() + Vector3::Constant(0.5))});
  }
  const Box box(Vector3::Zero(), Vector3::Constant(n * spacing), {spacing, -spacing, 0.0});
  return make_packing(box, {sphere}, placements);
}

double hertz(double overlap) {
  return 4.0 / 3.0 * E * std::sqrt(0.25) * std::pow(overlap, 1.5); // R* = d / 4
}

// Six contacts a sphere: P = (1 / 3 Vol) sum r f = f / a^2.
TEST(HertzSpheres, PressOnEachOtherInALatticeAsInClosedForm) {
  for (const double overlap : {1e-4, 1e-2}) {
    const double a = 1.0 - overlap;
    Stepper stepper(cubic_lattice(4, a), rigid, {.threads = 1});
    stepper.start();
    EXPECT_NEAR(totals_of(stepper.moving()).pressure / (hertz(overlap) / (a * a)), 1.0, 1e-10);
    EXPECT_NEAR(totals_of(stepper.moving()).mu(), 0.0, 1e-10);
  }
}

// A pure shear of the lattice makes no contacts longer or shorter to first order; an isotropic squeeze does. The bulk
// modulus is K = -V dP/dV of the closed form above, P(a) = f(1 - a) / a^2.
TEST(HertzSpheres, HaveTheLatticesBulkModulus) {
  const double overlap = 1e-2, a = 1.0 - overlap, h = 1e-6;
  const auto pressure = [](double spacing) { return hertz(1.0 - spacing) / (spacing * spacing); };
  const double modulus = -a / 3.0 * (pressure(a + h) - pressure(a - h)) / (2.0 * h);
  Stepper stepper(cubic_lattice(4, a), rigid, {.threads = 1});
  EXPECT_NEAR(affine_bulk_modulus(stepper.moving()) / modulus, 1.0, 1e-4);
}

// Two spheres that fly apart and together again across the periodic boundary: momentum stays, contacts are found
// however far they have gone. Free flight in between is uniform.
TEST(HertzSpheres, CollideWhenTheyMeet) {
  auto sphere = std::make_shared<const GrainTemplate>(build_template({.n_nodes = 1}));
  Packing packing = make_packing(Box(Vector3::Zero(), Vector3::Constant(6.0)), {sphere},
                                 {{.centre = {1.0, 3.0, 3.0}}, {.centre = {4.0, 3.0, 3.0}}});
  packing.velocity = {{0.01, 0.0, 0.0}, {-0.01, 0.0, 0.0}};
  Material elastic = rigid;
  elastic.gamma = 0.0;
  Stepper stepper(std::move(packing), elastic, {.dt = 0.05, .threads = 1});
  stepper.start();
  bool bounced = false;
  for (int step = 0; step < 4000; ++step) { // they meet after a gap of 2 d, at 100 tau
    stepper.advance(Virial::full);
    bounced = bounced || totals_of(stepper.moving()).pressure > 1e-6;
    stepper.move_cell({});
  }
  EXPECT_TRUE(bounced);
  const Snapshot after = take_snapshot(stepper.moving(), {.velocity = true});
  EXPECT_NEAR(after.velocity[0].x(), -0.01, 1e-5);
  EXPECT_NEAR(after.velocity[1].x(), 0.01, 1e-5);
}

struct Collision {
  double time = 0.0, restitution = 0.0;
};

/// Two spheres that meet head on, each at this speed. Crossings of r = d are interpolated between steps.
Collision collide(double speed, double gamma, double dt) {
  auto sphere = std::make_shared<const GrainTemplate>(build_template({.n_nodes = 1}));
  Packing packing = make_packing(Box(Vector3::Zero(), Vector3::Constant(6.0)), {sphere},
                                 {{.centre = {2.499, 3.0, 3.0}}, {.centre = {3.501, 3.0, 3.0}}});
  packing.velocity = {{speed, 0.0, 0.0}, {-speed, 0.0, 0.0}};
  Material material = rigid;
  material.gamma = gamma;
  Stepper stepper(std::move(packing), material, {.dt = dt, .threads = 1});
  stepper.start();
  Collision collision;
  double before = 1.002, begin = -1.0;
  for (int step = 1; step < 1000000; ++step) {
    stepper.advance(Virial::full);
    const Snapshot now = take_snapshot(stepper.moving(), {.velocity = true});
    const double distance = now.position[1].x() - now.position[0].x();
    const double crossing = dt * (step - 1 + (1.0 - before) / (distance - before));
    if (before >= 1.0 && distance < 1.0) {
      begin = crossing;
    } else if (before < 1.0 && distance >= 1.0) {
      collision.time = crossing - begin;
    } else if (collision.time > 0.0) {
      collision.restitution = now.velocity[1].x() / speed;
      break;
    }
    before = distance;
    stepper.move_cell({});
  }
  return collision;
}

// Without damping a collision lasts 2.9433 delta / v, delta = (15 m v^2 / (16 E* sqrt(R*)))^(2/5) the largest overlap,
// m = 1/2 the reduced mass, v the approach. Source: Hertz (1882); Landau & Lifshitz, Theory of Elasticity, sec. 9.
TEST(HertzSpheres, CollideForTheTimeOfHertzTheory) {
  for (const double v : {0.02, 0.002}) {
    const double deepest = std::pow(15.0 * 0.5 * v * v / (16.0 * E * 0.5), 0.4);
    const double time = 2.943275 * deepest / v;
    const Collision collision = collide(0.5 * v, 0.0, time / 1000.0);
    EXPECT_NEAR(collision.time / time, 1.0, 0.005);
    EXPECT_NEAR(collision.restitution, 1.0, 0.005);
  }
}

// Damped by a share of the critical one, the restitution e does not depend on the speed: with the force K x^(3/2) + a
// sqrt(m K) x^(1/4) x', a = -sqrt(5) ln e / sqrt(ln^2 e + pi^2). Here K = 2/3 E_eff sqrt(d) and a = sqrt(6) gamma.
// Source: Tsuji, Tanaka & Ishida (1992); Antypov & Elliott, EPL 94, 50004 (2011), equation 17.
TEST(HertzSpheres, BounceWithTheRestitutionOfTheirDamping) {
  for (const double gamma : {0.05, 0.3}) {
    for (const double v : {0.02, 0.002}) {
      const double time = 2.943275 * std::pow(15.0 * 0.5 * v * v / (16.0 * E * 0.5), 0.4) / v;
      const double a = std::sqrt(6.0) * gamma;
      const double restitution = std::exp(-std::acos(-1.0) * a / std::sqrt(5.0 - a * a));
      EXPECT_NEAR(collide(0.5 * v, gamma, time / 2000.0).restitution / restitution, 1.0, 0.005) << gamma;
    }
  }
}

} // namespace
} // namespace boba::test
