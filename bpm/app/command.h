// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/exit_code.h"

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>

namespace boba {

/// Runs when its subcommand was chosen.
using CommandBody = std::function<ExitCode()>;

/// Adds a subcommand to the program; the body runs once all arguments have been read. A command is one file,
/// command_NAME.cpp, with one of the functions below, and a line in command_line.cpp.
using AddCommand = CommandBody (*)(CLI::App& subcommand);

struct Command {
  const char* name;
  const char* summary;
  AddCommand add;
};

CommandBody add_run_command(CLI::App& app);
CommandBody add_resume_command(CLI::App& app);
CommandBody add_check_command(CLI::App& app);
CommandBody add_forces_command(CLI::App& app);
CommandBody add_info_command(CLI::App& app);
CommandBody add_measure_command(CLI::App& app);
CommandBody add_plot_command(CLI::App& app);
CommandBody add_report_command(CLI::App& app);
CommandBody add_watch_command(CLI::App& app);
CommandBody add_picture_command(CLI::App& app);
CommandBody add_units_command(CLI::App& app);

} // namespace boba
