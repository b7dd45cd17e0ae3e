// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/folder_lock.h"
#include "bpm/io/input_error.h"
#include "bpm/io/printable.h"
#include "tests/support/temporary_folder.h"

#include <memory>
#include <optional>
#include <sys/wait.h>

namespace boba::test {
namespace {

class FolderLockTest : public testing::TestWithParam<FolderLock::Means> {};

TEST_P(FolderLockTest, HasOneHolderWhoIsNamed) {
  const TemporaryFolder folder;
  const auto file = folder / "run.lock";
  {
    const FolderLock lock(file, "first", GetParam());
    const std::string message = message_of<InputError>([&] { FolderLock(file, "second", GetParam()); });
    EXPECT_NE(message.find("process " + std::to_string(getpid()) + " on "), std::string::npos) << message;
    EXPECT_NE(message.find(", since 2"), std::string::npos) << message;
    EXPECT_NE(message.find("(first)"), std::string::npos) << message;
  }
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_NO_THROW(FolderLock(file, "third", GetParam()));
}

TEST_P(FolderLockTest, AProcessThatEndedHoldsNothing) {
  const TemporaryFolder folder;
  const auto file = folder / "run.lock";
  const pid_t child = fork();
  if (child == 0) {
    const FolderLock* kept = new FolderLock(file, "child", GetParam());
    _exit(kept == nullptr ? 1 : 0); // as when killed: no destructor
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_EQ(WEXITSTATUS(status), 0);
  ASSERT_TRUE(std::filesystem::exists(file));
  EXPECT_NO_THROW(FolderLock(file, "next", GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Means, FolderLockTest, testing::Values(FolderLock::Means::system, FolderLock::Means::record),
                         [](const auto& info) {
                           return info.param == FolderLock::Means::system ? "System" : "Record";
                         });

TEST(FolderLock, ARecordOfAnotherMachineHolds) {
  const TemporaryFolder folder;
  const auto file =
      folder.file("run.lock", "process 1234567 on another-machine, since 2026-01-01 00:00:00 +0000 (x)\n");
  const std::string message = message_of<InputError>([&] { FolderLock(file, "second", FolderLock::Means::record); });
  EXPECT_NE(message.find("another-machine"), std::string::npos) << message;
  EXPECT_NE(message.find("remove"), std::string::npos) << message;
}

TEST(FolderLock, TellsItsHolderWithoutTakingIt) {
  const TemporaryFolder folder;
  const auto file = folder / "run.lock";
  EXPECT_EQ(FolderLock::holder_of(file), "");
  {
    const FolderLock lock(file, "first");
    EXPECT_NE(FolderLock::holder_of(file).find("(first)"), std::string::npos);
  }
  folder.file("run.lock", "process 1 on a machine, since long ago (killed)\n");
  EXPECT_EQ(FolderLock::holder_of(file), "");
}

TEST(Printable, WritesControlCharactersOut) {
  EXPECT_EQ(printable("a\nb\tc\x1b[31m\x7f"), "a\\nb\\tc\\x1b[31m\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\x9b31m");
  EXPECT_EQ(printable("K\xc3\xb6rner \xc2\xb5 \xce\xb3"), "K\xc3\xb6rner \xc2\xb5 \xce\xb3"); // letters stay
}

} // namespace
} // namespace boba::test
