// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/outline.h"

#include <algorithm>
#include <cmath>

namespace boba {

namespace {

using Eigen::Vector3d;
using Shape = TemplateSpec::Shape;

/// -overlap beyond [-half, half], signed.
double push_back(double x, double half) {
  return x > half ? half - x : x < -half ? -half - x : 0.0;
}

} // namespace

Outline::Outline(const TemplateSpec& spec, double scale) : shape_(spec.shape) {
  if (shape_ == Shape::sphere) {
    half_lengths_.setConstant(spec.radius);
  } else if (shape_ == Shape::cylinder) {
    half_lengths_ = {spec.radius, spec.radius, 0.5 * spec.height};
  } else {
    half_lengths_ = 0.5 * spec.size;
  }
  half_lengths_ *= scale;
}

Outline Outline::with_volume(const TemplateSpec& spec, double volume) {
  return Outline(spec, std::cbrt(volume / Outline(spec, 1.0).volume()));
}

double Outline::volume() const {
  const double filled = shape_ == Shape::sphere ? M_PI / 6.0 : shape_ == Shape::cylinder ? M_PI / 4.0 : 1.0;
  return 8.0 * half_lengths_.prod() * filled;
}

double Outline::reach(const Vector3d& x) const {
  if (shape_ == Shape::sphere) {
    return x.norm() / half_lengths_.x();
  }
  if (shape_ == Shape::cylinder) {
    return std::max(std::hypot(x.x(), x.y()) / half_lengths_.x(), std::abs(x.z()) / half_lengths_.z());
  }
  return x.cwiseQuotient(half_lengths_).cwiseAbs().maxCoeff();
}

Vector3d Outline::wall_force(const Vector3d& x) const {
  if (shape_ == Shape::sphere) {
    const double r = x.norm();
    return r > half_lengths_.x() ? Vector3d((half_lengths_.x() / r - 1.0) * x) : Vector3d(Vector3d::Zero());
  }
  if (shape_ == Shape::cylinder) {
    const double rho = std::hypot(x.x(), x.y());
    const double radial = rho > half_lengths_.x() ? half_lengths_.x() / rho - 1.0 : 0.0;
    return {radial * x.x(), radial * x.y(), push_back(x.z(), half_lengths_.z())};
  }
  return x.binaryExpr(half_lengths_, &push_back);
}

} // namespace boba
