// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/archive/archive.h"

#include <cmath>

namespace boba {

/// How far a run has been sheared, forward and back: the sum of |d strain|. While the direction stays the same it is
/// the distance from where it last turned, so that no rounding adds up; before the first turn it is |strain|.
class StrainPath {
public:
  explicit StrainPath(double strain) : turned_at_(strain), before_(std::abs(strain)), last_(strain) {}

  /// The path once the strain is `strain`. To be told of every step, in order.
  double to(double strain) {
    const double step = strain - last_;
    const double direction = step > 0.0 ? 1.0 : step < 0.0 ? -1.0 : 0.0;
    if (direction != 0.0 && direction != direction_) {
      before_ += std::abs(last_ - turned_at_);
      turned_at_ = last_;
      direction_ = direction;
      // From 0 on, the path is |strain| itself: with the same bits as a run that never turns.
      if (before_ == std::abs(last_) && last_ * direction >= 0.0) {
        before_ = 0.0;
        turned_at_ = 0.0;
      }
    }
    last_ = strain;
    return now();
  }
  double now() const { return before_ + std::abs(last_ - turned_at_); }

  void archive(Archive& archive) {
    archive.field("turned_at", turned_at_);
    archive.field("before", before_);
    archive.field("direction", direction_);
    archive.field("last", last_);
    if (!std::isfinite(turned_at_ + before_ + direction_ + last_)) {
      archive.fail("before", "holds no finite path of the strain");
    }
  }

private:
  double turned_at_, before_; ///< strain at the last turn, and the path until then
  double direction_ = 0.0;
  double last_;
};

} // namespace boba
