// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace boba::continuum {

/// Version of the summary's schema (docs/formats-continuum.md); raised when a field changes its meaning.
constexpr int summary_schema_version = 1;

/// Makes the folder. Throws std::invalid_argument when it holds a summary already and force is false, and
/// std::runtime_error when it cannot be made.
void prepare_folder(const std::filesystem::path& folder, bool force);

/// Writes folder/summary.json, summary.h5 and loads.csv from one document: `loads` is a list of objects whose numbers
/// become columns and whose objects of arrays become groups. Throws std::runtime_error when a file cannot be written.
void write_summary(const std::filesystem::path& folder, const nlohmann::json& document);

/// Unit of a field of the summary in terms of the caller's length and stress, for instance "stress*length^2".
std::string unit_of(const std::string& field);

} // namespace boba::continuum
