// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

namespace boba {

/// A closed surface about its centre of volume, as a shape sees it; bpm/mesh has the one of triangles.
class ClosedSurface {
public:
  virtual ~ClosedSurface() = default;
  virtual double volume() const = 0;
  /// The largest |x|, |y| and |z| of the surface.
  virtual Eigen::Vector3d half_lengths() const = 0;
  /// Distance of a point from the surface, negative inside.
  virtual double signed_distance(const Eigen::Vector3d& x) const = 0;
  /// The point of the surface that is nearest to x.
  virtual Eigen::Vector3d nearest(const Eigen::Vector3d& x) const = 0;
  /// Hash of all that the surface is made of.
  virtual std::uint64_t fingerprint() const = 0;
};

} // namespace boba
