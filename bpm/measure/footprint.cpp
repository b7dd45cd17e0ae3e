// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/footprint.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/convex_hull_2.h>
#include <Eigen/Geometry>
#include <iterator>
#include <numbers>
#include <vector>

namespace boba::measure {

double footprint_area(std::span<const Vector3> points, const Vector3& normal, double radius) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
  const Vector3 u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<Point> projected;
  projected.reserve(points.size());
  for (const Vector3& x : points) {
    const Vector3 from_first = x - points.front();
    projected.emplace_back(u.dot(from_first), v.dot(from_first));
  }
  std::vector<Point> hull;
  CGAL::convex_hull_2(projected.begin(), projected.end(), std::back_inserter(hull));
  double area = 0.0, length = 0.0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point &a = hull[i], &b = hull[(i + 1) % hull.size()];
    area += 0.5 * (a.x() * b.y() - b.x() * a.y());
    length += std::hypot(b.x() - a.x(), b.y() - a.y());
  }
  return area + length * radius + std::numbers::pi * radius * radius;
}

} // namespace boba::measure
