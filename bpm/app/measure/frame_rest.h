// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/material.h"
#include "bpm/packing/packing.h"
#include "bpm/packing/snapshot.h"

#include <vector>

namespace boba {

/// Lets a copy of a frame come to rest for a short time, for measures that noise and flow disturb.
///
/// The copy starts from the frame's positions without velocities and is moved by the engine itself, in the frame's
/// cell, which does not change; damping takes the energy out. Nothing of the run is touched.
class FrameRest {
public:
  /// \param packing networks and grains of the frames; its positions are not used  \param dt time step, tau
  /// \param time of the rest, tau
  FrameRest(Packing packing, const Material& material, double dt, double time);

  /// Centres of the grains after the rest, d, unwrapped like the frame.
  /// \throws std::invalid_argument for a frame of another packing; BlowUp when the copy blows up.
  std::vector<Vector3> rested_centres(const Snapshot& snapshot) const;

private:
  Packing packing_;
  Material material_;
  double dt_, time_;
};

} // namespace boba
