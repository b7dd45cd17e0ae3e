// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba {

/// How a shear of the cell acts on the nodes.
/// Source: docs/notation.md, "Box".
enum class Remap {
  positions,  ///< node positions follow the cell affinely; damping sees peculiar velocities
  velocities, ///< positions stay; an image across the gradient direction carries the velocity of the cell's shear
};

} // namespace boba
