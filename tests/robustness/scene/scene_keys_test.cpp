// SPDX-License-Identifier: GPL-3.0-or-later
// Every key of every table of a scene: wrong type, missing, absurd. The schema says which keys there are and what they
// may hold; whatever lies outside is refused with key, line and range.
#include "bpm/io/input_error.h"
#include "bpm/scene/scene.h"
#include "bpm/scene/scene_schema.h"
#include "tests/robustness/scene/trial_scene.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sstream>

namespace boba {
namespace {

using test::TrialScene;

std::string message(const std::string& text) {
  try {
    read_stored_scene(text, "scene.toml", {});
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

bool in_range(const SceneKey& key, double value) {
  return value <= key.highest && (key.above_lowest ? value > key.lowest : value >= key.lowest);
}

/// Values that the key must refuse, as TOML.
std::vector<std::string> wrong_values(const SceneKey& key) {
  using Type = SceneKey::Type;
  const bool is_number = key.type == Type::integer || key.type == Type::real;
  std::vector<std::string> wrong = {"{ a = 1 }", "1979-05-27", "[]"};
  if (key.type != Type::numbers) {
    wrong.emplace_back("[1, 2]");
  } else {
    wrong.insert(wrong.end(), {"[1, -1e300]", "[1, nan]", "[\"a\"]", "[[1]]", "5"});
  }
  if (key.type != Type::boolean) {
    wrong.insert(wrong.end(), {"true", "false"});
  }
  if (key.type != Type::text && key.type != Type::choice) {
    wrong.insert(wrong.end(), {"\"fast\"", "\"\"", "\"1\""});
  } else {
    wrong.insert(wrong.end(), {"3", "-1.5"});
  }
  if (key.type == Type::choice) {
    wrong.insert(wrong.end(), {"\"\"", "\"no such thing\""});
  }
  if (key.type == Type::boolean) {
    wrong.insert(wrong.end(), {"1", "0", "0.5"});
  }
  if (key.type == Type::vector3) {
    wrong.insert(wrong.end(), {"[1, 2, 3, 4]", "[1, 2, nan]", "[1, 2, -1e300]", "[\"a\", 1, 2]", "5"});
    if (!in_range(key, 0.0)) {
      wrong.emplace_back("[0, 0, 0]");
    }
  }
  if (is_number) {
    wrong.insert(wrong.end(), {"nan", "-nan", "inf", "-inf"});
    for (const char* value : {"0", "-1", "-1e300", "1e300", "9223372036854775807", "-9223372036854775808", "1e-320"}) {
      const bool is_whole = std::string(value).find('e') == std::string::npos;
      if (!in_range(key, std::strtod(value, nullptr)) || (key.type == Type::integer && !is_whole)) {
        wrong.emplace_back(value);
      }
    }
  }
  if (key.type == Type::integer) {
    wrong.emplace_back("2.5");
  }
  return wrong;
}

TEST(SceneKeys, TheTrialScenesAreRight) {
  for (const SceneSection& section : scene_schema()) {
    EXPECT_EQ(message(TrialScene(section, "").text("")), "") << section.path << " " << section.kind;
  }
}

TEST(SceneKeys, EveryWrongValueIsRefusedWithKeyLineAndRange) {
  int n_tried = 0;
  for (const SceneSection& section : scene_schema()) {
    for (const SceneKey& key : section.keys) {
      const TrialScene scene(section, key.name);
      for (const std::string& value : wrong_values(key)) {
        const std::string line = key.name + " = " + value;
        const std::string text = scene.text(line);
        const std::string refusal = message(text);
        const std::string where = section.path + " " + section.kind + ": " + line + "\n" + refusal;
        ASSERT_NE(refusal, "") << "was accepted: " << where;
        EXPECT_NE(refusal.find(key.name), std::string::npos) << where;
        EXPECT_NE(refusal.find(fmt::format("scene.toml:{}", TrialScene::line_number(text, line))), std::string::npos)
            << where;
        EXPECT_NE(refusal.find(key.allowed()), std::string::npos) << where << "\nshould say: " << key.allowed();
        EXPECT_EQ(refusal.find('\n'), std::string::npos) << where;
        ++n_tried;
      }
    }
  }
  EXPECT_GT(n_tried, 800);
  RecordProperty("tried", n_tried);
}

TEST(SceneKeys, EveryMissingKeyThatIsNeededIsNamed) {
  int n_tried = 0;
  for (const SceneSection& section : scene_schema()) {
    for (const SceneKey& key : section.keys) {
      if (key.required) {
        const std::string refusal = message(TrialScene(section, key.name).text(""));
        EXPECT_NE(refusal.find(key.name), std::string::npos)
            << section.path << " " << section.kind << "." << key.name << ": " << refusal;
        EXPECT_NE(refusal.find("scene.toml"), std::string::npos) << refusal;
        ++n_tried;
      }
    }
  }
  EXPECT_GE(n_tried, 6);
}

/// A path of a scene names a place below the folder the run is started in, whatever it is spelled like.
TEST(SceneKeys, NoOutputOutsideTheFolder) {
  for (const char* path : {"/tmp/x", "..", "../x", "a/../../x", "a/..", "./../x", "/", "", "//x", "a/./../../b"}) {
    const std::string text = fmt::format("[output]\ndirectory = \"{}\"\n", path) +
                             "[[template]]\nname = \"t\"\nnodes = 60\n[[species]]\ncount = 2\nalpha = 1.0\n"
                             "[[stage]]\ntype = \"insert\"\n";
    EXPECT_NE(message(text).find("directory"), std::string::npos) << path << ": " << message(text);
  }
}

} // namespace
} // namespace boba
