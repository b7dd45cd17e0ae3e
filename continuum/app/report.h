// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/cylinder/cylinder.h"
#include "continuum/sphere/sphere.h"

#include <filesystem>
#include <nlohmann/json.hpp>

namespace boba::continuum {

/// The head of a summary: schema, version, problem and parameters, without loads.
nlohmann::json summary_header(const char* problem, nlohmann::json parameters);

/// Arrays of the summary.
nlohmann::json profile_of(const std::vector<FieldPoint>& points);
nlohmann::json array_of(const Eigen::VectorXd& values);

/// The summary of a run; parameters: what the command line chose.
nlohmann::json report(const std::vector<SphereLoad>& loads, const SphereProblem& problem, nlohmann::json parameters);
nlohmann::json report(const CylinderResult& result, const CylinderProblem& problem, nlohmann::json parameters);

/// Writes fields_NNNN.vtu for each load and fields.pvd.
void write_fields(const std::filesystem::path& folder, const std::vector<SphereLoad>& loads,
                  const SphereProblem& problem);
void write_fields(const std::filesystem::path& folder, const CylinderResult& result, const CylinderProblem& problem);

} // namespace boba::continuum
