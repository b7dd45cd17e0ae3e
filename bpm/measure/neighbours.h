// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/box.h"

#include <span>
#include <vector>

namespace boba::measure {

/// A neighbour of a grain: which grain, where its nearest copy is, and how much it counts.
struct Neighbour {
  int grain = 0;
  Vector3 vector = Vector3::Zero(); ///< from the grain's centre to the neighbour's (that periodic copy), d
  double weight = 1.0;              ///< 1, or the area of the shared Voronoi face, d^2
};

/// Neighbours of every grain. A grain in a small periodic box may be its own neighbour, or another one's twice.
using NeighbourLists = std::vector<std::vector<Neighbour>>;

/// Neighbours by solid angle: the m nearest, with the smallest m >= 3 for which sum_{j<=m} r_j / (m - 2) <= r_{m+1}.
///
/// Free of parameters and scale: 12 in fcc and hcp, 14 in bcc. Weights are 1. Not always mutual.
/// \throws std::invalid_argument when centres coincide, or when an open box holds too few grains.
/// Source: van Meel, Filion, Valeriani, Frenkel, J. Chem. Phys. 136, 234107 (2012).
NeighbourLists solid_angle_neighbours(const Box& box, std::span<const Vector3> centres);

/// The `n` nearest neighbours, nearest first; fewer where an open box holds fewer. Weights are 1.
/// \throws std::invalid_argument when centres coincide, or without grains.
NeighbourLists nearest_neighbours(const Box& box, std::span<const Vector3> centres, int n);

/// Neighbours by radical (power) Voronoi cells; weights are the areas of the shared faces.
///
/// \param radii one a grain, d: the cell of a large grain reaches farther; equal radii give the Voronoi cells
/// \param min_area_share faces smaller than this share of their cell's surface are left out: in a perfect crystal
/// several cells meet in one point, and rounding turns that point into a tiny face
/// \throws std::invalid_argument for a box that is not periodic in all directions, or centres that coincide.
/// Source: Rycroft, Chaos 19, 041111 (2009), Voro++.
NeighbourLists voronoi_neighbours(const Box& box, std::span<const Vector3> centres, std::span<const double> radii,
                                  double min_area_share = 1e-6);

/// Volumes of the same radical Voronoi cells, d^3; they fill the box. A cell may be empty (0).
std::vector<double> voronoi_volumes(const Box& box, std::span<const Vector3> centres, std::span<const double> radii);

} // namespace boba::measure
