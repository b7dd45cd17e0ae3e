// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <stdexcept>

namespace boba::test {
namespace {

TEST(Program, IsFoundInItsFolder) {
  EXPECT_EQ(program_beside("base_test"), program_folder() / "base_test");
  EXPECT_THROW(program_beside("no_such_program"), std::runtime_error);
}

TEST(Program, EndsWithItsExitCode) {
  EXPECT_EQ(run_process("/bin/true", {}), 0);
  EXPECT_EQ(run_process("/bin/sh", {"-c", "exit 7"}), 7);
  EXPECT_EQ(run_process("/bin/sh", {"-c", "kill -9 $$"}), -1);
  EXPECT_THROW(run_process("/no/such/program", {}), std::runtime_error);
}

TEST(Program, GetsItsArgumentsAsTheyAre) {
  const TemporaryFolder folder;
  const std::filesystem::path log = folder / "log";
  // No shell reads them: blanks, quotes and dollar signs arrive.
  EXPECT_EQ(run_process("/usr/bin/printf", {"%s|", "a b", "\"$HOME\"", ""}, log), 0);
  EXPECT_EQ(content_of(log), "a b|\"$HOME\"||");
}

TEST(Program, WritesBothStreamsIntoItsLog) {
  const TemporaryFolder folder;
  const std::filesystem::path log = folder / "log";
  run_process("/bin/sh", {"-c", "echo out; echo err >&2"}, log);
  EXPECT_EQ(content_of(log), "out\nerr\n");
}

} // namespace
} // namespace boba::test
