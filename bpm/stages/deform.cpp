// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/deform.h"

#include "bpm/dynamics/elastic_probe.h"
#include "bpm/dynamics/node_exchange.h"
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/io/input_error.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <stdexcept>

namespace boba {

namespace {

/// Half of what the largest grain measures: a sphere of its volume, or the shortest side of a periodic network.
double half_of_largest_grain(const Packing& packing) {
  double largest = 0.0;
  for (const auto& grain : packing.templates) {
    const double volume = grain->reference_volume > 0.0 ? grain->reference_volume : nominal_volume(grain->n_nodes());
    const double size = grain->period ? grain->period->minCoeff() : std::cbrt(6.0 * volume / std::numbers::pi);
    largest = std::max(largest, size);
  }
  return 0.5 * largest;
}

/// Of all grains, on all ranks, d. Collective.
std::vector<Vector3> centres_of_grains(const MovingPacking& moving) {
  std::vector<Vector3> centres(moving.layout.n_grains(), Vector3::Zero());
  for (const int g : moving.layout.grains()) {
    centres[g] = moving.state.position_sum(g) / moving.layout.n_nodes(g);
  }
  share_grains(moving, centres);
  return centres;
}

} // namespace

DeformDriver::DeformDriver(const DeformStage& stage) : stage_(stage), pressure_(stage.pressure) {
  double fastest = 0.0;
  for (int c = 0; c < 6; ++c) {
    held_.emplace_back(std::string("stress ") + cell_components[c], std::string("sigma_") + cell_components[c]);
    const ComponentDrive& drive = stage_.component[c];
    if (drive.kind == Kind::strain && drive.path.fastest() > fastest) {
      fastest = drive.path.fastest();
      leading_ = c;
    }
  }
  if (leading_ >= 0 && stage_.component[leading_].path.kind != PrescribedStrain::Kind::ramp) {
    meter_.emplace();
  }
}

/// Largest rate of the leading component, 1/tau; 0 without one.
double DeformDriver::leading_rate() const {
  return leading_ < 0 ? 0.0 : stage_.component[leading_].path.fastest();
}

bool DeformDriver::has(Kind kind) const {
  return std::ranges::any_of(stage_.component, [kind](const ComponentDrive& drive) { return drive.kind == kind; });
}

void DeformDriver::begin(Stepper& stepper) {
  dt_ = stepper.options().dt;
  steps_.begin(stage_.time, dt_);
  first_lengths_ = stepper.box().lengths();
  first_volume_ = stepper.box().volume();
  least_distance_ = half_of_largest_grain(stepper.packing());
  check_path(stepper);
  pressure_.begin(stepper, leading_rate());
  const std::array<double, 6> present = stress_of(stepper.moving());
  for (int c = 0; c < 6; ++c) {
    const ComponentDrive& drive = stage_.component[c];
    first_target_[c] = drive.from_present ? present[c] : drive.stress_from.value_or(drive.stress);
  }
  settle_gains(stepper);
  if (meter_) {
    meter_->begin(centres_of_grains(stepper.moving()));
  }
}

/// The gain of each servo from the packing's affine stiffness for its component, as that of the barostat.
void DeformDriver::settle_gains(Stepper& stepper) {
  for (int c = 0; c < 6; ++c) {
    if (stage_.component[c].kind == Kind::stress) {
      const double stiffness = stage_.servo.gain ? 1.0 : affine_stiffness(stepper.moving(), c);
      gain_[c] =
          barostat_gain(stage_.servo, {stiffness / 3.0, sound_crossing(stepper.moving(), stiffness), leading_rate()});
    }
  }
}

/// The lengths when a share of the stage is done; what nothing prescribes is as in `others`. Prescribed ones are
/// computed from those at the beginning: rounding does not add up.
Vector3 DeformDriver::lengths_at(double share_done, const Vector3& others) const {
  Vector3 lengths = others;
  double product = 1.0;
  int n_following = 0;
  for (int c = 0; c < 3; ++c) {
    const ComponentDrive& drive = stage_.component[c];
    if (drive.kind == Kind::strain) {
      const double strain = drive.path.at(share_done);
      lengths[c] = first_lengths_[c] * (stage_.measure == StrainMeasure::engineering ? 1.0 + strain : std::exp(strain));
    }
    product *= lengths[c];
    n_following += drive.kind == Kind::volume ? 1 : 0;
  }
  const double growth = n_following == 0 ? 1.0 : std::pow(first_volume_ / product, 1.0 / n_following);
  for (int c = 0; c < 3; ++c) {
    lengths[c] *= stage_.component[c].kind == Kind::volume ? growth : 1.0;
  }
  return lengths;
}

/// Refuses, before anything moves, strains on the way to which a side becomes shorter than half a grain.
void DeformDriver::check_path(const Stepper& stepper) const {
  const Vector3 now = stepper.box().lengths();
  const auto is_thin = [&](double share) { return !(lengths_at(share, now).minCoeff() >= least_distance_); };
  constexpr int samples = 1000;
  int k = 0;
  while (k <= samples && !is_thin(static_cast<double>(k) / samples)) {
    ++k;
  }
  if (leading_ < 0 || k > samples) {
    return;
  }
  double before = std::max(k - 1, 0) / static_cast<double>(samples), thin = k / static_cast<double>(samples);
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (before + thin);
    (is_thin(middle) ? thin : before) = middle;
  }
  const PrescribedStrain& path = stage_.component[leading_].path;
  int side = 0;
  lengths_at(thin, now).minCoeff(&side);
  throw InputError(fmt::format("{}: the strain of {} is to go to {:.4g}, but it ends at {:.4g}: there the cell's side "
                               "along {} is half as long as "
                               "its largest grain ({:.4g} d), and no other choice of cell vectors helps",
                               stage_.kind, cell_components[leading_], path.at_end(), path.at(thin), "xyz"[side],
                               least_distance_));
}

