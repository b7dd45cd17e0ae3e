// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba {

/// -overlap beyond [-half, half], signed.
inline double push_back(double x, double half) {
  return x > half ? half - x : x < -half ? -half - x : 0.0;
}

} // namespace boba
