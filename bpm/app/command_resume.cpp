// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/argument_checks.h"
#include "bpm/app/checkpoint_observer.h"
#include "bpm/app/command.h"
#include "bpm/app/on_ranks.h"
#include "bpm/app/output_record.h"
#include "bpm/app/run_session.h"
#include "bpm/app/standard_streams.h"
#include "bpm/app/thread_warning.h"
#include "bpm/forces/kernels/kernels.h"
#include "bpm/io/input_error.h"
#include "bpm/parallel/message_passing.h"
#include "bpm/scene/scene_packing.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace boba {

namespace {

struct ResumeArguments {
  std::filesystem::path folder;
  std::optional<int> threads;
  std::optional<double> wall_time;
  bool allow_other_isa = false;
  bool accept_gaps = false;
  bool quiet = false;
  std::string caller;
};

/// The same numbers come only from the same instruction set.
void check_instruction_set(const LatestCheckpoint& checkpoint, bool allow_other) {
  const std::string then = run_record(checkpoint).instruction_set;
  const std::string now = kernels::best_table().name;
  if (then != now && !allow_other) {
    throw InputError(
        fmt::format("{}: the run was computed with {}, this machine takes {}; the continuation would not be the "
                    "same bit for bit. --allow-other-isa goes on all the same",
                    checkpoint.path.string(), then, now));
  }
}

/// A folder that is not there is told by whoever looks for its checkpoints.
std::shared_ptr<const FolderLock> lock_of_run(const OutputFolder& folder) {
  std::error_code error;
  return std::filesystem::is_directory(folder.checkpoints(), error)
             ? std::make_shared<const FolderLock>(folder.lock(), "boba resume")
             : nullptr;
}

/// What the checkpoint points back to must be there. Returns what is missing, once the user accepts that.
std::vector<std::string> check_output(const LatestCheckpoint& checkpoint, const OutputFolder& folder, bool accept) {
  std::string record;
  try {
    Archive archive = Archive::reading_from(checkpoint.data);
    archive.field(output_record_name, record);
  } catch (const SavedStateError& error) {
    throw InputError(fmt::format("{}: the run cannot continue: {}", checkpoint.path.string(), error.what()));
  }
  std::vector<std::string> gaps = missing_output(folder, record);
  if (!gaps.empty() && !accept) {
    throw InputError(fmt::format("{}: the run cannot be continued without gaps: {}; --accept-gaps continues it all "
                                 "the same",
                                 folder.root().string(), fmt::join(gaps, "; ")));
  }
  return gaps;
}

/// Rank 0 reads; the others get everything but the nodes, which the simulation hands out.
LatestCheckpoint read(const ResumeArguments& a, const OutputFolder& folder, const Ranks& ranks) {
  LatestCheckpoint checkpoint;
  ranks.on_root([&] {
    checkpoint = latest_checkpoint(folder.checkpoints());
    for (const std::string& refused : checkpoint.refused) {
      print_error(fmt::format("boba: warning: {}; continuing from {}", refused, checkpoint.path.string()));
    }
    check_instruction_set(checkpoint, a.allow_other_isa);
  });
  share_checkpoint(checkpoint, ranks);
  return checkpoint;
}

ExitCode resume(const ResumeArguments& a, const Ranks& ranks) {
  const auto begin = std::chrono::steady_clock::now();
  outlive_standard_output();
  const OutputFolder folder(a.folder);
  std::optional<RunSetup> setup;
  std::shared_ptr<const FolderLock> lock;
  std::vector<std::string> gaps;
  ranks.on_root([&] { lock = lock_of_run(folder); });
  {
    const LatestCheckpoint checkpoint = read(a, folder, ranks);
    ranks.on_root([&] { gaps = check_output(checkpoint, folder, a.accept_gaps); });
    ranks.collectively([&] { setup = setup_from(checkpoint, folder); });
  }
  setup->begin = begin;
  setup->caller = caller_of(a.caller, ranks);
  setup->lock = std::move(lock);
  setup->gaps = std::move(gaps);
  setup->accept_gaps = a.accept_gaps;
  setup->scene.options.threads = a.threads.value_or(setup->scene.options.threads);
  if (ranks.is_distributed() && !a.threads) {
    setup->scene.options.threads = std::min(setup->scene.options.threads, threads_of_a_rank(ranks));
  }
  setup->scene.wall_time = a.wall_time ? a.wall_time : setup->scene.wall_time;
  setup->quiet = a.quiet;
  if (ranks.is_root()) {
    warn_of_threads(setup->scene.options.threads);
  }
  ranks.collectively([&] {
    setup->stages = prepare_stages(setup->scene, stage_context(setup->scene, setup->packing, setup->modulus));
  });
  return run_scene(std::move(*setup), ranks);
}

} // namespace

CommandBody add_resume_command(CLI::App& app) {
  auto a = std::make_shared<ResumeArguments>();
  app.add_option("run", a->folder, "output folder of the run")->required();
  app.add_option("--threads", a->threads, "threads (default: the scene's, or all cores)")->check(CLI::Range(1, 1024));
  app.add_option("--wall-time", a->wall_time, "stop with a checkpoint after so many seconds")
      ->check(positive_seconds());
  app.add_flag("--allow-other-isa", a->allow_other_isa,
               "continue although the instruction set differs: no longer bit for bit");
  app.add_flag("--accept-gaps", a->accept_gaps, "continue although files of the run are missing, cut short or edited");
  app.add_flag("--quiet", a->quiet, "print nothing but errors");
  app.add_option("--caller", a->caller, "pipes to the program that looks at the run")->group("");
  return [a] { return on_all_ranks([a](const Ranks& ranks) { return resume(*a, ranks); }); };
}

} // namespace boba
