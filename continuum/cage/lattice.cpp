// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/cage/lattice.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace boba::continuum {
namespace {

/// All planes whose normals have the given number of components of equal size, in every place and with every sign.
void add_family(std::vector<Plane>& planes, int n_components, double distance) {
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const Eigen::Vector3d normal(x, y, z);
        if (std::abs(x) + std::abs(y) + std::abs(z) == n_components) {
          planes.push_back({normal.normalized(), distance});
        }
      }
    }
  }
}

Plane plane_of(const std::string& line, const std::string& where) {
  std::istringstream stream(line);
  Eigen::Vector3d normal;
  double distance = 0;
  std::string rest;
  if (!(stream >> normal[0] >> normal[1] >> normal[2] >> distance) || stream >> rest) {
    throw std::invalid_argument(
        fmt::format("{}: \"{}\" is not allowed: it must be four numbers, normal and distance", where, line));
  }
  if (!(normal.norm() > 0) || !normal.allFinite()) {
    throw std::invalid_argument(
        fmt::format("{}: normal = ({}, {}, {}) is not allowed: it must be finite and have a length > 0", where,
                    normal[0], normal[1], normal[2]));
  }
  if (!(distance > 0) || !std::isfinite(distance)) {
    throw std::invalid_argument(fmt::format(
        "{}: distance = {} is not allowed: it must be finite and > 0, the sphere's centre inside", where, distance));
  }
  return {normal.normalized(), distance};
}

} // namespace

std::vector<Plane> lattice_planes(const std::string& name, double radius) {
  std::vector<Plane> planes;
  if (name == "sc") {
    add_family(planes, 1, radius);
  } else if (name == "fcc") {
    add_family(planes, 2, radius);
  } else if (name == "bcc") {
    add_family(planes, 3, radius);
    add_family(planes, 1, 2 / std::sqrt(3.0) * radius);
  } else {
    throw std::invalid_argument(fmt::format("lattice = {} is not allowed: it must be sc, bcc or fcc", name));
  }
  return planes;
}

std::vector<Plane> read_planes(const std::filesystem::path& file, double radius) {
  std::ifstream stream(file);
  if (!stream) {
    throw std::invalid_argument(fmt::format("planes = {} cannot be read: it must be a text file", file.string()));
  }
  std::vector<Plane> planes;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const auto first = line.find_first_not_of(" \t\r");
    if (first != std::string::npos && line[first] != '#') {
      planes.push_back(plane_of(line, fmt::format("{}, line {}", file.string(), number)));
    }
  }
  if (planes.empty()) {
    throw std::invalid_argument(fmt::format("planes = {} holds no plane: at least four are needed", file.string()));
  }
  const auto nearest = std::min_element(planes.begin(), planes.end(),
                                        [](const Plane& a, const Plane& b) { return a.distance < b.distance; });
  return scaled(planes, radius / nearest->distance);
}

void check_mirrors(const std::vector<Plane>& planes) {
  for (const Plane& plane : planes) {
    for (int c = 0; c < 3; ++c) {
      Eigen::Vector3d image = plane.normal;
      image[c] = -image[c];
      const bool found = std::any_of(planes.begin(), planes.end(), [&](const Plane& other) {
        return (other.normal - image).norm() < 1e-8 && std::abs(other.distance / plane.distance - 1) < 1e-8;
      });
      if (!found) {
        throw std::invalid_argument(fmt::format("the plane with normal ({:.6g}, {:.6g}, {:.6g}) has no mirror image in "
                                                "{} = 0: a cage must be symmetric about "
                                                "x = 0, y = 0 and z = 0",
                                                plane.normal[0], plane.normal[1], plane.normal[2], "xyz"[c]));
      }
    }
  }
}

} // namespace boba::continuum
