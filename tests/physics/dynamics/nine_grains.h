// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/motion_archive.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/dynamics/stepper.h"
#include "tests/support/small_packings.h"

#include <gtest/gtest.h>

namespace boba::test {

/// A cell that leans, and nine grains of two dozen nodes in it: what most tests of whole runs begin with.
inline const Box tilted({0.3, -1.0, 2.0}, {12.0, 11.0, 13.0}, {5.0, -4.0, 4.5});

inline Packing nine_grains(double alpha = 2.0) {
  return small_packing({.box = tilted, .n_grains = 9, .alpha = alpha});
}

inline void expect_same_bits(const Snapshot& a, const Snapshot& b) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.strain, b.strain);
  EXPECT_EQ(a.box.h(), b.box.h());
  for (std::size_t i = 0; i < a.position.size(); ++i) {
    ASSERT_EQ(a.position[i], b.position[i]) << "node " << i;
    ASSERT_EQ(a.velocity[i], b.velocity[i]) << "node " << i;
    ASSERT_EQ(a.force[i], b.force[i]) << "node " << i;
  }
}

/// Gives the motion of a packing to another of the same grains, as a checkpoint would.
inline void continue_from(Stepper& from, Stepper& to) {
  SavedState saved;
  Archive saving = Archive::saving_to(saved), reading = Archive::reading_from(saved);
  archive_motion(saving, from.moving());
  archive_motion(reading, to.moving());
}

inline constexpr Simulation::Parts all_parts = {.velocity = true, .force = true};

} // namespace boba::test
