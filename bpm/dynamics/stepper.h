// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/agreement.h"
#include "bpm/dynamics/barostat.h"
#include "bpm/dynamics/clamp.h"
#include "bpm/dynamics/remap.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/forces/force_field.h"
#include "bpm/packing/lane_state.h"
#include "bpm/parallel/distribution.h"
#include "bpm/parallel/placement.h"
#include "bpm/parallel/star_forest.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace boba {

/// How the cell moves at the end of a step.
struct CellRates {
  double shear = 0.0; ///< d(xy)/dt over the current Ly, 1/tau
  Remap remap = Remap::positions;
  double dilation = 0.0; ///< d ln L / dt of all three axes, 1/tau; always acts on positions
};

/// Advances a packing by velocity Verlet in its leapfrog form, one pass over the nodes a step:
///
///     v(n+1/2) = v(n-1/2) + dt/m f(n)          in the pass that computes f(n), node by node
///     x(n+1)   = M(n) x(n) + dt v(n+1/2)       M(n): the cell's motion at the end of step n
///
/// The full-step velocity is v(n) = v(n+1/2) - dt/2m f(n). The map M is applied with the next drift; `snapshot`
/// applies it to what it hands out, so that positions and cell of a snapshot belong together.
/// Source: docs/notation.md, "Time".
class Stepper {
public:
  Stepper(Packing packing, const Material& material, const SimulationOptions& options);

  /// Forces at the start, and the half kick that turns full-step velocities into half-step ones. Once.
  void start();
  bool started() const { return started_; }
  /// Forces and sums at the present state, which must not have started; nothing moves.
  void evaluate_only();
  /// The volume pass of every block alone, for the benchmark.
  void volumes_only() { forces_.volumes_only(state_); }
  /// Drift, forces, kick. The cell stands still; see move_cell.
  void advance(Virial virial);
  /// After a step with a virial: \throws BlowUp when the velocities of some grains turn round at every step. The
  /// velocity of a full step is the mean of two half steps, so that it then nearly vanishes. Beyond the stable step a
  /// vibration may stay finite like this for good, because it stretches its bonds: nothing else would show it.
  void check_alternation() const;
  /// Moves the cell at the end of a step, flips it when it leans too far, and advances time and strain.
  void move_cell(const CellRates& rates);
  /// The same for any velocity gradient of the cell (upper triangular), of which `of_positions` acts on the nodes.
  void deform_cell(const Matrix3& gradient, const Matrix3& of_positions);
  /// The part of the cell's velocity gradient that does not act on positions: images move with it.
  void set_residual_gradient(const Matrix3& gradient) { residual_rate_ = gradient * box_.h(); }
  /// Adds (sign = 1) or removes (-1) the linear velocity profile of a shear that does not act on positions.
  void add_streaming(double rate, double sign);

  double pressure() const { return pressure_; }
  double kinetic_energy() const { return kinetic_energy_; }
  double bond_energy() const { return forces_.bond_energy(state_, box_); }
  /// Bulk modulus of the packing under an affine change of volume, from two evaluations at +- 1e-5 in length (k/d).
  double affine_bulk_modulus();
  /// Time sound needs across the cell's shortest side, with the modulus above (tau).
  double sound_crossing(double bulk_modulus) const;
  Totals totals() const; ///< needs an evaluation with Virial::full
  /// \throws std::logic_error when velocities or forces are asked for at a step that nobody asked the full stress of:
  /// its forces were not kept.
  Snapshot snapshot(Simulation::Parts parts) const;
  /// Smallest and largest z of any node, d.
  std::array<double, 2> extent_z() const;

