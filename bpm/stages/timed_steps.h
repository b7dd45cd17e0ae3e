// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/archive/archive.h"
#include "bpm/dynamics/observer.h"
#include "bpm/dynamics/step_count.h"

#include <cstdint>

namespace boba {

/// The steps of a stage that lasts a known time.
class TimedSteps {
public:
  /// \param duration, \param dt in tau  \throws std::invalid_argument when there are more than `most_steps`.
  void begin(double duration, double dt) { n_steps_ = step_count(duration, dt); }
  void count() { ++steps_done_; }
  std::int64_t done() const { return steps_done_; }
  std::int64_t left() const { return n_steps_ - steps_done_; }
  bool finished() const { return steps_done_ >= n_steps_; }
  /// 0 .. 1; 1 when there are no steps. \param more steps than those that are done
  double share_done(int more = 0) const {
    return n_steps_ > 0 ? static_cast<double>(steps_done_ + more) / static_cast<double>(n_steps_) : 1.0;
  }

  void archive(Archive& archive) {
    archive.field("n_steps", n_steps_);
    archive.field("steps_done", steps_done_);
  }

private:
  std::int64_t n_steps_ = 0, steps_done_ = 0;
};

/// Progress of a stage that nothing but time drives. \param duration of the stage, tau  \param dt tau
inline StageProgress progress_in_time(const TimedSteps& steps, double duration, double dt) {
  StageProgress progress;
  progress.done = steps.share_done();
  progress.driven = "time";
  progress.target = duration;
  progress.value = static_cast<double>(steps.done()) * dt;
  return progress;
}

} // namespace boba
