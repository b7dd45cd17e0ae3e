// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/mesh/closed_mesh.h"

#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Simple_cartesian.h>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>

namespace boba {

namespace {

using Eigen::Vector3d;
using Point = CGAL::Simple_cartesian<double>::Point_3;

constexpr double largest_coordinate = 1e9;

[[noreturn]] void refuse(const std::string& message) {
  throw std::invalid_argument(message);
}

std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

/// Numbers in the head of an OFF or PLY file, for which room would be made before anything is read.
void check_announced_counts(const std::filesystem::path& path, const std::string& ending) {
  std::ifstream in(path, std::ios::binary);
  constexpr int head_lines = 100;
  std::string line;
  const auto check = [](double count) {
    if (!(count >= 0.0 && count <= 3.0 * static_cast<double>(most_triangles))) {
      refuse(fmt::format("announces {:.0f} points or faces; at most {} triangles are allowed", count, most_triangles));
    }
  };
  for (int n = 0; n < head_lines && std::getline(in, line); ++n) {
    std::istringstream words(line.substr(0, 200));
    std::string first, kind;
    double count = 0.0, second = 0.0;
    if (ending == ".ply" && words >> first && first == "element" && words >> kind >> count) {
      check(count);
    } else if (ending == ".ply" && first == "end_header") {
      return;
    } else if (std::istringstream numbers(line.substr(0, 200)); ending == ".off" && numbers >> count >> second) {
      check(count);
      check(second);
      return;
    }
  }
}

void check_file(const std::filesystem::path& path, const std::string& ending) {
  if (ending != ".stl" && ending != ".off" && ending != ".ply" && ending != ".obj") {
    refuse("ends in none of .stl, .off, .ply, .obj");
  }
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) {
    refuse("cannot be read: " + error.message());
  }
  if (bytes > longest_mesh_file) {
    refuse(fmt::format("is {} bytes long; allowed: {}", bytes, longest_mesh_file));
  }
  if (ending == ".ply" || ending == ".off") {
    check_announced_counts(path, ending);
  }
}

/// Numbers of the points once those that coincide are one; STL names every corner of every triangle.
class PointNumbers {
public:
  explicit PointNumbers(std::vector<Vector3d>& points) : points_(points) {}
  int of(const Point& p) {
    const auto [at, is_new] = number_.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(points_.size()));
    if (is_new) {
      points_.emplace_back(p.x(), p.y(), p.z());
    }
    return at->second;
  }

private:
  std::vector<Vector3d>& points_;
  std::map<std::array<double, 3>, int> number_;
};

void check_points(const std::vector<Point>& points) {
  for (std::size_t n = 0; n < points.size(); ++n) {
    for (const double x : {points[n].x(), points[n].y(), points[n].z()}) {
      if (!(std::abs(x) <= largest_coordinate)) {
        refuse(fmt::format("point {} has the coordinate {}; allowed: up to {:g}", n, x, largest_coordinate));
      }
    }
  }
}

} // namespace

TriangleMesh read_triangle_mesh(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  check_file(path, ending);
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> faces;
  bool is_read = false;
  try {
    is_read = CGAL::IO::read_polygon_soup(path.string(), points, faces);
  } catch (const std::bad_alloc&) {
    refuse("asks for more memory than there is");
  } catch (const std::exception&) {
    is_read = false;
  }
  if (!is_read || faces.empty()) {
    refuse(fmt::format("cannot be read as {}", ending.substr(1)));
  }
  check_points(points);
  TriangleMesh mesh;
  PointNumbers numbers(mesh.points);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::vector<std::size_t>& corners = faces[f];
    if (corners.size() < 3 ||
        std::any_of(corners.begin(), corners.end(), [&](std::size_t c) { return c >= points.size(); })) {
      refuse(fmt::format("face {} has {} corners, or a corner that is no point", f, corners.size()));
    }
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
      const std::array<int, 3> triangle = {numbers.of(points[corners[0]]), numbers.of(points[corners[k]]),
                                           numbers.of(points[corners[k + 1]])};
      if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0]) {
        mesh.triangles.push_back(triangle);
      }
    }
    if (mesh.triangles.size() > most_triangles) {
      refuse(fmt::format("has more than the {} triangles that are allowed", most_triangles));
    }
  }
  return mesh;
}

} // namespace boba
