// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/cage/plane.h"

#include <cmath>

namespace boba::continuum {
namespace {

/// A component of a normal below this is zero.
constexpr double zero_component = 1e-9;

} // namespace

std::vector<Plane> scaled(std::vector<Plane> planes, double factor) {
  for (Plane& plane : planes) {
    plane.distance *= factor;
  }
  return planes;
}

std::vector<Plane> octant_planes(const std::vector<Plane>& planes) {
  std::vector<Plane> result;
  for (Plane plane : planes) {
    if (plane.normal.minCoeff() > -zero_component) {
      plane.normal = (plane.normal.array() < zero_component).select(0.0, plane.normal.array()).matrix();
      result.push_back(plane);
    }
  }
  return result;
}

std::vector<Plane> mirror_images(const std::vector<Plane>& planes) {
  std::vector<Plane> result;
  for (const Plane& plane : planes) {
    for (int image = 0; image < 8; ++image) {
      Plane mirrored = plane;
      bool twice = false;
      for (int c = 0; c < 3; ++c) {
        const bool turned = (image >> c & 1) != 0;
        twice |= turned && plane.normal[c] < zero_component;
        mirrored.normal[c] *= turned ? -1 : 1;
      }
      if (!twice) {
        result.push_back(mirrored);
      }
    }
  }
  return result;
}

int octants_of(const Plane& plane) {
  return 1 << (plane.normal.array().abs() < zero_component).count();
}

} // namespace boba::continuum
