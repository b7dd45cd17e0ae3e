// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <voro++/voro++.hh>

namespace boba::measure {

namespace {

using Container = voro::container_periodic_poly;

void check(const Box& box, std::span<const Vector3> centres, std::span<const double> radii) {
  if (box.periodic() != std::array{true, true, true}) {
    throw std::invalid_argument("Voronoi neighbours: the box must be periodic in all three directions");
  }
  if (centres.empty() || centres.size() != radii.size()) {
    throw std::invalid_argument(fmt::format(
        "Voronoi neighbours: {} centres and {} radii; there must be one radius a grain", centres.size(), radii.size()));
  }
  for (std::size_t i = 0; i < centres.size(); ++i) {
    if (!centres[i].allFinite() || !(radii[i] >= 0.0) || !std::isfinite(radii[i])) {
      throw std::invalid_argument(fmt::format("Voronoi neighbours: grain {} has no finite centre and radius", i));
    }
    for (std::size_t j = 0; j < i && centres.size() <= 64; ++j) {
      if (box.minimum_image(centres[i] - centres[j]).norm() == 0.0) {
        throw std::invalid_argument(fmt::format("neighbours: grains {} and {} have the same centre", j, i));
      }
    }
  }
}

/// Calls visit(grain, cell) with the radical Voronoi cell of each grain that has one.
template <class Visit>
void for_each_cell(const Box& box, std::span<const Vector3> centres, std::span<const double> radii,
                   const Visit& visit) {
  // A cell with short tilts: the search region of Voro++ grows with the tilt.
  Box cell_box = box;
  cell_box.flip();
  const double spacing = std::cbrt(cell_box.volume() / (0.25 * static_cast<double>(centres.size())));
  const Vector3 lengths = cell_box.lengths();
  const auto blocks = [&](int axis) { return std::max(1, static_cast<int>(lengths[axis] / spacing)); };
  Container container(lengths[0], cell_box.xy(), lengths[1], cell_box.xz(), cell_box.yz(), lengths[2], blocks(0),
                      blocks(1), blocks(2), 8);
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const Vector3 x = cell_box.wrapped(centres[i]) - cell_box.origin();
    container.put(static_cast<int>(i), x[0], x[1], x[2], radii[i]);
  }
  voro::c_loop_all_periodic loop(container);
  voro::voronoicell_neighbor cell;
  if (loop.start()) {
    do {
      if (container.compute_cell(cell, loop)) {
        visit(loop.pid(), cell);
      }
    } while (loop.inc());
  }
}

/// The periodic copy of neighbour j whose radical plane has this normal and distance from the centre of grain i.
Vector3 image_across(const Box& box, const Vector3& between, double radius_i, double radius_j, const Vector3& normal,
                     double plane_distance) {
  const Vector3 nearest = box.minimum_image(between);
  Vector3 best = nearest;
  double best_misfit = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 125; ++k) {
    const Vector3 vector = nearest + box.h() * Eigen::Vector3i(k % 5 - 2, k / 5 % 5 - 2, k / 25 - 2).cast<double>();
    const double r = vector.norm();
    if (r == 0.0) {
      continue;
    }
    const double distance = (r * r + radius_i * radius_i - radius_j * radius_j) / (2.0 * r);
    const double misfit = (distance * vector / r - plane_distance * normal).norm() + (vector / r - normal).norm();
    if (misfit < best_misfit) {
      best_misfit = misfit;
      best = vector;
    }
  }
  return best;
}

} // namespace

NeighbourLists voronoi_neighbours(const Box& box, std::span<const Vector3> centres, std::span<const double> radii,
                                  double min_area_share) {
  check(box, centres, radii);
  NeighbourLists lists(centres.size());
  Box reduced = box;
  reduced.flip();
  for_each_cell(box, centres, radii, [&](int grain, voro::voronoicell_neighbor& cell) {
    std::vector<int> ids, face_vertices;
    std::vector<double> areas, normals, vertices;
    cell.neighbors(ids);
    cell.face_areas(areas);
    cell.normals(normals);
    cell.face_vertices(face_vertices);
    cell.vertices(vertices); // relative to the grain's centre
    const double surface = std::accumulate(areas.begin(), areas.end(), 0.0);
    std::size_t at = 0; // face_vertices: for each face its number of vertices, then those
    for (std::size_t f = 0; f < ids.size(); at += face_vertices[at] + 1, ++f) {
      if (areas[f] < min_area_share * surface) {
        continue;
      }
      const Vector3 normal = Eigen::Map<const Vector3>(&normals[3 * f]);
      const double distance = normal.dot(Eigen::Map<const Vector3>(&vertices[3 * face_vertices[at + 1]]));
      const Vector3 vector =
          image_across(reduced, centres[ids[f]] - centres[grain], radii[grain], radii[ids[f]], normal, distance);
      lists[grain].push_back({ids[f], vector, areas[f]});
    }
  });
  return lists;
}

std::vector<double> voronoi_volumes(const Box& box, std::span<const Vector3> centres, std::span<const double> radii) {
  check(box, centres, radii);
  std::vector<double> volumes(centres.size(), 0.0);
  for_each_cell(box, centres, radii,
                [&](int grain, voro::voronoicell_neighbor& cell) { volumes[grain] = cell.volume(); });
  return volumes;
}

} // namespace boba::measure
