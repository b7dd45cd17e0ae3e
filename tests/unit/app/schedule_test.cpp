// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/schedule.h"

#include <gtest/gtest.h>
#include <vector>

namespace boba {
namespace {

/// Steps at which a shear at `rate` with dt = 0.1 is due, going on from step `first`.
std::vector<std::int64_t> due_steps(const OutputInterval& every, double rate, std::int64_t first, std::int64_t last) {
  double strain = 0.0;
  for (std::int64_t step = 1; step <= first; ++step) {
    strain += rate * 0.1;
  }
  Schedule schedule(every, StrainPath(strain), 0.1 * static_cast<double>(first));
  std::vector<std::int64_t> due;
  for (std::int64_t step = first + 1; step <= last; ++step) {
    strain += rate * 0.1;
    if (schedule.due({step, 0.1 * static_cast<double>(step), strain, false})) {
      due.push_back(step);
    }
  }
  return due;
}

TEST(Schedule, StrainAndTimeIntervals) {
  EXPECT_EQ(due_steps({0.01, std::nullopt}, 1e-3, 0, 350), (std::vector<std::int64_t>{100, 200, 300}));
  EXPECT_EQ(due_steps({0.01, std::nullopt}, -1e-3, 0, 350), (std::vector<std::int64_t>{100, 200, 300}));
  EXPECT_EQ(due_steps({std::nullopt, 7.0}, 0.0, 0, 150), (std::vector<std::int64_t>{70, 140}));
  EXPECT_EQ(due_steps({0.01, 15.0}, 1e-3, 0, 310), (std::vector<std::int64_t>{100, 150, 200, 300}));
  EXPECT_TRUE(due_steps({}, 1e-3, 0, 1000).empty());
}

TEST(Schedule, ARunThatGoesOnWritesAtTheSameSteps) {
  const OutputInterval every{0.003, 1.3};
  const std::vector<std::int64_t> whole = due_steps(every, 1e-3, 0, 2000);
  for (const std::int64_t stop : {1, 29, 30, 31, 777, 1300}) {
    std::vector<std::int64_t> parts = due_steps(every, 1e-3, 0, stop);
    const std::vector<std::int64_t> rest = due_steps(every, 1e-3, stop, 2000);
    parts.insert(parts.end(), rest.begin(), rest.end());
    EXPECT_EQ(parts, whole) << "stopped at " << stop;
  }
}

/// Intervals shorter than a step are due at every step, however short: 1e-320 has more of them than can be counted.
TEST(Schedule, ATinyIntervalIsDueAtEveryStep) {
  for (const double tiny : {1e-3, 1e-12, 1e-300, 1e-320}) {
    EXPECT_EQ(due_steps({std::nullopt, tiny}, 0.0, 0, 50).size(), 50U) << tiny;
    EXPECT_EQ(due_steps({std::nullopt, tiny}, 0.0, 20, 50).size(), 30U) << tiny;
    EXPECT_EQ(due_steps({1e-2 * tiny, std::nullopt}, 1e-3, 0, 50).size(), 50U) << tiny;
    EXPECT_TRUE(due_steps({tiny, std::nullopt}, 0.0, 0, 50).empty()) << tiny;
  }
}

TEST(Schedule, LongRunsKeepTheirPace) {
  EXPECT_EQ(due_steps({0.01, std::nullopt}, 1e-3, 0, 1000000).size(), 10000U);
}

/// Forward to 0.05, back to -0.02: samples stand every 0.01 of path, none a step after the turn, and a run that was
/// stopped anywhere takes the same.
TEST(Schedule, ShearThatTurnsIsSampledByItsPath) {
  const auto strain_at = [](std::int64_t step) { return 1e-4 * static_cast<double>(step <= 500 ? step : 1000 - step); };
  const auto due_from = [&](Schedule& schedule, std::int64_t first, std::int64_t last) {
    std::vector<std::int64_t> due;
    for (std::int64_t step = first + 1; step <= last; ++step) {
      if (schedule.due({step, 0.1 * static_cast<double>(step), strain_at(step), false})) {
        due.push_back(step);
      }
    }
    return due;
  };
  const OutputInterval every{0.01, std::nullopt};
  Schedule whole(every, StrainPath(0.0), 0.0);
  const std::vector<std::int64_t> expected = {100, 200, 300, 400, 500, 600, 700, 800, 900, 1000, 1100, 1200};
  EXPECT_EQ(due_from(whole, 0, 1200), expected);
  for (const std::int64_t stop : {1, 499, 500, 501, 777, 1001}) {
    Schedule first(every, StrainPath(0.0), 0.0);
    std::vector<std::int64_t> parts = due_from(first, 0, stop);
    SavedState saved;
    StrainPath path = first.path(), restored(0.0);
    Archive to = Archive::saving_to(saved), from = Archive::reading_from(saved);
    path.archive(to);
    restored.archive(from);
    Schedule second(every, restored, 0.1 * static_cast<double>(stop));
    const std::vector<std::int64_t> rest = due_from(second, stop, 1200);
    parts.insert(parts.end(), rest.begin(), rest.end());
    EXPECT_EQ(parts, expected) << "stopped at " << stop;
  }
}

} // namespace
} // namespace boba
