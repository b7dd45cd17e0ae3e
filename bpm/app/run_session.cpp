// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/run_session.h"

#include "bpm/app/checkpoint_observer.h"
#include "bpm/app/output_record.h"
#include "bpm/app/progress_display.h"
#include "bpm/app/run_files.h"
#include "bpm/app/run_log.h"
#include "bpm/app/run_writers.h"
#include "bpm/app/stage_summary.h"
#include "bpm/app/stop_request.h"
#include "bpm/app/version.h"
#include "bpm/archive/saved_state.h"
#include "bpm/io/naming.h"
#include "bpm/io/table.h"
#include "bpm/packing/packing_numbers.h"

#include <cmath>
#include <fmt/format.h>

namespace boba {

namespace {

/// Forces are the same bits on all ranks only if all compute them with the same instructions.
void check_instruction_sets(const Simulation& simulation, const Ranks& ranks) {
  std::string of_root = simulation.instruction_set();
  ranks.broadcast(of_root);
  if (of_root != simulation.instruction_set()) {
    throw std::runtime_error(
        fmt::format("this rank's machine computes with {}, rank 0's with {}; set BOBA_ISA to what both "
                    "have (baseline, avx2 or avx512)",
                    simulation.instruction_set(), of_root));
  }
}

/// Feeds the summary line with the steps that somebody else looks at.
class SummaryObserver : public Observer {
public:
  explicit SummaryObserver(StageSummary& summary, Observer& pace) : summary_(summary), pace_(pace) {}
  bool wants(const StepForecast& forecast) override {
    wanted_ = pace_.wants(forecast);
    return wanted_;
  }
  void observe(const Simulation& simulation, const StageProgress& progress) override {
    pace_.observe(simulation, progress);
    if (wanted_) {
      summary_.add(simulation, progress.done);
    }
    wanted_ = false;
  }

private:
  StageSummary& summary_;
  Observer& pace_;
  bool wanted_ = false;
};

/// One run: its simulation, its files, and the loop over the stages.
class Session {
public:
  Session(RunSetup setup, const Ranks& ranks)
      : setup_(std::move(setup)), ranks_(ranks),
        simulation_(std::move(setup_.packing), setup_.scene.material, options_on(ranks)),
        numbers_(simulation_.packing(), setup_.scene.material, setup_.modulus),
        stop_(setup_.scene.wall_time, setup_.begin),
        log_(ranks.is_root() ? setup_.folder.log() : "", setup_.quiet || !ranks.is_root()), summary_(numbers_),
        progress_(setup_.modulus.value_or(0.0), numbers_.n_nodes, setup_.quiet, ranks),
        output_record_(setup_.folder, files_of_run(setup_.scene)) {
    if (setup_.restart) {
      take_up(*setup_.restart);
    } else {
      writers_ = open_writers(setup_, simulation_, numbers_);
    }
    const OutputPlan& plan = setup_.scene.output;
    checkpoints_ = std::make_unique<CheckpointObserver>(
        setup_.folder.checkpoints(), constant_part(setup_, simulation_), plan.checkpoint_seconds,
        Schedule({std::nullopt, plan.checkpoint_time}, StrainPath(simulation_.strain()), simulation_.time()),
        [this](SavedState& data) {
          writers_.wait(); // what a checkpoint points back to is on disk
          store_writers(data, writers_);
          if (ranks_.is_root()) {
            data[output_record_name] = {
                output_record_.text(simulation_.step(), writers_.trajectory ? writers_.trajectory->n_frames() : 0,
                                    writers_.trajectory ? writers_.frames.front()->last_step() : -1),
                {}};
          }
        });
  }

  ExitCode run() {
    ranks_.collectively([&] { check_instruction_sets(simulation_, ranks_); });
    introduce();
    try {
      return run_stages();
    } catch (const SavedStateError& error) {
      progress_.finish();
      throw InputError(fmt::format("{}: the run cannot continue: {}", setup_.restart->file, error.what()));
    } catch (const std::exception& error) {
      progress_.finish();
      log_.last_words(error.what(), "the last checkpoints are kept in " + setup_.folder.checkpoints().string());
      throw;
    }
  }

private:
  SimulationOptions options_on(const Ranks& ranks) const {
    SimulationOptions options = setup_.scene.options;
    options.ranks = &ranks;
    return options;
  }

  /// The state and the files of the run that continues.
  void take_up(RunSetup::Restart& restart) {
    try {
      naming(restart.file, [&] { simulation_.restore(restart.state); });
      std::erase_if(restart.state, [](const auto& field) { return !field.first.starts_with("output."); });
      writers_ = open_writers(setup_, simulation_, numbers_);
      restart.state = {};
    } catch (const SavedStateError& error) {
      throw InputError(fmt::format("{}: the run cannot continue: {}", restart.file, error.what()));
    }
  }

  /// Returns the file, on rank 0. What goes wrong there, all hear of.
  std::filesystem::path write_checkpoint() {
    std::filesystem::path file;
    ranks_.collectively([&] { file = checkpoints_->write(simulation_); });
    return file;
  }

