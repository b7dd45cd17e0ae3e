// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/convex_polyhedron.h"
#include "bpm/grain/shapes/shape_kinds.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

using Eigen::Vector3d;

/// A convex polyhedron with a ball of some radius rolled round it.
class RoundedPolyhedron final : public SolidShape {
public:
  RoundedPolyhedron(ConvexPolyhedron core, double radius) : core_(std::move(core)), radius_(radius) {}

  /// Steiner's formula: V + A r + r^2 sum l theta / 2 + 4/3 pi r^3, over edges of length l between faces whose normals
  /// make the angle theta. Source: L. A. Santalo, Integral Geometry and Geometric Probability (1976), III.13.
  double volume() const override {
    double bend = 0.0;
    for (const ConvexPolyhedron::Edge& edge : core_.edges()) {
      bend += 0.5 * edge.angle * (core_.vertices()[edge.a] - core_.vertices()[edge.b]).norm();
    }
    return core_.volume() + radius_ * (core_.surface_area() + radius_ * (bend + radius_ * 4.0 / 3.0 * M_PI));
  }

  Vector3d half_lengths() const override {
    Vector3d farthest = Vector3d::Zero();
    for (const Vector3d& v : core_.vertices()) {
      farthest = farthest.cwiseMax(v.cwiseAbs());
    }
    return farthest.array() + radius_;
  }

  double reach(const Vector3d& x) const override {
    double above = 0.0, below = 0.0; // the solid lies inside the moved faces, and holds the core
    for (const ConvexPolyhedron::Face& face : core_.faces()) {
      const double height = face.normal.dot(x);
      below = std::max(below, height / (face.offset + radius_));
      above = std::max(above, height / face.offset);
    }
    if (radius_ == 0.0) {
      return below;
    }
    constexpr int halvings = 50;
    for (int i = 0; i < halvings && above > below * (1.0 + 1e-14); ++i) {
      const double t = 0.5 * (below + above);
      (distance(x / t) > radius_ ? below : above) = t;
    }
    return above;
  }

  Vector3d wall_force(const Vector3d& x) const override {
    if (radius_ == 0.0) {
      Vector3d force = Vector3d::Zero();
      for (const ConvexPolyhedron::Face& face : core_.faces()) {
        force -= std::max(0.0, face.normal.dot(x) - face.offset) * face.normal;
      }
      return force;
    }
    const Vector3d beyond = x - core_.nearest(x);
    const double r = beyond.norm();
    return r > radius_ ? Vector3d((radius_ / r - 1.0) * beyond) : Vector3d(Vector3d::Zero());
  }

private:
  /// Of a point from the core; zero inside.
  double distance(const Vector3d& x) const { return (x - core_.nearest(x)).norm(); }

  ConvexPolyhedron core_;
  double radius_;
};

/// Without rounding, scaled by `scale`.
ConvexPolyhedron plain(const TemplateSpec& spec, double scale) {
  std::vector<Vector3d> vertices = spec.vertices;
  if (vertices.empty()) {
    vertices = named_vertices(spec.polyhedron);
    scale *= spec.radius;
  }
  for (Vector3d& v : vertices) {
    v *= scale;
  }
  return ConvexPolyhedron(vertices);
}

/// `polyhedron`, a name, with `radius`, that of the sphere through its outermost corners; or `vertices`. `rounding` s
/// shrinks it about its centre by 1 - s and rolls a ball round it whose radius is s times that of the largest sphere
/// inside, so that faces keep their places where all touch that sphere.
class PolyhedronKind final : public ShapeKind {
public:
  std::string name() const override { return "polyhedron"; }
  std::vector<std::string> keys() const override { return {"polyhedron", "vertices", "radius", "rounding"}; }
  std::unique_ptr<const SolidShape> make(const TemplateSpec& spec, double scale) const override;
  std::vector<BoundedLength> given(const TemplateSpec& spec) const override;
  std::vector<BoundedLength> widths(const TemplateSpec& spec) const override;
  std::string text(const TemplateSpec& spec) const override;
  void check(const TemplateSpec& spec) const override;
};

std::unique_ptr<const SolidShape> PolyhedronKind::make(const TemplateSpec& spec, double scale) const {
  const double radius = spec.rounding > 0.0 ? spec.rounding * plain(spec, scale).inner_radius() : 0.0;
  return std::make_unique<RoundedPolyhedron>(plain(spec, (1.0 - spec.rounding) * scale), radius);
}

std::vector<BoundedLength> PolyhedronKind::given(const TemplateSpec& spec) const {
  if (spec.vertices.empty()) {
    return {{"radius", spec.radius, spec.n_nodes ? least_proportion : 1.5}};
  }
  return {{"width", plain(spec, 1.0).width(), spec.n_nodes ? least_proportion : least_width}};
}

std::vector<BoundedLength> PolyhedronKind::widths(const TemplateSpec& spec) const {
  return {{"width", plain(spec, 1.0).width(), least_width}};
}

std::string PolyhedronKind::text(const TemplateSpec& spec) const {
  std::string text;
  if (spec.vertices.empty()) {
    text = " polyhedron=" + spec.polyhedron;
    text += spec.n_nodes ? "" : fmt::format(" radius={}", spec.radius);
  } else {
    text = " vertices=";
    for (const Vector3d& v : spec.vertices) {
      text += fmt::format("{},{},{};", v.x(), v.y(), v.z());
    }
  }
  return text + fmt::format(" rounding={}", spec.rounding);
}

void PolyhedronKind::check(const TemplateSpec& spec) const {
  if (!(spec.rounding >= 0.0 && spec.rounding <= 0.9)) {
    throw std::invalid_argument(
        fmt::format("grain template: rounding = {} is outside the allowed 0 .. 0.9", spec.rounding));
  }
  plain(spec, 1.0);
}

} // namespace

const ShapeKind& polyhedron_kind() {
  static const PolyhedronKind kind;
  return kind;
}

} // namespace boba
