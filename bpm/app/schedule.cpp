// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/schedule.h"

#include <cmath>

namespace boba {

std::int64_t Schedule::index(double value, const std::optional<double>& interval) {
  // The small number forgives the rounding of a sum of many steps.
  return interval ? static_cast<std::int64_t>(std::floor(std::abs(value) / *interval + 1e-6)) : 0;
}

bool Schedule::due(const StepForecast& forecast) {
  const std::int64_t strain_index = index(forecast.strain, every_.strain);
  const std::int64_t time_index = index(forecast.time, every_.time);
  const bool passed = strain_index != strain_index_ || time_index != time_index_;
  strain_index_ = strain_index;
  time_index_ = time_index;
  return passed;
}

} // namespace boba
