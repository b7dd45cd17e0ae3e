// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba {

/// Nodes per d^3 of the disordered, force-free arrangement that grains are made of.
/// Source: docs/notation.md, "Grain".
inline constexpr double bulk_node_density = 1.226;

} // namespace boba
