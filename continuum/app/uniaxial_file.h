// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/elasticity/hyperelastic.h"

#include <filesystem>

namespace boba::continuum {

/// Reads a uniaxial test: lines `strain, stress, lateral strain` with compressive strain and stress positive (nominal)
/// and the lateral strain positive outward; a first line that is not a number is a heading.
/// Throws std::invalid_argument for a file that cannot be read and for a line that is not three numbers, by its number.
std::vector<UniaxialState> read_uniaxial_test(const std::filesystem::path& file);

} // namespace boba::continuum
