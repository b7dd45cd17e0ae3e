// SPDX-License-Identifier: GPL-3.0-or-later
// 64 grains of 303 nodes at P~ = 0.1, sheared from the same state as LAMMPS did (tests/data/packing64): rate 1e-3,
// positions remapped, pressure held with gain 0.02, alpha = 0.
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/io/lammps_packing.h"

#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

namespace boba::test {
namespace {

struct Row {
  double step, strain, pressure, normalised, mu, kinetic;
};

std::vector<Row> lammps_rows() {
  std::ifstream in(std::string(BOBA_TEST_DATA) + "/packing64/shear_a0.csv");
  std::string line;
  std::getline(in, line);
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    Row row{};
    words >> row.step >> row.strain >> row.pressure >> row.normalised >> row.mu >> row.kinetic;
    rows.push_back(row);
  }
  return rows;
}

class Packing64 : public testing::TestWithParam<Precision> {};

TEST_P(Packing64, ShearsLikeThePeerFromTheSameState) {
  const std::string folder = std::string(BOBA_TEST_DATA) + "/packing64/";
  LammpsPacking read = read_lammps_packing({folder + "p64.data.gz", folder + "dense64_a0.dump.gz", std::nullopt});
  const std::vector<Row> rows = lammps_rows();
  ASSERT_EQ(rows.size(), 51u);
  Stepper stepper(std::move(read.packing), {}, {.threads = 2, .precision = GetParam()});
  stepper.start();
  const bool mixed = GetParam() == Precision::mixed;
  EXPECT_NEAR(totals_of(stepper.moving()).pressure, rows[0].pressure, mixed ? 1e-7 : 1e-8); // the file's digits
  EXPECT_NEAR(totals_of(stepper.moving()).mu(), rows[0].mu, mixed ? 1e-6 : 1e-7);
  EXPECT_NEAR(totals_of(stepper.moving()).kinetic_energy, rows[0].kinetic, 1e-8);
  std::size_t next = 1;
  for (int step = 1; step <= 1000; ++step) {
    const bool compared = step % 20 == 0;
    // The strain that the peer reports refers to the initial Ly, and it holds P~ = 0.1 with a rounded modulus: the two
    // runs part slowly.
    stepper.advance(compared ? Virial::full : Virial::trace);
    if (compared) {
      ASSERT_EQ(rows[next].step, step);
      EXPECT_NEAR(totals_of(stepper.moving()).mu(), rows[next].mu, 5e-6 + 1e-3 * rows[next].strain);
      EXPECT_NEAR(totals_of(stepper.moving()).pressure, rows[next].pressure, 1e-4 * rows[next].pressure);
      EXPECT_NEAR(totals_of(stepper.moving()).kinetic_energy, rows[next].kinetic, 2e-3 * rows[next].kinetic);
      ++next;
    }
    stepper.move_cell({.shear = 1e-3, .dilation = 0.02 * (stepper.pressure() - 0.1 * 1.84 / 1.875)});
  }
}

INSTANTIATE_TEST_SUITE_P(Precisions, Packing64, testing::Values(Precision::full, Precision::mixed),
                         [](const auto& info) { return info.param == Precision::full ? "Double" : "Mixed"; });

} // namespace
} // namespace boba::test
