// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <string>

namespace boba::continuum::testing {

/// One line of docs/verification.md: printed, and checked to |measured - reference| <= tolerance.
struct Row {
  std::string what;
  double measured;
  double reference;
  /// Relative unless absolute is set.
  double tolerance;
  std::string source;
  bool absolute = false;
};

inline void verify(const Row& row) {
  const double difference = std::abs(row.measured - row.reference);
  const double error = row.absolute ? difference : difference / std::abs(row.reference);
  fmt::print("ROW | {} | {:.8g} | {:.8g} | {:.1e} | {:.1e}{} | {} |\n", row.what, row.measured, row.reference, error,
             row.tolerance, row.absolute ? " (absolute)" : "", row.source);
  EXPECT_LE(error, row.tolerance) << row.what;
}

/// A line without a tolerance: a number that is published, not required.
inline void report(const std::string& what, double measured, double reference, const std::string& source) {
  fmt::print("ROW | {} | {:.8g} | {:.8g} | {:.1e} | report | {} |\n", what, measured, reference,
             std::abs(measured / reference - 1), source);
}

} // namespace boba::continuum::testing
