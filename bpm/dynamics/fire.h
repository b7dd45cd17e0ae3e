// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/archive/archive.h"
#include "bpm/dynamics/moving_packing.h"

namespace boba {

/// The fast inertial relaxation engine at a fixed time step: the nodes keep moving as the equation of motion says, but
/// their velocities are turned towards the forces, and all stop when the motion goes against the forces.
///
///     P = f . v >= 0: v <- (1 - a) v + a |v| f / |f|,  and a <- 0.99 a after 5 such steps in a row
///     otherwise:      v <- 0, a <- 0.25
///
/// It needs forces alone, no energy. The laws' damping stays.
/// Source: Bitzek et al., Phys. Rev. Lett. 97, 170201 (2006), steps F1 to F4; a_start and the leapfrog form of
/// Guenole et al., Comput. Mater. Sci. 175, 109584 (2020), table 1.
class Fire {
public:
  /// Turns or stops the velocities after a step whose forces were kept. Returns the largest net force on any node, k d.
  /// A pass over the nodes. Collective.
  double steer(MovingPacking& moving);
  /// All nodes stop where they are; the next steer begins from the start.
  void stop(MovingPacking& moving);

  void archive(Archive& archive);

private:
  double mixing_ = 0.25;
  int n_downhill_ = 0;
};

/// Largest net force on any node at the last evaluation, whose forces were kept, k d. Collective.
double largest_net_force(const MovingPacking& moving);

} // namespace boba
