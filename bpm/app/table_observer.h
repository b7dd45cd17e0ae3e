// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/schedule.h"
#include "bpm/archive/archive.h"
#include "bpm/dynamics/observer.h"
#include "bpm/io/table.h"
#include "bpm/packing/packing_numbers.h"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace boba {

/// Columns of table.csv that only some scenes have.
struct TableParts {
  bool broken_bonds = false;   ///< how many bonds are broken
  bool plastic_strain = false; ///< mean plastic strain of the bonds that may yield
  bool stress = false;         ///< all components of the stress
};

/// Columns of table.csv, in order; each name carries its unit.
/// Source: docs/formats.md, "Table".
std::vector<std::string> run_table_columns(const TableParts& parts);

/// Writes a row of table.csv at the ends of stages and whenever the schedule says so, each step once.
class TableObserver : public Observer {
public:
  /// Without a writer it looks on and writes nothing.
  TableObserver(std::optional<TableWriter> writer, const Schedule& schedule, const PackingNumbers& numbers,
                std::int64_t last_step, bool with_stress)
      : writer_(std::move(writer)), schedule_(schedule), numbers_(numbers), last_step_(last_step),
        speed_step_(last_step), with_stress_(with_stress) {}

  bool wants(const StepForecast& forecast) override;
  void observe(const Simulation& simulation, const StageProgress& progress) override;
  void archive(Archive& archive) {
    archive.field("last_step", last_step_);
    StrainPath path = schedule_.path();
    archive.object("strain_path", path);
  }

private:
  double steps_per_second(std::int64_t step);

  using Clock = std::chrono::steady_clock;
  std::optional<TableWriter> writer_;
  Schedule schedule_;
  PackingNumbers numbers_;
  std::int64_t last_step_, speed_step_;
  bool with_stress_;
  Clock::time_point last_time_ = Clock::now();
};

} // namespace boba
