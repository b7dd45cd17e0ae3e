// SPDX-License-Identifier: GPL-3.0-or-later
// A run that was stopped, killed or given another number of threads ends as one that was left alone, bit for bit.
#include "tests/robustness/app/same_run.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace boba::test {
namespace {

/// The same scene left alone, in `folder`/alone.
void run_alone(const TemporaryFolder& folder, const std::vector<std::string>& more = {}) {
  std::vector<std::string> command{"run", "scene.toml", "--output", "alone"};
  command.insert(command.end(), more.begin(), more.end());
  const ProgramResult result = boba(command, folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
}

TEST(Resume, ThreadsDoNotMatter) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  run_alone(folder);
  for (const char* threads : {"2", "3"}) {
    const ProgramResult result = boba({"run", "scene.toml", "--threads", threads, "--output", threads}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    expect_same_run(folder / "alone", folder / threads);
  }
}

TEST(Resume, AfterAWallTimeLimit) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  run_alone(folder);
  ProgramResult result = boba({"run", "scene.toml", "--wall-time", "0.05"}, folder);
  int n_stops = 0;
  while (result.exit_code == 75 && n_stops < 200) {
    EXPECT_NE(result.out.find("wall-time limit"), std::string::npos) << result.out;
    ++n_stops;
    result = boba({"resume", "out", "--wall-time", n_stops < 5 ? "0.05" : "1"}, folder);
  }
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GE(n_stops, 1);
  expect_same_run(folder / "alone", folder / "out");
}

TEST(Resume, AfterSignals) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  run_alone(folder, {"--set", "stage.2.strain=6"});
  for (const int signal : {SIGINT, SIGTERM}) {
    const std::string out = std::to_string(signal);
    const ProgramResult stopped = boba({"run", "scene.toml", "--set", "stage.2.strain=6", "--output", out}, folder,
                                       Disturbance{0.1, signal, (folder / out / "table.csv").string()});
    EXPECT_EQ(stopped.exit_code, 75) << stopped.err;
    const ProgramResult resumed = boba({"resume", out}, folder);
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    expect_same_run(folder / "alone", folder / out);
  }
}

/// Is one complete? One that was being written when its run was killed has another name.
bool has_checkpoint(const std::filesystem::path& checkpoints) {
  for (const auto& entry : std::filesystem::directory_iterator(checkpoints)) {
    if (entry.path().extension() == ".boba") {
      return true;
    }
  }
  return false;
}

/// MDAnalysis reads each of these trajectories, and finds the frames of the first or, in a run that is not over, its
/// first frames.
void expect_readable(const std::filesystem::path& whole, const std::vector<std::filesystem::path>& others,
                     const std::string& how) {
  std::vector<std::string> command{BOBA_PYTHON, BOBA_READ_RUNS, how, whole.string()};
  for (const std::filesystem::path& other : others) {
    command.push_back(other.string());
  }
  const ProgramResult result = run_program(command, whole.parent_path().string());
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
}

/// Killed again and again at random moments until it is through; BOBA_KILLS asks for more kills than a few.
TEST(Resume, AfterBeingKilled) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  const std::vector<std::string> often{"--quiet",
                                       "--set",
                                       "output.checkpoint.every_time=15",
                                       "--set",
                                       "stage.2.strain=1.5",
                                       "--set",
                                       "output.dump.every_strain=0.05",
                                       "--set",
                                       "output.vtk.every_strain=0.1",
                                       "--set",
                                       "measure=[{what = \"motion, order\", every_strain = 0.05}]"};
  run_alone(folder, often);
  const char* asked = std::getenv("BOBA_KILLS");
  const int n_wanted = asked != nullptr ? std::atoi(asked) : 12;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> moment(0.0, 0.35);
  int n_kills = 0, n_rounds = 0;
  std::vector<std::filesystem::path> after_kills, after_ends; // trajectories
  const auto keep = [&](const std::string& out, std::vector<std::filesystem::path>& kept) {
    kept.push_back(folder / ("kept" + std::to_string(after_kills.size() + after_ends.size()) + ".h5"));
    std::filesystem::copy_file(folder / out / "trajectory.h5", kept.back());
  };
  while (n_kills < n_wanted) {
    const std::string out = "killed" + std::to_string(n_rounds++);
    std::vector<std::string> run{"run", "scene.toml", "--output", out};
    run.insert(run.end(), often.begin(), often.end());
    ProgramResult result =
        boba(run, folder, Disturbance{moment(random), SIGKILL, (folder / out / "checkpoints").string()});
    if (!has_checkpoint(folder / out / "checkpoints")) { // killed before there was anything to go on from
      std::filesystem::remove_all(folder / out);
      continue;
    }
    while (result.signal == SIGKILL) {
      ++n_kills;
      keep(out, after_kills);
      result = n_kills < n_wanted
                   ? boba({"resume", out, "--quiet"}, folder, Disturbance{0.05 + moment(random), SIGKILL})
                   : boba({"resume", out, "--quiet"}, folder);
      ASSERT_TRUE(result.signal == SIGKILL || result.exit_code == 0) << result.err;
    }
    ASSERT_EQ(result.exit_code, 0) << result.err;
    expect_same_run(folder / "alone", folder / out);
    for (const char* table : {"motion.csv", "grain_motion.csv", "order.csv"}) {
      EXPECT_EQ(content_of(folder / "alone/measures" / table), content_of(folder / out / "measures" / table)) << table;
    }
    keep(out, after_ends);
    std::filesystem::remove_all(folder / out);
    ASSERT_LT(n_rounds, 1000) << "the run ends before it is killed";
  }
  expect_readable(folder / "alone/trajectory.h5", after_ends, "same");
  expect_readable(folder / "alone/trajectory.h5", after_kills, "first");
  RecordProperty("kills", n_kills);
}

