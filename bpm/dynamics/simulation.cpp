// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/simulation.h"

#include "bpm/archive/archive.h"
#include "bpm/dynamics/blow_up_checks.h"
#include "bpm/dynamics/grain_migration.h"
#include "bpm/dynamics/motion_archive.h"
#include "bpm/dynamics/scoped_threads.h"
#include "bpm/dynamics/share_state.h"
#include "bpm/dynamics/sound_motion.h"
#include "bpm/dynamics/stage_driver.h"
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>

namespace boba {

namespace {

/// Steps between two looks for overstretched bonds, and for velocities that turn round at every step.
constexpr std::int64_t stretch_interval = 100;
constexpr std::int64_t alternation_interval = 50;

void check(const Packing& packing, const SimulationOptions& options) {
  if (packing.grains.empty()) {
    throw std::invalid_argument("simulation: the packing has no grains");
  }
  if (!(options.dt > 0.0) || !std::isfinite(options.dt)) {
    throw std::invalid_argument(fmt::format("simulation: dt = {} tau; it must be positive", options.dt));
  }
  if (options.threads < 1) {
    throw std::invalid_argument(fmt::format("simulation: threads = {}; at least 1 is needed", options.threads));
  }
  if (!(options.skin > 0.0) || !std::isfinite(options.skin)) {
    throw std::invalid_argument(fmt::format("simulation: skin = {} d; it must be positive", options.skin));
  }
}

} // namespace

void Totals::archive(Archive& archive) {
  archive.field("stress", stress);
  archive.field("pressure", pressure);
  archive.field("kinetic_energy", kinetic_energy);
  archive.field("elastic_energy", elastic_energy);
  archive.field("largest_overlap", largest_overlap);
  archive.field("n_broken_bonds", n_broken_bonds);
  archive.field("plastic_strain", plastic_strain);
}

struct Simulation::Impl {
  Impl(Packing packing, const Material& material, const SimulationOptions& options)
      : stepper(std::move(packing), material, options) {}

  Stepper stepper;
  LoadBalance load_balance;
  Totals totals;
  int stage_index = 0;
  StageDriver* driver = nullptr;           ///< of the stage that `run` is in
  std::optional<SavedState> stopped_stage; ///< of the driver, when a stage was stopped here or in a restored run
  double last_balance = 0.0;               ///< s

  StageProgress progress() const {
    StageProgress progress = driver->progress(stepper);
    progress.stage = stage_index;
    progress.name = driver->name();
    progress.shear_rate = driver->shear_rate();
    return progress;
  }

  /// The observers that want the step to come.
  std::vector<Observer*> interested(std::span<Observer* const> observers) const {
    const StepForecast forecast = {stepper.step() + 1, static_cast<double>(stepper.step() + 1) * stepper.options().dt,
                                   stepper.strain() + driver->shear_rate() * stepper.options().dt,
                                   driver->steps_left(stepper) == 1, stepper.agreement().seconds()};
    std::vector<Observer*> wanting;
    for (Observer* observer : observers) {
      if (observer->wants(forecast)) {
        wanting.push_back(observer);
      }
    }
    return wanting;
  }

  void take_step(std::span<Observer* const> observers, Simulation& self) {
    const std::vector<Observer*> wanting = interested(observers);
    const bool full = !wanting.empty() || driver->may_end(stepper);
    const bool look = (stepper.step() + 1) % alternation_interval == 0;
    const Virial virial = full || driver->needs_stress()     ? Virial::full
                          : driver->needs_pressure() || look ? Virial::trace
                                                             : Virial::none;
    stepper.advance(virial);
    if (look) {
      stepper.ranks().collectively([&] { check_alternation(stepper.moving()); });
    }
    stepper.move_cell(driver->update(stepper));
    if (stepper.step() % stretch_interval == 0) {
      check_bonds(stepper.moving());
    }
    if (full) {
      totals = totals_of(stepper.moving());
    }
    show(wanting, self);
    balance();
  }

  /// What goes wrong while one rank writes must be known to all.
  void show(std::span<Observer* const> observers, Simulation& self) const {
    for (Observer* observer : observers) {
      stepper.ranks().collectively([&] { observer->observe(self, progress()); });
    }
  }

  void balance() {
    const double now = stepper.agreement().seconds();
    if (stepper.ranks().is_distributed() && now - last_balance >= stepper.options().rebalance_seconds) {
      load_balance.rebalance(stepper.moving());
      last_balance = now;
    }
  }

  /// The driver's fields with its name, which must be the same when they are read.
  void archive_driver(Archive& archive) {
    archive.inside("simulation", [&] {
      archive.inside("stage", [&] {
        std::string name = driver->name();
        archive.field("name", name);
        if (name != driver->name()) {
          archive.fail("name", fmt::format("is \"{}\"; the run continues with a stage \"{}\"", name, driver->name()));
        }
        archive.object("driver", *driver);
      });
    });
  }

