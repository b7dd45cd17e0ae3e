// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/schedule.h"

#include <cmath>

namespace boba {

namespace {

/// More intervals than can be counted: every step passes some.
constexpr std::int64_t countless = std::int64_t{1} << 53;

} // namespace

std::int64_t Schedule::index(double value, const std::optional<double>& interval) {
  // The small number forgives the rounding of a sum of many steps.
  const double intervals = interval ? std::floor(std::abs(value) / *interval + 1e-6) : 0.0;
  return intervals < static_cast<double>(countless) ? static_cast<std::int64_t>(intervals) : countless;
}

bool Schedule::due(const StepForecast& forecast) {
  const double before = path_.now();
  const std::int64_t strain_index = index(path_.to(forecast.strain), every_.strain);
  const std::int64_t time_index = index(forecast.time, every_.time);
  const bool passed = strain_index != strain_index_ || time_index != time_index_ || time_index == countless ||
                      (strain_index == countless && path_.now() != before);
  strain_index_ = strain_index;
  time_index_ = time_index;
  return passed;
}

} // namespace boba
