// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/moving_packing.h"

#include <vector>

namespace boba {

/// Gives grains other owners; nothing else changes. Nothing on one rank. Collective.
void move_grains(MovingPacking& moving, std::vector<int> owner);

/// Looks from time to time whether the work is spread evenly over the ranks by what it has cost lately.
class LoadBalance {
public:
  /// Moves grains if that gains enough. Collective.
  void rebalance(MovingPacking& moving);

private:
  double worked_until_ = 0.0; ///< seconds of work at the last look
};

} // namespace boba
