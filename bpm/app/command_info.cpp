// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/command.h"
#include "bpm/app/command_description.h"
#include "bpm/app/version.h"
#include "bpm/forces/kernels/kernels.h"
#include "bpm/grain/template_cache.h"
#include "bpm/parallel/usable_cores.h"
#include "bpm/scene/poisson_table.h"
#include "bpm/scene/scene_schema.h"

#include <fmt/format.h>

namespace boba {

namespace {

ExitCode print_info() {
  const PoissonTable table = PoissonTable::installed();
  const auto [lowest, highest] = table.alpha_range();
  fmt::print("{}\n", version_text());
  fmt::print("instruction set: {}; cores: {}\n", kernels::best_table().name, usable_cores());
  fmt::print("template cache: {}\n", default_cache_directory().string());
  fmt::print("table of elastic constants: alpha {:g} to {:g} k d, nu {:g} to {:g}\n  {}\n", lowest, highest,
             table.poisson(lowest, 1.0), table.poisson(highest, 1.0), table.source());
  return ExitCode::done;
}

} // namespace

CommandBody add_info_command(CLI::App& app) {
  struct Wanted {
    bool reference = false, manual = false;
    std::string shell;
  };
  auto wanted = std::make_shared<Wanted>();
  app.add_flag("--scene-reference", wanted->reference, "print docs/scene.md: every table and key of a scene");
  app.add_flag("--man", wanted->manual, "print the manual page");
  app.add_option("--completion", wanted->shell, "print the completion of commands and options for bash, zsh or fish")
      ->type_name("SHELL");
  return [wanted, program = app.get_parent()] {
    if (wanted->reference) {
      fmt::print("{}", scene_reference());
    } else if (wanted->manual) {
      fmt::print("{}", manual_page(*program, version()));
    } else if (!wanted->shell.empty()) {
      fmt::print("{}", shell_completion(*program, wanted->shell));
    } else {
      return print_info();
    }
    return ExitCode::done;
  };
}

} // namespace boba
