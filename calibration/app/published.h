// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <optional>

namespace boba::calibration {

/// The published calibration: alpha (k d) -> nu, E (k/d) at k = 1.
/// Source: Clemmer, Hackney & Grest, "Shear and crystallization in deformable granular packings", calibration of the
/// bonds.
struct PublishedPair {
  double alpha, poisson, young;
};

inline constexpr std::array<PublishedPair, 5> published_pairs{
    {{-0.8, 0.40, 0.58}, {0.0, 0.25, 1.84}, {2.0, -0.01, 4.05}, {5.0, -0.25, 6.04}, {12.0, -0.52, 8.30}}};

inline std::optional<PublishedPair> published_pair(double alpha) {
  for (const PublishedPair& pair : published_pairs) {
    if (std::abs(pair.alpha - alpha) < 1e-9) {
      return pair;
    }
  }
  return std::nullopt;
}

} // namespace boba::calibration
