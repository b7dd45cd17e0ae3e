// SPDX-License-Identifier: GPL-3.0-or-later
// 64 grains of 303 nodes sheared to strain 1 from the same state as LAMMPS did (tests/data/packing64): rate 1e-3,
// positions remapped, P~ = 0.1 held with gain 0.02, alpha = 0. The trajectories part by chaos; averages must not.
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/io/lammps_packing.h"
#include "bpm/measure/blocking.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

namespace boba::test {
namespace {

constexpr int n_steps = 10000, interval = 100;
constexpr double target = 0.1 * 1.84 / 1.875; // the peer's rounded modulus

struct Series {
  std::vector<double> strain, mu, volume;
};

Series lammps_series() {
  std::ifstream in(std::string(BOBA_TEST_DATA) + "/packing64/shear_a0_strain1.csv");
  std::string line;
  std::getline(in, line);
  Series series;
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    double step = 0, strain = 0, pressure = 0, mu = 0, volume = 0;
    words >> step >> strain >> pressure >> mu >> volume;
    series.strain.push_back(strain);
    series.mu.push_back(mu);
    series.volume.push_back(volume);
  }
  return series;
}

Series boba_series() {
  const std::string folder = std::string(BOBA_TEST_DATA) + "/packing64/";
  LammpsPacking read = read_lammps_packing({folder + "p64.data.gz", folder + "dense64_a0.dump.gz", std::nullopt});
  Stepper stepper(std::move(read.packing), {}, {.threads = 2});
  stepper.start();
  Series series;
  for (int step = 0; step <= n_steps; ++step) {
    if (step > 0) {
      stepper.advance(step % interval == 0 ? Virial::full : Virial::trace);
    }
    if (step % interval == 0) {
      series.strain.push_back(1e-4 * step);
      series.mu.push_back(totals_of(stepper.moving()).mu());
      series.volume.push_back(stepper.box().volume());
    }
    stepper.move_cell({.shear = 1e-3, .dilation = 0.02 * (stepper.pressure() - target)});
  }
  return series;
}

/// The two means agree within three standard errors of their difference, and the errors are small enough to mean it.
void expect_same_mean(const Series& a, const Series& b, const std::vector<double>& of_a,
                      const std::vector<double>& of_b, double largest_error) {
  const auto x = measure::blocked_mean_in_window(a.strain, of_a, 0.3, 1.01);
  const auto y = measure::blocked_mean_in_window(b.strain, of_b, 0.3, 1.01);
  const double error = std::hypot(x.standard_error, y.standard_error);
  testing::Test::RecordProperty("boba", fmt::format("{} +- {}", x.mean, x.standard_error));
  testing::Test::RecordProperty("lammps", fmt::format("{} +- {}", y.mean, y.standard_error));
  EXPECT_NEAR(x.mean, y.mean, 3.0 * error);
  EXPECT_LT(error, largest_error);
}

TEST(Packing64ToStrain1, HasThePeersStressRatioAndDensity) {
  const Series peer = lammps_series(), ours = boba_series();
  ASSERT_EQ(peer.mu.size(), 101u);
  ASSERT_EQ(ours.mu.size(), 101u);
  EXPECT_NEAR(peer.strain.back(), ours.strain.back(), 1e-9);
  expect_same_mean(ours, peer, ours.mu, peer.mu, 0.02);
  expect_same_mean(ours, peer, ours.volume, peer.volume, 0.01 * peer.volume.back());
}

} // namespace
} // namespace boba::test
