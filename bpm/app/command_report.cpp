// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program.h"
#include "bpm/app/command.h"

#include <fmt/format.h>

namespace boba {

namespace {

/// A command whose body is the Python module's: all arguments, --help among them, belong to it.
CommandBody add_module_command(CLI::App& app) {
  app.prefix_command();
  app.set_help_flag();
  return [&app]() -> ExitCode {
    const std::filesystem::path script = data_folder() / "report";
    if (!std::filesystem::exists(script)) {
      throw std::runtime_error(fmt::format("{}: {} is missing", app.get_name(), script.string()));
    }
    std::vector<std::string> arguments = {script.string(), app.get_name()};
    const std::vector<std::string> rest = app.remaining();
    arguments.insert(arguments.end(), rest.begin(), rest.end());
    replace_process("/usr/bin/python3", arguments);
  };
}

} // namespace

CommandBody add_report_command(CLI::App& app) {
  return add_module_command(app);
}

CommandBody add_watch_command(CLI::App& app) {
  return add_module_command(app);
}

} // namespace boba
