// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace boba {

/// A convex polyhedron about its centre of volume.
class ConvexPolyhedron {
public:
  /// A face: n . x <= h, |n| = 1, and its vertices in order, anticlockwise seen from outside.
  struct Face {
    Eigen::Vector3d normal;
    double offset;
    std::vector<int> vertices;
  };
  /// An edge: its two vertices and the angle between the normals of its two faces.
  struct Edge {
    int a, b;
    double angle;
  };

  /// The hull of the vertices, which may stand about any point; 4 to `most_vertices` of them.
  /// \throws std::invalid_argument when one is not a corner of the hull, or all lie in a plane.
  explicit ConvexPolyhedron(const std::vector<Eigen::Vector3d>& vertices);

  static constexpr int most_vertices = 100;

  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }
  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<Edge>& edges() const { return edges_; }
  double volume() const { return volume_; }
  double surface_area() const { return area_; }
  /// Radius of the largest sphere about the centre that fits in, and of the smallest that holds all.
  double inner_radius() const;
  double outer_radius() const;
  /// The least distance of two parallel planes with the polyhedron between, over the normals of its faces.
  double width() const;
  /// The point of the polyhedron that is nearest to a point outside it.
  Eigen::Vector3d nearest(const Eigen::Vector3d& x) const;

private:
  void find_faces();
  void add_face(const Eigen::Vector3d& normal, double offset);
  void find_edges();
  void centre();

  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Face> faces_;
  std::vector<Edge> edges_;
  double size_ = 0.0; ///< what tolerances are relative to
  double volume_ = 0.0, area_ = 0.0;
};

/// The names of the polyhedra that have one.
const std::vector<std::string>& polyhedron_names();
/// The vertices of a polyhedron by name, at the distance 1 from the centre at most.
/// \throws std::invalid_argument for another name.
std::vector<Eigen::Vector3d> named_vertices(const std::string& name);

} // namespace boba
