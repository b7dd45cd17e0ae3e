// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/simulation.h"

#include "bpm/dynamics/blow_up.h"
#include "bpm/dynamics/share_state.h"
#include "bpm/dynamics/stage_driver.h"
#include "bpm/dynamics/stepper.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
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

struct Simulation::Impl {
  Impl(Packing packing, const Material& material, const SimulationOptions& options)
      : stepper(std::move(packing), material, options) {}

  Stepper stepper;
  Totals totals;
  int stage_index = 0;
  std::unique_ptr<StageDriver> driver;        ///< of the stage that is under way
  std::unique_ptr<SavedState> saved_in_stage; ///< a restored stage waits here for `run` to name it
  double last_balance = 0.0;                  ///< s

  StageProgress progress(const Stage& stage) const {
    StageProgress progress = driver->progress(stepper);
    progress.stage = stage_index;
    progress.name = stage_name(stage);
    return progress;
  }

  /// The observers that want the step to come.
  std::vector<Observer*> interested(std::span<Observer* const> observers, double rate) const {
    const StepForecast forecast = {stepper.step() + 1, static_cast<double>(stepper.step() + 1) * stepper.options().dt,
                                   stepper.strain() + rate * stepper.options().dt, driver->steps_left(stepper) == 1,
                                   stepper.agreement().seconds()};
    std::vector<Observer*> wanting;
    for (Observer* observer : observers) {
      if (observer->wants(forecast)) {
        wanting.push_back(observer);
      }
    }
    return wanting;
  }

  void take_step(const Stage& stage, std::span<Observer* const> observers, Simulation& self) {
    const auto* shear = std::get_if<ShearStage>(&stage);
    const std::vector<Observer*> wanting = interested(observers, shear != nullptr ? shear->rate : 0.0);
    const bool full = !wanting.empty() || driver->may_end(stepper);
    const bool look = (stepper.step() + 1) % alternation_interval == 0;
    const Virial virial = full ? Virial::full : driver->needs_pressure() || look ? Virial::trace : Virial::none;
    stepper.advance(virial);
    if (look) {
      stepper.ranks().together([&] { stepper.check_alternation(); });
    }
    stepper.move_cell(driver->update(stepper));
    check_bonds();
    if (full) {
      totals = stepper.totals();
    }
    show(wanting, stage, self);
    balance();
  }

  /// What goes wrong while one rank writes must be known to all.
  void show(std::span<Observer* const> observers, const Stage& stage, Simulation& self) const {
    for (Observer* observer : observers) {
      stepper.ranks().together([&] { observer->observe(self, progress(stage)); });
    }
  }

  void balance() {
    const double now = stepper.agreement().seconds();
    if (stepper.ranks().many() && now - last_balance >= stepper.options().rebalance_seconds) {
      stepper.rebalance();
      last_balance = now;
    }
  }

  void check_bonds() const {
    if (stepper.step() % stretch_interval == 0) {
      const ForceField::Stretch stretch = stepper.largest_stretch();
      if (!(stretch.ratio <= largest_bond_stretch)) {
        throw BlowUp(describe_stretched_bond(stretch, stepper.step(), stepper.options().dt));
      }
    }
  }

  void begin_stage(const Stage& stage, std::span<Observer* const> observers, Simulation& self) {
    driver = make_stage_driver(stage);
    if (saved_in_stage) {
      driver->restore(*saved_in_stage, stepper);
      saved_in_stage.reset();
      return;
    }
    if (!stepper.started()) {
      stepper.start();
      totals = stepper.totals();
    }
    driver->begin(stepper);
    show(observers, stage, self);
  }
};

Simulation::Simulation(Packing packing, const Material& material, const SimulationOptions& options) {
  check(packing, options);
  impl_ = std::make_unique<Impl>(std::move(packing), material, options);
}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

RunOutcome Simulation::run(int stage_index, const Stage& stage, std::span<Observer* const> observers,
                           const StopRequest& stop) {
  impl_->stage_index = stage_index;
  impl_->begin_stage(stage, observers, *this);
  while (!impl_->driver->finished()) {
    impl_->stepper.agreement().wish_to_stop(stop && stop());
    if (impl_->stepper.agreement().stop()) {
      return RunOutcome::stopped;
    }
    impl_->take_step(stage, observers, *this);
  }
  impl_->show(observers, stage, *this);
  impl_->driver->end(impl_->stepper);
  impl_->driver.reset();
  ++impl_->stage_index;
  return RunOutcome::finished;
}

void Simulation::evaluate() {
  if (impl_->stepper.started()) {
    throw std::logic_error("simulation: evaluate() looks at a state that has not begun to move");
  }
  impl_->stepper.evaluate_only();
  impl_->totals = impl_->stepper.totals();
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
  return impl_->stepper.timings();
}
std::string Simulation::instruction_set() const {
  return impl_->stepper.forces().kernel_table().name;
}
Snapshot Simulation::snapshot(Parts parts) const {
  return impl_->stepper.snapshot(parts);
}
std::array<double, 2> Simulation::end_forces() const {
  return impl_->stepper.end_forces();
}
double Simulation::end_gap() const {
  return impl_->stepper.end_gap();
}
int Simulation::stage_index() const {
  return impl_->stage_index;
}

std::span<const int> Simulation::own_grains() const {
  return impl_->stepper.layout().grains();
}

SavedState Simulation::save() const {
  SavedState saved;
  impl_->stepper.save(saved);
  saved.integer["stage"] = {impl_->stage_index, impl_->driver ? 1 : 0};
  const Totals& totals = impl_->totals;
  saved.real["totals"] = {totals.pressure, totals.kinetic_energy, totals.elastic_energy, totals.largest_overlap};
  saved.real["totals_stress"] = {totals.stress.begin(), totals.stress.end()};
  if (impl_->driver) {
    impl_->driver->save(saved);
  }
  return saved;
}

namespace {

/// Rank 0's state for all, but for the nodes.
SavedState shared(SavedState state, const Ranks& ranks) {
  if (!ranks.is_root()) {
    state = {};
  }
  share_but_nodes(state.real, ranks);
  share_but_nodes(state.integer, ranks);
  return state;
}

} // namespace

void Simulation::restore(const SavedState& of_root) {
  const SavedState of_all = ranks().many() ? shared(of_root, ranks()) : SavedState{};
  const SavedState& state = ranks().many() ? of_all : of_root;
  try {
    impl_->stepper.restore(state);
    impl_->stage_index = static_cast<int>(state.integer.at("stage").at(0));
    const std::vector<double>& totals = state.real.at("totals");
    impl_->totals.pressure = totals.at(0);
    impl_->totals.kinetic_energy = totals.at(1);
    impl_->totals.elastic_energy = totals.at(2);
    impl_->totals.largest_overlap = totals.at(3);
    std::copy_n(state.real.at("totals_stress").begin(), 6, impl_->totals.stress.begin());
    impl_->driver.reset();
    impl_->saved_in_stage.reset();
    if (state.integer.at("stage").at(1) != 0) {
      impl_->saved_in_stage = std::make_unique<SavedState>(state);
      for (const std::string& name : entries_of_nodes) {
        impl_->saved_in_stage->real.erase(name);
        impl_->saved_in_stage->integer.erase(name);
      }
    }
  } catch (const std::out_of_range&) {
    throw std::runtime_error("saved state: a number is missing; it was written by another version of Boba");
  }
}

} // namespace boba
