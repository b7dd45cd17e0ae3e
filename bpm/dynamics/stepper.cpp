// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/stepper.h"

#include "bpm/dynamics/blow_up.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <omp.h>

namespace boba {

namespace {

/// Steps between two looks at the range of fixed-point positions, and at the momentum of floats. In one step a node
/// moves at most half a diameter.
constexpr std::int64_t recentre_interval = 64;
constexpr double largest_range_share = 0.45;
/// Kinetic energy of full steps over that of half steps below which velocities change sign from step to step.
constexpr double least_smoothness = 0.25;
/// d a step, root mean square over a block. Below it a few nodes at most may do that, at the ends of a bond that
/// collapsed.
constexpr double least_motion = 3e-3;

} // namespace

Stepper::Stepper(Packing packing, const Material& material, const SimulationOptions& options)
    : packing_(std::move(packing)), material_(material), options_(options),
      distribution_(distribute(packing_, *options.ranks, options.precision)), agreement_(*options.ranks),
      layout_(packing_, options.precision, own_grains(packing_, distribution_)), state_(packing_, layout_),
      forces_(packing_, layout_, material, options.skin, distribution_), box_(packing_.box) {
  omp_set_num_threads(options.threads);
  if (!options.ranks->is_root()) { // rank 0 alone writes
    for (std::vector<Vector3>* big : {&packing_.position, &packing_.velocity}) {
      std::vector<Vector3>().swap(*big);
    }
    std::vector<std::int64_t>().swap(packing_.id);
  }
  agreement_.begin();
}

void Stepper::evaluate(Evaluation what) {
  what.keep_forces = what.virial == Virial::full || !clamps_.empty();
  forces_.evaluate(state_, box_, what);
  forces_kept_ = what.keep_forces;
  evaluated_volume_ = box_.volume();
  for (Clamp& clamp : clamps_) {
    apply_clamp(clamp, layout_, state_, distribution_);
  }
  const double begin = omp_get_wtime();
  forces_.share_sums(what.virial);
  reduction_seconds_ += omp_get_wtime() - begin;
  if (what.virial != Virial::none) {
    sum_up();
  }
}

void Stepper::evaluate_only() {
  evaluate({.virial = Virial::full, .residual_rate = residual_rate_});
}

void Stepper::start() {
  started_ = true;
  // The dumped velocities are those of the full step: the sums must see them as they are.
  evaluate({.kick = 0.5 * options_.dt, .virial = Virial::full, .residual_rate = residual_rate_});
  note_momentum();
}

void Stepper::advance(Virial virial) {
  drift();
  if ((step_ + 1) % recentre_interval == 0) {
    const double share = distribution_.ranks->largest(state_.recentre());
    if (share > largest_range_share) {
      throw BlowUp(describe_torn_grain(share, step_ + 1, options_.dt));
    }
  }
  evaluate({.kick = options_.dt, .half_kick = 0.5 * options_.dt, .virial = virial, .residual_rate = residual_rate_});
  ++step_;
  if (step_ % recentre_interval == 0) {
    restore_momentum();
  }
}

void Stepper::drift() {
  const double begin = omp_get_wtime();
  kernels::Drift drift{};
  drift.dt = options_.dt;
  drift.mapped = position_map_ != Matrix3::Identity();
  const Vector3 shift = box_.origin() - position_map_ * box_.origin();
  const Vector3 residual = (residual_rate_ * box_.h_inverse()).row(0);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      drift.map[row][column] = position_map_(row, column);
    }
    drift.shift[row] = shift[row];
    drift.residual[row] = residual[row];
  }
  drift.residual_shift = -residual.dot(box_.origin());

  drift.dither_seed = static_cast<std::uint64_t>(step_ + 1) << 32; // the kernel adds the node's number
  state_.map_origins(position_map_, shift);
  const std::vector<BlockMotion> results = forces_.drift(state_, drift);
  const double drifted = omp_get_wtime();
  integration_seconds_ += drifted - begin;
  const Agreement::Speeds speeds = agreement_.exchange(largest_speeds(results));
  reduction_seconds_ += omp_get_wtime() - drifted;
  if (!(speeds.largest <= largest_allowed_speed())) {
    distribution_.ranks->collectively([&] { check_drift(results); });
  }
  forces_.contact_list().note_motion(cell_map_, options_.dt * speeds.largest, options_.dt * speeds.common);
  cell_map_.setIdentity();
  position_map_.setIdentity();
}

