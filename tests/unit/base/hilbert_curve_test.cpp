// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/hilbert_curve.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <map>

namespace boba::test {
namespace {

using Cell = std::array<std::uint32_t, 3>;

std::map<std::uint64_t, Cell> cells_along_curve(std::uint32_t side, int levels) {
  std::map<std::uint64_t, Cell> cells;
  for (std::uint32_t x = 0; x < side; ++x) {
    for (std::uint32_t y = 0; y < side; ++y) {
      for (std::uint32_t z = 0; z < side; ++z) {
        cells[hilbert_index({x, y, z}, levels)] = {x, y, z};
      }
    }
  }
  return cells;
}

// What makes a curve a Hilbert curve: it visits every cell once, and consecutive cells share a face.
void expect_unit_steps(const std::map<std::uint64_t, Cell>& cells, std::uint32_t side) {
  ASSERT_EQ(cells.size(), std::size_t{side} * side * side);
  ASSERT_EQ(cells.begin()->first, 0U);
  ASSERT_EQ(cells.rbegin()->first, cells.size() - 1);
  for (auto at = cells.begin(), next = std::next(at); next != cells.end(); ++at, ++next) {
    int distance = 0;
    for (int axis = 0; axis < 3; ++axis) {
      distance += std::abs(static_cast<int>(at->second[axis]) - static_cast<int>(next->second[axis]));
    }
    EXPECT_EQ(distance, 1);
  }
}

TEST(HilbertCurve, VisitsEveryCellStepByStep) {
  for (int levels = 1; levels <= 4; ++levels) {
    const std::uint32_t side = 1U << levels;
    expect_unit_steps(cells_along_curve(side, levels), side);
  }
}

// The curve fills the cube at the origin before it leaves it, however fine it is.
TEST(HilbertCurve, FillsACoarseCubeBeforeTheNext) {
  for (const int levels : {10, 16, 21}) {
    expect_unit_steps(cells_along_curve(8, levels), 8);
  }
}

} // namespace
} // namespace boba::test
