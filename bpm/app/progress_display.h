// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/observer.h"
#include "bpm/parallel/ranks.h"

#include <chrono>
#include <string>

namespace boba {

/// Shows a person where a run is: a bar that is drawn over itself on a terminal, a line every so often on a pipe, with
/// the quantity the stage drives, speed and time left.
class ProgressDisplay : public Observer {
public:
  /// `modulus` > 0 shows pressures as P~ = P / modulus.
  ProgressDisplay(double modulus, std::int64_t n_nodes, bool quiet, const Ranks& ranks = Ranks::alone());

  bool wants(const StepForecast& forecast) override;
  void observe(const Simulation& simulation, const StageProgress& progress) override;
  /// Ends the bar so that other text can follow.
  void finish();

private:
  using Clock = std::chrono::steady_clock;
  void begin_stage(std::int64_t step, const StageProgress& progress);
  std::string line(const StageProgress& progress, double pressure, std::int64_t step) const;

  double modulus_;
  double n_nodes_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  bool visible_;              ///< rank 0 alone draws
  double interval_;           ///< s
  double last_seconds_ = 0.0; ///< of the forecast that was answered with yes
  int stage_ = -1;
  std::int64_t first_step_ = 0;
  double first_done_ = 0.0;
  Clock::time_point stage_begin_;
};

/// "2 h 05 min", "3 min 20 s", "12 s".
std::string readable_duration(double seconds);

} // namespace boba
