// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/held_pressure_report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace boba {

void HeldPressureReport::add(double value, double target, double scale, double share_done) {
  target_ = target;
  if (share_done < 0.5 || scale == 0.0) {
    return;
  }
  const double off = (value - target) / std::abs(scale);
  n_ += 1.0;
  sum_of_scales_ += std::abs(scale);
  sum_ += off;
  sum2_ += off * off;
  n_within_ += std::abs(off) <= tolerance ? 1.0 : 0.0;
}

bool HeldPressureReport::is_missed() const {
  return !(std::abs(sum_ / n_) <= tolerance);
}

std::string HeldPressureReport::text() const {
  if (n_ == 0.0) {
    return "";
  }
  const double mean = sum_ / n_, spread = std::sqrt(std::max(0.0, sum2_ / n_ - mean * mean));
  const double scale = sum_of_scales_ / n_;
  const std::string of_what = target_ == 0.0 ? fmt::format("{:.3g} k/d", scale) : "the target";
  const std::string held =
      fmt::format("{} {:.4g} +- {:.2g} k/d in the second half, {:.0f} % of its steps within {:.0f} % of {} {:.4g}",
                  symbol_, target_ + mean * scale, spread * scale, 100.0 * n_within_ / n_, 100.0 * tolerance,
                  target_ == 0.0 ? of_what + " from" : of_what, target_);
  return is_missed()
             ? fmt::format(
                   "warning: the {} was not held: {}; means of this stage are not those of its target. A slower "
                   "stage, a larger gain or rate_cap help",
                   what_, held)
             : fmt::format("{} held: {}", what_, held);
}

void HeldPressureReport::archive(Archive& archive) {
  archive.field("n", n_);
  archive.field("target", target_);
  archive.field("sum", sum_);
  archive.field("sum_of_squares", sum2_);
  archive.field("sum_of_scales", sum_of_scales_);
  archive.field("n_within", n_within_);
}

} // namespace boba
