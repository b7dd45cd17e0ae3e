// SPDX-License-Identifier: GPL-3.0-or-later
// Deformations of the cell by component against LAMMPS's `fix deform` (the authors' branch); tests/data/loading.
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/stages/deform.h"
#include "tests/support/lammps_fixture.h"

#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <sstream>

namespace boba::test {
namespace {

using Kind = ComponentDrive::Kind;

constexpr double time_of_run = 10.0; // tau, 100 steps

struct Loading {
  std::string name;
  DeformStage stage;
};

std::ostream& operator<<(std::ostream& out, const Loading& loading) {
  return out << loading.name;
}

/// A stage with the rates of these components (1/tau).
DeformStage at_rates(StrainMeasure measure, const std::vector<std::pair<int, double>>& rates) {
  DeformStage stage{.time = time_of_run, .measure = measure};
  for (const auto& [component, rate] : rates) {
    stage.component[component].kind = Kind::strain;
    stage.component[component].path = {.duration = time_of_run, .rate_from = rate, .rate = rate};
  }
  return stage;
}

/// xy(t) = 0.4 d sin(2 pi t / 8 tau), with Ly = 14.5 d.
DeformStage wiggle() {
  DeformStage stage{.time = time_of_run};
  stage.component[3].kind = Kind::strain;
  stage.component[3].path = {.kind = PrescribedStrain::Kind::sine,
                             .duration = time_of_run,
                             .amplitude = 0.4 / 14.5,
                             .cycles = time_of_run / 8.0};
  return stage;
}

/// The row of a step in LAMMPS's table: its columns by name.
std::map<std::string, double> table_row(const std::string& name, int step) {
  std::ifstream in(test_data("loading/ortho." + name + ".a2.thermo.csv"));
  std::string header, line, column, value;
  std::getline(in, header);
  while (std::getline(in, line)) {
    std::istringstream names(header), values(line);
    std::map<std::string, double> row;
    while (std::getline(names, column, ',') && std::getline(values, value, ',')) {
      row[column] = std::stod(value);
    }
    if (row.at("Step") == step) {
      return row;
    }
  }
  throw std::runtime_error(name + ": no row of step " + std::to_string(step));
}

class LammpsLoading : public testing::TestWithParam<Loading> {};

/// Their box moves about its centre at the end of a step, before the dump; ours about its corner, and nodes follow with
/// the next drift. Stress times volume knows nothing of that move.
TEST_P(LammpsLoading, SameForcesPositionsAndCell) {
  const auto& [name, stage] = GetParam();
  const LammpsPacking read = fixture_packing("ortho", "ortho.a2.step0.dump.gz", 2.0);
  Stepper stepper(read.packing, {}, {});
  DeformDriver driver(stage);
  stepper.start();
  driver.begin(stepper);
  for (int step = 1; step <= 100; ++step) {
    stepper.advance(Virial::full);
    const Box evaluated = stepper.box();
    stepper.move_cell(driver.update(stepper));
    if (step % 10 == 0) {
      const std::map<std::string, double> row = table_row(name, step);
      const char* lengths[] = {"Lx", "Ly", "Lz"};
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(stepper.box().lengths()[axis], row.at(lengths[axis]), 1e-12 * row.at(lengths[axis])) << step;
      }
      EXPECT_NEAR(stepper.box().xy(), row.at("Xy"), 1e-12) << step;
      EXPECT_NEAR(stepper.box().xz(), row.at("Xz"), 1e-12) << step;
      EXPECT_NEAR(stepper.box().yz(), row.at("Yz"), 1e-12) << step;
      const char* pressures[] = {"Pxx", "Pyy", "Pzz", "Pxy", "Pxz", "Pyz"};
      for (int c = 0; c < 6; ++c) {
        EXPECT_NEAR(-stress_of(stepper.moving())[c] * evaluated.volume(), row.at(pressures[c]) * row.at("Volume"),
                    step == 10 ? 1e-10 : 1e-4)
            << step << " " << pressures[c];
      }
    }
    if (step != 10 && step != 100) {
      continue;
    }
    Snapshot snapshot = take_snapshot(stepper.moving(), {.velocity = true, .force = true});
    const LammpsFrame frame =
        read_lammps_dump(test_data("loading/ortho." + name + ".a2.step" + std::to_string(step) + ".dump.gz"));
    const MovingCell& cell = stepper.moving().cell;
    const Vector3 shift = frame.box.origin() - cell.box().origin();
    for (Vector3& x : snapshot.position) {
      x = cell.position_map() * x + cell.position_shift() + shift;
    }
    const double tolerance = step == 10 ? 1e-11 : 1e-6;
    EXPECT_LT(largest_position_difference(read, snapshot.position, frame, cell.box()), tolerance) << step;
    EXPECT_LT(largest_difference(read, snapshot.velocity, frame, frame.velocity), tolerance) << step;
    EXPECT_LT(largest_difference(read, snapshot.force, frame, frame.force), tolerance) << step;
  }
}

INSTANTIATE_TEST_SUITE_P(Fixtures, LammpsLoading,
                         testing::Values(Loading{"uniaxial", at_rates(StrainMeasure::engineering, {{0, -2e-3}})},
                                         Loading{"pure", at_rates(StrainMeasure::logarithmic, {{0, 1e-3}, {1, -1e-3}})},
                                         Loading{"tilts",
                                                 at_rates(StrainMeasure::engineering, {{4, 1e-3}, {5, -1.5e-3}})},
                                         Loading{"wiggle", wiggle()}));

} // namespace
} // namespace boba::test
