// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/observer.h"
#include "bpm/packing/packing_numbers.h"

#include <chrono>
#include <string>

namespace boba {

/// Adds up what the line at the end of a stage says. Looks only at steps that the stress is computed on anyway.
class StageSummary {
public:
  explicit StageSummary(const PackingNumbers& numbers) : numbers_(numbers) {}

  void begin(const Simulation& simulation);
  /// A step with its totals; those of the stage's second half count for means.
  void add(const Simulation& simulation, double share_done);
  /// "shear: strain 1, P~ 0.1, phi_reference 0.8, mu 0.13 (mean of the second half), 10000 steps in 12 s, ..."
  std::string text(const Simulation& simulation, const std::string& name) const;

private:
  using Clock = std::chrono::steady_clock;
  PackingNumbers numbers_;
  Clock::time_point begin_ = Clock::now();
  std::int64_t first_step_ = 0;
  double first_strain_ = 0.0;
  double n_ = 0.0, n_mu_ = 0.0, mu_ = 0.0, pressure_ = 0.0, phi_ = 0.0;
};

} // namespace boba