/// Stops where a servo, the volume or tilts that cannot be flipped have made the cell too thin.
void DeformDriver::check_faces(const Stepper& stepper, const Box& box, double share_done) const {
  const Vector3 distance = box.face_distances();
  int thinnest = 0;
  if (distance.minCoeff(&thinnest) >= least_distance_) {
    return;
  }
  const std::string strain = leading_ < 0 ? fmt::format("after {:.4g} tau", share_done * stage_.time)
                                          : fmt::format("at the strain {} = {:.4g}", cell_components[leading_],
                                                        stage_.component[leading_].path.at(share_done));
  throw std::runtime_error(fmt::format("{}: step {}: the cell has become too {} {}: its faces across {} are {:.4g} d "
                                       "apart, less than half of its largest "
                                       "grain ({:.4g} d); a smaller strain or a held stress helps",
                                       stage_.kind, stepper.step(),
                                       box.lengths()[thinnest] < 2.0 * least_distance_ ? "thin" : "flat", strain,
                                       "xyz"[thinnest], distance[thinnest], least_distance_));
}

double DeformDriver::target(int c, double share_done) const {
  return first_target_[c] + share_done * (stage_.component[c].stress - first_target_[c]);
}

double DeformDriver::servo_rate(double stress, int c) const {
  const double off = target(c, steps_.share_done()) - stress;
  return off == 0.0 ? 0.0 : std::clamp(gain_[c] * off, -stage_.servo.rate_cap, stage_.servo.rate_cap);
}

/// What the path of a component adds in the step that ends now; steps_ counts it already.
double DeformDriver::strain_in_step(int c) const {
  const PrescribedStrain& path = stage_.component[c].path;
  return path.at(steps_.share_done()) - path.at(steps_.share_done(-1));
}

/// The ratios of the three lengths, new to old.
Matrix3 DeformDriver::map_of_lengths(const Stepper& stepper, const std::array<double, 6>& stress) {
  const Vector3 lengths = stepper.box().lengths();
  const double dilation = pressure_.dilation_rate(stepper, steps_.share_done());
  Vector3 next = lengths;
  for (int c = 0; c < 3; ++c) {
    const Kind kind = stage_.component[c].kind;
    const double rate = kind == Kind::stress ? servo_rate(stress[c], c) : kind == Kind::pressure ? dilation : 0.0;
    next[c] += rate * dt_ * lengths[c];
  }
  return lengths_at(steps_.share_done(), next).cwiseQuotient(lengths).asDiagonal();
}

/// Adds the tilts to the cell's map of a step, which has the lengths. Of the whole deformation F = map F_before the
/// components of an engineering strain are prescribed; others are rates of the cell as it is.
void DeformDriver::add_tilts(const std::array<double, 6>& stress, Matrix3& map) const {
  const Matrix3& f = deformation_;
  for (const int c : {3, 5, 4}) { // xz last: it needs the other two
    const auto [row, column] = component_place[c];
    const ComponentDrive& drive = stage_.component[c];
    if (drive.kind == Kind::stress) {
      map(row, column) = dt_ * servo_rate(stress[c], c);
    } else if (stage_.measure == StrainMeasure::logarithmic) {
      map(row, column) = drive.kind == Kind::strain ? strain_in_step(c) : 0.0;
    } else {
      const double wanted = drive.kind == Kind::strain ? drive.path.at(steps_.share_done()) : 0.0;
      double known = map(row, row) * f(row, column);
      if (c == 4) {
        known += map(0, 1) * f(1, 2);
      }
      map(row, column) = (wanted - known) / f(column, column);
    }
  }
}

