// SPDX-License-Identifier: GPL-3.0-or-later
// The program of examples/extend: a stage from outside the tree runs, is documented, checked and continued like any
// other.
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
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

} // namespace
} // namespace boba::test
