// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/held_pressure.h"

#include "bpm/dynamics/elastic_probe.h"
#include "bpm/dynamics/stepper.h"

namespace boba {

void HeldPressure::begin(Stepper& stepper, double shear_rate) {
  if (barostat_) {
    const double modulus =
        barostat_->gain ? 1.0 : affine_bulk_modulus(stepper.moving()); // of no use to a gain that is given
    gain_ = barostat_gain(*barostat_, {modulus, sound_crossing(stepper.moving(), modulus), shear_rate});
  }
}

double HeldPressure::dilation_rate(const Stepper& stepper, double share_done) {
  if (!barostat_) {
    return 0.0;
  }
  report_.add(stepper.pressure(), barostat_->pressure, share_done);
  return barostat_rate(*barostat_, gain_, stepper.pressure());
}

void HeldPressure::save(SavedState& saved) const {
  saved.real["driver"] = {gain_};
  saved.real["held_pressure"] = report_.numbers();
}

void HeldPressure::restore(const SavedState& saved) {
  gain_ = saved.real.at("driver").at(0);
  const std::vector<double>& numbers = saved.real.at("held_pressure");
  report_.restore(numbers.at(0), numbers.at(1), numbers.at(2), numbers.at(3), numbers.at(4));
}

} // namespace boba
