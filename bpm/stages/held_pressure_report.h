// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/archive/archive.h"

#include <string>

namespace boba {

/// How well a stage holds a pressure or a stress: mean, spread and share of the steps within the tolerance, over its
/// second half.
class HeldPressureReport {
public:
  /// \param what "pressure"  \param symbol "P"
  explicit HeldPressureReport(std::string what = "pressure", std::string symbol = "P")
      : what_(std::move(what)), symbol_(std::move(symbol)) {}

  /// A step at the pressure P for the target P0 (k/d, not 0), when `share_done` (0 .. 1) of the stage is done.
  void add(double pressure, double target, double share_done) { add(pressure, target, target, share_done); }
  /// The same for any target; `scale` (k/d, not 0) is what the tolerance is a share of.
  void add(double value, double target, double scale, double share_done);
  /// True when the mean is farther from the target than the tolerance, or there are no steps to tell.
  bool is_missed() const;
  bool has_steps() const { return n_ > 0.0; }
  /// "pressure held at 0.0501 +- 0.002 k/d, 98 % of the steps within 5 % of 0.05", with a warning where the target was
  /// missed; "" without steps.
  std::string text() const;

  /// All that it has added up.
  void archive(Archive& archive);

  static constexpr double tolerance = 0.05; ///< of |P - P0| over the scale

private:
  std::string what_, symbol_;
  double n_ = 0.0, target_ = 0.0;
  double sum_ = 0.0, sum2_ = 0.0; ///< of (P - P0) / scale and of its square
  double sum_of_scales_ = 0.0;    ///< k/d
  double n_within_ = 0.0;
};

} // namespace boba
