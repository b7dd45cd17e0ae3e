// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene may say and nobody would: the ends of the range of every number, and next to nothing where 0 is
// excluded. The program answers, in time and in a bounded memory, or stops at its wall-time limit. One value in four is
// tried; all of them when BOBA_ALLOWED=all.
#include "bpm/scene/scene_schema.h"
#include "tests/robustness/app/small_scene.h"
#include "tests/robustness/scene/trial_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <string_view>

namespace boba::test {
namespace {

std::vector<std::string> ends_of_range(const SceneKey& key) {
  std::vector<std::string> values;
  const auto add = [&](double value) {
    values.push_back(key.type == SceneKey::Type::integer ? fmt::format("{:.0f}", value) : fmt::format("{:g}", value));
  };
  if (std::isfinite(key.lowest)) {
    add(key.above_lowest ? (key.lowest == 0.0 ? 1e-320 : key.lowest * (1.0 - std::copysign(1e-9, key.lowest)))
                         : key.lowest);
  }
  if (key.above_lowest && key.lowest == 0.0) {
    add(1e-12);
  }
  if (std::isfinite(key.highest)) {
    add(key.highest);
  }
  return values;
}

/// Killed when it takes longer than a minute or more than 20 GB of addresses; a thousand threads want 8.
ProgramResult limited(std::vector<std::string> arguments, const TemporaryFolder& folder) {
  arguments.insert(arguments.begin(),
                   {"/usr/bin/timeout", "-s", "KILL", "60", "/usr/bin/prlimit", "--as=20000000000", BOBA_PROGRAM});
  return run_program(arguments, (folder / "").string());
}

TEST(AllowedValues, AtTheEndsOfTheirRangesHaveAnAnswer) {
  const char* wish = std::getenv("BOBA_ALLOWED");
  const int stride = wish != nullptr && std::string_view(wish) == "all" ? 1 : 4;
  int n_values = 0, n_tried = 0, n_right = 0;
  std::string refused;
  for (const SceneSection& section : scene_schema()) {
    for (const SceneKey& key : section.keys) {
      const bool is_number = key.type == SceneKey::Type::integer || key.type == SceneKey::Type::real;
      if (!is_number || section.path == "start") { // which needs files
        continue;
      }
      for (const std::string& value : ends_of_range(key)) {
        if (n_values++ % stride != 0) {
          continue;
        }
        const TemporaryFolder folder;
        const std::string line = key.name + " = " + value;
        folder.file("scene.toml", TrialScene(section, key.name).text(line));
        const ProgramResult checked = limited({"check", "scene.toml"}, folder);
        const std::string where = section.path + " " + section.kind + ": " + line + "\n" + checked.err + checked.out;
        EXPECT_EQ(checked.signal, 0) << where;
        EXPECT_TRUE(checked.exit_code == 0 || checked.exit_code == 2 || checked.exit_code == 3) << where;
        EXPECT_EQ(checked.out.find("-9223372"), std::string::npos) << where;
        EXPECT_EQ(checked.exit_code == 2, checked.err.find("boba: ") == 0) << where;
        ++n_tried;
        n_right += checked.exit_code == 0;
        refused += checked.exit_code == 0 ? "" : where;
        if (checked.exit_code == 0 && section.path != "measure") { // a thousand million points take their time
          const ProgramResult ran =
              limited({"run", "scene.toml", "--quiet", "--wall-time", "0.1", "--output", "out"}, folder);
          EXPECT_EQ(ran.signal, 0) << where << ran.err;
          // 2 too: how far a cell can be strained is known when the stage begins.
          EXPECT_TRUE(ran.exit_code >= 0 && (ran.exit_code <= 2 || ran.exit_code == 75)) << where << ran.err;
        }
      }
    }
  }
  EXPECT_GT(n_values, 120);
  // Most of these scenes are to run, and not to be refused for something else.
  EXPECT_GT(n_right, n_tried * 3 / 4) << refused;
  RecordProperty("tried", n_tried);
}

} // namespace
} // namespace boba::test
