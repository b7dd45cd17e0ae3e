// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/command.h"
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
  auto reference = std::make_shared<bool>(false);
  app.add_flag("--scene-reference", *reference, "print docs/scene.md: every table and key of a scene");
  return [reference] {
    if (*reference) {
      fmt::print("{}", scene_reference());
      return ExitCode::done;
    }
    return print_info();
  };
}

} // namespace boba
