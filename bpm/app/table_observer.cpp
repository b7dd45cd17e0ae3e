// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/table_observer.h"

#include "bpm/dynamics/simulation.h"
#include "bpm/packing/cell_components.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace boba {

std::vector<std::string> run_table_columns(const TableParts& parts) {
  std::vector<std::string> columns = {"step",
                                      "time_tau",
                                      "stage",
                                      "strain",
                                      "phi_reference",
                                      "P_k/d",
                                      "P_normalised",
                                      "mu",
                                      "inertial_number",
                                      "kinetic_energy_kd2",
                                      "elastic_energy_kd2",
                                      "largest_overlap_d",
                                      "Lx_d",
                                      "Ly_d",
                                      "Lz_d",
                                      "xy_d",
                                      "xz_d",
                                      "yz_d",
                                      "end_gap_d",
                                      "end_force_kd",
                                      "speed_steps/s"};
  if (parts.broken_bonds) {
    columns.insert(columns.end() - 1, "broken_bonds");
  }
  if (parts.plastic_strain) {
    columns.insert(columns.end() - 1, "plastic_strain");
  }
  if (parts.stress) {
    for (const char* component : cell_components) {
      columns.push_back(std::string("stress_") + component + "_k/d");
    }
  }
  return columns;
}

bool TableObserver::wants(const StepForecast& forecast) {
  const bool due = schedule_.due(forecast); // asked at every step, whatever else is true
  return due || forecast.last_of_stage;
}

double TableObserver::steps_per_second(std::int64_t step) {
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - last_time_).count();
  const double steps = static_cast<double>(step - std::max<std::int64_t>(speed_step_, 0));
  last_time_ = now;
  speed_step_ = step;
  return seconds > 0.0 ? steps / seconds : 0.0;
}

void TableObserver::observe(const Simulation& simulation, const StageProgress& progress) {
  if (simulation.step() <= last_step_) {
    return; // the end of one stage is the beginning of the next
  }
  last_step_ = simulation.step();
  if (!writer_) {
    return;
  }
  const Totals& totals = simulation.totals();
  const Box& box = simulation.box();
  const auto [lower, upper] = simulation.end_forces();
  const bool has_ends = simulation.end_gap() != 0.0;
  const auto known = [](double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; };
  std::vector<std::optional<double>> values = {simulation.time(),
                                               static_cast<double>(progress.stage),
                                               simulation.strain(),
                                               numbers_.phi_reference(box),
                                               totals.pressure,
                                               known(numbers_.normalised(totals.pressure)),
                                               known(totals.mu()),
                                               known(numbers_.inertial_number(progress.shear_rate, totals.pressure)),
                                               totals.kinetic_energy,
                                               totals.elastic_energy,
                                               totals.largest_overlap,
                                               box.lengths()[0],
                                               box.lengths()[1],
                                               box.lengths()[2],
                                               box.xy(),
                                               box.xz(),
                                               box.yz(),
                                               has_ends ? std::optional(simulation.end_gap()) : std::nullopt,
                                               has_ends ? std::optional(0.5 * (lower + upper)) : std::nullopt};
  if (totals.n_broken_bonds) {
    values.push_back(static_cast<double>(*totals.n_broken_bonds));
  }
  if (totals.plastic_strain) {
    values.push_back(*totals.plastic_strain);
  }
  values.push_back(steps_per_second(simulation.step()));
  if (with_stress_) {
    values.insert(values.end(), totals.stress.begin(), totals.stress.end());
  }
  writer_->write(simulation.step(), values);
}

} // namespace boba
