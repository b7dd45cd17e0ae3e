// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/schedule.h"
#include "bpm/archive/archive.h"
#include "bpm/dynamics/simulation.h"

#include <functional>
#include <string>

namespace boba {

/// Hands snapshots to a writer of frames: at the ends of stages and whenever the schedule says so, each step once.
class FrameObserver : public Observer {
public:
  using Write = std::function<void(Snapshot&&)>;
  /// `name`: what checkpoints call it. `last_step`: of the frame that was written last, for a run that goes on; -1 for
  /// a new one.
  FrameObserver(std::string name, const Schedule& schedule, Simulation::Parts parts, std::int64_t last_step,
                Write write)
      : name_(std::move(name)), schedule_(schedule), parts_(parts), last_step_(last_step), write_(std::move(write)) {}

  bool wants(const StepForecast& forecast) override;
  void observe(const Simulation& simulation, const StageProgress& progress) override;
  const std::string& name() const { return name_; }
  std::int64_t last_step() const { return last_step_; }
  void archive(Archive& archive) { archive.field("last_step", last_step_); }

private:
  std::string name_;
  Schedule schedule_;
  Simulation::Parts parts_;
  std::int64_t last_step_;
  Write write_;
};

} // namespace boba
