// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/box.h"

#include <span>

namespace boba::measure {

/// Area of the convex hull of discs of the given radius around the points, projected along `normal`, d^2.
///
/// A = A_hull + L_hull radius + pi radius^2 (Steiner); L_hull is twice the length for points on one line.
double footprint_area(std::span<const Vector3> points, const Vector3& normal, double radius);

} // namespace boba::measure