/// The evaluation that has just been made belongs to the strain before the step that is now counted.
void DeformDriver::note_cycle(const Stepper& stepper, const std::array<double, 6>& stress) {
  const PrescribedStrain& path = stage_.component[leading_].path;
  const auto strain = [&](int steps) { return path.at(steps_.share_done(steps)); };
  const CycleMeter::Sample sample = {.step = stepper.step(),
                                     .cycles = path.cycles * steps_.share_done(-1),
                                     .next_cycles = path.cycles * steps_.share_done(),
                                     .strain = strain(-1),
                                     .strain_before = strain(-2),
                                     .strain_after = strain(0),
                                     .stress = stress[leading_],
                                     .pressure = stepper.pressure(),
                                     .volume = stepper.moving().cell.evaluated_box().volume()};
  if (meter_->add(sample)) {
    meter_->end_cycle(sample, centres_of_grains(stepper.moving()), deformation_ * cycle_deformation_.inverse());
    cycle_deformation_ = deformation_;
  }
}

/// A target of zero is measured by the largest stress there is.
void DeformDriver::note_held(const std::array<double, 6>& stress) {
  double largest = 0.0;
  for (const double s : stress) {
    largest = std::max(largest, std::abs(s));
  }
  for (int c = 0; c < 6; ++c) {
    if (stage_.component[c].kind == Kind::stress) {
      const double wanted = target(c, steps_.share_done());
      held_[c].add(stress[c], wanted, wanted == 0.0 ? largest : wanted, steps_.share_done());
    }
  }
}

std::string DeformDriver::report() const {
  std::string text = pressure_.is_held() ? pressure_.report().text() : "";
  for (const HeldPressureReport& held : held_) {
    const std::string line = held.text();
    text += text.empty() || line.empty() ? line : "; " + line;
  }
  return text;
}

bool DeformDriver::has_missed() const {
  return pressure_.has_missed() || std::ranges::any_of(held_, [](const HeldPressureReport& held) {
           return held.has_steps() && held.is_missed();
         });
}

CellRates DeformDriver::update(Stepper& stepper) {
  steps_.count();
  const std::array<double, 6> stress = needs_stress() ? stress_of(stepper.moving()) : std::array<double, 6>{};
  note_held(stress);
  if (meter_) {
    note_cycle(stepper, stress);
  }
  Matrix3 map = map_of_lengths(stepper, stress);
  add_tilts(stress, map);
  deformation_ = map * deformation_;
  Box next = stepper.box();
  next.set_h(map * next.h());
  if (!stepper.forces().bonds().has_periodic_template()) {
    next.flip();
  }
  check_faces(stepper, next, steps_.share_done());
  return {.remap = stage_.remap,
          .gradient = (map - Matrix3::Identity()) / dt_,
          .strain_rate = leading_ < 0 ? 0.0 : strain_in_step(leading_) / dt_};
}

double DeformDriver::shear_rate() const {
  if (leading_ < 0 || steps_.left() <= 0) {
    return 0.0;
  }
  const PrescribedStrain& path = stage_.component[leading_].path;
  return (path.at(steps_.share_done(1)) - path.at(steps_.share_done())) / dt_;
}

StageProgress DeformDriver::progress(const Stepper& stepper) const {
  if (leading_ < 0) {
    return progress_in_time(steps_, stage_.time, stepper.options().dt);
  }
  StageProgress progress;
  progress.done = steps_.share_done();
  if (meter_) {
    progress.driven = std::string("cycles of ") + cell_components[leading_];
    progress.target = stage_.component[leading_].path.cycles;
    progress.value = progress.target * progress.done;
    return progress;
  }
  progress.driven = std::string(cell_components[leading_]) + " strain";
  progress.target = stage_.component[leading_].path.at_end();
  progress.value = stage_.component[leading_].path.at(steps_.share_done());
  return progress;
}

void DeformDriver::archive(Archive& archive) {
  archive.object("steps", steps_);
  archive.object("pressure", pressure_);
  archive.field("dt", dt_);
  archive.field("first_lengths", first_lengths_);
  archive.field("first_volume", first_volume_);
  archive.field("deformation", deformation_);
  archive.field("gain", gain_);
  archive.field("first_target", first_target_);
  archive.field("least_distance", least_distance_);
  if (meter_) {
    archive.object("meter", *meter_);
    archive.field("cycle_deformation", cycle_deformation_);
  }
  for (int c = 0; c < 6; ++c) {
    archive.object(std::string("held_") + cell_components[c], held_[c]);
  }
}

} // namespace boba
