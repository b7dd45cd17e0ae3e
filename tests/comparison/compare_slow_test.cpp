// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/simulation.h"
#include "calibration/specimen/bulk_cut.h"
#include "tests/calibration/test_boxes.h"
#include "tests/comparison/comparison_case.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <memory>
#include <vector>

namespace boba::calibration {
namespace {

/// Mean force at approach / R = 0.1 over that of the continuum with the layer, of the spheres of one resolution.
struct Level {
  int n_nodes = 0, samples = 0;
  double inverse_radius = 0.0; ///< d / R of the solid
  double ratio = 0.0, error = 0.0;
  double to_rigid = 0.0; ///< the same over the rigid plate's
};

Level level_of(double alpha, int n_nodes, int samples) {
  ComparisonSettings settings = comparison_case(alpha, {0.05, 0.1}, "resolution");
  settings.bulk = test_box(4000);
  settings.n_nodes = n_nodes;
  settings.samples = samples;
  settings.models = {"linear_layer", "finite", "finite_layer", "neo_layer"};
  const auto document = compare_sphere(settings);
  std::filesystem::remove_all(settings.folder);
  if (n_nodes == 5137) {
    expect_force_of_the_layer(document, alpha, 0.05);
    expect_force_of_the_layer(document, alpha, 0.1);
  }
  const auto& force = row_of(document, "walls", 0.1, "force");
  const double mean = force.at("particles"), layer = force.at("continuum").at("finite_layer");
  // Bodies of one resolution scatter by 5 % at 5137 nodes and elsewhere like the inverse root of the number of nodes in
  // contact.
  const double scatter = 0.05 * std::cbrt(5137.0 / n_nodes);
  const Level level{.n_nodes = n_nodes,
                    .samples = samples,
                    .inverse_radius = 1.0 / document.at("cases")[0].at("surface").at("body_radius").get<double>(),
                    .ratio = mean / layer,
                    .error = samples > 3 ? force.at("particles_error").get<double>() / layer
                                         : scatter / std::sqrt(double(samples)),
                    .to_rigid = mean / force.at("continuum").at("finite").get<double>()};
  const auto& bulge = row_of(document, "walls", 0.1, "bulge_number");
  fmt::print("alpha = {}, {} nodes, {} bodies: F over the layer's {:.3f} +- {:.3f}, over the rigid plate's {:.3f}; "
             "u_eq E R / F {:.4f} +- {:.4f}, linear continuum {:.4f}\n",
             alpha, n_nodes, samples, level.ratio, level.error, level.to_rigid, bulge.at("particles").get<double>(),
             samples > 1 ? bulge.at("particles_error").get<double>() : 0.0,
             bulge.at("continuum").at("linear_layer").get<double>());
  std::fflush(stdout);
  return level;
}

class Resolution : public ::testing::TestWithParam<double> {};

/// The layer is as thick in d for every R, so the continuum with the layer tends to the rigid plate: the limit of the
/// particles' force over the layer's is the limit of their force over the rigid plate's, without the slow (d/R)^0.65
/// by which each of the two comes up. A weighted straight line in d / R. Tolerance: 5 % and the line's standard error.
TEST_P(Resolution, ExtrapolatedTheForceIsTheRigidPlates) {
  const double alpha = GetParam();
  const std::vector<Level> levels = {level_of(alpha, 1000, 16), level_of(alpha, 5137, 12), level_of(alpha, 20000, 2)};
  double w = 0, wx = 0, wxx = 0, wy = 0, wxy = 0;
  for (const Level& level : levels) {
    const double weight = std::pow(level.error, -2), x = level.inverse_radius;
    w += weight, wx += weight * x, wxx += weight * x * x, wy += weight * level.ratio, wxy += weight * x * level.ratio;
  }
  const double determinant = w * wxx - wx * wx, limit = (wy * wxx - wxy * wx) / determinant,
               error = std::sqrt(wxx / determinant);
  expect_near(fmt::format("alpha = {}: force over the rigid plate's for d / R = 0 (standard error {:.3f})", alpha, error),
              limit, 1.0, 0.05 + error);
  EXPECT_LT(levels[0].to_rigid, levels[1].to_rigid);
  EXPECT_LT(levels[1].to_rigid, levels[2].to_rigid);
}

INSTANTIATE_TEST_SUITE_P(Alpha, Resolution, ::testing::Values(-0.8, 0.0, 2.0, 5.0, 12.0),
                         [](const auto& test) { return fmt::format("{}", test.index); });

/// Node i and its image touch at the plane between them, as at a wall; some nodes touch a neighbour's image too.
TEST(Presses, AMirrorImageIsNearlyAWall) {
  ComparisonSettings settings = comparison_case(0.0, {0.1}, "presses");
  settings.n_nodes = 1000;
  settings.samples = 1;
  settings.presses = {Press::walls, Press::mirror};
  const auto document = compare_sphere(settings);
  std::filesystem::remove_all(settings.folder);
  const double wall = row_of(document, "walls", 0.1, "force")["particles"],
               mirror = row_of(document, "mirror", 0.1, "force")["particles"];
  expect_near("force of two mirrored grains against the wall's", mirror, wall, 0.05 * wall);
}

/// The engine's walls close on a grain that is free to turn, and rest; the static solver goes to the same gap.
TEST(Presses, TheEngineFindsTheStaticForce) {
  TemplateSpec spec{.shape = TemplateSpec::Shape::sphere};
  spec.n_nodes = 1000;
  const GrainTemplate grain = cut_from_bulk(test_box(2048), spec, 1);
  const Vector3 half = Vector3::Constant(20.0);
  Packing packing = make_packing(Box(-half, 2.0 * half, Vector3::Zero(), {false, false, false}),
                                 {std::make_shared<GrainTemplate>(grain)}, {Placement{.grain = {.alpha = 2.0}}});
  Simulation simulation(std::move(packing), Material{}, SimulationOptions{});
  simulation.run(0, PressStage{.ends = PressStage::Ends::walls, .velocity = 1e-3, .strain = 0.15}, {});
  simulation.run(1, HoldStage{.time = 600.0, .barostat = {}}, {});
  const auto ends = simulation.end_forces();
  const double force = 0.5 * (std::abs(ends[0]) + std::abs(ends[1])), gap = simulation.end_gap();
  const SurfaceRule rule{.radius = 6.0};
  const double still = press_sphere(grain, 2.0, rule, {rule.radius - 0.5 * gap}).front().force;
  expect_near(fmt::format("force of the engine at a gap of {:.3f} d against the static one", gap), force, still,
              0.03 * still);
}

} // namespace
} // namespace boba::calibration
