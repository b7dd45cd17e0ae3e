// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cstdio>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace {

struct Outcome {
  int code = -1;
  std::string output; // both streams
};

Outcome run(const std::string& arguments) {
  const std::string command =
      std::string("BOBA_CACHE_DIR='" BOBA_TEST_CACHE "' '" BOBA_CALIBRATE "' ") + arguments + " 2>&1";
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    outcome.output.append(buffer.data(), n);
  }
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

void expect(const std::string& arguments, int code, const std::string& words) {
  const Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.output;
  EXPECT_NE(outcome.output.find(words), std::string::npos) << arguments << "\n" << outcome.output;
}

TEST(CommandLine, WrongInputEndsWithTwoAndSaysWhatIsAllowed) {
  expect("table --alpha -1.2 --nodes 500 --seeds 1", 2, "stability limit of this network, -1.0");
  expect("table --alpha 2 --nodes 3", 2, "n_nodes = 3");
  expect("table --alpha 2 --size 1", 2, "size[0] = 1");
  expect("table --alpha nan --nodes 500", 2, "alpha = nan");
  expect("table --alpha two --nodes 500", 2, "two");
  expect("table --alpha 2 --nodes 500 --seeds 0", 2, "seeds = 0");
  expect("table --alpha 2 --nodes 500 --tolerance 5", 2, "tolerance = 5");
  expect("table", 2, "--alpha");
  expect("frobnicate", 2, "");
  expect("find --poisson 0.49 --nodes 500 --seeds 1", 2, "allowed are");
  expect("find --poisson 0.7 --nodes 500", 2, "-1 .. 0.5");
  expect("find --poisson 0.1 --young -2 --nodes 500", 2, "young = -2");
  expect("strain --alpha -3", 2, "stability limit");
  expect("specimen --alpha 0 --strain 0.9", 2, "strain = 0.9");
  const std::string folder = testing::TempDir() + "boba-compare";
  expect("compare sphere --output " + folder, 2, "alpha or poisson");
  expect("compare sphere --alpha=-2 --bulk-nodes 500 --force --output " + folder, 2, "stability limit");
  expect("compare sphere --alpha 0 --bulk-nodes 500 --nodes 3 --force --output " + folder, 2, "nodes = 3");
  expect("compare cylinder --alpha 0 --bulk-nodes 500 --strain 0.9 --force --output " + folder, 2, "0 .. 0.25");
}

TEST(CommandLine, ASolveThatFailsEndsWithOneAndGivesNoNumber) {
  const Outcome outcome =
      run("table --alpha 2 --nodes 500 --seeds 1 --tolerance 1e-300"); // beyond any linear algebra library
  EXPECT_EQ(outcome.code, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("last residuals"), std::string::npos) << outcome.output;
  EXPECT_EQ(outcome.output.find("4.0"), std::string::npos) << outcome.output;
}

TEST(CommandLine, TableWritesItsFilesAndOverwritesNothing) {
  const std::filesystem::path directory =
      std::filesystem::temp_directory_path() / ("boba-table-" + std::to_string(getpid()));
  const std::string command = "table --alpha 0,2 --nodes 500 --seeds 2 --output " + directory.string();
  expect(command, 0, "nu publ.");
  for (const char* name : {"table.csv", "table.json", "table.png"}) {
    EXPECT_GT(std::filesystem::file_size(directory / name), 100u) << name;
  }
  expect(command, 2, "--force");
  expect(command + " --force", 0, "nu publ.");
  std::filesystem::remove_all(directory);
}

TEST(CommandLine, FindScalesWithTheModulus) {
  expect("find --poisson 0.25 --nodes 500 --seeds 2", 0, "k = 1.000000");
  expect("find --poisson 0.25 --young 3.0 --nodes 500 --seeds 2", 0, "young = 3.00000");
}

} // namespace
