// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/trajectory.h"
#include "tests/support/small_packing.h"
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
