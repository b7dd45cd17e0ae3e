// SPDX-License-Identifier: GPL-3.0-or-later
// A write that fails, at one call after the other: the program says which file, ends with 1, and what it leaves can be
// gone on from, to the same end bit for bit. BOBA_FAULTS=all tries every call, one after the other (minutes); by
// default some of them and the last.
#include "tests/robustness/app/same_run.h"

#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>

namespace boba::test {
namespace {

/// Environment of the programs started while it lives.
class Faults {
public:
  Faults(long at, bool later_too, const std::filesystem::path& count) {
    setenv("LD_PRELOAD", BOBA_FAIL_WRITE, 1);
    setenv("BOBA_FAIL_AT", std::to_string(at).c_str(), 1);
    setenv("BOBA_FAIL_ON", later_too ? "1" : "0", 1);
    setenv("BOBA_FAIL_COUNT", count.c_str(), 1);
  }
  ~Faults() {
    for (const char* name : {"LD_PRELOAD", "BOBA_FAIL_AT", "BOBA_FAIL_ON", "BOBA_FAIL_COUNT"}) {
      unsetenv(name);
    }
  }
  Faults(const Faults&) = delete;
  Faults& operator=(const Faults&) = delete;
};

/// A complete run with frames, tables, measures and checkpoints, and no more calls than can all be tried.
const std::vector<std::string> settings = {"--quiet",
                                           "--set",
                                           "stage.2.strain=0.02",
                                           "--set",
                                           "output.table.every_time=200",
                                           "--set",
                                           "output.checkpoint.every_time=150",
                                           "--set",
                                           "output.trajectory.every_strain=0.01",
                                           "--set",
                                           "output.dump.every_strain=0.01",
                                           "--set",
                                           "output.vtk.every_strain=0.02",
                                           "--set",
                                           "measure=[{what = \"stress\", every_strain = 0.01}]"};

std::vector<std::string> command(const std::string& output) {
  std::vector<std::string> words = {"run", "scene.toml", "--output", output};
  words.insert(words.end(), settings.begin(), settings.end());
  return words;
}

TEST(WriteErrors, AtEveryCallAreToldAndLoseNothing) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  ASSERT_EQ(boba(command("alone"), folder).exit_code, 0);
  const std::filesystem::path count = folder / "count";
  {
    const Faults none(0, false, count);
    ASSERT_EQ(boba(command("counted"), folder).exit_code, 0);
  }
  const long n_calls = std::atol(content_of(count).c_str());
  ASSERT_GT(n_calls, 100);
  const char* all = std::getenv("BOBA_FAULTS");
  const long step = all != nullptr ? 1 : n_calls / 20 + 1;
  int n_resumed = 0;
  constexpr long closing = 8; // the last ones, when files are closed, are all tried: each is a case of its own
  for (long at = 1; at <= n_calls; at += at < n_calls - closing ? std::min(step, n_calls - closing - at) : 1) {
    const bool later_too = at / step % 2 == 0;
    SCOPED_TRACE("call " + std::to_string(at) + " of " + std::to_string(n_calls) +
                 (later_too ? " and all later ones" : ""));
    ProgramResult result;
    {
      const Faults faults(at, later_too, count);
      result = boba(command("faulty"), folder);
    }
    EXPECT_EQ(result.signal, 0) << "crashed";
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_NE(result.err.find("faulty"), std::string::npos) << "names no file: " << result.err;
    const ProgramResult resumed = boba({"resume", "faulty", "--quiet"}, folder);
    if (resumed.exit_code == 0) {
      expect_same_run(folder / "alone", folder / "faulty");
      ++n_resumed;
    } else { // nothing had been written yet that could be gone on from
      EXPECT_EQ(resumed.exit_code, 2) << resumed.err;
      EXPECT_NE(resumed.err.find("checkpoint"), std::string::npos) << resumed.err;
      EXPECT_LT(at, n_calls / 4) << "too late for that: " << resumed.err;
    }
    std::filesystem::remove_all(folder / "faulty");
  }
  EXPECT_GT(n_resumed, 8);
  RecordProperty("calls", static_cast<int>(n_calls));
}

/// No folder can be made there, whoever asks.
TEST(WriteErrors, AFolderThatCannotBeMadeIsAMessage) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  folder.file("closed", "a file, not a folder");
  for (const std::string place : {"/proc/boba_run", "closed/run"}) {
    const ProgramResult result = boba(command(place), folder);
    EXPECT_TRUE(result.exit_code == 1 || result.exit_code == 2) << result.exit_code << result.err;
    EXPECT_NE(result.err.find(place), std::string::npos) << result.err;
    EXPECT_EQ(content_of(folder / "closed"), "a file, not a folder");
  }
}

} // namespace
} // namespace boba::test
