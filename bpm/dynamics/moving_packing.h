// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/moving_cell.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/dynamics/specimen_ends.h"
#include "bpm/forces/force_field.h"
#include "bpm/packing/lane_state.h"
#include "bpm/parallel/distribution.h"

#include <cstddef>
#include <cstdint>

namespace boba {

/// A packing in motion: what it is made of, where its nodes and its cell are, and the sums of the last evaluation.
/// These are data. Stepper moves them; other files look at them (take_snapshot.h, elastic_probe.h), store them
/// (motion_archive.h), spread them over ranks (grain_migration.h) or watch over them (blow_up_checks.h,
/// total_momentum.h).
struct MovingPacking {
  MovingPacking(Packing packing, const Material& material, const SimulationOptions& options);
  MovingPacking(const MovingPacking&) = delete;
  MovingPacking& operator=(const MovingPacking&) = delete;

  const Ranks& ranks() const { return *distribution.ranks; }
  double time() const { return static_cast<double>(step) * options.dt; }
  double n_nodes() const { return static_cast<double>(packing.first_nodes().back()); }
  /// Over all nodes, k d^2.
  double bond_energy() const { return forces.survey(state).energy(cell.box()); }

  Packing packing; ///< as it was at the start; rank 0 alone keeps ids, positions and velocities
  Material material;
  SimulationOptions options;
  Distribution distribution;
  LaneLayout layout; ///< of this rank's grains
  LaneState state;   ///< velocities are those of half steps once it has started
  ForceField forces;
  MovingCell cell;
  SpecimenEnds ends;
  bool started = false;
  bool forces_kept = false; ///< state.f holds the forces of the last evaluation
  std::int64_t step = 0;
  double pressure = 0.0;       ///< k/d
  double kinetic_energy = 0.0; ///< k d^2
  /// Sum of all nodes' velocities without streaming when it was noted (total_momentum.h).
  Vector3 noted_momentum = Vector3::Zero();
  /// What that sum loses while the packing as a whole moves along the streaming's gradient: the integral of the
  /// streaming times the whole sum of velocities over time, d/tau.
  Vector3 momentum_along_gradient = Vector3::Zero();
  double integration_seconds = 0.0, reduction_seconds = 0.0;
  std::int64_t migrated_grains = 0;
};

/// Seconds spent so far in each part of the steps, and what was exchanged with other ranks.
Timings timings_of(const MovingPacking& moving);

/// Memory of everything that grows with the number of grains: state, contact list, the packing as it began.
std::size_t bytes_of(const MovingPacking& moving);

} // namespace boba
