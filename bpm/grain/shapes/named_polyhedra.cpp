// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/convex_polyhedron.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace boba {

namespace {

using Eigen::Vector3d;
using Vertices = std::vector<Vector3d>;

/// x with all its signs; a zero has one.
Vertices with_signs(const Vector3d& x) {
  Vertices result;
  for (int signs = 0; signs < 8; ++signs) {
    Vector3d v = x;
    bool is_new = true;
    for (int axis = 0; axis < 3; ++axis) {
      if ((signs >> axis & 1) != 0) {
        is_new = is_new && x[axis] != 0.0;
        v[axis] = -v[axis];
      }
    }
    if (is_new) {
      result.push_back(v);
    }
  }
  return result;
}

Vertices joined(Vertices first, const Vertices& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// x with all its signs and its coordinates in cyclic order.
Vertices cyclic(const Vector3d& x) {
  return joined(joined(with_signs(x), with_signs({x.y(), x.z(), x.x()})), with_signs({x.z(), x.x(), x.y()}));
}

Vertices tetrahedron() {
  return {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
}

Vertices cube() {
  return with_signs({1, 1, 1});
}

Vertices octahedron() {
  return cyclic({1, 0, 0});
}

constexpr double golden = std::numbers::phi;

Vertices dodecahedron() {
  return joined(cube(), cyclic({0, 1.0 / golden, golden}));
}

Vertices icosahedron() {
  return cyclic({0, 1, golden});
}

Vertices rhombic_dodecahedron() {
  return joined(cube(), cyclic({2, 0, 0}));
}

Vertices truncated_octahedron() {
  return joined(cyclic({0, 1, 2}), cyclic({0, 2, 1}));
}

Vertices cuboctahedron() {
  return cyclic({1, 1, 0});
}

using Maker = Vertices (*)();

const std::vector<std::pair<std::string, Maker>>& makers() {
  static const std::vector<std::pair<std::string, Maker>> all = {{"tetrahedron", tetrahedron},
                                                                 {"cube", cube},
                                                                 {"octahedron", octahedron},
                                                                 {"dodecahedron", dodecahedron},
                                                                 {"icosahedron", icosahedron},
                                                                 {"rhombic dodecahedron", rhombic_dodecahedron},
                                                                 {"truncated octahedron", truncated_octahedron},
                                                                 {"cuboctahedron", cuboctahedron}};
  return all;
}

} // namespace

const std::vector<std::string>& polyhedron_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, maker] : makers()) {
      all.push_back(name);
    }
    return all;
  }();
  return names;
}

Vertices named_vertices(const std::string& name) {
  for (const auto& [known, maker] : makers()) {
    if (known == name) {
      Vertices vertices = maker();
      double farthest = 0.0;
      for (const Vector3d& v : vertices) {
        farthest = std::max(farthest, v.norm());
      }
      for (Vector3d& v : vertices) {
        v /= farthest;
      }
      return vertices;
    }
  }
  throw std::invalid_argument(
      fmt::format("grain template: polyhedron = \"{}\" is not one of {}", name, fmt::join(polyhedron_names(), ", ")));
}

} // namespace boba
