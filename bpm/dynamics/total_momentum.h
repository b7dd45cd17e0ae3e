// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/moving_packing.h"

namespace boba {

/// The momentum of the whole. In mixed precision the rounding errors of a packing's forces do not add up to zero, and
/// at rest they are the same at every step: nothing damps the motion of the whole, so that it would be accelerated for
/// good.

/// Notes the sum of all nodes' velocities without the profile `streaming` (1/tau) that they hold. Collective.
void note_momentum(MovingPacking& moving, const Matrix3& streaming);

/// Adds a step's motion along the gradient of the streaming that the velocities hold now.
void note_motion_along_gradient(MovingPacking& moving);

/// Takes what rounding has changed of that sum since it was noted from all nodes alike; motion along the streaming's
/// gradient has its part in the sum. Bonds and contacts cannot change it; walls, clamps and gravity can, and then
/// nothing is done. Collective.
void restore_momentum(MovingPacking& moving);

/// When the last of a streaming profile is gone: gives the packing the momentum that it had before. Motion along the
/// gradient has no part in it any more. Collective.
void restore_momentum_without_streaming(MovingPacking& moving);

} // namespace boba
