// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace boba {

/// How a shear of the cell acts on the nodes.
/// Source: docs/notation.md, "Box".
enum class Remap {
  positions,  ///< node positions follow the cell affinely; damping sees peculiar velocities
  velocities, ///< positions stay; an image across the gradient direction carries the velocity of the cell's shear
};

/// The linear barostat: d ln L / dt = gain (P - target), limited to +- `rate_cap`.
struct Barostat {
  double pressure = 0.0;      ///< target, k/d
  std::optional<double> gain; ///< d/(k tau); absent: from the measured bulk modulus, see docs/notation.md
  double rate_cap = 1e-3;     ///< largest |d ln L / dt|, 1/tau
};

/// Isotropic compression at a constant rate until the pressure is reached, then a hold under the barostat until
/// |P / P_target - 1| < pressure_tolerance and kinetic / elastic energy < kinetic_tolerance.
struct CompressStage {
  Barostat barostat;
  double rate = 5e-4; ///< -d ln L / dt of the ramp, 1/tau
  double pressure_tolerance = 1e-3;
  double kinetic_tolerance = 1e-4;
  double max_time = 1e6; ///< tau; the stage fails when it has not settled by then
};

/// A fixed cell, or a constant pressure, for a time.
struct HoldStage {
  double time = 0.0; ///< tau
  std::optional<Barostat> barostat;
};

/// Simple shear in x with gradient y, at constant volume or at a held pressure.
struct ShearStage {
  double rate = 0.0;   ///< 1/tau; negative shears backwards
  double strain = 0.0; ///< > 0, to be added by this stage
  Remap remap = Remap::positions;
  std::optional<Barostat> barostat;
};

/// Squeezes a specimen along z between two rigid walls or two clamped ends (which move towards each other with
/// `velocity` each, symmetrically), until the nominal strain is reached.
struct PressStage {
  enum class Ends { walls, clamps };
  Ends ends = Ends::walls;
  double velocity = 1e-3; ///< of each end, d/tau; negative pulls (clamps)
  double strain = 0.0;    ///< nominal strain: displacement of both ends together over the specimen's initial height
  double clamp_thickness = 2.0; ///< d; nodes within this distance of the specimen's ends move rigidly
};

using Stage = std::variant<CompressStage, HoldStage, ShearStage, PressStage>;

/// "compress", "hold", "shear" or "press".
std::string stage_name(const Stage& stage);

} // namespace boba
