// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/template_spec.h"

#include <Eigen/Core>

namespace boba {

/// The ideal shape of a grain, centred on the origin; a cylinder's axis is z. Lengths in d.
class Outline {
public:
  /// The shape of a valid specification, scaled as a whole by `scale`.
  Outline(const TemplateSpec& spec, double scale);
  /// The same shape scaled to a volume (d^3).
  static Outline with_volume(const TemplateSpec& spec, double volume);

  double volume() const;
  Eigen::Vector3d half_lengths() const { return half_lengths_; }

  /// The factor by which the outline must be scaled for its surface to pass through x; below 1 inside.
  double reach(const Eigen::Vector3d& x) const;

  /// Force (k d) of a wall of stiffness k at the outline: -k times the distance beyond each face, along its normal.
  Eigen::Vector3d wall_force(const Eigen::Vector3d& x) const;

private:
  TemplateSpec::Shape shape_;
  Eigen::Vector3d half_lengths_; // (R, R, R), (R, R, height / 2) or size / 2
};

} // namespace boba
