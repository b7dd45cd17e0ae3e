// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/elasticity/meridian_body.h"

#include <filesystem>

namespace boba::continuum {

/// Writes the meridian with displacement, stress components, mean and von Mises stress as a .vtu file.
/// stress: the points of body.stress(). Throws std::runtime_error when the file cannot be written.
void write_vtu(const std::filesystem::path& file, const MeridianBody& body, const Eigen::VectorXd& displacement,
               const std::vector<StressPoint>& stress);

/// Writes a ParaView collection; each entry is a file name beside it and the value of its load.
void write_pvd(const std::filesystem::path& file, const std::vector<std::pair<double, std::string>>& entries);

} // namespace boba::continuum
