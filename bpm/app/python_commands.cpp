// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program.h"
#include "bpm/app/command.h"

#include <fmt/format.h>

namespace boba {

namespace {

/// The program that starts a part of the Python module, in data_folder().
std::filesystem::path python_starter() {
  std::filesystem::path installed = data_folder() / "start-python";
  if (!std::filesystem::exists(installed)) {
    throw std::runtime_error(fmt::format("{} is missing", installed.string()));
  }
  return installed;
}

/// A command that the Python module carries out; all arguments, --help among them, are its own.
CommandBody python_command(CLI::App& app) {
  app.prefix_command();
  app.set_help_flag();
  return [&app]() -> ExitCode {
    std::vector<std::string> arguments = {python_starter().string(), app.get_name()};
    const std::vector<std::string> rest = app.remaining();
    arguments.insert(arguments.end(), rest.begin(), rest.end());
    replace_process("/usr/bin/python3", arguments);
  };
}

} // namespace

CommandBody add_plot_command(CLI::App& app) {
  return python_command(app);
}

CommandBody add_picture_command(CLI::App& app) {
  return python_command(app);
}

CommandBody add_report_command(CLI::App& app) {
  return python_command(app);
}

CommandBody add_watch_command(CLI::App& app) {
  return python_command(app);
}

} // namespace boba
