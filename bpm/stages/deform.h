// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stage_driver.h"
#include "bpm/packing/cell_components.h"
#include "bpm/stages/cycle_meter.h"
#include "bpm/stages/held_pressure.h"
#include "bpm/stages/prescribed_strain.h"
#include "bpm/stages/timed_steps.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace boba {

/// What a strain means for the cell.
enum class StrainMeasure {
  /// Of the cell at the stage's beginning: h = F h_0 with F_ii = 1 + e_ii and F_ij = e_ij.
  engineering,
  /// Of the cell as it is: L = L_0 exp(e_ii), and d(xy) = de_xy Ly on top of what the lengths do to the tilt.
  logarithmic,
};

/// What drives one component of the cell.
struct ComponentDrive {
  enum class Kind {
    fixed,
    strain,   ///< along `path`
    stress,   ///< a servo holds `stress`, tension positive: de/dt = gain (target - sigma)
    volume,   ///< a length that keeps the cell's volume as it was at the stage's beginning
    pressure, ///< a length that dilates, with the others of its kind, to hold the pressure
  };
  Kind kind = Kind::fixed;
  PrescribedStrain path;
  double stress = 0.0;               ///< target at the end, k/d
  std::optional<double> stress_from; ///< at the beginning; absent: as at the end
  bool from_present = false;         ///< the ramp of the target begins at what the stress is then
};

/// A deformation of the periodic cell, component by component.
struct DeformStage {
  std::string kind = "deform"; ///< what the stage is called in scenes
  double time = 0.0;           ///< tau
  StrainMeasure measure = StrainMeasure::engineering;
  std::array<ComponentDrive, 6> component;
  std::optional<Barostat> pressure; ///< held by the lengths of that kind
  Barostat servo;                   ///< of the stresses: its gain and cap
  Remap remap = Remap::positions;   ///< of the tilts; lengths act on positions
};

/// Moves the cell along prescribed strains, holds stresses by servos, and keeps the volume where that is wanted.
class DeformDriver : public StageDriver {
public:
  explicit DeformDriver(const DeformStage& stage);

  std::string name() const override { return stage_.kind; }
  void begin(Stepper& stepper) override;
  bool needs_pressure() const override { return pressure_.is_held() || meter_; }
  bool needs_stress() const override { return has(ComponentDrive::Kind::stress) || meter_; }
  CellRates update(Stepper& stepper) override;
  bool finished() const override { return steps_.finished(); }
  std::int64_t steps_left(const Stepper&) const override { return steps_.left(); }
  bool may_end(const Stepper&) const override { return steps_.left() == 1; }
  /// Of the leading component: the fastest of those that are driven along strains.
  double shear_rate() const override;
  void end(Stepper&) override {}
  StageProgress progress(const Stepper& stepper) const override;
  std::string report() const override;
  bool has_missed() const override;
  /// Of its cycles, where the leading component makes any.
  const StageTable* table() const override { return meter_ ? &meter_->table() : nullptr; }
  void archive(Archive& archive) override;

private:
  using Kind = ComponentDrive::Kind;
  double leading_rate() const;
  bool has(Kind kind) const;
  void note_cycle(const Stepper& stepper, const std::array<double, 6>& stress);
  void note_held(const std::array<double, 6>& stress);
  void settle_gains(Stepper& stepper);
  void check_path(const Stepper& stepper) const;
  void check_faces(const Stepper& stepper, const Box& box, double share_done) const;
  double target(int component, double share_done) const;
  double servo_rate(double stress, int component) const;
  Vector3 lengths_at(double share_done, const Vector3& others) const;
  Matrix3 map_of_lengths(const Stepper& stepper, const std::array<double, 6>& stress);
  void add_tilts(const std::array<double, 6>& stress, Matrix3& map) const;
  double strain_in_step(int component) const;

  DeformStage stage_;
  int leading_ = -1; ///< component whose strain counts as the stage's; -1 without one
  TimedSteps steps_;
  HeldPressure pressure_;
  double dt_ = 0.0; ///< tau
  // Of the cell and the packing when the stage began, and what has become of the cell.
  Vector3 first_lengths_ = Vector3::Ones();
  double first_volume_ = 1.0;
  Matrix3 deformation_ = Matrix3::Identity();       ///< F, as if the cell had never been flipped
  std::array<double, 6> gain_{};                    ///< of the servos, d/(k tau)
  std::array<double, 6> first_target_{};            ///< k/d
  std::vector<HeldPressureReport> held_;            ///< of the six stresses
  std::optional<CycleMeter> meter_;                 ///< of the leading component
  Matrix3 cycle_deformation_ = Matrix3::Identity(); ///< F at the last sample of the cycle before
  double least_distance_ = 0.0;                     ///< between opposite faces, d
};

} // namespace boba
