// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/argument_checks.h"
#include "bpm/app/command.h"
#include "bpm/app/on_ranks.h"
#include "bpm/app/run_files.h"
#include "bpm/app/run_session.h"
#include "bpm/app/standard_streams.h"
#include "bpm/app/thread_warning.h"
#include "bpm/io/input_error.h"
#include "bpm/io/output_file.h"
#include "bpm/io/printable.h"
#include "bpm/parallel/message_passing.h"
#include "bpm/parallel/share_packing.h"
#include "bpm/scene/continued_run.h"
#include "bpm/scene/scene_packing.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

namespace boba {

namespace {

struct RunArguments {
  std::filesystem::path scene, output;
  std::vector<std::string> overrides;
  std::optional<int> threads;
  std::optional<double> wall_time;
  bool force = false;
  bool quiet = false;
  std::string caller;
};

/// The scene as it was given, with the command line's changes as comments; an older one is replaced in one go.
void copy_scene(const Scene& scene, const OutputFolder& folder) {
  const std::filesystem::path beside = folder.scene().string() + ".part";
  OutputFile file(beside, FileMode::overwrite);
  file.write(scene.text);
  if (!scene.overrides.empty() && !scene.text.ends_with('\n')) {
    file.write("\n");
  }
  for (const std::string& assignment : scene.overrides) {
    file.print("# --set {}\n", assignment);
  }
  file.close();
  std::filesystem::rename(beside, folder.scene());
}

/// Takes the folder for this run, and looks once more whether it is free: another run may have ended there meanwhile.
void take_folder(RunSetup& setup, bool force) {
  setup.folder.create();
  setup.lock = std::make_shared<FolderLock>(setup.folder.lock(), "boba run");
  check_free(setup.folder, setup.scene, force);
  if (force) {
    remove_written(setup.folder);
  }
  write_file_list(setup.folder, files_of_run(setup.scene));
  copy_scene(setup.scene, setup.folder);
}

/// A scene's folder has no ".." in it; a link on the way could lead outside all the same.
void check_inside(const Scene& scene) {
  const std::filesystem::path here = std::filesystem::canonical(std::filesystem::current_path());
  const std::filesystem::path there = std::filesystem::weakly_canonical(here / scene.output.directory);
  if (std::mismatch(here.begin(), here.end(), there.begin(), there.end()).first != here.end()) {
    throw InputError(
        fmt::format("{}: output.directory = {}: leads to {} through a link, outside of the current folder; "
                    "--output may name any folder",
                    scene.path.string(), scene.output.directory.string(), there.string()));
  }
}

/// Rank 0 makes the packing that the run starts from; the others read the scene alone.
RunSetup prepare(const RunArguments& a, const Ranks& ranks) {
  const auto narrate = [&](const std::string& text) {
    if (!ranks.is_root()) {
      return;
    }
    if (text.starts_with("warning: ")) { // --quiet hides no warning
      fmt::print(stderr, "boba: {}\n", printable(text));
    } else if (!a.quiet) {
      print_line(printable(text));
    }
  };
  Scene scene = read_scene_to_run(a.scene, a.overrides, narrate);
  scene.options.threads = a.threads.value_or(scene.options.threads);
  scene.wall_time = a.wall_time ? a.wall_time : scene.wall_time;
  if (a.output.empty() && ranks.is_root()) {
    check_inside(scene);
  }
  const OutputFolder folder(a.output.empty() ? scene.output.directory : a.output);
  RunSetup setup{std::move(scene), folder, {}, {}, std::nullopt, a.quiet, std::nullopt};
  if (ranks.is_root()) {
    if (const std::string holder = FolderLock::holder_of(folder.lock()); !holder.empty()) {
      throw InputError(fmt::format("output: {} is in use by {}", folder.root().string(), holder));
    }
    check_free(folder, setup.scene, a.force);
    const PoissonTable table = PoissonTable::installed();
    setup.packing = make_start(setup.scene, table, narrate);
    setup.modulus = effective_modulus(setup.packing, setup.scene.material, table);
    const bool automatic = setup.scene.automatic_dt;
    check_time_step(setup.scene, settle_time_step(setup.scene, setup.packing));
    if (automatic) {
      narrate(fmt::format("time step: {:.4g} tau", setup.scene.options.dt));
    }
  }
  return setup;
}

ExitCode run(const RunArguments& a, const Ranks& ranks) {
  const auto begin = std::chrono::steady_clock::now();
  outlive_standard_output();
  std::optional<RunSetup> setup;
  ranks.collectively([&] { setup = prepare(a, ranks); });
  setup->begin = begin;
  setup->caller = caller_of(a.caller, ranks);
  share_packing(setup->packing, ranks);
  ranks.broadcast(setup->modulus);
  ranks.broadcast(setup->scene.options.dt);
  if (ranks.is_distributed() && !a.threads) {
    setup->scene.options.threads = std::min(setup->scene.options.threads, threads_of_a_rank(ranks));
  }
  if (ranks.is_root()) {
    warn_of_threads(setup->scene.options.threads);
  }
  ranks.collectively([&] {
    setup->stages = prepare_stages(setup->scene, stage_context(setup->scene, setup->packing, setup->modulus));
    if (ranks.is_root()) {
      // Everything that can be wrong with the input has been found by now: from here on files are written.
      take_folder(*setup, a.force);
    }
  });
  return run_scene(std::move(*setup), ranks);
}

} // namespace

CommandBody add_run_command(CLI::App& app) {
  auto a = std::make_shared<RunArguments>();
  app.add_option("scene", a->scene, "scene file (TOML); docs/scene.md lists its keys")->required();
  app.add_option("--set", a->overrides, "replace a value: section.key=value, stage.0.key=value")
      ->type_name("PLACE=VALUE")
      ->allow_extra_args(false);
  app.add_option("--output", a->output, "output folder (default: the scene's, below the current folder)");
  app.add_option("--threads", a->threads, "threads (default: the scene's, or all cores)")->check(CLI::Range(1, 1024));
  app.add_option("--wall-time", a->wall_time,
                 "stop with a checkpoint after so many seconds, building and placing included")
      ->check(positive_seconds());
  app.add_flag("--force", a->force, "replace the run that is in the output folder");
  app.add_flag("--quiet", a->quiet, "print nothing but errors");
  // Of the Python module; not shown in the help.
  app.add_option("--caller", a->caller, "pipes to the program that looks at the run")->group("");
  return [a] { return on_all_ranks([a](const Ranks& ranks) { return run(*a, ranks); }); };
}

} // namespace boba
