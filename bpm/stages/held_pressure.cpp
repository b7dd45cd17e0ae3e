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

} // namespace boba
