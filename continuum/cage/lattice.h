// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/cage/plane.h"

#include <filesystem>
#include <string>

namespace boba::continuum {

/// The planes midway to the neighbours of a grain in a crystal of equal spheres, the nearest ones at distance `radius`:
/// sc six {100}, bcc eight {111} and six {100} at 2 / sqrt(3) of their distance, fcc twelve {110}.
/// Throws std::invalid_argument for another name.
std::vector<Plane> lattice_planes(const std::string& name, double radius);

/// Planes from a text file, one a line: three components of the outward normal (any length) and the distance from the
/// origin; lines that begin with # are comments. The distances are scaled to touch a sphere of `radius` first.
/// Throws std::invalid_argument (file, line, value, what is allowed) for a line that is no plane.
std::vector<Plane> read_planes(const std::filesystem::path& file, double radius);

/// Throws std::invalid_argument unless the planes are mirror images of each other in x = 0, y = 0 and z = 0.
void check_mirrors(const std::vector<Plane>& planes);

} // namespace boba::continuum
