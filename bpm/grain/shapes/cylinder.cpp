// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/push_back.h"
#include "bpm/grain/shapes/shape_kinds.h"
#include "bpm/grain/shapes/sized_kind.h"

#include <algorithm>
#include <cmath>

namespace boba {

namespace {

using Eigen::Vector3d;

class Cylinder final : public SolidShape {
public:
  Cylinder(double radius, double half_height) : half_lengths_(radius, radius, half_height) {}
  double volume() const override { return 8.0 * half_lengths_.prod() * (M_PI / 4.0); }
  Vector3d half_lengths() const override { return half_lengths_; }
  double reach(const Vector3d& x) const override {
    return std::max(std::hypot(x.x(), x.y()) / half_lengths_.x(), std::abs(x.z()) / half_lengths_.z());
  }
  Vector3d wall_force(const Vector3d& x) const override {
    const double rho = std::hypot(x.x(), x.y());
    const double radial = rho > half_lengths_.x() ? half_lengths_.x() / rho - 1.0 : 0.0;
    return {radial * x.x(), radial * x.y(), push_back(x.z(), half_lengths_.z())};
  }

private:
  Vector3d half_lengths_;
};

/// `radius` and `height`, axis along z.
class CylinderKind final : public RadiusAndHeightKind {
public:
  std::string name() const override { return "cylinder"; }
  std::unique_ptr<const SolidShape> make(const TemplateSpec& spec, double scale) const override;
  std::vector<BoundedLength> widths(const TemplateSpec& spec) const override;
};

std::unique_ptr<const SolidShape> CylinderKind::make(const TemplateSpec& spec, double scale) const {
  return std::make_unique<Cylinder>(spec.radius * scale, 0.5 * spec.height * scale);
}

std::vector<BoundedLength> CylinderKind::widths(const TemplateSpec& spec) const {
  return {{"diameter", 2.0 * spec.radius, least_width}, {"height", spec.height, least_width}};
}

} // namespace

const ShapeKind& cylinder_kind() {
  static const CylinderKind kind;
  return kind;
}

} // namespace boba
