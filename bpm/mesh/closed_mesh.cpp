// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/mesh/closed_mesh.h"

#include "bpm/grain/template_spec.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <Eigen/Geometry>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

namespace boba {

namespace {

using Eigen::Vector3d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<SurfaceMesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

[[noreturn]] void refuse(const std::string& message) {
  throw std::invalid_argument(message);
}

std::string shown(const Vector3d& x) {
  return fmt::format("({:g}, {:g}, {:g})", x.x(), x.y(), x.z());
}

/// Every edge has one triangle on either side, and they go along it in opposite senses.
void check_edges(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> along; // from, to: how many triangles
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      ++along[{t[k], t[(k + 1) % 3]}];
    }
  }
  for (const auto& [edge, count] : along) {
    const auto& [from, to] = edge;
    const auto other = along.find({to, from});
    const int back = other == along.end() ? 0 : other->second;
    const std::string where = fmt::format("the edge from {} to {}", shown(mesh.points[from]), shown(mesh.points[to]));
    if (count + back == 1) {
      refuse(fmt::format("is not closed: {} has one triangle", where));
    }
    if (count + back > 2) {
      refuse(fmt::format("is not the surface of a solid: {} has {} triangles", where, count + back));
    }
    if (count == 2) {
      refuse(fmt::format("is not oriented: two triangles go along {} in the same sense", where));
    }
  }
}

/// Volume and its centre by tetrahedra from the first point.
std::pair<double, Vector3d> volume_and_centre(const TriangleMesh& mesh) {
  const Vector3d apex = mesh.points.front();
  double volume = 0.0;
  Vector3d moment = Vector3d::Zero();
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.points[t[0]], b = mesh.points[t[1]], c = mesh.points[t[2]];
    const double part = (b - a).cross(c - a).dot(a - apex) / 6.0;
    volume += part;
    moment += part * 0.25 * (apex + a + b + c);
  }
  return {volume, moment / volume};
}

class MeshSurface final : public ClosedSurface {
public:
  MeshSurface(const TriangleMesh& mesh, double volume) : volume_(volume) {
    std::vector<SurfaceMesh::Vertex_index> vertices;
    std::string bytes; // of all that it is made of
    for (const Vector3d& p : mesh.points) {
      vertices.push_back(surface_.add_vertex(Point(p.x(), p.y(), p.z())));
      half_lengths_ = half_lengths_.cwiseMax(p.cwiseAbs());
      bytes.append(reinterpret_cast<const char*>(p.data()), sizeof(double) * 3);
    }
    for (const auto& t : mesh.triangles) {
      if (surface_.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]) == SurfaceMesh::null_face()) {
        refuse(fmt::format("is not the surface of a solid: parts of it meet in the point {} alone",
                           shown(mesh.points[t[0]])));
      }
      bytes.append(reinterpret_cast<const char*>(t.data()), sizeof(int) * 3);
    }
    hash_ = template_hash(bytes);
    check_crossings();
    tree_.rebuild(faces(surface_).first, faces(surface_).second, surface_);
    tree_.accelerate_distance_queries();
    side_ = std::make_unique<CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel>>(surface_);
  }

  double volume() const override { return volume_; }
  Vector3d half_lengths() const override { return half_lengths_; }
  double signed_distance(const Vector3d& x) const override {
    const Point p(x.x(), x.y(), x.z());
    const double distance = std::sqrt(tree_.squared_distance(p));
    return (*side_)(p) == CGAL::ON_BOUNDED_SIDE ? -distance : distance;
  }
  Vector3d nearest(const Vector3d& x) const override {
    const Point p = tree_.closest_point(Point(x.x(), x.y(), x.z()));
    return {p.x(), p.y(), p.z()};
  }
  std::uint64_t fingerprint() const override { return hash_; }

private:
  void check_crossings() const {
    namespace processing = CGAL::Polygon_mesh_processing;
    std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> crossings;
    processing::self_intersections(surface_, std::back_inserter(crossings));
    if (!crossings.empty()) {
      const Point p = surface_.point(surface_.target(surface_.halfedge(crossings.front().first)));
      refuse(fmt::format("cuts itself: {} pairs of triangles, the first near {}", crossings.size(),
                         shown({p.x(), p.y(), p.z()})));
    }
  }

  double volume_;
  Vector3d half_lengths_ = Vector3d::Zero();
  std::uint64_t hash_ = 0;
  SurfaceMesh surface_;
  Tree tree_;
  std::unique_ptr<CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel>> side_;
};

} // namespace

std::shared_ptr<const ClosedSurface> closed_surface(TriangleMesh mesh) {
  if (mesh.triangles.size() < 4) {
    refuse(fmt::format("has {} triangles; a solid has 4 at least", mesh.triangles.size()));
  }
  check_edges(mesh);
  const auto [volume, centre] = volume_and_centre(mesh);
  if (volume < 0.0) {
    refuse(fmt::format("is inside out: its volume is {:g}; turn the order of corners round in every triangle", volume));
  }
  double size = 0.0;
  for (Vector3d& p : mesh.points) {
    p -= centre;
    size = std::max(size, p.norm());
  }
  if (!(volume > 1e-9 * size * size * size)) {
    refuse(fmt::format("encloses the volume {:g}, next to nothing for its size", volume));
  }
  return std::make_shared<const MeshSurface>(mesh, volume);
}

} // namespace boba
