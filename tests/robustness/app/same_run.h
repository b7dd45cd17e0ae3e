// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/io/checkpoint.h"
#include "bpm/io/trajectory.h"
#include "tests/robustness/app/small_scene.h"

#include <gtest/gtest.h>

namespace boba::test {

/// Two runs ended with the same table, frames and state, bit for bit.
inline void expect_same_run(const std::filesystem::path& a, const std::filesystem::path& b) {
  EXPECT_TRUE(table_without_speed(a / "table.csv") == table_without_speed(b / "table.csv")) << "tables differ";
  const TrajectoryReader first(a / "trajectory.h5"), second(b / "trajectory.h5");
  ASSERT_EQ(first.steps(), second.steps());
  for (std::int64_t frame = 0; frame < first.n_frames(); ++frame) {
    const Snapshot x = first.snapshot(frame), y = second.snapshot(frame);
    EXPECT_EQ(x.position, y.position) << "frame " << frame;
    EXPECT_EQ(x.velocity, y.velocity) << "frame " << frame;
    EXPECT_EQ(x.grain_stress, y.grain_stress) << "frame " << frame;
  }
  const CheckpointData end = latest_checkpoint(a / "checkpoints").data,
                       other = latest_checkpoint(b / "checkpoints").data;
  EXPECT_EQ(end.real, other.real);
  EXPECT_EQ(end.integer, other.integer);
}

} // namespace boba::test
