// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/packing/box.h"

namespace boba {

using kernels::Virial;

/// How an evaluation of the forces treats velocities and how much it sums up.
struct Evaluation {
  double kick = 0.0;      ///< v += kick f / m when a node's force is complete, tau
  double half_kick = 0.0; ///< full-step velocity = v + half_kick f / m, tau
  Virial virial = Virial::none;
  bool keep_forces = false; ///< write the forces to the state; otherwise they live in scratch only
  bool is_trial = false;    ///< of a state that is put back: bonds that break here stay whole
  /// d/dt of the cell matrix as far as it does not act on positions (remap = "velocities"): an image displaced by h n
  /// moves with rate n, and the streaming velocity is taken from the kinetic tensor.
  Matrix3 residual_rate = Matrix3::Zero();
};

} // namespace boba
