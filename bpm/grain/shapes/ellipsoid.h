// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace boba {

/// The point of the ellipsoid sum (x_i / a_i)^2 = 1 that is nearest to a point outside it, d.
///
/// p_i = a_i^2 x_i / (t + a_i^2), with t >= 0 the root of sum (a_i x_i / (t + a_i^2))^2 = 1, which falls and is convex:
/// Newton's steps from t = 0 approach the root from below.
Eigen::Vector3d nearest_on_ellipsoid(const Eigen::Vector3d& half_lengths, const Eigen::Vector3d& x);

} // namespace boba
