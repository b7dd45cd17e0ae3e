// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/shape_kinds.h"
#include "bpm/grain/shapes/sized_kind.h"

#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

using Eigen::Vector3d;

double exponent_z(const TemplateSpec& spec) {
  return spec.exponent_z.value_or(spec.exponent);
}

class Superellipsoid final : public SolidShape {
public:
  Superellipsoid(const Vector3d& half_lengths, double e, double f) : half_lengths_(half_lengths), e_(e), f_(f) {}

  /// V = 2 a b c p q B(p/2 + 1, p) B(q/2, q/2), p = 2/f, q = 2/e, with Euler's beta function. Source: A. Jaklic,
  /// A. Leonardis, F. Solina, Segmentation and Recovery of Superquadrics (2000), equation 2.60.
  double volume() const override {
    const double p = 2.0 / f_, q = 2.0 / e_;
    return 2.0 * half_lengths_.prod() * p * q * std::beta(0.5 * p + 1.0, p) * std::beta(0.5 * q, 0.5 * q);
  }
  Vector3d half_lengths() const override { return half_lengths_; }

  double reach(const Vector3d& x) const override {
    const Vector3d u = x.cwiseQuotient(half_lengths_).cwiseAbs();
    const double largest = u.maxCoeff();
    if (!(largest > 0.0)) {
      return 0.0;
    }
    const Vector3d w = u / largest; // so that no power overflows
    return largest * std::pow(std::pow(in_plane(w), f_) + std::pow(w.z(), f_), 1.0 / f_);
  }

  /// To first order in the distance, along the gradient of the reach g: -(g - 1) grad g / |grad g|^2.
  Vector3d wall_force(const Vector3d& x) const override {
    const double g = reach(x);
    if (!(g > 1.0)) {
      return Vector3d::Zero();
    }
    const Vector3d u = x.cwiseQuotient(half_lengths_).cwiseAbs() / g; // on the surface
    const double s = in_plane(u);
    Vector3d gradient = Vector3d::Zero();
    for (int axis = 0; axis < 2; ++axis) {
      if (s > 0.0) {
        gradient[axis] = std::pow(s, f_ - e_) * std::pow(u[axis], e_ - 1.0);
      }
    }
    gradient.z() = std::pow(u.z(), f_ - 1.0);
    for (int axis = 0; axis < 3; ++axis) {
      gradient[axis] *= std::copysign(1.0 / half_lengths_[axis], x[axis]);
    }
    return -(g - 1.0) / gradient.squaredNorm() * gradient;
  }

private:
  double in_plane(const Vector3d& u) const { return std::pow(std::pow(u.x(), e_) + std::pow(u.y(), e_), 1.0 / e_); }

  Vector3d half_lengths_;
  double e_, f_;
};

/// `size`, `exponent` e and `exponent_z` f: (|x/a|^e + |y/b|^e)^(f/e) + |z/c|^f = 1, with a, b, c half the size.
///
/// An exponent of 2 is round, a large one a box, 1 an octahedron. Source of the form: A. H. Barr, "Superquadrics and
/// angle-preserving transformations", IEEE Computer Graphics and Applications 1 (1981), 11.
class SuperellipsoidKind final : public SizedKind {
public:
  std::string name() const override { return "superellipsoid"; }
  std::vector<std::string> keys() const override { return {"size", "exponent", "exponent_z"}; }
  std::unique_ptr<const SolidShape> make(const TemplateSpec& spec, double scale) const override;
  std::string text(const TemplateSpec& spec) const override;
  void check(const TemplateSpec& spec) const override;
};

std::unique_ptr<const SolidShape> SuperellipsoidKind::make(const TemplateSpec& spec, double scale) const {
  return std::make_unique<Superellipsoid>(0.5 * spec.size * scale, spec.exponent, exponent_z(spec));
}

std::string SuperellipsoidKind::text(const TemplateSpec& spec) const {
  return SizedKind::text(spec) + fmt::format(" exponent={} exponent_z={}", spec.exponent, exponent_z(spec));
}

void SuperellipsoidKind::check(const TemplateSpec& spec) const {
  for (const auto& [name, value] : {std::pair{"exponent", spec.exponent}, std::pair{"exponent_z", exponent_z(spec)}}) {
    if (!(value >= 1.0 && value <= 50.0)) {
      throw std::invalid_argument(fmt::format(
          "grain template: {} = {} is outside the allowed 1 .. 50 (below 1 a grain is concave)", name, value));
    }
  }
}

} // namespace

const ShapeKind& superellipsoid_kind() {
  static const SuperellipsoidKind kind;
  return kind;
}

} // namespace boba
