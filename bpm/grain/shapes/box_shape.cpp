// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/box_shape.h"

#include "bpm/grain/shapes/push_back.h"

#include <fmt/format.h>

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

std::vector<BoundedLength> lengths(const TemplateSpec& spec, double lowest) {
  std::vector<BoundedLength> result;
  for (int a = 0; a < 3; ++a) {
    result.push_back({fmt::format("size[{}]", a), spec.size[a], lowest});
  }
  return result;
}

} // namespace

std::string size_text(const TemplateSpec& spec) {
  const double unit = spec.n_nodes ? spec.size.x() : 1.0;
  return fmt::format(" size={},{},{}", spec.size.x() / unit, spec.size.y() / unit, spec.size.z() / unit);
}

std::vector<BoundedLength> given_size(const TemplateSpec& spec) {
  return lengths(spec, spec.n_nodes ? least_proportion : least_width);
}

std::vector<BoundedLength> size_widths(const TemplateSpec& spec) {
  return lengths(spec, least_width);
}

std::unique_ptr<const SolidShape> BoxKind::make(const TemplateSpec& spec, double scale) const {
  return std::make_unique<Cuboid>(0.5 * spec.size * scale);
}

std::vector<BoundedLength> BoxKind::given(const TemplateSpec& spec) const {
  return given_size(spec);
}

std::vector<BoundedLength> BoxKind::widths(const TemplateSpec& spec) const {
  return size_widths(spec);
}

std::string BoxKind::text(const TemplateSpec& spec) const {
  return size_text(spec);
}

} // namespace boba
