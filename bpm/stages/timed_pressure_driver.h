// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/stages/held_pressure.h"
#include "bpm/stages/timed_driver.h"

#include <optional>

namespace boba {

/// The driver of a stage that lasts a known time and may hold a pressure meanwhile.
class TimedPressureDriver : public TimedDriver {
public:
  explicit TimedPressureDriver(const std::optional<Barostat>& barostat) : pressure_(barostat) {}

  bool needs_pressure() const override { return pressure_.is_held(); }
  std::string report() const override { return pressure_.is_held() ? pressure_.report().text() : ""; }
  bool has_missed() const override { return pressure_.has_missed(); }
  void archive(Archive& archive) override {
    archive.object("steps", steps_);
    archive.object("pressure", pressure_);
  }

protected:
  HeldPressure pressure_;
};

} // namespace boba
