// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/lammps_packing.h"
#include "tests/comparison/comparison_case.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <numeric>
#include <stdexcept>

namespace boba::calibration {
namespace {

constexpr double radius = 10.04; // d, half the height at which LAMMPS's grain meets its images
constexpr int n_orientations = 3;

std::string sphere_data(const std::string& name) {
  return std::string(BOBA_TEST_DATA) + "/sphere/" + name;
}

/// LAMMPS's force at a height of the cell, between the rows of its table.
double lammps_force(double alpha, double height) {
  std::ifstream table(sphere_data(fmt::format("alpha_{:.1f}.csv", alpha)));
  std::string header;
  std::getline(table, header);
  double above = INFINITY, force_above = 0.0, below = 0.0, force_below = 0.0;
  char comma = 0;
  while (table >> below >> comma >> force_below) {
    if (below <= height && height < above) {
      return force_below + (force_above - force_below) * (height - below) / (above - below);
    }
    above = below;
    force_above = force_below;
  }
  throw std::out_of_range(fmt::format("no force at a height of {} d for alpha = {}", height, alpha));
}

/// u_r at the equator at a height of 18.07 d in LAMMPS's runs, d.
double lammps_bulge(double alpha) {
  return alpha < 0.0 ? 0.079 : alpha > 0.0 ? -0.036 : 0.061;
}

struct Mean {
  double value, deviation;
};

Mean mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0;
  for (const double value : values) {
    squares += std::pow(value - mean, 2);
  }
  return {mean, std::sqrt(squares / (n - 1.0))};
}

/// LAMMPS's own grain under the static solver. How it lay in LAMMPS's run is not known, so it is pressed as it lies
/// in the file and turned, and a force may differ from the mean by what one orientation does: 2 to 4 % of the mean
/// at 18.99 d, less below. Tolerance: 10 %, three times that; of the bulge 10 % plus what orientations differ by, as
/// for the continuum's: which nodes LAMMPS's equator was taken from is not known.
class LammpsImages : public ::testing::TestWithParam<double> {};

TEST_P(LammpsImages, CarryTheForceThatLammpsFound) {
  const double alpha = GetParam();
  const LammpsPacking file = read_lammps_packing({.reference = sphere_data("grain_5141.data.gz")});
  const std::vector<double> heights = {18.99, 18.07};
  std::vector<double> approaches;
  for (const double height : heights) {
    approaches.push_back(radius - 0.5 * height);
  }
  std::vector<std::vector<double>> forces(heights.size());
  std::vector<double> bulges;
  for (int n = 0; n < n_orientations; ++n) {
    GrainTemplate grain = *file.packing.templates.front();
    const Eigen::Quaterniond turn =
        Eigen::AngleAxisd(1.3 * n, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(0.7 * n, Eigen::Vector3d::UnitY());
    for (Eigen::Vector3d& x : grain.position) {
      x = turn * x;
    }
    const auto states = press_sphere(grain, alpha, {.radius = radius, .body = 9.57}, approaches, Press::images);
    for (std::size_t h = 0; h < heights.size(); ++h) {
      forces[h].push_back(states[h].force);
    }
    bulges.push_back(states.back().bulge);
    fmt::print("orientation {}: forces {:.5g}, {:.5g}, bulge {:.4f}, {:.1f} s\n", n, states[0].force, states[1].force,
               states.back().bulge, states[0].seconds + states[1].seconds);
    std::fflush(stdout);
  }
  for (std::size_t h = 0; h < heights.size(); ++h) {
    const Mean mean = mean_of(forces[h]);
    const double reference = lammps_force(alpha, heights[h]);
    expect_near(fmt::format("alpha = {}, height {} d: force (orientations differ by {:.1f} %)", alpha, heights[h],
                            100.0 * mean.deviation / mean.value),
                mean.value, reference, 0.1 * reference);
  }
  const Mean bulge = mean_of(bulges);
  const double equator = lammps_bulge(alpha);
  expect_near(fmt::format("alpha = {}, height {} d: bulge at the equator", alpha, heights.back()), bulge.value, equator,
              std::max(0.005, 0.1 * std::abs(equator) + bulge.deviation));
}

INSTANTIATE_TEST_SUITE_P(Alpha, LammpsImages, ::testing::Values(-0.8, 0.0, 12.0),
                         [](const auto& test) { return fmt::format("{}", test.index); });

} // namespace
} // namespace boba::calibration
