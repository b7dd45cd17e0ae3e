// SPDX-License-Identifier: GPL-3.0-or-later
// The program as a script meets it: files, fields and exit codes.
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

namespace {

class Program : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              fmt::format("boba_continuum_{}", ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Exit code of the program; its messages go to the void.
  int run(const std::string& arguments) const {
    const std::string command =
        fmt::format("{} {} --output {} >/dev/null 2>&1", BOBA_CONTINUUM, arguments, folder_.string());
    return WEXITSTATUS(std::system(command.c_str()));
  }
  nlohmann::json summary() const {
    std::ifstream stream(folder_ / "summary.json");
    return nlohmann::json::parse(stream);
  }

  std::filesystem::path folder_;
};

TEST_F(Program, WritesTheSummaryOfASphere) {
  ASSERT_EQ(run("sphere --radius 1 --young 1 --poisson 0.25 --approach 5e-4,1e-3"), 0);
  const auto document = summary();
  EXPECT_EQ(document.at("schema_version"), 1);
  ASSERT_EQ(document.at("loads").size(), 2U);
  for (const char* name : {"approach", "force", "contact_radius", "peak_pressure"}) {
    EXPECT_GT(document.at("loads")[1].at(name).get<double>(), 0) << name;
  }
  for (const char* name : {"summary.h5", "loads.csv", "fields_0001.vtu", "fields.pvd"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
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

} // namespace
