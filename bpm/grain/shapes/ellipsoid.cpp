// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/ellipsoid.h"

#include "bpm/grain/shapes/shape_kinds.h"
#include "bpm/grain/shapes/sized_kind.h"

#include <cmath>

namespace boba {

namespace {

using Eigen::Vector3d;

class Ellipsoid final : public SolidShape {
public:
  explicit Ellipsoid(const Vector3d& half_lengths) : half_lengths_(half_lengths) {}
  double volume() const override { return 4.0 / 3.0 * M_PI * half_lengths_.prod(); }
  Vector3d half_lengths() const override { return half_lengths_; }
  double reach(const Vector3d& x) const override { return x.cwiseQuotient(half_lengths_).norm(); }
  Vector3d wall_force(const Vector3d& x) const override {
    return reach(x) > 1.0 ? Vector3d(nearest_on_ellipsoid(half_lengths_, x) - x) : Vector3d(Vector3d::Zero());
  }

private:
  Vector3d half_lengths_;
};

/// `size`: the three diameters.
class EllipsoidKind final : public SizedKind {
public:
  std::string name() const override { return "ellipsoid"; }
  std::unique_ptr<const SolidShape> make(const TemplateSpec& spec, double scale) const override;
};

std::unique_ptr<const SolidShape> EllipsoidKind::make(const TemplateSpec& spec, double scale) const {
  return std::make_unique<Ellipsoid>(0.5 * spec.size * scale);
}

} // namespace

Vector3d nearest_on_ellipsoid(const Vector3d& half_lengths, const Vector3d& x) {
  constexpr int most_steps = 100;
  const Eigen::Array3d a2 = half_lengths.array().square();
  const Eigen::Array3d numerator = a2 * x.array().square();
  double t = 0.0;
  for (int step = 0; step < most_steps; ++step) {
    const Eigen::Array3d inverse = (a2 + t).inverse();
    const double excess = (numerator * inverse.square()).sum() - 1.0;
    const double slope = -2.0 * (numerator * inverse.cube()).sum();
    const double next = t - excess / slope;
    if (!(next > t)) { // rounding is all that is left
      break;
    }
    t = next;
  }
  return (a2 * x.array() / (a2 + t)).matrix();
}

const ShapeKind& ellipsoid_kind() {
  static const EllipsoidKind kind;
  return kind;
}

} // namespace boba
