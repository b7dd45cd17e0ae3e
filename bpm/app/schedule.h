// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/observer.h"
#include "bpm/scene/scene.h"

namespace boba {

/// Says at which steps something is due. It depends on strain and time alone, so a run that was stopped and goes on
/// writes at the same steps as one that never stopped.
class Schedule {
public:
  Schedule(const OutputInterval& every, double strain, double time)
      : every_(every), strain_(strain), strain_index_(index(strain, every.strain)),
        time_index_(index(time, every.time)) {}

  /// True when the step passes a multiple of the strain or time interval. To be asked once for every step, in order.
  bool due(const StepForecast& forecast);

private:
  static std::int64_t index(double value, const std::optional<double>& interval);

  OutputInterval every_;
  double strain_;
  std::int64_t strain_index_, time_index_;
};

} // namespace boba
