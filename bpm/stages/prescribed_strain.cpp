// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/prescribed_strain.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace boba {

namespace {

/// Goes from 0 to 1, to -1 and back to 0 while `phase` goes from 0 to 1.
double triangle(double phase) {
  const double within = phase - std::floor(phase);
  return within < 0.25 ? 4.0 * within : within < 0.75 ? 2.0 - 4.0 * within : 4.0 * within - 4.0;
}

} // namespace

double PrescribedStrain::at(double s) const {
  switch (kind) {
  case Kind::sine:
    return amplitude * std::sin(2.0 * std::numbers::pi * cycles * s);
  case Kind::triangle:
    return amplitude * triangle(cycles * s);
  case Kind::ramp:
    break;
  }
  return duration * (rate_from * s + 0.5 * (rate - rate_from) * s * s);
}

double PrescribedStrain::smallest() const {
  if (kind != Kind::ramp) {
    return -std::abs(amplitude);
  }
  double least = std::min(0.0, at_end());
  if (rate_from * rate < 0.0) { // it turns where the rate is 0
    least = std::min(least, at(rate_from / (rate_from - rate)));
  }
  return least;
}

double PrescribedStrain::fastest() const {
  switch (kind) {
  case Kind::sine:
    return 2.0 * std::numbers::pi * std::abs(amplitude) * cycles / duration;
  case Kind::triangle:
    return 4.0 * std::abs(amplitude) * cycles / duration;
  case Kind::ramp:
    break;
  }
  return std::max(std::abs(rate_from), std::abs(rate));
}

} // namespace boba
