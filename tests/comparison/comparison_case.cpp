// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/comparison/comparison_case.h"

#include "tests/calibration/test_boxes.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stdexcept>
#include <unistd.h>

namespace boba::calibration {

ComparisonSettings comparison_case(double alpha, std::vector<double> loads, const std::string& name) {
  ComparisonSettings settings;
  settings.alphas = {alpha};
  settings.bulk = test_box(2048);
  settings.loads = std::move(loads);
  settings.folder = std::filesystem::temp_directory_path() / fmt::format("boba_{}_{}", name, getpid());
  std::filesystem::create_directories(settings.folder);
  return settings;
}

const nlohmann::json& row_of(const nlohmann::json& document, const std::string& setup, double load,
                             const std::string& quantity) {
  for (const auto& row : document.at("rows")) {
    if (row["setup"] == setup && row["quantity"] == quantity && std::abs(row["load"].get<double>() - load) < 1e-9) {
      return row;
    }
  }
  throw std::out_of_range(setup + ", " + quantity);
}

void expect_near(const std::string& what, double measured, double reference, double tolerance) {
  fmt::print("{}: measured {:.5g}, reference {:.5g}, difference {:+.3g} ({:+.1f} %), tolerance {:.3g}\n", what,
             measured, reference, measured - reference, 100.0 * (measured / reference - 1.0), tolerance);
  std::fflush(stdout);
  EXPECT_NEAR(measured, reference, tolerance) << what;
}

void expect_force_of_the_layer(const nlohmann::json& document, double alpha, double load) {
  const auto& force = row_of(document, "walls", load, "force");
  const auto& models = force.at("continuum");
  const double reference = models.at("finite_layer"), error = force.at("particles_error");
  const double share = alpha > 10.0 ? 0.1 : alpha > 4.0 ? 0.07 : 0.05;
  expect_near(fmt::format("alpha = {}, approach / R = {}: mean force of {} bodies (standard error {:.1f} %)", alpha,
                          load, force.at("samples").size(), 100.0 * error / reference),
              force.at("particles"), reference, share * reference + error);
  if (models.contains("neo_layer")) {
    fmt::print("  neo-Hookean: {:.5g}\n", models.at("neo_layer").get<double>());
  }
}

} // namespace boba::calibration
