// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/comparison/comparison_case.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>

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
  fmt::print("force over the continuum's at approach / R = 0.1: {:+.3f} at 1000 nodes, {:+.3f} at 20000\n", coarse, fine);
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
  const double wall = row_of(document, "walls", 0.1, "force")["particles"], mirror = row_of(document, "mirror", 0.1, "force")["particles"];
  expect_near("force of two mirrored grains against the wall's", mirror, wall, 0.05 * wall);
}

} // namespace
} // namespace boba::calibration