/// Of this rank's nodes; beyond all limits when one has no finite velocity.
Agreement::Speeds Stepper::largest_speeds(const std::vector<BlockMotion>& results) const {
  double largest2 = 0.0, common2 = 0.0;
  for (const BlockMotion& result : results) {
    largest2 = std::isfinite(result.checksum) ? std::max(largest2, result.largest_speed2)
                                              : std::numeric_limits<double>::infinity();
    common2 = std::max(common2, result.common_speed2);
  }
  return {std::sqrt(largest2), std::sqrt(common2)};
}

void Stepper::check_drift(const std::vector<BlockMotion>& results) const {
  const double limit = largest_allowed_speed();
  for (std::size_t b = 0; b < results.size(); ++b) {
    if (!std::isfinite(results[b].checksum) || results[b].largest_speed2 > limit * limit) {
      throw BlowUp(describe_fast_node(layout_.blocks()[b], state_, step_ + 1, options_.dt, material_));
    }
  }
}

void Stepper::check_alternation() const {
  if (!clamps_.empty() || residual_rate_ != Matrix3::Zero()) {
    return; // part of the velocities is then not the nodes' own
  }
  for (const Block& block : layout_.blocks()) {
    double full_step = 0.0, speed2 = 0.0; // idle lanes have no part in it
    for (const int grain : block.grain) {
      full_step += grain >= 0 ? forces_.grain_sums()[grain].kinetic_trace : 0.0;
      for (int node = 0; grain >= 0 && node < block.n_nodes; ++node) {
        speed2 += state_.velocity(grain, node).squaredNorm(); // of the half step to come
      }
    }
    const double half_step = speed2 * material_.node_mass;
    const double moved2 = options_.dt * options_.dt * speed2 / (block.n_grains() * block.n_nodes);
    if (full_step < least_smoothness * half_step && moved2 > least_motion * least_motion) {
      throw BlowUp(describe_alternation(block, step_, options_.dt, std::sqrt(moved2)));
    }
  }
}

void Stepper::sum_up() {
  double virial = 0.0, kinetic = 0.0;
  for (const GrainSums& grain :
       forces_.grain_sums()) { // grain by grain: the order is the packing's, whatever the threads
    virial += grain.virial_trace;
    kinetic += grain.kinetic_trace;
  }
  pressure_ = (virial + kinetic) / (3.0 * evaluated_volume_);
  kinetic_energy_ = 0.5 * kinetic;
}

namespace {

Matrix3 simple_shear(double rate) {
  Matrix3 gradient = Matrix3::Zero();
  gradient(0, 1) = rate;
  return gradient;
}

} // namespace

void Stepper::move_cell(const CellRates& rates) {
  const Matrix3 dilation = rates.dilation * Matrix3::Identity();
  const Matrix3 gradient = dilation + simple_shear(rates.shear);
  strain_ += rates.shear * options_.dt;
  deform_cell(gradient, rates.remap == Remap::positions ? gradient : dilation);
}

void Stepper::deform_cell(const Matrix3& gradient, const Matrix3& of_positions) {
  if (gradient != Matrix3::Zero()) {
    cell_map_ = Matrix3::Identity() + options_.dt * gradient;
    position_map_ = Matrix3::Identity() + options_.dt * of_positions;
    box_.set_h(cell_map_ * box_.h());
    // A periodic template's bonds name their images by the cell vectors it was made with: its cell is never flipped.
    if (!forces_.has_periodic_template() && box_.flip()) {
      forces_.contact_list().invalidate();
    }
  }
  set_residual_gradient(gradient - of_positions);
}

