// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/trajectory.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/small_packings.h"
#include "tests/support/temporary_folder.h"

#include <chrono>
#include <cstdlib>
#include <gtest/gtest.h>
#include <random>
#include <signal.h>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace boba {
namespace {

/// Writes frames as fast as it can until it is killed; tells through a pipe how many are flushed.
[[noreturn]] void write_until_killed(const std::filesystem::path& path, int report) {
  TrajectoryWriter writer(path, test::small_topology(), {}, {true, 0});
  for (std::int64_t step = 0;; ++step) {
    writer.write(test::small_snapshot(step));
    if (write(report, "f", 1) != 1) {
      _exit(1);
    }
  }
}

/// Kills a writer at a random moment and returns how many frames it had flushed by then.
std::int64_t kill_a_writer(const std::filesystem::path& path, std::chrono::microseconds after) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    write_until_killed(path, ends[1]);
  }
  close(ends[1]);
  char byte = 0;
  std::int64_t n_flushed = read(ends[0], &byte, 1);
  std::this_thread::sleep_for(after);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  char buffer[4096];
  for (ssize_t got; (got = read(ends[0], buffer, sizeof buffer)) > 0;) {
    n_flushed += got;
  }
  close(ends[0]);
  return n_flushed;
}

/// Every flushed frame is there and right; one more may have been complete when the kill came.
void expect_all_frames(const std::filesystem::path& path, std::int64_t n_flushed) {
  const TrajectoryReader reader(path);
  ASSERT_GE(reader.n_frames(), n_flushed);
  ASSERT_LE(reader.n_frames(), n_flushed + 1);
  for (std::int64_t frame = 0; frame < reader.n_frames(); ++frame) {
    const Snapshot read = reader.snapshot(frame), wanted = test::small_snapshot(frame);
    ASSERT_EQ(read.step, frame);
    ASSERT_EQ(read.velocity, wanted.velocity);
    ASSERT_LT((read.position[4] - wanted.position[4]).norm(), 1e-13);
    ASSERT_EQ(read.grain_stress, wanted.grain_stress);
  }
}

/// Writes four frames in another process, which then ends with or without closing the file.
void write_four_frames(const std::filesystem::path& path, bool with_close) {
  const pid_t child = fork();
  if (child == 0) {
    auto* writer = new TrajectoryWriter(path, test::small_topology(), {}, {true, 3});
    for (std::int64_t step = 0; step < 4; ++step) {
      writer->write(test::small_snapshot(step));
    }
    if (with_close) {
      writer->close();
    }
    _exit(0); // runs no destructor, like a kill
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
}

TEST(KilledRun, CopiesAFileThatWasNotClosedBeforeGoingOn) {
  for (const bool with_close : {true, false}) {
    const test::TemporaryFolder folder;
    const auto path = folder / "run.h5md";
    write_four_frames(path, with_close);
    std::filesystem::create_hard_link(path, folder / "before"); // tells a copy from the file itself
    TrajectoryWriter again = TrajectoryWriter::go_on(path, test::small_topology(), 2);
    again.write(test::small_snapshot(7));
    again.close();
    EXPECT_EQ(std::filesystem::hard_link_count(path) == 2, with_close);
    EXPECT_FALSE(std::filesystem::exists(folder / "run.h5md.rebuilt"));
    const TrajectoryReader reader(path);
    EXPECT_EQ(reader.steps(), (std::vector<std::int64_t>{0, 1, 2, 7}));
    EXPECT_EQ(reader.snapshot(1).velocity, test::small_snapshot(1).velocity);
    EXPECT_EQ(reader.snapshot(2).grain_stress, test::small_snapshot(2).grain_stress);
    EXPECT_EQ(reader.snapshot(3).box.h(), test::small_snapshot(7).box.h());
  }
}

/// Writes frames until the disk is full; ends with 0 when that was told and the program could go on to its end.
[[noreturn]] void write_until_full(const std::filesystem::path& path) {
  std::string message;
  {
    TrajectoryWriter writer(path, test::small_topology(), {}, {true, 0});
    const test::FileSizeLimit full(std::filesystem::file_size(path) + 1500000);
    message = test::message_of<std::runtime_error>([&] {
      for (std::int64_t step = 0; step < 100000; ++step) {
        writer.write(test::small_snapshot(step));
      }
    });
  }
  std::exit(message.find("run.h5md") != std::string::npos ? 0 : 1);
}

TEST(FullDisk, IsAMessageAndLeavesTheFramesBefore) {
  const test::TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    write_until_full(folder / "run.h5md");
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  const TrajectoryReader reader(folder / "run.h5md");
  ASSERT_GT(reader.n_frames(), 10);
  for (std::int64_t frame = 0; frame < reader.n_frames(); ++frame) {
    ASSERT_EQ(reader.snapshot(frame).velocity, test::small_snapshot(frame).velocity);
  }
}

TEST(KilledRun, LeavesEveryFlushedFrameReadable) {
  const test::TemporaryFolder folder;
  std::mt19937 random(2024);
  std::uniform_int_distribution<int> wait(0, 60000);
  const char* rounds = std::getenv("BOBA_KILLS"); // more of them by hand
  for (int round = 0; round < (rounds != nullptr ? std::atoi(rounds) : 30); ++round) {
    const auto path = folder / ("run" + std::to_string(round) + ".h5md");
    const std::int64_t n_flushed = kill_a_writer(path, std::chrono::microseconds(wait(random)));
    ASSERT_GT(n_flushed, 0);
    expect_all_frames(path, n_flushed);
    if (HasFatalFailure()) {
      return;
    }
    TrajectoryWriter again = TrajectoryWriter::go_on(path, test::small_topology(), n_flushed);
    again.write(test::small_snapshot(n_flushed + 5));
    again.close();
    ASSERT_EQ(TrajectoryReader(path).steps().back(), n_flushed + 5);
    std::filesystem::remove(path);
  }
}

} // namespace
} // namespace boba
