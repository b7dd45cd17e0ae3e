// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/cage/hull.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

namespace boba::continuum {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

} // namespace

HullMeasures hull_of_mirrored(const std::vector<Eigen::Vector3d>& points) {
  std::vector<Kernel::Point_3> all;
  for (const auto& x : points) {
    for (int image = 0; image < 8; ++image) {
      all.emplace_back(image & 1 ? -x[0] : x[0], image & 2 ? -x[1] : x[1], image & 4 ? -x[2] : x[2]);
    }
  }
  Mesh mesh;
  CGAL::convex_hull_3(all.begin(), all.end(), mesh);
  HullMeasures result;
  for (const auto face : mesh.faces()) {
    std::vector<Kernel::Point_3> corner;
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face))) {
      corner.push_back(mesh.point(vertex));
    }
    const auto twice = CGAL::cross_product(corner[1] - corner[0], corner[2] - corner[0]);
    result.surface += 0.5 * std::sqrt(twice.squared_length());
    result.volume += twice * (corner[0] - CGAL::ORIGIN) / 6;
  }
  return result;
}

} // namespace boba::continuum
