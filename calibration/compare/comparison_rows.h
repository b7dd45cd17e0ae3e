// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "calibration/compare/comparison.h"
#include "calibration/network/elastic_constants.h"

#include <nlohmann/json.hpp>

namespace boba::calibration {

/// The head of a document, and the check of what both problems share.
nlohmann::json comparison_head(const char* problem, const ComparisonSettings& settings, const char* best_model);

/// Calibrates (the uniaxial test to `largest_strain`), or takes what is known.
Solid solid_of(const ComparisonSettings& settings, double alpha, double largest_strain);

/// One row: a quantity of the particles and the same of each model.
struct RowKey {
  const Solid& solid;
  const char* setup; ///< "walls", "bonded", ...
  double load;
  const char* quantity;
};
nlohmann::json comparison_row(const RowKey& key, const std::vector<double>& samples, const nlohmann::json& continuum,
                              const nlohmann::json& hertz = nullptr);

/// Linear interpolation of y(x) given at unsorted points.
double interpolated(std::vector<std::pair<double, double>> points, double x);

} // namespace boba::calibration
