// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/simulation.h"
#include "bpm/grain/random.h"
#include "calibration/network/network_stiffness.h"
#include "calibration/specimen/cylinder.h"
#include "calibration/specimen/dynamic_box.h"
#include "calibration/specimen/nonlinear_network.h"
#include "calibration/specimen/uniaxial_curve.h"
#include "tests/calibration/test_boxes.h"

#include <gtest/gtest.h>
#include <memory>

namespace boba::calibration {
namespace {

std::vector<Vector3> random_displacements(int n, double size) {
  Random random(11);
  std::vector<Vector3> u(n);
  for (Vector3& value : u) {
    value = random.vector(size);
  }
  return u;
}

TEST(NonlinearNetwork, HasTheEnginesForcesFarFromRest) {
  const GrainTemplate box = test_box(500);
  const std::vector<Vector3> u = random_displacements(box.n_nodes(), 0.08);
  for (const double alpha : {-0.8, 12.0}) {
    Packing packing = make_packing(Box(-0.5 * *box.period, *box.period), {std::make_shared<GrainTemplate>(box)},
                                   {Placement{.grain = {.alpha = alpha}}});
    const NonlinearNetwork network(box, alpha);
    std::vector<Vector3> mine = network.position();
    for (int n = 0; n < box.n_nodes(); ++n) {
      packing.position[n] += u[n];
      mine[n] += u[n];
    }
    Simulation simulation(std::move(packing), Material{}, SimulationOptions{});
    simulation.evaluate();
    const std::vector<Vector3> expected = simulation.snapshot({.velocity = false, .force = true}).force;
    const std::vector<Vector3> forces = network.forces(mine);
    double largest = 0.0;
    for (int n = 0; n < box.n_nodes(); ++n) {
      largest = std::max(largest, expected[n].norm());
      EXPECT_LT((forces[n] - expected[n]).norm(), 1e-11);
    }
    EXPECT_GT(largest, 0.1);
  }
}

TEST(NonlinearNetwork, DerivativeIsThatOfTheForces) {
  const GrainTemplate box = test_box(500);
  NonlinearNetwork network(box, 5.0);
  network.deform_cell(Vector3(0.9, 1.02, 1.02).asDiagonal());
  const std::vector<Vector3> u = random_displacements(box.n_nodes(), 1.0);
  const double h = 1e-5;
  std::vector<Vector3> plus = network.position(), minus = plus;
  for (std::size_t n = 0; n < u.size(); ++n) {
    plus[n] += h * u[n];
    minus[n] -= h * u[n];
  }
  const auto ahead = network.forces(plus), behind = network.forces(minus), exact = network.force_derivative(u);
  for (std::size_t n = 0; n < u.size(); ++n) {
    EXPECT_LT(((ahead[n] - behind[n]) / (2.0 * h) - exact[n]).norm(), 1e-6 * (1.0 + exact[n].norm()));
  }
}

TEST(UniaxialCurve, StartsWithTheSlopeOfTheStaticStiffness) {
  const GrainTemplate box = test_box(500);
  for (const double alpha : {-0.8, 2.0}) {
    const Stiffness c = relaxed_stiffness(LinearNetwork(box), {alpha}, {.relative_tolerance = 1e-9}).front().stiffness;
    // Equal stretches across, mean lateral stress zero.
    const double lateral = -(c(1, 0) + c(2, 0)) / c.block<2, 2>(1, 1).sum();
    const double young = c(0, 0) + (c(0, 1) + c(0, 2)) * lateral;
    const auto points = uniaxial_curve(box, alpha, {-1e-3, 1e-3});
    // The mean of the two sides has no error of first order in the strain.
    EXPECT_NEAR(0.5 * (points[1].stress - points[0].stress) / 1e-3, young, 1e-4 * young);
    EXPECT_NEAR(0.5 * (points[1].lateral_stretch - points[0].lateral_stretch) / 1e-3, lateral, 2e-4);
  }
}

TEST(UniaxialCurve, SoftensInCompressionAndLeavesNoLateralStress) {
  const auto points = uniaxial_curve(test_box(500), 0.0, {-0.2, -0.1, 0.1});
  EXPECT_LT(points[0].stress / -0.2, points[1].stress / -0.1);
  for (const UniaxialPoint& point : points) {
    EXPECT_LT(std::abs(point.lateral_stress), 1e-6);
  }
}

TEST(DynamicBox, TheEngineMeasuresTheStaticModuli) {
  const GrainTemplate box = test_box(500);
  for (const double alpha : {0.0, 2.0}) {
    const Stiffness c = relaxed_stiffness(LinearNetwork(box), {alpha}, {.relative_tolerance = 1e-9}).front().stiffness;
    const DynamicModuli moduli = dynamic_moduli(box, alpha);
    EXPECT_NEAR(moduli.shear, c(5, 5), 1e-3 * c(5, 5));
    // The finite pressure of 2e-3 k/d changes K by about its own size.
    EXPECT_NEAR(moduli.bulk, isotropic_part(c).bulk, 5e-3 * moduli.bulk);
  }
}

TEST(Cylinder, StaticAndDynamicSqueezesAgree) {
  const GrainTemplate cylinder = test_cylinder(4.0, 16.0);
  const CylinderTest test{.alpha = 2.0};
  const BulkDensity bulk = bulk_density(test_box(2048));
  const CylinderResult rest = static_cylinder(cylinder, test, bulk), run = dynamic_cylinder(cylinder, test, bulk);
  EXPECT_NEAR(run.young(), rest.young(), 1e-3 * rest.young());
  EXPECT_NEAR(run.poisson(), rest.poisson(), 1e-3);
  EXPECT_NEAR(rest.density_area, M_PI * 16.0, 0.05 * M_PI * 16.0);
}

TEST(Cylinder, HasTheNetworksModulusOverTheAreaOfItsBonds) {
  const GrainTemplate box = test_box(2048);
  TemplateSpec spec{.shape = TemplateSpec::Shape::cylinder, .radius = 7.0, .height = 28.0};
  const GrainTemplate cylinder = cut_from_bulk(box, spec, 1);
  const std::vector<double> alphas = {-0.8, 0.0, 12.0};
  const auto network = relaxed_stiffness(LinearNetwork(box), alphas);
  for (std::size_t a = 0; a < alphas.size(); ++a) {
    const ElasticConstants solid = isotropic_part(network[a].stiffness);
    const CylinderResult result = static_cylinder(cylinder, {.alpha = alphas[a]}, bulk_density(box));
    EXPECT_NEAR(result.young(), solid.young(), 0.03 * solid.young());
    EXPECT_NEAR(result.poisson(), solid.poisson(), 0.02);
    // By number of nodes the missing bonds of the surface are taken for solid.
    EXPECT_LT(result.young_of(result.density_area), 0.95 * solid.young());
  }
}

TEST(BulkCut, TakesTheNodesInsideTheOutlineInEveryOrientation) {
  const GrainTemplate box = test_box(500);
  const TemplateSpec spec{.shape = TemplateSpec::Shape::cylinder, .radius = 6.0, .height = 30.0};
  for (const std::uint64_t sample : {1, 2, 3}) {
    const GrainTemplate body = cut_from_bulk(box, spec, sample);
    EXPECT_NEAR(body.n_nodes(), 1.226 * M_PI * 36.0 * 30.0, 60.0); // a few nodes without hold are shed
    for (const Vector3& x : body.position) {
      EXPECT_LE(x.head<2>().norm(), 6.0);
      EXPECT_LE(std::abs(x.z()), 15.0);
    }
  }
}

TEST(Cylinder, SlabsThatLeaveNothingAreRefused) {
  EXPECT_THROW(static_cylinder(test_cylinder(4.0, 16.0), {.clamp_thickness = 8.0}, {}), std::invalid_argument);
}

} // namespace
} // namespace boba::calibration