void Stepper::add_streaming(double rate, double sign) {
  for (const int g : layout_.grains()) {
    for (int node = 0; node < layout_.n_nodes(g); ++node) {
      const double y = state_.position(g, node)[1] - box_.origin()[1];
      state_.set_velocity(g, node, state_.velocity(g, node) + Vector3(sign * rate * y, 0.0, 0.0));
    }
  }
  set_residual_gradient(simple_shear(sign > 0.0 ? rate : 0.0));
  note_momentum();
}

double Stepper::virial_pressure_when_scaled(const std::vector<Vector3>& x, double factor) {
  const Matrix3 map = factor * position_map_;
  const Vector3 shift = box_.origin() - map * box_.origin();
  std::size_t next = 0;
  for (const int g : layout_.grains()) {
    for (int node = 0; node < layout_.n_nodes(g); ++node) {
      state_.set_position(g, node, map * x[next++] + shift);
    }
  }
  Box scaled_box = box_;
  scaled_box.set_h(factor * box_.h());
  forces_.contact_list().invalidate();
  forces_.evaluate(state_, scaled_box, {.virial = Virial::trace, .residual_rate = residual_rate_});
  forces_.share_sums(Virial::trace);
  double virial = 0.0;
  for (const GrainSums& grain : forces_.grain_sums()) {
    virial += grain.virial_trace;
  }
  return virial / (3.0 * scaled_box.volume());
}

double Stepper::affine_bulk_modulus() {
  const LaneState before = state_;
  std::vector<Vector3> x;
  for (const int g : layout_.grains()) {
    for (int node = 0; node < layout_.n_nodes(g); ++node) {
      x.push_back(state_.position(g, node));
    }
  }
  const ForceField::Results results = forces_.results();
  const std::vector<Wall> walls = forces_.walls();
  const double step = 1e-5;
  const double looser = virial_pressure_when_scaled(x, 1.0 + step);
  const double tighter = virial_pressure_when_scaled(x, 1.0 - step);
  // Nothing of the state has moved but these; the list of the next step is built anew and gives the same forces.
  state_.take(before);
  forces_.set_results(results);
  forces_.walls() = walls;
  forces_.contact_list().invalidate();
  return (tighter - looser) / (6.0 * step);
}

double Stepper::sound_crossing(double bulk_modulus) const {
  const double mass = static_cast<double>(packing_.first_nodes().back()) * material_.node_mass;
  const double speed = std::sqrt(bulk_modulus * box_.volume() / mass);
  return box_.lengths().minCoeff() / speed;
}

Timings Stepper::timings() const {
  Timings timings;
  timings.bonds = forces_.bond_seconds;
  timings.contacts = forces_.contact_seconds;
  timings.search = forces_.search_seconds;
  timings.integration = integration_seconds_;
  timings.steps = step_;
  timings.list_builds = forces_.contact_list().counts().grains;
  timings.halo = forces_.halo_seconds;
  timings.reductions = reduction_seconds_;
  const ContactHalo::Traffic& traffic = forces_.halo().traffic();
  timings.halo_messages = traffic.messages;
  timings.halo_bytes = traffic.bytes;
  timings.halo_builds = traffic.rebuilds;
  timings.migrated_grains = migrated_grains_;
  return timings;
}

std::array<double, 2> Stepper::extent_z() const {
  std::array<double, 2> extent = {1e300, -1e300};
  for (const int g : layout_.grains()) {
    for (int node = 0; node < layout_.n_nodes(g); ++node) {
      const double z = state_.position(g, node)[2];
      extent = {std::min(extent[0], z), std::max(extent[1], z)};
    }
  }
  return {distribution_.ranks->smallest(extent[0]), distribution_.ranks->largest(extent[1])};
}

} // namespace boba
