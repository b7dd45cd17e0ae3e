// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "calibration/network/alpha_sweep.h"

#include <filesystem>
#include <string>

namespace boba::calibration {

/// Creates the directory, or takes an empty one; one that holds files only with `force`.
/// \throws std::invalid_argument naming the directory and --force otherwise.
void prepare_output(const std::filesystem::path& directory, bool force);

/// Writes a text file in one step (beside, then renamed). \throws std::runtime_error naming the file.
void write_text(const std::filesystem::path& file, const std::string& text);

/// Columns as docs/formats-calibration.md lists them.
std::string table_csv(const Sweep& sweep);
std::string table_json(const Sweep& sweep, const SweepSettings& settings);
/// calibration/table.toml, what `poisson = ...` in a scene reads.
std::string table_toml(const Sweep& sweep, const SweepSettings& settings);
/// The lines printed at the terminal.
std::string table_text(const Sweep& sweep);

/// Draws nu and E against alpha from DIR/table.csv into DIR/table.png with python3-matplotlib.
/// Returns false (and says why on stderr) when that fails.
bool plot_table(const std::filesystem::path& directory);

} // namespace boba::calibration
