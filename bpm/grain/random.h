// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>

namespace boba {

/// Random numbers that are the same with every standard library: std::mt19937_64 is fixed by the standard, the
/// library's distributions are not.
class Random {
public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1): the top 53 bits.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in 0 .. n-1 (n > 0); the bias of n / 2^64 is of no consequence here.
  std::uint64_t below(std::uint64_t n) { return engine_() % n; }
  /// Components independent and uniform in [-half_width, half_width).
  Eigen::Vector3d vector(double half_width) {
    const double x = uniform(-half_width, half_width);
    const double y = uniform(-half_width, half_width);
    const double z = uniform(-half_width, half_width);
    return {x, y, z};
  }

private:
  std::mt19937_64 engine_;
};

} // namespace boba
