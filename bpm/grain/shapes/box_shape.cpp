// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/push_back.h"
#include "bpm/grain/shapes/shape_kinds.h"
#include "bpm/grain/shapes/sized_kind.h"

namespace boba {

namespace {

using Eigen::Vector3d;

class Cuboid final : public SolidShape {
public:
  explicit Cuboid(const Vector3d& half_lengths) : half_lengths_(half_lengths) {}
  double volume() const override { return 8.0 * half_lengths_.prod(); }
  Vector3d half_lengths() const override { return half_lengths_; }
  double reach(const Vector3d& x) const override { return x.cwiseQuotient(half_lengths_).cwiseAbs().maxCoeff(); }
  Vector3d wall_force(const Vector3d& x) const override { return x.binaryExpr(half_lengths_, &push_back); }

private:
  Vector3d half_lengths_;
};

/// `size`: the edges of a cuboid.
class BoxKind : public SizedKind {
public:
  std::string name() const override { return "box"; }
  std::unique_ptr<const SolidShape> make(const TemplateSpec& spec, double scale) const override;
};

/// The same without a surface: bonds cross the faces.
class PeriodicBoxKind final : public BoxKind {
public:
  std::string name() const override { return "periodic_box"; }
};

std::unique_ptr<const SolidShape> BoxKind::make(const TemplateSpec& spec, double scale) const {
  return std::make_unique<Cuboid>(0.5 * spec.size * scale);
}

} // namespace

const ShapeKind& box_kind() {
  static const BoxKind kind;
  return kind;
}

const ShapeKind& periodic_box_kind() {
  static const PeriodicBoxKind kind;
  return kind;
}

} // namespace boba
