// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program.h"
#include "bpm/app/command.h"

#include <fmt/format.h>

namespace boba {

namespace {

/// The plot program, in data_folder().
std::filesystem::path plot_script() {
  std::filesystem::path installed = data_folder() / "plot";
  if (!std::filesystem::exists(installed)) {
    throw std::runtime_error(fmt::format("plot: {} is missing", installed.string()));
  }
  return installed;
}

} // namespace

CommandBody add_plot_command(CLI::App& app) {
  // All arguments, --help among them, belong to the Python program.
  app.prefix_command();
  app.set_help_flag();
  return [&app]() -> ExitCode {
    std::vector<std::string> arguments = {plot_script().string()};
    const std::vector<std::string> rest = app.remaining();
    arguments.insert(arguments.end(), rest.begin(), rest.end());
    replace_process("/usr/bin/python3", arguments);
  };
}

} // namespace boba
