// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/shapes/shape.h"

namespace boba {

/// The kinds, one source file each. What a shape takes stands with its class there.
const ShapeKind& sphere_kind();
const ShapeKind& cylinder_kind();
const ShapeKind& box_kind();
const ShapeKind& periodic_box_kind();
const ShapeKind& ellipsoid_kind();
const ShapeKind& superellipsoid_kind();
const ShapeKind& capsule_kind();
const ShapeKind& polyhedron_kind();
const ShapeKind& mesh_kind();

} // namespace boba
