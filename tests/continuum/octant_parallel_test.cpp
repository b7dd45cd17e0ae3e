// SPDX-License-Identifier: GPL-3.0-or-later
// The octant on 2 and 4 ranks, as a script starts it: the result of one rank, to the solver's tolerance.
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// First load of the summary that boba-continuum writes on so many ranks.
nlohmann::json first_load(int ranks, const std::string& arguments) {
  const fs::path folder =
      fs::temp_directory_path() /
      fmt::format("boba_octant_{}_{}", ::testing::UnitTest::GetInstance()->current_test_info()->name(), ranks);
  fs::remove_all(folder);
  // Ranks of a test share cores with other tests; a container's user may be root.
  const std::string command =
      fmt::format("OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1 "
                  "{} --oversubscribe --bind-to none -np {} {} {} --dimension 3 --output {} >/dev/null",
                  BOBA_MPIRUN, ranks, BOBA_CONTINUUM, arguments, folder.string());
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  std::ifstream stream(folder / "summary.json");
  const auto document = nlohmann::json::parse(stream);
  EXPECT_EQ(document.at("parameters").at("ranks"), ranks);
  EXPECT_TRUE(fs::exists(folder / "fields_0000.pvtu"));
  fs::remove_all(folder);
  return document.at("loads").at(0);
}

void expect_same(const std::string& arguments, const std::vector<std::string>& names, double tolerance) {
  const auto alone = first_load(1, arguments);
  for (const int ranks : {2, 4}) {
    const auto shared = first_load(ranks, arguments);
    EXPECT_EQ(shared.at("n_unknowns"), alone.at("n_unknowns"));
    EXPECT_LE(shared.at("cg_iterations").get<int>(), 2 * alone.at("cg_iterations").get<int>());
    ASSERT_EQ(shared.at("profile").at("r").size(), alone.at("profile").at("r").size());
    for (const auto& name : names) {
      const double expected = alone.at(name).get<double>();
      EXPECT_NE(expected, 0);
      EXPECT_NEAR(shared.at(name).get<double>() / expected, 1, tolerance) << name << " on " << ranks << " ranks";
    }
  }
}

TEST(OctantInParallel, BondedCylinder) {
  expect_same("cylinder --radius 1 --height 2 --young 1 --poisson 0.3 --strain 0.01 --degree 1 --refinements 2",
              {"force", "midheight_poisson", "midheight_poisson_local"}, 1e-6);
}

TEST(OctantInParallel, PressedSphere) {
  expect_same("sphere --radius 1 --young 1 --poisson 0.25 --approach 0.04 --refinements 1 --elements-across 8",
              {"force", "contact_radius", "peak_pressure", "equatorial_bulge"}, 1e-6);
}

} // namespace
