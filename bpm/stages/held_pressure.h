// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/archive/archive.h"
#include "bpm/dynamics/barostat.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/stages/held_pressure_report.h"

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
  /// d ln L / dt of the cell after a step, 1/tau; 0 when no pressure is held. `share_done` of the stage: 0 .. 1.
  double dilation_rate(const Stepper& stepper, double share_done);
  const HeldPressureReport& report() const { return report_; }
  bool has_missed() const { return is_held() && report_.has_steps() && report_.is_missed(); }

  void archive(Archive& archive) {
    archive.field("gain", gain_);
    archive.object("report", report_);
  }

private:
  std::optional<Barostat> barostat_;
  double gain_ = 0.0; ///< d/(k tau)
  HeldPressureReport report_;
};

} // namespace boba
