// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/archive/saved_state.h"
#include "bpm/dynamics/observer.h"
#include "bpm/laws/material.h"
#include "bpm/packing/lane_layout.h"
#include "bpm/packing/packing.h"
#include "bpm/packing/snapshot.h"
#include "bpm/parallel/ranks.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace boba {

class Archive;
class StageDriver;

struct SimulationOptions {
  double dt = 0.1; ///< tau
  int threads = 1;
  double skin = 0.3; ///< d; margin of the contact list
  Precision precision = Precision::full;
  const Ranks* ranks = &Ranks::alone(); ///< must outlive the simulation
  double rebalance_seconds = 60.0;      ///< between two looks at how the work is spread over the ranks; 0: every step
};

/// Sums over the packing at the present step. Stress: tension positive, xx yy zz xy xz yz, k/d.
struct Totals {
  std::array<double, 6> stress{}; ///< all parts, kinetic included
  double pressure = 0.0;          ///< -(xx + yy + zz) / 3, k/d
  double kinetic_energy = 0.0;    ///< k d^2, full-step velocities
  double elastic_energy = 0.0;    ///< k d^2, pairwise part of bonds and contacts (the many-body term has no energy)
  double largest_overlap = 0.0;   ///< d, over all contacts
  double least_pressure = 1e-12;  ///< k/d; a pressure below it cannot be told from rounding
  std::optional<std::int64_t> n_broken_bonds; ///< absent where bonds do not break
  std::optional<double> plastic_strain;       ///< mean of the bonds that may yield; absent where none does
  /// Shear stress over pressure; not a number where the pressure cannot be told from rounding.
  double mu() const {
    return std::abs(pressure) > least_pressure ? stress[3] / pressure : std::numeric_limits<double>::quiet_NaN();
  }
  void archive(Archive& archive);
};

/// Seconds spent in each part of the steps so far, for the benchmark and the log.
struct Timings {
  double bonds = 0.0, contacts = 0.0, search = 0.0, integration = 0.0;
  double halo = 0.0, reductions = 0.0; ///< waiting for other ranks: for their nodes, for what all must know
  std::int64_t steps = 0, list_builds = 0;
  std::int64_t halo_messages = 0, halo_bytes = 0, halo_builds = 0, migrated_grains = 0; ///< received by this rank
};

/// A blow-up: the run cannot go on. The message names node, grain, step and a likely cause.
class BlowUp : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// The run was told to stop (signal, wall-time limit) and is at a step from which it can go on.
enum class RunOutcome { finished, stopped };

/// A packing in motion: the engine's only public face.
///
/// With several ranks, all make the same calls, and everything but the mere looks (step, time, box, totals ...) is
/// collective. Whole packings are handed out to rank 0 alone, or to all who ask for it.
class Simulation {
public:
  /// \throws std::invalid_argument for a packing or an option outside its range.
  Simulation(Packing packing, const Material& material, const SimulationOptions& options);
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Called between steps; return true to stop (a signal, a wall-time limit).
  using StopRequest = std::function<bool()>;
  /// Runs one stage to its end: from its beginning or, when this stage was stopped (here, or in the run that `restore`
  /// took over), from where it was. The driver is used during the call alone.
  /// \throws BlowUp, std::runtime_error when the stage cannot reach its goal; SavedStateError or std::invalid_argument
  /// when another stage was stopped and has not ended.
  RunOutcome run(int stage_index, StageDriver& driver, std::span<Observer* const> observers,
                 const StopRequest& stop = {});
  /// The same for a driver that is made in the call: `simulation.run(0, HoldDriver({.time = 10.0}), {})`.
  RunOutcome run(int stage_index, StageDriver&& driver, std::span<Observer* const> observers,
                 const StopRequest& stop = {}) {
    return run(stage_index, driver, observers, stop);
  }

  /// Forces and stress at the present positions and velocities, without moving anything.
  void evaluate();

  std::int64_t step() const;
  double time() const;
  double strain() const;
  const Box& box() const;
  /// As it was at the start; templates and grains do not change. Only rank 0 keeps ids, positions and velocities.
  const Packing& packing() const;
  const Ranks& ranks() const;
  const Totals& totals() const; ///< of the last step an observer asked for
  Timings timings() const;
  std::string instruction_set() const; ///< "avx512", "avx2" or "baseline"

  struct Parts {
    bool velocity = false;
    bool force = false;
    bool positions_on_all_ranks = false; ///< of all nodes, 24 bytes each on every rank; otherwise on rank 0 alone
    bool own = false; ///< with several ranks: no gathering, each has the nodes of its own grains (Snapshot::grains)
  };
  /// What is not asked for on all ranks, stresses of grains included, is there on rank 0 alone.
  Snapshot snapshot(Parts parts) const;
  Snapshot snapshot() const { return snapshot(Parts{}); }
  /// Forces on the two ends of a `press` stage, along z (k d): lower, upper.
  std::array<double, 2> end_forces() const;
  /// Distance between the two ends (walls or clamps) at present, d; 0 when there are none.
  double end_gap() const;

  /// Fields below "simulation", the same for any number of ranks: of those of nodes (node_fields) each rank has the
  /// nodes of its own grains (own_grains), everything else is there on rank 0.
  SavedState save() const;
  /// Grains that this rank owns, ascending; with one rank all.
  std::span<const int> own_grains() const;
  /// Rank 0's state for all; fields of others may be among it. \throws SavedStateError when a field is missing or is
  /// not that of this packing.
  void restore(const SavedState& state);
  /// Index of the stage that a restored state is in (or that comes next).
  int stage_index() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace boba
