// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"
#include "calibration/network/elastic_constants.h"

#include <filesystem>
#include <string>

namespace boba::calibration {

/// The network as a solid: what the continuum is told of it.
struct Solid {
  double alpha = 0.0; ///< k d
  ElasticConstants constants;
  std::filesystem::path compression; ///< its uniaxial test, as `boba-continuum --fit` reads it
};

/// Calibrates the bulk afresh: static stiffness and uniaxial compression of the periodic box to `largest_strain`; the
/// test is written into `folder`. A law fitted over more strain than a body sees is worse over what it sees. \throws
/// what relaxed_stiffness and uniaxial_curve throw.
Solid calibrate_solid(const GrainTemplate& box, double alpha, const std::filesystem::path& folder,
                      double largest_strain = 0.2);

} // namespace boba::calibration
