// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/network/connected_network.h"

#include "bpm/grain/bond_network.h"

#include <stdexcept>

namespace boba::calibration {

LinearNetwork connected_network(const GrainTemplate& grain) {
  if (const auto reason = floating_part(grain)) {
    throw std::invalid_argument("the network is not rigid: " + *reason);
  }
  return LinearNetwork(grain);
}

} // namespace boba::calibration
