// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/outline.h"
#include "bpm/grain/random.h"

#include <Eigen/Core>
#include <vector>

namespace boba {

/// `n` disordered nodes (d) at rest in a periodic cuboid [-period/2, period/2): fcc sites, random velocities, damped
/// soft repulsion.
///
/// Lengths in d. Source: Clemmer, Hackney & Grest, sample preparation, with the details of docs/notation.md, "Grain".
std::vector<Eigen::Vector3d> bulk_arrangement(const Eigen::Vector3d& period, int n, Random& random);

/// `n` disordered nodes (d) at rest inside a wall that pushes with -k times the distance beyond the outline.
///
/// They start on the fcc sites nearest to the centre (by the outline's own measure), with random velocities.
/// Source: the grains of the authors' published example.
std::vector<Eigen::Vector3d> walled_arrangement(const Outline& outline, int n, Random& random);

} // namespace boba
