// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba {

/// A strain that is prescribed as a function of the share s (0 .. 1) of a stage that is done.
struct PrescribedStrain {
  enum class Kind {
    ramp,     ///< e = T (rate_from s + (rate - rate_from) s^2 / 2): the rate goes linearly from one value to another
    sine,     ///< e = amplitude sin(2 pi cycles s)
    triangle, ///< the same with straight flanks: up, down and up again in every cycle
  };
  Kind kind = Kind::ramp;
  double duration = 0.0;              ///< T of the stage, tau
  double rate_from = 0.0, rate = 0.0; ///< of a ramp at the beginning and at the end, 1/tau
  double amplitude = 0.0;
  double cycles = 1.0;

  double at(double share_done) const;
  double at_end() const { return at(1.0); }
  /// Smallest value on the way.
  double smallest() const;
  /// Largest |de/dt| on the way, 1/tau.
  double fastest() const;
};

} // namespace boba
