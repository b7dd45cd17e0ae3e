// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/moving_packing.h"

#include <vector>

namespace boba {

/// Largest speed that a node may have, half a diameter a step, d/tau.
double largest_allowed_speed(const MovingPacking& moving);

/// \throws BlowUp when a node of this rank's grains is faster than that, or has no finite velocity; `motion` is what
/// the drift of each block saw. Idle lanes that are so fast are put to rest instead: no grain is in them.
void check_drift(MovingPacking& moving, const std::vector<BlockMotion>& motion);

/// Centres fixed-point positions on their grains again. \throws BlowUp when a grain reaches too far. Collective.
void recentre_grains(MovingPacking& moving);

/// After a step with a virial: \throws BlowUp when the velocities of some of this rank's grains turn round at every
/// step. The velocity of a full step is the mean of two half steps, so that it then nearly vanishes. Beyond the stable
/// step a vibration may stay finite like this for good, because it stretches its bonds: nothing else would show it.
void check_alternation(const MovingPacking& moving);

/// The bond with the largest r / r0 of all ranks' grains; of several the one whose grain comes first. Collective.
Stretch largest_stretch(const MovingPacking& moving);

/// \throws BlowUp when that bond is longer than `largest_bond_stretch` allows. Collective.
void check_bonds(const MovingPacking& moving);

} // namespace boba
