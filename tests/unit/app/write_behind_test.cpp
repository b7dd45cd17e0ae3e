// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/write_behind.h"

#include <chrono>
#include <gtest/gtest.h>
#include <semaphore>
#include <stdexcept>
#include <thread>
#include <vector>

namespace boba {
namespace {

Snapshot frame(std::int64_t step) {
  Snapshot snapshot;
  snapshot.step = step;
  return snapshot;
}

TEST(WriteBehind, LetsTheRunGoOnWhileAFrameIsWritten) {
  std::binary_semaphore may_finish(0);
  std::thread::id writer;
  WriteBehind behind([&](const Snapshot&) {
    writer = std::this_thread::get_id();
    may_finish.acquire();
  });
  behind.add(frame(1)); // would never come back if it waited
  may_finish.release();
  behind.wait();
  EXPECT_NE(writer, std::this_thread::get_id());
}

TEST(WriteBehind, WritesEachFrameOnceAndInOrder) {
  std::vector<std::int64_t> steps;
  WriteBehind behind([&](const Snapshot& snapshot) { steps.push_back(snapshot.step); });
  for (int step = 0; step < 100; ++step) {
    behind.add(frame(step));
  }
  behind.wait();
  ASSERT_EQ(steps.size(), 100u);
  for (int step = 0; step < 100; ++step) {
    EXPECT_EQ(steps[step], step);
  }
}

TEST(WriteBehind, FinishesItsFrameWhenItGoesAway) {
  std::int64_t written = 0;
  {
    WriteBehind behind([&](const Snapshot& snapshot) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      written = snapshot.step;
    });
    behind.add(frame(7));
  }
  EXPECT_EQ(written, 7);
}

TEST(WriteBehind, TellsOfAFailureAtTheNextFrameAndWhenSomebodyWaits) {
  WriteBehind behind([](const Snapshot& snapshot) {
    if (snapshot.step < 0) {
      throw std::runtime_error("disk full");
    }
  });
  behind.add(frame(-1));
  EXPECT_THROW(behind.add(frame(2)), std::runtime_error);
  behind.add(frame(-1));
  EXPECT_THROW(behind.wait(), std::runtime_error);
  behind.wait();
}

} // namespace
} // namespace boba