  void archive(Archive& archive) {
    archive.inside("simulation", [&] {
      archive_motion(archive, stepper.moving());
      archive.field("stage_index", stage_index);
      archive.object("totals", totals);
    });
  }

  void begin_stage(std::span<Observer* const> observers, Simulation& self) {
    if (stopped_stage) {
      Archive archive = Archive::reading_from(*stopped_stage);
      archive_driver(archive);
      stopped_stage.reset();
      return;
    }
    if (!stepper.started()) {
      stepper.start();
      totals = totals_of(stepper.moving());
    }
    driver->begin(stepper);
    show(observers, self);
  }

  RunOutcome run_stage(std::span<Observer* const> observers, const StopRequest& stop, Simulation& self) {
    begin_stage(observers, self);
    while (!driver->finished()) {
      stepper.agreement().wish_to_stop(stop && stop());
      if (stepper.agreement().stop()) {
        Archive archive = Archive::saving_to(stopped_stage.emplace());
        archive_driver(archive);
        return RunOutcome::stopped;
      }
      take_step(observers, self);
    }
    show(observers, self);
    driver->end(stepper);
    ++stage_index;
    return RunOutcome::finished;
  }
};

Simulation::Simulation(Packing packing, const Material& material, const SimulationOptions& options) {
  check(packing, options);
  impl_ = std::make_unique<Impl>(std::move(packing), material, options);
}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

RunOutcome Simulation::run(int stage_index, StageDriver& driver, std::span<Observer* const> observers,
                           const StopRequest& stop) {
  if (impl_->stopped_stage && stage_index != impl_->stage_index) {
    throw std::invalid_argument(fmt::format("simulation: stage {} was stopped; it must end before stage {} can run",
                                            impl_->stage_index, stage_index));
  }
  const ScopedThreads threads(impl_->stepper.options().threads);
  impl_->stage_index = stage_index;
  impl_->driver = &driver;
  const std::unique_ptr<StageDriver*, void (*)(StageDriver**)> in_use(&impl_->driver,
                                                                      [](StageDriver** used) { *used = nullptr; });
  return impl_->run_stage(observers, stop, *this);
}

void Simulation::evaluate() {
  if (impl_->stepper.started()) {
    throw std::logic_error("simulation: evaluate() looks at a state that has not begun to move");
  }
  impl_->stepper.evaluate_only();
  impl_->totals = totals_of(impl_->stepper.moving());
}

std::int64_t Simulation::step() const {
  return impl_->stepper.step();
}
double Simulation::time() const {
  return impl_->stepper.time();
}
double Simulation::strain() const {
  return impl_->stepper.strain();
}
const Box& Simulation::box() const {
  return impl_->stepper.box();
}
const Packing& Simulation::packing() const {
  return impl_->stepper.packing();
}
const Ranks& Simulation::ranks() const {
  return impl_->stepper.ranks();
}
const Totals& Simulation::totals() const {
  return impl_->totals;
}
Timings Simulation::timings() const {
  return timings_of(impl_->stepper.moving());
}
std::string Simulation::instruction_set() const {
  return impl_->stepper.forces().kernel_table().name;
}
Snapshot Simulation::snapshot(Parts parts) const {
  return take_snapshot(impl_->stepper.moving(), parts);
}
std::array<double, 2> Simulation::end_forces() const {
  return impl_->stepper.moving().ends.forces();
}
double Simulation::end_gap() const {
  return impl_->stepper.moving().ends.gap();
}
int Simulation::stage_index() const {
  return impl_->stage_index;
}

std::span<const int> Simulation::own_grains() const {
  return impl_->stepper.layout().grains();
}

SavedState Simulation::save() const {
  SavedState saved;
  Archive archive = Archive::saving_to(saved);
  impl_->archive(archive);
  if (impl_->driver != nullptr) {
    impl_->archive_driver(archive);
  } else if (impl_->stopped_stage) {
    saved.insert(impl_->stopped_stage->begin(), impl_->stopped_stage->end());
  }
  return saved;
}

void Simulation::restore(const SavedState& of_root) {
  SavedState of_all;
  if (ranks().is_distributed()) {
    of_all = ranks().is_root() ? of_root : SavedState();
    share_but_nodes(of_all, ranks());
  }
  const SavedState& state = ranks().is_distributed() ? of_all : of_root;
  Archive archive = Archive::reading_from(state);
  impl_->archive(archive);
  check_motion(impl_->stepper.moving());
  impl_->totals.least_pressure = least_pressure(impl_->stepper.options().precision);
  impl_->stopped_stage.reset();
  const std::string of_stage = "simulation.stage.";
  for (auto at = state.lower_bound(of_stage); at != state.end() && at->first.starts_with(of_stage); ++at) {
    (impl_->stopped_stage ? *impl_->stopped_stage : impl_->stopped_stage.emplace()).insert(*at);
  }
}

} // namespace boba
