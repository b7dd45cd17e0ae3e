// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/barostat.h"

#include <algorithm>
#include <cmath>

namespace boba {

double barostat_gain(const Barostat& barostat, const BarostatContext& context) {
  if (barostat.gain) {
    return *barostat.gain;
  }
  double response = 100.0;
  if (context.shear_rate != 0.0) {
    response = std::min(0.01 / std::abs(context.shear_rate), response);
  }
  response = std::max(response, 3.0 * context.sound_crossing);
  return 1.0 / (3.0 * context.bulk_modulus * response);
}

double barostat_rate(const Barostat& barostat, double gain, double pressure) {
  return std::clamp(gain * (pressure - barostat.pressure), -barostat.rate_cap, barostat.rate_cap);
}

} // namespace boba
