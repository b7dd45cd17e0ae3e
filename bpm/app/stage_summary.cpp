// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/stage_summary.h"

#include "bpm/app/progress_display.h"
#include "bpm/dynamics/simulation.h"

#include <cmath>
#include <fmt/format.h>

namespace boba {

void StageSummary::begin(const Simulation& simulation) {
  *this = StageSummary(numbers_);
  first_step_ = simulation.step();
  first_strain_ = simulation.strain();
}

void StageSummary::add(const Simulation& simulation, double share_done) {
  if (share_done >= 0.5) {
    n_ += 1.0;
    if (const double mu = simulation.totals().mu(); std::isfinite(mu)) {
      mu_ += mu;
      n_mu_ += 1.0;
    }
    pressure_ += simulation.totals().pressure;
    phi_ += numbers_.phi_reference(simulation.box());
  }
}

std::string StageSummary::text(const Simulation& simulation, const std::string& name) const {
  const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
  const auto steps = static_cast<double>(simulation.step() - first_step_);
  std::string text = name + ":";
  const double strain = simulation.strain() - first_strain_;
  // A sheared packing fluctuates: means. Any other stage is told by where it ends.
  const bool sheared = strain != 0.0 && n_ > 0.0;
  const double pressure = sheared ? pressure_ / n_ : simulation.totals().pressure;
  const double phi = sheared ? phi_ / n_ : numbers_.phi_reference(simulation.box());
  if (sheared) {
    text += fmt::format(" strain {:.4g}; means of its second half: mu {:.3f},", strain, mu_ / n_mu_);
  }
  text += numbers_.modulus ? fmt::format(" P~ {:.4g},", numbers_.normalised(pressure)) : "";
  text += fmt::format(" P {:.4g} k/d, phi_reference {:.4f},", pressure, phi);
  return text + fmt::format(" {:.0f} steps in {}, {:.3g} M node-steps/s", steps, readable_duration(seconds),
                            seconds > 0.0 ? steps * static_cast<double>(numbers_.n_nodes) / seconds * 1e-6 : 0.0);
}

} // namespace boba