std::vector<std::filesystem::path> checkpoints_of(const std::filesystem::path& run) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(run / "checkpoints")) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Resume, RefusesADamagedCheckpointByNameAndTakesTheOlderOne) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  run_alone(folder);
  const auto files = checkpoints_of(folder / "alone");
  ASSERT_EQ(files.size(), 2U);
  std::string altered = content_of(files[1]);
  altered[altered.size() / 2] ^= 4;
  std::ofstream(files[1], std::ios::binary) << altered;
  const std::string table = table_without_speed(folder / "alone/table.csv");
  const ProgramResult resumed = boba({"resume", "alone"}, folder);
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_NE(resumed.err.find(files[1].filename().string()), std::string::npos) << resumed.err;
  EXPECT_NE(resumed.err.find(files[0].filename().string()), std::string::npos) << resumed.err;
  EXPECT_EQ(table_without_speed(folder / "alone/table.csv"), table);
}

/// Cut or with a flipped bit at every kilobyte: refused by name, the older one taken, the same end.
TEST(Resume, AfterDamageAtEveryKilobyteOfTheCheckpoint) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  run_alone(folder, {"--quiet", "--set", "stage.2.strain=0.02"});
  std::filesystem::copy(folder / "alone", folder / "kept", std::filesystem::copy_options::recursive);
  const auto files = checkpoints_of(folder / "alone");
  const std::string whole = content_of(files[1]);
  for (std::size_t at = 0; at < whole.size(); at += 1024) {
    std::string damaged = whole;
    if (at / 1024 % 2 == 0) {
      damaged.resize(at);
    } else {
      damaged[at] = static_cast<char>(damaged[at] ^ 16);
    }
    std::ofstream(files[1], std::ios::binary) << damaged;
    const ProgramResult resumed = boba({"resume", "alone", "--quiet"}, folder);
    ASSERT_EQ(resumed.exit_code, 0) << at << ": " << resumed.err;
    ASSERT_NE(resumed.err.find(files[1].filename().string()), std::string::npos) << at << ": " << resumed.err;
    expect_same_run(folder / "kept", folder / "alone");
    std::filesystem::remove_all(folder / "alone");
    std::filesystem::copy(folder / "kept", folder / "alone", std::filesystem::copy_options::recursive);
  }
}

TEST(Resume, WithoutAWholeCheckpointIsWrongInput) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  run_alone(folder, {"--set", "stage.2.strain=0.01"});
  for (const auto& file : checkpoints_of(folder / "alone")) {
    std::filesystem::resize_file(file, 1000);
  }
  const ProgramResult resumed = boba({"resume", "alone"}, folder);
  EXPECT_EQ(resumed.exit_code, 2);
  EXPECT_NE(resumed.err.find("checkpoint-"), std::string::npos) << resumed.err;
}

TEST(Resume, AnotherInstructionSetAsksForLeave) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  run_alone(folder, {"--set", "stage.2.strain=0.01"});
  SavedState data = latest_checkpoint(folder / "alone/checkpoints").data;
  data.at("run.instruction_set").values = std::string("abacus");
  write_checkpoint(folder / "alone/checkpoints", data);
  const ProgramResult refused = boba({"resume", "alone"}, folder);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("abacus"), std::string::npos) << refused.err;
  EXPECT_EQ(boba({"resume", "alone", "--allow-other-isa"}, folder).exit_code, 0);
}

