// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/parallel/ranks.h"

#include <chrono>

namespace boba {

/// What the ranks tell each other once a step, all in one reduction while the drift is looked at: the largest speeds, a
/// wish to stop, rank 0's clock. Decisions that depend on time or signals are made from these, so that all make the
/// same.
class Agreement {
public:
  explicit Agreement(const Ranks& ranks) : ranks_(ranks) {}

  /// Before the first step. Collective.
  void begin() { exchange({}); }
  struct Speeds {
    double largest = 0.0; ///< of any node, d/tau
    double common = 0.0;  ///< of those that the contact list does not follow by themselves
  };
  /// Returns the largest speeds of any rank; takes the others' wishes. Collective.
  Speeds exchange(const Speeds& own) {
    double values[4] = {own.largest, own.common, wish_ ? 1.0 : 0.0, ranks_.is_root() ? own_seconds() : 0.0};
    ranks_.largest(values);
    stop_ = values[2] > 0.0;
    seconds_ = values[3];
    return {values[0], values[1]};
  }
  /// This rank wishes to stop (or not); the others hear of it with the next exchange.
  void wish_to_stop(bool wish) {
    wish_ = wish;
    stop_ = ranks_.is_distributed() ? stop_ : wish;
  }
  bool stop() const { return stop_; }
  /// Seconds since the beginning, by rank 0's clock at the last exchange.
  double seconds() const { return ranks_.is_distributed() ? seconds_ : own_seconds(); }

private:
  using Clock = std::chrono::steady_clock;
  double own_seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  const Ranks& ranks_;
  Clock::time_point begin_ = Clock::now();
  bool wish_ = false, stop_ = false;
  double seconds_ = 0.0;
};

} // namespace boba
