// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/shape_kinds.h"

#include <cmath>
#include <fmt/format.h>

namespace boba {

namespace {

using Eigen::Vector3d;

class Sphere final : public SolidShape {
public:
  explicit Sphere(double radius) : radius_(radius) {}
  double volume() const override { return 8.0 * half_lengths().prod() * (M_PI / 6.0); }
  Vector3d half_lengths() const override { return Vector3d::Constant(radius_); }
  double reach(const Vector3d& x) const override { return x.norm() / radius_; }
  Vector3d wall_force(const Vector3d& x) const override {
    const double r = x.norm();
    return r > radius_ ? Vector3d((radius_ / r - 1.0) * x) : Vector3d(Vector3d::Zero());
  }

private:
  double radius_;
};

/// `radius`.
class SphereKind final : public ShapeKind {
public:
  std::string name() const override { return "sphere"; }
  std::vector<std::string> keys() const override { return {"radius"}; }
  std::unique_ptr<const SolidShape> make(const TemplateSpec& spec, double scale) const override;
  std::vector<BoundedLength> given(const TemplateSpec& spec) const override;
  std::vector<BoundedLength> widths(const TemplateSpec&) const override { return {}; }
  std::string text(const TemplateSpec& spec) const override;
};

std::unique_ptr<const SolidShape> SphereKind::make(const TemplateSpec& spec, double scale) const {
  return std::make_unique<Sphere>(spec.radius * scale);
}

std::vector<BoundedLength> SphereKind::given(const TemplateSpec& spec) const {
  return spec.n_nodes ? std::vector<BoundedLength>{} : std::vector<BoundedLength>{{"radius", spec.radius, 1.5}};
}

std::string SphereKind::text(const TemplateSpec& spec) const {
  return spec.n_nodes ? "" : fmt::format(" radius={}", spec.radius);
}

} // namespace

const ShapeKind& sphere_kind() {
  static const SphereKind kind;
  return kind;
}

} // namespace boba
