// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/output_record.h"
#include "bpm/io/checkpoint.h"
#include "bpm/io/trajectory.h"
#include "tests/robustness/app/small_scene.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <vector>

namespace boba::test {

/// Two runs ended with the same text dumps and VTK files, or both without.
inline void expect_same_pictures(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::vector<std::filesystem::path> files = {"dump.lammpstrj"};
  for (const std::filesystem::path& run : {a, b}) {
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(run / "vtk", none)) {
      files.push_back("vtk" / entry.path().filename());
    }
  }
  for (const std::filesystem::path& file : files) {
    ASSERT_EQ(std::filesystem::exists(a / file), std::filesystem::exists(b / file)) << file;
    EXPECT_TRUE(!std::filesystem::exists(a / file) || content_of(a / file) == content_of(b / file))
        << file << " differ";
  }
}

/// Two runs ended with the same table, frames and state, bit for bit.
inline void expect_same_run(const std::filesystem::path& a, const std::filesystem::path& b) {
  expect_same_pictures(a, b);
  EXPECT_TRUE(table_without_speed(a / "table.csv") == table_without_speed(b / "table.csv")) << "tables differ";
  const TrajectoryReader first(a / "trajectory.h5"), second(b / "trajectory.h5");
  ASSERT_EQ(first.steps(), second.steps());
  for (std::int64_t frame = 0; frame < first.n_frames(); ++frame) {
    const Snapshot x = first.snapshot(frame), y = second.snapshot(frame);
    EXPECT_EQ(x.position, y.position) << "frame " << frame;
    EXPECT_EQ(x.velocity, y.velocity) << "frame " << frame;
    EXPECT_EQ(x.grain_stress, y.grain_stress) << "frame " << frame;
  }
  SavedState end = latest_checkpoint(a / "checkpoints").data, other = latest_checkpoint(b / "checkpoints").data;
  for (SavedState* state : {&end, &other}) {
    // Its path and options differ, and the sums of its files: the column of speed in table.csv is never the same.
    std::erase_if(*state, [](const auto& field) { return field.first.starts_with("run."); });
    EXPECT_EQ(state->erase(output_record_name), 1U);
  }
  EXPECT_TRUE(end == other) << "the last checkpoints differ";
}

} // namespace boba::test
