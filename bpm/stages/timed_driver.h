// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stage_driver.h"
#include "bpm/stages/timed_steps.h"

namespace boba {

/// The driver of a stage that lasts a known time: all that follows from its steps.
class TimedDriver : public StageDriver {
public:
  bool finished() const override { return steps_.finished(); }
  std::int64_t steps_left(const Stepper&) const override { return steps_.left(); }
  bool may_end(const Stepper&) const override { return steps_.left() == 1; }
  void end(Stepper&) override {}

protected:
  TimedSteps steps_;
};

} // namespace boba
