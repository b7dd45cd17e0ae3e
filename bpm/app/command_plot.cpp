// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/command.h"
#include "bpm/app/output_folder.h"
#include "bpm/app/sibling.h"
#include "bpm/io/input_error.h"

#include <fmt/format.h>

namespace boba {

namespace {

/// The plot script: beside the installed program's data, or in the source tree a build folder belongs to.
std::filesystem::path plot_script() {
  const std::filesystem::path installed = program_folder().parent_path() / "share/boba/plot";
  if (!std::filesystem::exists(installed)) {
    throw std::runtime_error(fmt::format("plot: {} is missing", installed.string()));
  }
  return installed;
}

} // namespace

CommandBody add_plot_command(CLI::App& app) {
  auto folder = std::make_shared<std::filesystem::path>();
  auto picture = std::make_shared<std::filesystem::path>();
  app.add_option("run", *folder, "output folder of a run")->required();
  app.add_option("--output", *picture, "PNG to write (default: plot.png in the folder)");
  return [folder, picture]() -> ExitCode {
    const std::filesystem::path table = OutputFolder(*folder).table();
    if (!std::filesystem::is_regular_file(table)) {
      throw InputError(fmt::format("plot: {}: there is no such table", table.string()));
    }
    const std::filesystem::path png = picture->empty() ? *folder / "plot.png" : *picture;
    replace_process("/usr/bin/python3", {plot_script().string(), table.string(), "--output", png.string()});
  };
}

} // namespace boba
