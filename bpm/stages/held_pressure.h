// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/barostat.h"
#include "bpm/dynamics/simulation.h"

#include <optional>

namespace boba {

class Stepper;

/// The pressure that a stage holds, if it holds one: a barostat whose gain is settled when the stage begins.
class HeldPressure {
public:
  explicit HeldPressure(const std::optional<Barostat>& barostat) : barostat_(barostat) {}

  bool is_held() const { return barostat_.has_value(); }
  /// Settles the gain for a packing that is sheared at `shear_rate` (1/tau).
  void begin(Stepper& stepper, double shear_rate);
  /// d ln L / dt of the cell after a step, 1/tau; 0 when no pressure is held.
  double dilation_rate(const Stepper& stepper) const;

  void save(SavedState& saved) const { saved.real["driver"] = {gain_}; }
  void restore(const SavedState& saved) { gain_ = saved.real.at("driver").at(0); }

private:
  std::optional<Barostat> barostat_;
  double gain_ = 0.0; ///< d/(k tau)
};

} // namespace boba
