// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/shape_kinds.h"
#include "bpm/grain/shapes/sized_kind.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

using Eigen::Vector3d;

class Capsule final : public SolidShape {
public:
  /// `half_axis` is half the distance of the two spheres' centres.
  Capsule(double radius, double half_axis) : radius_(radius), half_axis_(half_axis) {}

  double volume() const override { return M_PI * radius_ * radius_ * (4.0 / 3.0 * radius_ + 2.0 * half_axis_); }
  Vector3d half_lengths() const override { return {radius_, radius_, radius_ + half_axis_}; }

  /// The factor t at which the distance of x from the axis, t times as long, is t R.
  double reach(const Vector3d& x) const override {
    const double rho2 = x.x() * x.x() + x.y() * x.y(), z = std::abs(x.z());
    const double beside = std::sqrt(rho2) / radius_; // t where the nearest point lies within the axis
    if (z <= beside * half_axis_) {
      return beside;
    }
    const double c = z * half_axis_, r2 = rho2 + z * z;
    // rho^2 + (z - t c)^2 = (t R)^2, its positive root in the form without cancellation
    return r2 / (c + std::sqrt(c * c + (radius_ * radius_ - half_axis_ * half_axis_) * r2));
  }

  Vector3d wall_force(const Vector3d& x) const override {
    const Vector3d from_axis = x - Vector3d(0.0, 0.0, std::clamp(x.z(), -half_axis_, half_axis_));
    const double r = from_axis.norm();
    return r > radius_ ? Vector3d((radius_ / r - 1.0) * from_axis) : Vector3d(Vector3d::Zero());
  }

private:
  double radius_, half_axis_;
};

/// `radius` and `height`: a cylinder along z with two half spheres, `height` long with both.
class CapsuleKind final : public RadiusAndHeightKind {
public:
  std::string name() const override { return "capsule"; }
  std::unique_ptr<const SolidShape> make(const TemplateSpec& spec, double scale) const override;
  std::vector<BoundedLength> widths(const TemplateSpec& spec) const override;
  void check(const TemplateSpec& spec) const override;
};

std::unique_ptr<const SolidShape> CapsuleKind::make(const TemplateSpec& spec, double scale) const {
  return std::make_unique<Capsule>(spec.radius * scale, (0.5 * spec.height - spec.radius) * scale);
}

std::vector<BoundedLength> CapsuleKind::widths(const TemplateSpec& spec) const {
  return {{"diameter", 2.0 * spec.radius, least_width}};
}

void CapsuleKind::check(const TemplateSpec& spec) const {
  if (!(spec.height >= 2.0 * spec.radius)) {
    throw std::invalid_argument(fmt::format("grain template: height = {} is outside the allowed {} and above: a "
                                            "capsule is two half spheres and what lies between",
                                            spec.height, 2.0 * spec.radius));
  }
}

} // namespace

const ShapeKind& capsule_kind() {
  static const CapsuleKind kind;
  return kind;
}

} // namespace boba
