// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/comparison/comparison_case.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace boba::calibration {
namespace {

/// Cylinders of about 5080 nodes (R = 7 d) at 1 % strain against the finite-strain continuum.
class Cylinders : public ::testing::TestWithParam<double> {};

TEST_P(Cylinders, FollowTheContinuumAtOnePercent) {
  const double alpha = GetParam();
  ComparisonSettings settings = comparison_case(alpha, {0.01}, "cylinder");
  settings.samples = 3;
  const auto document = compare_cylinder(settings);
  std::filesystem::remove_all(settings.folder);
  for (const std::string setup : {"sliding", "bonded"}) {
    const auto& modulus = row_of(document, setup, 0.01, "apparent_modulus");
    const auto& poisson = row_of(document, setup, 0.01, "poisson");
    const double reference = modulus["continuum"]["finite"];
    expect_near(fmt::format("alpha = {}, {}: apparent modulus", alpha, setup), modulus["particles"], reference, 0.03 * reference);
    expect_near(fmt::format("alpha = {}, {}: nu at mid-height", alpha, setup), poisson["particles"],
                poisson["continuum"]["finite"], 0.02);
  }
  for (const auto& one : document["cases"]) {
    expect_near(fmt::format("alpha = {}, {}: misfit of the profile over its largest value", alpha, one["setup"].get<std::string>()),
                one["profiles"][0]["misfit"]["finite"], 0.0, 0.05);
  }
}

INSTANTIATE_TEST_SUITE_P(Alpha, Cylinders, ::testing::Values(-0.8, 0.0, 2.0, 5.0, 12.0),
                         [](const auto& info) { return fmt::format("{}", info.index); });

} // namespace
} // namespace boba::calibration
