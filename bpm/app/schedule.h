// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/strain_path.h"
#include "bpm/dynamics/observer.h"
#include "bpm/scene/scene.h"

namespace boba {

/// Says at which steps something is due. It depends on strain and time alone, so a run that was stopped and continues
/// writes at the same steps as one that never stopped. Strain counts forward and back: what matters is its path.
class Schedule {
public:
  Schedule(const OutputInterval& every, const StrainPath& path, double time)
      : every_(every), path_(path), strain_index_(index(path.now(), every.strain)),
        time_index_(index(time, every.time)) {}

  /// True when the step passes a multiple of the strain or time interval. To be asked once for every step, in order.
  bool due(const StepForecast& forecast);
  const StrainPath& path() const { return path_; }

private:
  static std::int64_t index(double value, const std::optional<double>& interval);

  OutputInterval every_;
  StrainPath path_;
  std::int64_t strain_index_, time_index_;
};

} // namespace boba
