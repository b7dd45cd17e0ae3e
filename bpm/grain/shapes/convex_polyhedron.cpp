// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/convex_polyhedron.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <stdexcept>

namespace boba {

namespace {

using Eigen::Vector3d;

/// Points nearer to a plane than this share of the polyhedron's size lie in it.
constexpr double flatness = 1e-9;

Vector3d nearest_on_segment(const Vector3d& a, const Vector3d& b, const Vector3d& x) {
  const Vector3d along = b - a;
  return a + std::clamp(along.dot(x - a) / along.squaredNorm(), 0.0, 1.0) * along;
}

} // namespace

ConvexPolyhedron::ConvexPolyhedron(const std::vector<Vector3d>& vertices) : vertices_(vertices) {
  if (vertices.size() < 4 || vertices.size() > most_vertices) {
    throw std::invalid_argument(fmt::format("grain template: vertices names {} points; a polyhedron has 4 to {}",
                                            vertices.size(), most_vertices));
  }
  for (const Vector3d& v : vertices_) {
    size_ = std::max(size_, (v - vertices_.front()).norm());
  }
  find_faces();
  find_edges();
  centre();
}

/// Every plane through three vertices that has all others on one side.
void ConvexPolyhedron::find_faces() {
  const int n = static_cast<int>(vertices_.size());
  const double tolerance = flatness * size_;
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      for (int c = b + 1; c < n; ++c) {
        const Vector3d cross = (vertices_[b] - vertices_[a]).cross(vertices_[c] - vertices_[a]);
        if (!(cross.norm() > tolerance * size_)) {
          continue;
        }
        Vector3d normal = cross.normalized();
        double lowest = 0.0, highest = 0.0;
        for (const Vector3d& v : vertices_) {
          const double height = normal.dot(v - vertices_[a]);
          lowest = std::min(lowest, height);
          highest = std::max(highest, height);
        }
        if (highest <= tolerance && lowest < -tolerance) {
          add_face(normal, normal.dot(vertices_[a]));
        } else if (lowest >= -tolerance && highest > tolerance) {
          add_face(-normal, -normal.dot(vertices_[a]));
        }
      }
    }
  }
  if (faces_.size() < 4) {
    throw std::invalid_argument("grain template: the vertices all lie in one plane; a polyhedron has a volume");
  }
  std::vector<bool> used(vertices_.size(), false);
  for (const Face& face : faces_) {
    for (const int v : face.vertices) {
      used[v] = true;
    }
  }
  const auto inside = std::find(used.begin(), used.end(), false);
  if (inside != used.end()) {
    throw std::invalid_argument(fmt::format("grain template: vertices[{}] is no corner of the polyhedron that the "
                                            "others span",
                                            inside - used.begin()));
  }
}

/// Adds a face unless it is there already, with its vertices in order about its middle.
void ConvexPolyhedron::add_face(const Vector3d& normal, double offset) {
  const double tolerance = flatness * size_;
  for (const Face& face : faces_) {
    if ((face.normal - normal).norm() < 1e-6 && std::abs(face.offset - offset) < 10.0 * tolerance) {
      return;
    }
  }
  Face face{normal, offset, {}};
  Vector3d middle = Vector3d::Zero();
  for (int v = 0; v < static_cast<int>(vertices_.size()); ++v) {
    if (normal.dot(vertices_[v]) >= offset - tolerance) {
      face.vertices.push_back(v);
      middle += vertices_[v];
    }
  }
  middle /= static_cast<double>(face.vertices.size());
  const Vector3d first = (vertices_[face.vertices.front()] - middle).normalized(), second = normal.cross(first);
  std::map<int, double> angle;
  for (const int v : face.vertices) {
    const Vector3d r = vertices_[v] - middle;
    angle[v] = std::atan2(second.dot(r), first.dot(r));
  }
  std::sort(face.vertices.begin(), face.vertices.end(), [&](int a, int b) { return angle[a] < angle[b]; });
  faces_.push_back(std::move(face));
}

void ConvexPolyhedron::find_edges() {
  std::map<std::pair<int, int>, std::vector<int>> faces_of;
  for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
    const std::vector<int>& corners = faces_[f].vertices;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const int a = corners[k], b = corners[(k + 1) % corners.size()];
      faces_of[std::minmax(a, b)].push_back(f);
    }
  }
  for (const auto& [ends, two] : faces_of) {
    if (two.size() != 2) {
      throw std::invalid_argument(fmt::format("grain template: vertices[{}] and vertices[{}] are too near to each "
                                              "other, or to a plane through others, to tell the faces apart",
                                              ends.first, ends.second));
    }
    const double cosine = faces_[two[0]].normal.dot(faces_[two[1]].normal);
    edges_.push_back({ends.first, ends.second, std::acos(std::clamp(cosine, -1.0, 1.0))});
  }
}

/// Volume, area and centre of volume by tetrahedra from one vertex; then all is moved to that centre.
void ConvexPolyhedron::centre() {
  const Vector3d apex = vertices_.front();
  Vector3d moment = Vector3d::Zero();
  for (const Face& face : faces_) {
    for (std::size_t k = 1; k + 1 < face.vertices.size(); ++k) {
      const Vector3d a = vertices_[face.vertices[0]], b = vertices_[face.vertices[k]],
                     c = vertices_[face.vertices[k + 1]];
      const Vector3d cross = (b - a).cross(c - a);
      area_ += 0.5 * cross.norm();
      const double volume = cross.dot(a - apex) / 6.0;
      volume_ += volume;
      moment += volume * 0.25 * (apex + a + b + c);
    }
  }
  const Vector3d middle = moment / volume_;
  for (Vector3d& v : vertices_) {
    v -= middle;
  }
  for (Face& face : faces_) {
    face.offset -= face.normal.dot(middle);
  }
}

double ConvexPolyhedron::inner_radius() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Face& face : faces_) {
    least = std::min(least, face.offset);
  }
  return least;
}

double ConvexPolyhedron::outer_radius() const {
  double most = 0.0;
  for (const Vector3d& v : vertices_) {
    most = std::max(most, v.norm());
  }
  return most;
}

double ConvexPolyhedron::width() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Face& face : faces_) {
    double lowest = 0.0;
    for (const Vector3d& v : vertices_) {
      lowest = std::min(lowest, face.normal.dot(v));
    }
    least = std::min(least, face.offset - lowest);
  }
  return least;
}

Vector3d ConvexPolyhedron::nearest(const Vector3d& x) const {
  Vector3d best = x;
  double least = std::numeric_limits<double>::infinity();
  const auto take = [&](const Vector3d& y) {
    if (const double d2 = (y - x).squaredNorm(); d2 < least) {
      least = d2;
      best = y;
    }
  };
  for (const Face& face : faces_) {
    const double height = face.normal.dot(x) - face.offset;
    if (height <= 0.0) {
      continue; // the nearest point lies on a face that sees x
    }
    const Vector3d foot = x - height * face.normal;
    bool within = true;
    const std::size_t n = face.vertices.size();
    for (std::size_t k = 0; k < n; ++k) {
      const Vector3d &a = vertices_[face.vertices[k]], &b = vertices_[face.vertices[(k + 1) % n]];
      if (face.normal.dot((b - a).cross(foot - a)) < 0.0) {
        within = false;
        take(nearest_on_segment(a, b, x));
      }
    }
    if (within) {
      take(foot);
    }
  }
  return best;
}

} // namespace boba