  /// The table that a stage has filled. Its rows are in the checkpoints until then, so it is written as a whole.
  void write_table_of(const PreparedStage& stage) {
    const StageTable* table = stage.driver->table();
    if (table == nullptr) {
      return;
    }
    ranks_.on_root([&] {
      const std::filesystem::path folder = setup_.folder.root() / "stages";
      std::filesystem::create_directories(folder);
      std::vector<std::string> columns = {"step"};
      columns.insert(columns.end(), table->columns.begin(), table->columns.end());
      TableWriter writer(folder / fmt::format("stage-{}.csv", stage.index), columns, FileMode::overwrite);
      for (const StageTable::Row& row : table->rows) {
        std::vector<std::optional<double>> values;
        for (const double value : row.values) {
          values.push_back(std::isfinite(value) ? std::optional(value) : std::nullopt);
        }
        writer.write(row.step, values);
      }
      writer.close();
    });
  }

  void introduce() {
    log_.note(version_text() + ", instruction set " + simulation_.instruction_set());
    for (const std::string& assignment : setup_.scene.overrides) {
      log_.note("--set " + assignment);
    }
    for (const std::string& gap : setup_.gaps) {
      log_.say("gap accepted: " + gap);
    }
    const std::string begin =
        setup_.restart ? fmt::format("continuing at step {} from {}", simulation_.step(), setup_.restart->file)
                       : "starting";
    const std::string on_ranks = ranks_.is_distributed() ? fmt::format("{} ranks of ", ranks_.size()) : "";
    log_.say(fmt::format("{}: {} grains, {} nodes, {}{} threads, {} precision, {}; {}", setup_.scene.title,
                         simulation_.packing().n_grains(), numbers_.n_nodes, on_ranks, setup_.scene.options.threads,
                         setup_.scene.options.precision == Precision::mixed ? "mixed" : "double",
                         simulation_.instruction_set(), begin));
  }

  ExitCode run_stages() {
    SummaryObserver table(summary_, *writers_.table);
    std::vector<Observer*> observers{&table};
    for (const auto& frames : writers_.frames) {
      observers.push_back(frames.get());
    }
    if (setup_.caller) {
      caller_ = std::make_unique<CallerObserver>(*setup_.caller, simulation_.packing().topology(false));
      observers.push_back(caller_.get());
    }
    observers.push_back(&progress_);
    observers.push_back(checkpoints_.get()); // last: it points back to what the others write
    if (!setup_.restart) {
      write_checkpoint(); // so that a run killed early can be resumed too
    }
    for (const PreparedStage& stage : setup_.stages) {
      if (stage.index < simulation_.stage_index()) {
        continue; // done before the checkpoint
      }
      summary_.begin(simulation_);
      const RunOutcome outcome = simulation_.run(stage.index, *stage.driver, observers, [this] { return must_stop(); });
      progress_.finish();
      if (outcome == RunOutcome::stopped) {
        return stop();
      }
      write_table_of(stage);
      write_checkpoint();
      const bool missed = stage.driver->has_missed();
      log_.say(summary_.text(simulation_, stage.label) + (missed ? " (a target was missed)" : ""));
      if (const std::string report = stage.driver->report(); !report.empty()) {
        log_.say(stage.label + ": " + report);
      }
      if (missed && stage.is_strict) {
        return end_strictly(stage);
      }
    }
    return finish();
  }

  bool must_stop() const { return stop_.pending() || (caller_ && caller_->wants_to_stop()); }

  /// Another rank may be the one that was told to.
  std::string stop_reason() const {
    const std::string own = stop_.reason().empty() && caller_ ? "the program that started it" : stop_.reason();
    return own.empty() ? "a signal to another rank" : own;
  }

  ExitCode stop() {
    const std::filesystem::path file = write_checkpoint();
    log_.say(fmt::format("stopped by {} at step {}; checkpoint {}; continue with: boba resume {}", stop_reason(),
                         simulation_.step(), file.string(), setup_.folder.root().string()));
    return ExitCode::stopped;
  }

  ExitCode end_strictly(const PreparedStage& stage) {
    close_trajectory();
    log_.say(fmt::format("{}: strict = true: the run ends here, because a target was missed; boba resume {} continues "
                         "it with the next stage",
                         stage.label, setup_.folder.root().string()));
    return ExitCode::check_failed;
  }

  void close_trajectory() {
    if (writers_.trajectory) {
      writers_.trajectory->close();
    }
  }

  ExitCode finish() {
    close_trajectory();
    const Timings t = simulation_.timings();
    log_.note(fmt::format("seconds: bonds {:.2f}, contacts {:.2f}, search {:.2f}, integration {:.2f}; {} steps, {} "
                          "contact lists",
                          t.bonds, t.contacts, t.search, t.integration, t.steps, t.list_builds));
    if (ranks_.is_distributed()) {
      log_.note(fmt::format(
          "rank 0: halo {:.2f} s, reductions {:.2f} s; received {} messages, {} bytes of nodes; {} halos, {} "
          "grains moved here",
          t.halo, t.reductions, t.halo_messages, t.halo_bytes, t.halo_builds, t.migrated_grains));
    }
    log_.say(fmt::format("done at step {}; results in {}", simulation_.step(), setup_.folder.root().string()));
    return ExitCode::done;
  }

  RunSetup setup_;
  const Ranks& ranks_;
  Simulation simulation_;
  PackingNumbers numbers_;
  StopRequest stop_;
  RunLog log_;
  StageSummary summary_;
  ProgressDisplay progress_;
  RunWriters writers_;
  OutputRecord output_record_;
  std::unique_ptr<CheckpointObserver> checkpoints_;
  std::unique_ptr<CallerObserver> caller_;
};

} // namespace

ExitCode run_scene(RunSetup setup, const Ranks& ranks) {
  std::unique_ptr<Session> session;
  ranks.collectively([&] { session = std::make_unique<Session>(std::move(setup), ranks); });
  return session->run();
}

} // namespace boba
