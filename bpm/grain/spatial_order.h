// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace boba {

/// Indices of the points (lengths in d) in the order in which a Hilbert curve through their bounding cube meets them.
/// Source: the curve as defined by C. H. Hamilton, "Compact Hilbert Indices", Dalhousie University CS-2006-07.
std::vector<int> hilbert_order(const std::vector<Eigen::Vector3d>& position);

} // namespace boba
