// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/agreement.h"
#include "bpm/dynamics/moving_packing.h"

#include <cstdint>
#include <vector>

namespace boba {

/// Advances a packing by velocity Verlet in its leapfrog form, one pass over the nodes a step:
///
///     v(n+1/2) = v(n-1/2) + dt/m f(n)          in the pass that computes f(n), node by node
///     x(n+1)   = M(n) x(n) + dt v(n+1/2)       M(n): the cell's motion at the end of step n
///
/// The full-step velocity is v(n) = v(n+1/2) - dt/2m f(n). What is decided about the cell at the end of a step reaches
/// the nodes with the next drift: the map M, and the change of the velocity profile where images move and positions do
/// not follow them.
/// Source: docs/notation.md, "Time".
class Stepper {
public:
  Stepper(Packing packing, const Material& material, const SimulationOptions& options);

  /// Forces at the start, and the half kick that turns full-step velocities into half-step ones. Once.
  void start();
  /// Forces and sums at the present state, which must not have started; nothing moves.
  void evaluate_only();
  /// Drift, forces, kick. The cell stands still; see move_cell.
  void advance(Virial virial);
  /// Moves the cell at the end of a step, flips it when it leans too far, and adds to the strain.
  void move_cell(const CellRates& rates);
  /// The same for any velocity gradient of the cell (upper triangular), of which `of_positions` acts on the nodes.
  void deform_cell(const Matrix3& gradient, const Matrix3& of_positions);
  /// Before the start: the velocities hold the linear profile of this gradient already, and images move with it.
  void assume_streaming(const Matrix3& gradient) { moving_.cell.assume_streaming(gradient); }

  MovingPacking& moving() { return moving_; }
  const MovingPacking& moving() const { return moving_; }
  Agreement& agreement() { return agreement_; }
  const Agreement& agreement() const { return agreement_; }

  bool started() const { return moving_.started; }
  double pressure() const { return moving_.pressure; }
  double kinetic_energy() const { return moving_.kinetic_energy; }
  double bond_energy() const { return moving_.bond_energy(); }
  const Packing& packing() const { return moving_.packing; }
  const LaneLayout& layout() const { return moving_.layout; }
  const Box& box() const { return moving_.cell.box(); }
  const ForceField& forces() const { return moving_.forces; }
  ForceField& forces() { return moving_.forces; }
  SpecimenEnds& ends() { return moving_.ends; }
  const SimulationOptions& options() const { return moving_.options; }
  std::int64_t step() const { return moving_.step; }
  double time() const { return moving_.time(); }
  double strain() const { return moving_.cell.strain(); }
  double contact_range() const { return moving_.forces.contact_range(); } ///< between grains, d
  const Ranks& ranks() const { return moving_.ranks(); }
  const Distribution& distribution() const { return moving_.distribution; }

private:
  void drift();
  void change_streaming();
  void evaluate(Evaluation what);
  void sum_up();
  /// What the drift of every block applies.
  kernels::Drift drift_of_step() const;
  /// Tells the other ranks of the largest speeds, looks for a blow-up, and tells the contact list of the motion.
  void note_motion(const std::vector<BlockMotion>& motion);

  MovingPacking moving_;
  Agreement agreement_;
};

} // namespace boba
