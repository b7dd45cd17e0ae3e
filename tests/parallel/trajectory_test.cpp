// SPDX-License-Identifier: GPL-3.0-or-later
// A trajectory that several ranks write is the one that a single rank writes.
#include "bpm/io/trajectory.h"
#include "tests/parallel/mpirun.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

namespace boba::test {
namespace {

struct Kind {
  const char *name, *velocities, *compression;
};

void write_on(int ranks, const std::filesystem::path& file, const Kind& kind, int first, int last) {
  const ProgramResult result = run_on_ranks(ranks, file.parent_path().string(),
                                            {BOBA_TRAJECTORY_WORKER, file.string(), kind.velocities, kind.compression,
                                             std::to_string(first), std::to_string(last)});
  ASSERT_EQ(result.exit_code, 0) << result.err;
}

void expect_same_content(const std::filesystem::path& a, const std::filesystem::path& b) {
  const TrajectoryReader first(a), second(b);
  ASSERT_EQ(first.steps(), second.steps());
  ASSERT_EQ(first.n_frames(), 5);
  EXPECT_EQ(first.has_velocity(), second.has_velocity());
  EXPECT_EQ(first.topology().id, second.topology().id);
  EXPECT_EQ(first.topology().first_node, second.topology().first_node);
  for (std::int64_t frame = 0; frame < first.n_frames(); ++frame) {
    const Snapshot x = first.snapshot(frame), y = second.snapshot(frame);
    EXPECT_EQ(x.time, y.time);
    EXPECT_EQ(x.box.h(), y.box.h());
    EXPECT_EQ(x.position, y.position) << "frame " << frame;
    EXPECT_EQ(x.velocity, y.velocity) << "frame " << frame;
    EXPECT_EQ(x.grain_centre, y.grain_centre) << "frame " << frame;
    EXPECT_EQ(x.grain_stress, y.grain_stress) << "frame " << frame;
  }
}

class TrajectoryOnRanks : public ::testing::TestWithParam<Kind> {};

TEST_P(TrajectoryOnRanks, HasTheContentOfOneRanks) {
  const TemporaryFolder folder;
  write_on(1, folder / "1.h5", GetParam(), 0, 4);
  for (const int ranks : {2, 3, 4, 7}) {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    const std::filesystem::path file = folder / (std::to_string(ranks) + ".h5");
    write_on(ranks, file, GetParam(), 0, 4);
    expect_same_content(folder / "1.h5", file);
  }
}

TEST_P(TrajectoryOnRanks, IsGoneOnWithOnOthers) {
  const TemporaryFolder folder;
  write_on(1, folder / "1.h5", GetParam(), 0, 4);
  write_on(4, folder / "4.h5", GetParam(), 0, 3); // the last frame is cut off again
  for (const int ranks : {1, 3}) {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    const std::filesystem::path file = folder / (std::to_string(ranks) + "-later.h5");
    std::filesystem::copy_file(folder / "4.h5", file);
    write_on(ranks, file, GetParam(), 3, 4);
    expect_same_content(folder / "1.h5", file);
  }
  const std::filesystem::path file = folder / "more.h5";
  write_on(1, file, GetParam(), 0, 1);
  write_on(3, file, GetParam(), 2, 4);
  expect_same_content(folder / "1.h5", file);
}

INSTANTIATE_TEST_SUITE_P(Kinds, TrajectoryOnRanks,
                         ::testing::Values(Kind{"plain", "0", "0"}, Kind{"velocities", "1", "0"},
                                           Kind{"compressed", "1", "4"}),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace
} // namespace boba::test
