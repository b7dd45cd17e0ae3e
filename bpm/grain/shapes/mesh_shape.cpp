// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/closed_surface.h"
#include "bpm/grain/shapes/shape_kinds.h"

#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

using Eigen::Vector3d;

class MeshShape final : public SolidShape {
public:
  MeshShape(std::shared_ptr<const ClosedSurface> surface, double scale) : surface_(std::move(surface)), scale_(scale) {}
  double volume() const override { return scale_ * scale_ * scale_ * surface_->volume(); }
  Vector3d half_lengths() const override { return scale_ * surface_->half_lengths(); }

  /// 1 + distance / largest half length: a body that is not convex has no factor for every point. Below 1 inside and
  /// above outside, and growing with the distance.
  double reach(const Vector3d& x) const override {
    return 1.0 + surface_->signed_distance(x / scale_) / surface_->half_lengths().maxCoeff();
  }
  Vector3d wall_force(const Vector3d& x) const override {
    const Vector3d inner = x / scale_;
    return surface_->signed_distance(inner) > 0.0 ? Vector3d(scale_ * (surface_->nearest(inner) - inner))
                                                  : Vector3d(Vector3d::Zero());
  }

private:
  std::shared_ptr<const ClosedSurface> surface_;
  double scale_;
};

const ClosedSurface& surface_of(const TemplateSpec& spec) {
  if (spec.mesh == nullptr) {
    throw std::invalid_argument("grain template: the file of its mesh has not been read");
  }
  return *spec.mesh;
}

std::vector<BoundedLength> extents(const TemplateSpec& spec, double lowest) {
  const Vector3d size = 2.0 * spec.scale * surface_of(spec).half_lengths();
  return {
      {"extent along x", size.x(), lowest}, {"extent along y", size.y(), lowest}, {"extent along z", size.z(), lowest}};
}

/// `file`, a closed surface of triangles, and `scale`, its unit in d.
class MeshKind final : public ShapeKind {
public:
  std::string name() const override { return "mesh"; }
  std::vector<std::string> keys() const override { return {"file", "scale"}; }
  std::unique_ptr<const SolidShape> make(const TemplateSpec& spec, double scale) const override;
  std::vector<BoundedLength> given(const TemplateSpec& spec) const override;
  std::vector<BoundedLength> widths(const TemplateSpec& spec) const override;
  std::string text(const TemplateSpec& spec) const override;
  void check(const TemplateSpec& spec) const override;
};

std::unique_ptr<const SolidShape> MeshKind::make(const TemplateSpec& spec, double scale) const {
  surface_of(spec);
  return std::make_unique<MeshShape>(spec.mesh, spec.scale * scale);
}

std::vector<BoundedLength> MeshKind::given(const TemplateSpec& spec) const {
  return spec.n_nodes ? std::vector<BoundedLength>{} : extents(spec, least_width);
}

std::vector<BoundedLength> MeshKind::widths(const TemplateSpec& spec) const {
  return extents(spec, least_width);
}

std::string MeshKind::text(const TemplateSpec& spec) const {
  return fmt::format(" surface={:016x}", surface_of(spec).fingerprint()) +
         (spec.n_nodes ? "" : fmt::format(" scale={}", spec.scale));
}

void MeshKind::check(const TemplateSpec& spec) const {
  if (!(spec.scale > 0.0 && spec.scale <= 1e6)) {
    throw std::invalid_argument(fmt::format("grain template: scale = {} is outside the allowed: above 0 and at most "
                                            "1e6",
                                            spec.scale));
  }
}

} // namespace

const ShapeKind& mesh_kind() {
  static const MeshKind kind;
  return kind;
}

} // namespace boba
