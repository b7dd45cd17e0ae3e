// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/stepper.h"

#include "bpm/dynamics/blow_up_checks.h"
#include "bpm/dynamics/scoped_threads.h"
#include "bpm/dynamics/total_momentum.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <omp.h>

namespace boba {

namespace {

/// Steps between two looks at the range of fixed-point positions, and at the momentum of floats. In one step a node
/// moves at most half a diameter.
constexpr std::int64_t recentre_interval = 64;

} // namespace

Stepper::Stepper(Packing packing, const Material& material, const SimulationOptions& options)
    : moving_(std::move(packing), material, options), agreement_(*options.ranks) {
  agreement_.begin();
}

void Stepper::start() {
  const ScopedThreads threads(moving_.options.threads);
  moving_.started = true;
  // The dumped velocities are those of the full step: the sums must see them as they are.
  evaluate({.kick = 0.5 * moving_.options.dt, .virial = Virial::full, .residual_rate = moving_.cell.residual_rate()});
  note_momentum(moving_, moving_.cell.streaming());
}

void Stepper::evaluate_only() {
  const ScopedThreads threads(moving_.options.threads);
  evaluate({.virial = Virial::full, .residual_rate = moving_.cell.residual_rate()});
}

void Stepper::advance(Virial virial) {
  const ScopedThreads threads(moving_.options.threads);
  const double dt = moving_.options.dt;
  drift();
  const bool look = (moving_.step + 1) % recentre_interval == 0;
  if (look) {
    recentre_grains(moving_);
  }
  evaluate({.kick = dt, .half_kick = 0.5 * dt, .virial = virial, .residual_rate = moving_.cell.residual_rate()});
  ++moving_.step;
  if (look && moving_.options.precision == Precision::mixed) {
    restore_momentum(moving_);
  }
}

void Stepper::drift() {
  const double begin = omp_get_wtime();
  change_streaming();
  moving_.state.map_origins(moving_.cell.position_map(), moving_.cell.position_shift());
  const std::vector<BlockMotion> motion = moving_.forces.drift(moving_.state, drift_of_step());
  moving_.integration_seconds += omp_get_wtime() - begin;
  note_motion(motion);
  moving_.cell.note_drift();
  note_motion_along_gradient(moving_);
}

/// Brings the velocities to the profile that the next positions are to have. Peculiar velocities stay as they are, and
/// once the last of the profile is gone, so is what rounding and the motion along its gradient have added to the whole.
void Stepper::change_streaming() {
  const MovingCell& cell = moving_.cell;
  const Matrix3 change = cell.streaming_change();
  if (change == Matrix3::Zero()) {
    return;
  }
  const std::vector<Block>& blocks = moving_.layout.blocks();
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    moving_.state.add_profile(blocks[b], change, cell.box().origin());
  }
  if (cell.next_streaming() == Matrix3::Zero()) {
    restore_momentum_without_streaming(moving_);
  }
}

kernels::Drift Stepper::drift_of_step() const {
  const MovingCell& cell = moving_.cell;
  kernels::Drift drift{};
  drift.dt = moving_.options.dt;
  drift.mapped = cell.position_map() != Matrix3::Identity();
  const Vector3 shift = cell.position_shift();
  const Vector3 residual = (cell.residual_rate() * cell.box().h_inverse()).row(0);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      drift.map[row][column] = cell.position_map()(row, column);
    }
    drift.shift[row] = shift[row];
    drift.residual[row] = residual[row];
  }
  drift.residual_shift = -residual.dot(cell.box().origin());
  drift.dither_seed = static_cast<std::uint64_t>(moving_.step + 1) << 32; // the kernel adds the node's number
  return drift;
}

void Stepper::note_motion(const std::vector<BlockMotion>& motion) {
  const double begin = omp_get_wtime();
  double largest2 = 0.0, common2 = 0.0; // beyond all limits when a node has no finite velocity
  for (const BlockMotion& of_block : motion) {
    largest2 = std::isfinite(of_block.checksum) ? std::max(largest2, of_block.largest_speed2)
                                                : std::numeric_limits<double>::infinity();
    common2 = std::max(common2, of_block.common_speed2);
  }
  const Agreement::Speeds speeds = agreement_.exchange({std::sqrt(largest2), std::sqrt(common2)});
  moving_.reduction_seconds += omp_get_wtime() - begin;
  if (!(speeds.largest <= largest_allowed_speed(moving_))) {
    moving_.ranks().collectively([&] { check_drift(moving_, motion); });
  }
  const double dt = moving_.options.dt;
  moving_.forces.note_motion(moving_.cell.map(), dt * speeds.largest, dt * speeds.common);
}

void Stepper::evaluate(Evaluation what) {
  what.keep_forces = what.virial == Virial::full || moving_.ends.has_clamps();
  moving_.forces.evaluate(moving_.state, moving_.cell.box(), what);
  moving_.forces_kept = what.keep_forces;
  moving_.cell.note_evaluation();
  for (Clamp& clamp : moving_.ends.clamps()) {
    apply_clamp(clamp, moving_.layout, moving_.state, moving_.distribution);
  }
  const double begin = omp_get_wtime();
  moving_.forces.share_sums(what.virial);
  moving_.reduction_seconds += omp_get_wtime() - begin;
  if (what.virial != Virial::none) {
    sum_up();
  }
}

void Stepper::sum_up() {
  double virial = 0.0, kinetic = 0.0;
  for (const GrainSums& grain : moving_.forces.grain_sums()) { // in the packing's order, whatever the threads
    virial += grain.virial_trace;
    kinetic += grain.kinetic_trace;
  }
  moving_.pressure = (virial + kinetic) / (3.0 * moving_.cell.evaluated_box().volume());
  moving_.kinetic_energy = 0.5 * kinetic;
}

void Stepper::move_cell(const CellRates& rates) {
  const Matrix3 gradient = rates.dilation * Matrix3::Identity() + simple_shear(rates.shear) + rates.gradient;
  moving_.cell.add_strain((rates.shear + rates.strain_rate) * moving_.options.dt);
  deform_cell(gradient, rates.remap == Remap::positions ? gradient : Matrix3(gradient.diagonal().asDiagonal()));
}

void Stepper::deform_cell(const Matrix3& gradient, const Matrix3& of_positions) {
  // A periodic template's bonds name their images by the cell vectors it was made with: its cell is never flipped.
  const bool may_flip = !moving_.forces.bonds().has_periodic_template();
  if (moving_.cell.deform(gradient, of_positions, moving_.options.dt, may_flip)) {
    moving_.forces.forget_contacts();
  }
}

} // namespace boba
