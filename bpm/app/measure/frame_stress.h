// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/material.h"
#include "bpm/packing/packing.h"
#include "bpm/packing/snapshot.h"
#include "bpm/parallel/ranks.h"

#include <array>
#include <memory>
#include <vector>

namespace boba {

/// Evaluates the forces of stored frames again, for their stress.
///
/// sigma = -(1/V) sum (m v v + r_ij f_ij) over bonds and contacts. A run evaluates its damping with the velocities half
/// a step before the frame, v(n-1/2) = v(n) - dt/(2m) f(n); these are found by iteration, so that the result is the
/// run's own up to the motion of the cell within the last step. Without velocities damping and kinetic parts are
/// missing. Walls and clamps are not stored in frames and play no part. Source: docs/notation.md, "Stress".
class FrameStress {
public:
  /// \param packing the networks and grains of the frames; its positions only say which rank does which grains
  /// \param dt time step of the run, tau; 0: the velocities of a frame are taken as they are
  /// \param ranks each owns some grains, as in a run; must outlive this
  FrameStress(Packing packing, const Material& material, double dt, const Ranks& ranks = Ranks::alone());
  ~FrameStress();

  /// Each grain's part times the frame's volume, xx yy zz xy xz yz, tension positive, k d. Collective: all ranks are
  /// given the whole frame and have all grains' parts.
  ///
  /// \throws std::invalid_argument for a frame of another packing.
  std::vector<std::array<double, 6>> evaluate(const Snapshot& snapshot);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace boba
