// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/held_pressure_report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace boba {

void HeldPressureReport::add(double pressure, double target, double share_done) {
  target_ = target;
  if (share_done < 0.5 || target == 0.0) {
    return;
  }
  const double off = pressure / target - 1.0;
  n_ += 1.0;
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
  const std::string held = fmt::format(
      "P {:.4g} +- {:.2g} k/d in the second half, {:.0f} % of its steps within {:.0f} % of the target {:.4g}",
      target_ * (1.0 + mean), std::abs(target_) * spread, 100.0 * n_within_ / n_, 100.0 * tolerance, target_);
  return is_missed()
             ? "warning: the pressure was not held: " + held +
                   "; means of this stage are not those of its target. A slower stage, a larger gain or rate_cap help"
             : "pressure held: " + held;
}

void HeldPressureReport::archive(Archive& archive) {
  archive.field("n", n_);
  archive.field("target", target_);
  archive.field("sum", sum_);
  archive.field("sum_of_squares", sum2_);
  archive.field("n_within", n_within_);
}

} // namespace boba
