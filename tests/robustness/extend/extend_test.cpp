// SPDX-License-Identifier: GPL-3.0-or-later
// The program of examples/extend: a stage, a contact law and a measure from outside the tree run, are documented,
// checked and continued like any other.
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <numbers>
#include <sstream>

namespace boba::test {
namespace {

ProgramResult extended(std::vector<std::string> arguments, const TemporaryFolder& folder) {
  arguments.insert(arguments.begin(), BOBA_EXTENDED);
  return run_program(arguments, (folder / "").string());
}

/// Columns step, time, stage and strain of table.csv, as text.
std::vector<std::vector<std::string>> table(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<std::vector<std::string>> rows;
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line.substr(0, 26), "step,time_tau,stage,strain");
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    rows.emplace_back(4);
    for (std::string& cell : rows.back()) {
      std::getline(cells, cell, ',');
    }
  }
  return rows;
}

TEST(Extend, AStageFromOutsideRuns) {
  const TemporaryFolder folder;
  const ProgramResult result = extended({"run", BOBA_EXTEND_SCENE, "--output", "out"}, folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("stage.1 oscillate \"shake\""), std::string::npos) << result.out;
  const auto rows = table(folder / "out/table.csv");
  ASSERT_EQ(rows.size(), 17U); // every 5 tau of 80
  for (const auto& row : rows) {
    EXPECT_NEAR(std::stod(row[3]), 0.1 * std::sin(2.0 * std::numbers::pi * std::stod(row[1]) / 40.0), 1e-9);
  }
}

TEST(Extend, AStageFromOutsideContinuesBitForBit) {
  const TemporaryFolder folder;
  const std::vector<std::string> longer = {"--set", "stage.shake.cycles=400", "--set", "output.table.every_time=100"};
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), longer.begin(), longer.end());
    return extended(arguments, folder);
  };
  ASSERT_EQ(run({"run", BOBA_EXTEND_SCENE, "--output", "whole"}).exit_code, 0);
  ProgramResult result = run({"run", BOBA_EXTEND_SCENE, "--output", "cut", "--wall-time", "0.02"});
  ASSERT_EQ(result.exit_code, 75) << result.err;
  result = extended({"resume", "cut"}, folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(table(folder / "whole/table.csv"), table(folder / "cut/table.csv"));
}

TEST(Extend, AStageFromOutsideIsCheckedAndDocumented) {
  const TemporaryFolder folder;
  const ProgramResult checked = extended({"check", BOBA_EXTEND_SCENE}, folder);
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_NE(checked.out.find("stage.1 oscillate \"shake\": 800 steps, 80 tau"), std::string::npos) << checked.out;
  const ProgramResult reference = extended({"info", "--scene-reference"}, folder);
  EXPECT_NE(reference.out.find("| `amplitude` | a number above 0 and at most 1 | required |"), std::string::npos);
  const ProgramResult wrong = extended({"run", BOBA_EXTEND_SCENE, "--set", "stage.shake.amplitude=2"}, folder);
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("stage.1.amplitude = 2: must be a number above 0 and at most 1"), std::string::npos)
      << wrong.err;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// P of the first row of table.csv, k/d.
double first_pressure(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::string header, row, cell;
  std::getline(in, header);
  std::getline(in, row);
  std::istringstream names(header), values(row);
  for (std::string name; std::getline(names, name, ',') && std::getline(values, cell, ',');) {
    if (name == "P_k/d") {
      return std::stod(cell);
    }
  }
  return std::nan("");
}

TEST(Extend, AContactLawFromOutsideActs) {
  // Two spheres at r = 0.8 d, at rest: f = k 0.2 + s 0.04 and P = r f / (3 V).
  const TemporaryFolder folder;
  std::ofstream(folder / "two.data") << "two spheres\n\n2 atoms\n1 atom types\n0 10 xlo xhi\n0 10 ylo yhi\n0 10 zlo "
                                        "zhi\n\nMasses\n\n1 1\n\nAtoms # molecular\n\n1 1 1 5 5 5\n2 2 1 5.8 5 5\n";
  for (const double s : {0.0, 20.0}) {
    std::ofstream(folder / "two.toml")
        << "[start]\nlammps_reference = \"two.data\"\nalpha = 0.0\n[material]\ncontact = "
           "\"stiffening\"\nstiffening = "
        << s << "\n[[stage]]\ntype = \"hold\"\ntime = 1.0\n";
    const ProgramResult result = extended({"run", "two.toml", "--output", "out" + std::to_string(s)}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NEAR(first_pressure(folder / ("out" + std::to_string(s)) / "table.csv"), 0.8 * (0.2 + 0.04 * s) / 3000.0,
                1e-15);
  }
}

TEST(Extend, AMeasureFromOutsideIsTakenInRunsAndOnStoredFrames) {
  const TemporaryFolder folder;
  const std::vector<std::string> run = {"run", BOBA_EXTEND_SCENE, "--output",
                                        "out", "--set",           "output.trajectory.every_time=5"};
  const ProgramResult result = extended(run, folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string during = text_of(folder / "out/measures/nearest.csv");
  EXPECT_EQ(during.substr(0, during.find('\n')), "step,time_tau,strain,nearest_smallest_d,nearest_mean_d");
  EXPECT_EQ(std::count(during.begin(), during.end(), '\n'), 18); // a header, the start, and every 5 tau of 80
  const ProgramResult later = extended({"measure", "out", "--what", "nearest", "--output", "later"}, folder);
  ASSERT_EQ(later.exit_code, 0) << later.err;
  EXPECT_EQ(text_of(folder / "later/nearest.csv"), during);
  EXPECT_NE(text_of(folder / "later/averages.json").find("nearest_mean_d"), std::string::npos);
}

} // namespace
} // namespace boba::test
