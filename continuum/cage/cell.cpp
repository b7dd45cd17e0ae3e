// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/cage/cell.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>

namespace boba::continuum {
namespace {

using Polygon = std::vector<Eigen::Vector3d>;

/// The part of a convex polygon inside a plane.
Polygon clipped(const Polygon& polygon, const Plane& plane) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = plane.normal.dot(a) - plane.distance, db = plane.normal.dot(b) - plane.distance;
    if (da <= 0) {
      result.push_back(a);
    }
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
      result.push_back(a + da / (da - db) * (b - a));
    }
  }
  return result;
}

double area_of(const Polygon& polygon) {
  Eigen::Vector3d twice = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return 0.5 * twice.norm();
}

bool same(const Plane& a, const Plane& b) {
  return (a.normal - b.normal).norm() < 1e-9 && std::abs(a.distance - b.distance) < 1e-9 * a.distance;
}

/// A square of half diagonal `reach` on a plane.
Polygon square_on(const Plane& plane, double reach) {
  const Eigen::Vector3d s = plane.normal.unitOrthogonal(), t = plane.normal.cross(s);
  const Eigen::Vector3d foot = plane.distance * plane.normal;
  return {foot + reach * s, foot + reach * t, foot - reach * s, foot - reach * t};
}

} // namespace

double Cell::area() const {
  return std::accumulate(face_areas.begin(), face_areas.end(), 0.0);
}

Cell cell_of(const std::vector<Plane>& planes) {
  Cell cell;
  double farthest = 0;
  for (const Plane& plane : planes) {
    farthest = std::max(farthest, plane.distance);
  }
  const double reach = 1e3 * farthest;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    Polygon face = square_on(planes[k], reach);
    for (std::size_t l = 0; l < planes.size(); ++l) {
      if (l != k) {
        face = l < k && same(planes[l], planes[k]) ? Polygon{} : clipped(face, planes[l]);
      }
    }
    const Eigen::Vector3d& n = planes[k].normal;
    const std::string which = fmt::format("plane {} with normal ({:.6g}, {:.6g}, {:.6g}) and distance {:.6g}", k + 1,
                                          n[0], n[1], n[2], planes[k].distance);
    if (std::any_of(face.begin(), face.end(), [&](const auto& x) { return x.norm() > 0.1 * reach; })) {
      throw std::invalid_argument(
          fmt::format("the cage is open beside {}: the planes must enclose a finite volume", which));
    }
    cell.face_areas.push_back(area_of(face));
    if (!(cell.face_areas.back() > 1e-9 * farthest * farthest)) {
      throw std::invalid_argument(
          fmt::format("{} lies behind others: every plane must be a face of the cell, none twice", which));
    }
    cell.volume += cell.face_areas.back() * planes[k].distance / 3;
  }
  return cell;
}

} // namespace boba::continuum