  const Packing& packing() const { return packing_; }
  const LaneLayout& layout() const { return layout_; }
  const Box& box() const { return box_; }
  const ForceField& forces() const { return forces_; }
  ForceField& forces() { return forces_; }
  const SimulationOptions& options() const { return options_; }
  std::int64_t step() const { return step_; }
  double time() const { return static_cast<double>(step_) * options_.dt; }
  double strain() const { return strain_; }
  double node_diameter() const { return material_.diameter; }
  /// Over all ranks' grains.
  ForceField::Stretch largest_stretch() const;
  std::vector<Clamp>& clamps() { return clamps_; }
  void set_clamps(std::vector<Clamp> clamps) { clamps_ = std::move(clamps); }
  /// All nodes with z in [low, high] as a clamp at rest.
  Clamp nodes_between(double low, double high) const;
  /// Force of the material on the lower and the upper end (walls or clamps), positive when it pushes them apart, k d.
  std::array<double, 2> end_forces() const;
  double end_gap() const { return end_gap_; }
  void set_end_gap(double gap) { end_gap_ = gap; }
  const Ranks& ranks() const { return *distribution_.ranks; }
  Agreement& agreement() { return agreement_; }
  const Agreement& agreement() const { return agreement_; }
  const Distribution& distribution() const { return distribution_; }
  /// Gives grains other owners; nothing else changes. Collective.
  void move_grains(std::vector<int> owner);
  /// Looks whether the work is spread evenly by what it has cost lately, and moves grains if that gains enough.
  void rebalance();
  Timings timings() const;
  /// Memory of everything that grows with the number of grains: state, contact list, the packing as it began.
  std::size_t bytes() const;

  void save(SavedState& saved) const;
  /// \throws std::runtime_error, std::out_of_range when the state belongs to another packing or lacks a number.
  void restore(const SavedState& saved);

private:
  PlacementInput placement_input() const;
  std::vector<std::byte> own_nodes() const;
  void scatter_nodes(const std::vector<std::byte>& all);
  /// Values of this rank's nodes become those of all nodes, on rank 0.
  void gather(std::vector<Vector3>& values) const;
  /// A value a grain, known to its owner, for all.
  void share_grains(std::vector<Vector3>& values) const;
  std::unique_ptr<StarForest> forest_from_root() const;
  void save_nodes(SavedState& saved) const;
  void restore_nodes(const SavedState& saved);
  void save_ends(SavedState& saved) const;
  void restore_ends(const SavedState& saved);
  Vector3 velocity_sum() const;
  void note_momentum();
  void restore_momentum();
  void drift();
  double largest_allowed_speed() const { return 0.5 * material_.diameter / options_.dt; }
  Agreement::Speeds largest_speeds(const std::vector<BlockMotion>& results) const;
  void check_drift(const std::vector<BlockMotion>& results) const;
  void evaluate(Evaluation what);
  void sum_up();
  double virial_pressure_when_scaled(const std::vector<Vector3>& x, double factor);

  Packing packing_;
  Material material_;
  SimulationOptions options_;
  Distribution distribution_;
  Agreement agreement_;
  LaneLayout layout_;
  LaneState state_;
  ForceField forces_;
  Box box_;
  std::vector<Clamp> clamps_;
  double end_gap_ = 0.0; ///< between the ends of a pressed specimen, d
  bool started_ = false;
  bool forces_kept_ = false; ///< state_.f holds the forces of the last evaluation
  std::int64_t step_ = 0;
  double strain_ = 0.0;
  Matrix3 cell_map_ = Matrix3::Identity();     ///< of the whole cell, at the end of the last step
  Matrix3 position_map_ = Matrix3::Identity(); ///< the part of it that acts on positions, not yet applied
  Matrix3 residual_rate_ = Matrix3::Zero();    ///< the rest, as a rate of the cell matrix
  double evaluated_volume_ = 1.0;              ///< of the cell that the last forces belong to
  double pressure_ = 0.0, kinetic_energy_ = 0.0;
  Vector3 velocity_sum_ =
      Vector3::Zero(); ///< of all nodes, that is the momentum over a node's mass, when the run began
  double integration_seconds_ = 0.0;
  mutable double reduction_seconds_ = 0.0;
  double worked_until_ = 0.0; ///< seconds of work at the last look at the balance
  std::int64_t migrated_grains_ = 0;
};

} // namespace boba
