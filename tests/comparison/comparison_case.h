// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "calibration/compare/comparison.h"

#include <nlohmann/json.hpp>
#include <string>

namespace boba::calibration {

/// Settings of a comparison on a bulk of 2048 nodes, in a folder of its own below the build folder.
ComparisonSettings comparison_case(double alpha, std::vector<double> loads, const std::string& name);

/// The row of a quantity at a load.
const nlohmann::json& row_of(const nlohmann::json& document, const std::string& setup, double load,
                             const std::string& quantity);

/// Prints measured, reference, difference and tolerance, and expects |measured - reference| <= tolerance (absolute).
void expect_near(const std::string& what, double measured, double reference, double tolerance);

/// Expects the mean force of the bodies within 5 % and their standard error of the finite-strain continuum with the
/// layer; prints the neo-Hookean one beside it. At alpha = 12 ten and
/// at 5 seven percent: auxetic networks stiffen on short waves, which at 5137 nodes is 7 to 10 % and 3 to 6 % of a
/// contact's force and falls with d / R (docs/comparison.md).
void expect_force_of_the_layer(const nlohmann::json& document, double alpha, double load);

} // namespace boba::calibration
