// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/simulation.h"
#include "calibration/specimen/bulk_cut.h"
#include "tests/calibration/test_boxes.h"
#include "tests/comparison/comparison_case.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <memory>

namespace boba::calibration {
namespace {

double force_error(int n_nodes, int samples) {
  ComparisonSettings settings = comparison_case(0.0, {0.1}, "resolution");
  settings.n_nodes = n_nodes;
  settings.samples = samples;
  const auto document = compare_sphere(settings);
  std::filesystem::remove_all(settings.folder);
  const auto& force = row_of(document, "walls", 0.1, "force");
  return force.at("particles").get<double>() / force.at("continuum").at("finite_layer").get<double>() - 1.0;
}

TEST(Resolution, MoreNodesBringTheForceCloserToTheContinuum) {
  const double coarse = force_error(1000, 4), fine = force_error(20000, 1);
  fmt::print("force over the continuum's at approach / R = 0.1: {:+.3f} at 1000 nodes, {:+.3f} at 20000\n", coarse,
             fine);
  EXPECT_LT(std::abs(fine), 0.08);
  EXPECT_LT(std::abs(fine), std::abs(coarse));
}

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
