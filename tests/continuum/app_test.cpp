// SPDX-License-Identifier: GPL-3.0-or-later
// The program as a script meets it: files, fields and exit codes.
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>

namespace {

using boba::test::content_of;
using boba::test::ProgramResult;

class Program : public ::testing::Test {
protected:
  /// The program with arguments that are separated by blanks; its results go to the folder `out`.
  ProgramResult result_of(const std::string& arguments, const std::vector<std::string>& program = {BOBA_CONTINUUM}) {
    std::vector<std::string> words = program;
    std::istringstream stream(arguments + " --output out");
    for (std::string word; stream >> word;) {
      words.push_back(word);
    }
    return boba::test::run_program(words, (folder_ / "").string());
  }
  int run(const std::string& arguments) { return result_of(arguments).exit_code; }
  nlohmann::json summary() const { return nlohmann::json::parse(content_of(folder_ / "out/summary.json")); }

  boba::test::TemporaryFolder folder_;
};

/// How often `part` is found in the text.
int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) {
    ++found;
  }
  return found;
}

TEST_F(Program, WritesTheSummaryOfASphere) {
  ASSERT_EQ(run("sphere --radius 1 --young 1 --poisson 0.25 --approach 5e-4,1e-3"), 0);
  const auto document = summary();
  EXPECT_EQ(document.at("schema_version"), 1);
  ASSERT_EQ(document.at("loads").size(), 2U);
  for (const char* name : {"approach", "force", "contact_radius", "peak_pressure"}) {
    EXPECT_GT(document.at("loads")[1].at(name).get<double>(), 0) << name;
  }
  for (const char* name : {"summary.h5", "loads.csv", "fields_0001.vtu", "fields.pvd"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / name)) << name;
  }
  EXPECT_EQ(run("sphere --radius 1 --young 1 --poisson 0.25 --approach 5e-4"), 2) << "results are written over";
  EXPECT_EQ(run("sphere --radius 1 --young 1 --poisson 0.25 --approach 5e-4 --force"), 0);
}

TEST_F(Program, WritesTheSummaryOfACylinder) {
  ASSERT_EQ(run("cylinder --radius 7 --height 20 --young 1 --poisson 0.4 --ends bonded --strain 0.01"), 0);
  const auto load = summary().at("loads").at(0);
  for (const char* name : {"strain", "force", "apparent_modulus", "midheight_poisson", "midheight_poisson_local"}) {
    EXPECT_GT(load.at(name).get<double>(), 0) << name;
  }
}

TEST_F(Program, TellsWrongInputFromFailure) {
  EXPECT_EQ(run("sphere --radius 1 --young 1 --poisson 0.5 --approach 1e-3"), 2);
  EXPECT_EQ(run("sphere --radius 0 --young 1 --poisson 0.2 --approach 1e-3"), 2);
  EXPECT_EQ(run("sphere --radius 1 --young 1 --poisson 0.2 --approach 2"), 2);
  EXPECT_EQ(run("sphere --radius 1 --young 1 --poisson 0.2 --approach 1e-3 --elements-across 4"), 2);
  EXPECT_EQ(run("sphere --radius 1 --young 1 --poisson 0.2"), 2);
  EXPECT_EQ(run("cylinder --radius 1 --height 1 --young 1 --poisson 0.2 --strain soft"), 2);
  EXPECT_EQ(run("cylinder --radius 1 --height 1 --young 1 --poisson -0.5 --strain 0.5 --kinematics finite"), 1);
}

TEST_F(Program, AnActiveSetThatDoesNotSettleFailsWithItsResiduals) {
  // Before the second change of the set some nodes pull or stick through the plate.
  for (const char* more : {"", " --dimension 3 --refinements 1 --elements-across 8"}) {
    const ProgramResult result =
        result_of(std::string("sphere --radius 1 --young 1 --poisson 0.25 --approach 0.02 --active-sets 1") + more);
    EXPECT_EQ(result.exit_code, 1) << more;
    for (const char* part : {"active set did not settle in 1 iterations", "nodes contradict it", "largest overlap"}) {
      EXPECT_EQ(count(result.err, part), 1) << part << " in: " << result.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/summary.json")) << "a wrong number was written";
  }
  EXPECT_EQ(run("sphere --radius 1 --young 1 --poisson 0.25 --approach 0.02 --active-sets 0"), 2);
}

TEST_F(Program, WarnsOnceOfLargeStrain) {
  const std::string sphere = "sphere --radius 1 --young 1 --poisson 0.25 --force ";
  EXPECT_EQ(result_of(sphere + "--approach 0.1").err, "");
  const ProgramResult flat = result_of(sphere + "--approach 0.1,0.2,0.3");
  EXPECT_EQ(flat.exit_code, 0);
  EXPECT_EQ(count(flat.err, "--kinematics finite"), 1) << flat.err;
  EXPECT_NE(flat.err.find("at approach 0.2 the contact radius is 0.3"), std::string::npos) << flat.err;
  const ProgramResult octant =
      result_of(sphere + "--approach 0.2 --dimension 3 --refinements 1 --elements-across 8 --degree 1");
  EXPECT_EQ(octant.exit_code, 0) << octant.err;
  EXPECT_EQ(count(octant.err, "--kinematics finite"), 1) << octant.err;
  const ProgramResult cylinder =
      result_of("cylinder --radius 1 --height 2 --young 1 --poisson 0.3 --force --strain 0.05,0.2,0.3");
  EXPECT_EQ(count(cylinder.err, "strain 0.2 is beyond"), 1) << cylinder.err;
}

TEST_F(Program, TellsTheRangeOfFiniteKinematicsAtOnce) {
  const std::string sphere = "sphere --radius 1 --young 1 --kinematics finite --no-fields --approach 0.02 --poisson ";
  const ProgramResult wrong = result_of(sphere + "0.4999");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(count(wrong.err, "poisson = 0.4999 is not allowed with finite kinematics"), 1) << wrong.err;
  EXPECT_EQ(run(sphere + "0.4995"), 0);
}

/// `boba continuum` is the same program: same files, same messages, same exit codes.
TEST_F(Program, IsStartedByBoba) {
  const std::vector<std::string> chain = {BOBA_PROGRAM, "continuum"};
  const std::string sphere = "sphere --radius 1 --young 1 --poisson 0.25 --force --no-fields --approach ";
  ASSERT_EQ(result_of(sphere + "0.01", chain).exit_code, 0);
  const auto through = summary().at("loads");
  ASSERT_EQ(run(sphere + "0.01"), 0);
  EXPECT_EQ(summary().at("loads")[0].at("force"), through[0].at("force"));
  const ProgramResult wrong = result_of(sphere + "2", chain);
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(count(wrong.err, "approach = 2 is not allowed"), 1) << wrong.err;
}

} // namespace
