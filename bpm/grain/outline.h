// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/shapes/shape.h"

#include <memory>

namespace boba {

/// The ideal shape of a grain, centred on the origin; the axis of a cylinder or capsule is z. Lengths in d.
class Outline {
public:
  /// The shape of a valid specification, scaled as a whole by `scale`.
  Outline(const TemplateSpec& spec, double scale);
  /// The same shape scaled to a volume (d^3).
  static Outline with_volume(const TemplateSpec& spec, double volume);

  double volume() const { return shape_->volume(); }
  Eigen::Vector3d half_lengths() const { return shape_->half_lengths(); }

  /// The factor by which the outline must be scaled for its surface to pass through x; below 1 inside.
  double reach(const Eigen::Vector3d& x) const { return shape_->reach(x); }

  /// Force (k d) of a wall of stiffness k at the outline: -k times the distance beyond each face, along its normal.
  Eigen::Vector3d wall_force(const Eigen::Vector3d& x) const { return shape_->wall_force(x); }

private:
  std::shared_ptr<const SolidShape> shape_;
};

} // namespace boba
