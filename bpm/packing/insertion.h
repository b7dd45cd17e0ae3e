// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/packing.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace boba {

class Random;

/// What to place: one entry of `grains` a grain.
struct Insertion {
  std::vector<std::shared_ptr<const GrainTemplate>> templates;
  std::vector<Grain> grains;
  double packing_fraction = 0.4; ///< sum of the grains' reference volumes over the cell's volume
  bool rotate = true;
  std::uint64_t seed = 1;
  double diameter = 1.0; ///< d; nodes of different grains end up at least this far apart
};

/// Largest distance of a node from the template's centre, plus half a node diameter (d).
double bounding_radius(const GrainTemplate& grain, double diameter);

/// Centres of spheres without overlap in a periodic cube [0, edge)^3: random ones, pushed apart.
/// Lengths in d; the result depends on the arguments and the state of `random` alone.
/// \throws std::runtime_error when the overlaps cannot be removed (too dense).
std::vector<Vector3> place_spheres(const std::vector<double>& radii, double edge, Random& random);

/// Edge of the cubic cell of an insertion, d.
/// \throws std::invalid_argument without grains, without a packing fraction, or when the cell would be too large.
double insertion_edge(const Insertion& insertion);

/// Grains at rest at random places and angles in a cubic periodic cell, no two bounding spheres overlapping.
/// \throws std::invalid_argument when the bounding spheres would fill more than a random arrangement can (0.60), with
/// the packing fraction that is allowed; std::runtime_error when the overlaps cannot be removed.
Packing insert_at_random(const Insertion& insertion);

/// A rotation drawn uniformly from all rotations.
/// Source: K. Shoemake, "Uniform random rotations", Graphics Gems III (1992), p. 124.
Eigen::Quaterniond random_rotation(Random& random);

} // namespace boba
