// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <vector>

namespace boba::calibration {

/// A subcommand that has been declared to CLI11 and can be run once the command line is read; returns the exit code.
struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;
};

Command add_table(CLI::App& app);
Command add_make_table(CLI::App& app);
Command add_find(CLI::App& app);
Command add_limit(CLI::App& app);
Command add_strain(CLI::App& app);
Command add_specimen(CLI::App& app);
Command add_compare(CLI::App& app);

} // namespace boba::calibration