TEST(Resume, WrongNumbersUnderARightChecksumAreRefused) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  for (const char* precision : {"double", "mixed"}) {
    std::filesystem::remove_all(folder / "alone");
    run_alone(folder, {"--set", "stage.2.strain=0.01", "--set", std::string("run.precision=") + precision});
    const SavedState right = latest_checkpoint(folder / "alone/checkpoints").data;
    const auto expect_refused = [&](const char* what, auto change) {
      SavedState wrong = right;
      change(wrong);
      write_checkpoint(folder / "alone/checkpoints", wrong);
      const ProgramResult refused = boba({"resume", "alone"}, folder);
      EXPECT_EQ(refused.exit_code, 2) << precision << " " << what << ": " << refused.err;
      EXPECT_NE(refused.err.find(".boba: "), std::string::npos) << refused.err;
      EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    };
    const auto reals = [](SavedState& d, const char* name) -> SavedValue::Reals& {
      return std::get<SavedValue::Reals>(d.at(name).values);
    };
    expect_refused("a node at 1e300", [&](SavedState& d) { reals(d, "packing.position")[4] = 1e300; });
    expect_refused("r0", [&](SavedState& d) { reals(d, "packing.templates.0.bond_length")[7] *= 1.05; });
    expect_refused("negative r0", [&](SavedState& d) { reals(d, "packing.templates.0.bond_length")[7] = -1.0; });
    if (std::string(precision) == "double") {
      expect_refused("a node far away", [&](SavedState& d) { reals(d, "simulation.position")[4] = 1e300; });
      expect_refused("a node off its bonds", [&](SavedState& d) { reals(d, "simulation.position")[4] += 40.0; });
    } else {
      expect_refused("an origin", [&](SavedState& d) { reals(d, "simulation.origin")[1] = 1e300; });
      expect_refused("a coordinate", [&](SavedState& d) {
        std::get<SavedValue::Integers>(d.at("simulation.position").values)[4] = 1 << 30;
      });
    }
    expect_refused("a velocity", [&](SavedState& d) { reals(d, "simulation.velocity")[5] = std::nan(""); });
    expect_refused("a flat cell", [&](SavedState& d) { reals(d, "simulation.cell.h")[4] = 0.0; });
    expect_refused("a strain", [&](SavedState& d) { reals(d, "simulation.cell.strain")[0] = std::nan(""); });
    expect_refused(
        "corner", [&](SavedState& d) { reals(d, "packing.cell.origin")[1] = std::numeric_limits<double>::infinity(); });
  }
}

/// Whatever a field is: without it, or with a text in its place, the run does not continue, and one sentence says why.
TEST(Resume, AFieldThatIsMissingOrOfAnotherTypeIsNamed) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  ASSERT_EQ(boba({"run", "scene.toml", "--wall-time", "0.05"}, folder).exit_code, 75);
  const SavedState whole = latest_checkpoint(folder / "out/checkpoints").data;
  for (const char* name : {"run.scene", "packing.grains.alpha", "packing.templates.0.bond_length", "simulation.step",
                           "simulation.position", "simulation.cell.map", "simulation.totals.stress",
                           "simulation.stage.name", "output.table.last_step"}) {
    for (const bool is_missing : {true, false}) {
      SavedState data = whole;
      ASSERT_TRUE(data.contains(name)) << name;
      if (is_missing) {
        data.erase(name);
      } else {
        data[name] = std::string(name) == "run.scene" || std::string(name) == "simulation.stage.name"
                         ? SavedValue{SavedValue::Integers{1}, {}}
                         : SavedValue{std::string("eleven"), {}};
      }
      write_checkpoint(folder / "out/checkpoints", data);
      const ProgramResult refused = boba({"resume", "out"}, folder);
      EXPECT_EQ(refused.exit_code, 2) << name << refused.err;
      EXPECT_NE(refused.err.find(std::string(name) + (is_missing ? " is missing" : " holds ")), std::string::npos)
          << name << "\n"
          << refused.err;
      EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    }
  }
  write_checkpoint(folder / "out/checkpoints", whole);
  EXPECT_EQ(boba({"resume", "out"}, folder).exit_code, 0);
}

TEST(Resume, AScenesInputFilesMayBeGone) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  run_alone(folder, {"--set", "stage.2.strain=0.05"});
  folder.file("next.toml", "[run]\nthreads = 1\n[start]\ntrajectory = \"alone/trajectory.h5\"\n[output.trajectory]\n"
                           "every_time = 50\n[[stage]]\ntype = \"shear\"\nrate = -1e-3\nstrain = 0.2\n");
  ASSERT_EQ(boba({"run", "next.toml", "--output", "whole"}, folder).exit_code, 0);
  ASSERT_EQ(boba({"run", "next.toml", "--output", "cut", "--wall-time", "0.02"}, folder).exit_code, 75);
  std::filesystem::rename(folder / "alone", folder / "elsewhere");
  const ProgramResult resumed = boba({"resume", "cut"}, folder);
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  expect_same_run(folder / "whole", folder / "cut");
}

} // namespace
} // namespace boba::test
