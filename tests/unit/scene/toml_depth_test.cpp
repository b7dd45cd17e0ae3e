// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/input_error.h"
#include "bpm/toml/toml_node.h"
#include "tests/support/temporary_folder.h"

#include <chrono>
#include <gtest/gtest.h>

namespace boba {
namespace {

std::string repeated(const std::string& text, int n) {
  std::string result;
  for (int k = 0; k < n; ++k) {
    result += text;
  }
  return result;
}

std::string said(const std::string& text) {
  return test::message_of<InputError>([&] { parse_toml(text, "s.toml"); });
}

TEST(TomlDepth, IsLookedAtBeforeParsing) {
  EXPECT_NE(said("# a comment\n" + repeated("a.", 100000) + "a = 1\n").find("s.toml:2: a dotted key deeper than 32"),
            std::string::npos);
  EXPECT_NE(said("[" + repeated("a.", 100000) + "a]\n").find("a dotted key deeper"), std::string::npos);
  EXPECT_NE(said("x = 'it''s'\ny = " + repeated("[", 100000) + "\n").find("s.toml:2: brackets nested deeper"),
            std::string::npos);
  EXPECT_NE(said("x = " + repeated("{a=", 100000) + "1\n").find("brackets nested deeper"), std::string::npos);
  TomlNode root = parse_toml("title = \"t\"\n", "s.toml");
  const auto set = [&](const std::string& assignment) {
    return test::message_of<InputError>([&] { apply_override(root, assignment); });
  };
  EXPECT_NE(set("title={" + repeated("a.", 60000) + "a=1}").find("a dotted key deeper"), std::string::npos);
  EXPECT_NE(set(repeated("a.", 60000) + "a=1").find("60001 parts; 32 at most"), std::string::npos);
}

TEST(TomlDepth, CountsNeitherStringsNorCommentsNorNumbers) {
  const std::string dots = repeated("a.", 200) + repeated("[", 200);
  const TomlNode root = parse_toml("# " + dots + "\nx = \"" + dots + "\\\"[\"\ny = '''\n" + dots + "\n'''\nz = [" +
                                       repeated("1.5, ", 200) + "1.5]\n[a.b.\"c.d\"]\n",
                                   "s.toml");
  EXPECT_EQ(root.find("x")->text, dots + "\"[");
  EXPECT_EQ(root.find("z")->items.size(), 201u);
  EXPECT_EQ(parse_toml("x = " + repeated("[", 32) + repeated("]", 32) + "\n", "s.toml").members.size(), 1u);
}

TEST(TomlDepth, LongArraysAreShownNoFurtherThanAMessageNeeds) {
  const auto begin = std::chrono::steady_clock::now();
  const TomlNode root = parse_toml("x = " + repeated("[", 30) + repeated("1, ", 300000) + repeated("]", 30) +
                                       "\ny = [1, 2]\n"
                                       "z = {a = 1, b = \"c\"}\n",
                                   "s.toml");
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 30.0);
  EXPECT_LE(root.find("x")->shown.size(), 63u);
  EXPECT_EQ(root.find("y")->shown, "[ 1, 2 ]");
  EXPECT_EQ(root.find("z")->shown, "{ a = 1, b = \"c\" }");
}

} // namespace
} // namespace boba
