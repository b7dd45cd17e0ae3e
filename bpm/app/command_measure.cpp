// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/command.h"
#include "bpm/app/measure/measure_run.h"
#include "bpm/app/on_ranks.h"
#include "bpm/app/run_files.h"
#include "bpm/app/thread_warning.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace boba {

namespace {

struct MeasureArguments {
  MeasureRunOptions options;
  std::vector<std::string> what = {"all"};
  std::vector<double> window;
  std::string neighbours = "solid-angle";
  bool relaxed = false;
  double rest_time = MeasurePlan::default_rest;
};

ExitCode measure_stored_frames(MeasureArguments a, const Ranks& ranks) {
  ranks.collectively([&] { choose_measures(a.options.plan, a.what); });
  a.options.plan.neighbours = a.neighbours == "voronoi" ? NeighbourRule::voronoi : NeighbourRule::solid_angle;
  if (a.relaxed) {
    a.options.plan.rest = a.rest_time;
  }
  if (!a.window.empty()) {
    a.options.window = {a.window[0], a.window[1]};
  }
  const MeasureRunResult result = measure_run(a.options, ranks);
  if (!ranks.is_root()) {
    return ExitCode::done;
  }
  if (a.options.output.empty()) {
    add_to_file_list(OutputFolder(result.folder.parent_path()), files_of_measures(a.options.plan));
  }
  fmt::print("{} frame{} measured into {}\n{}", result.n_frames, result.n_frames == 1 ? "" : "s",
             result.folder.string(), result.averages);
  if (!result.undeformed_known) {
    fmt::print("note: the first frame shows no undeformed grain of every template; the undeformed columns are empty\n");
  }
  if (a.options.plan.has(MeasureKind::stress)) {
    if (!result.stored_stress.empty()) {
      fmt::print("note: the stress is that which the run stored, damping and kinetic parts included: {}\n",
                 result.stored_stress);
    } else if (!result.velocity_known) {
      fmt::print("note: no velocities are stored; damping and kinetic parts are missing from the stress (P_run and "
                 "mu_run, of the run itself, hold them)\n");
    }
  }
  return ExitCode::done;
}

void add_numbers(CLI::App& app, MeasurePlan& plan) {
  app.add_option("--points", plan.packing_fraction.n_points, "random points of the packing fraction")
      ->capture_default_str();
  app.add_option("--target-error", plan.packing_fraction.target_error,
                 "draw points until the packing fraction's standard error is at most this");
  app.add_option("--seed", plan.packing_fraction.seed, "of the random points")->capture_default_str();
  app.add_option("--min-cosine", plan.facets.min_cosine, "facets: triangles join while n . n' is above this")
      ->capture_default_str();
  app.add_option("--min-area-share", plan.facets.min_area_share, "facets: smallest share of the hull's area")
      ->capture_default_str();
  app.add_flag("--sensitivity", plan.facet_sensitivity, "facets at other thresholds too: facet_sensitivity.csv");
  app.add_option("--q-max", plan.scattering.q_max, "scattering: largest wave number, 1/d; the cost grows as its cube")
      ->capture_default_str();
  app.add_option("--shell-width", plan.scattering.shell_width, "scattering: width of a shell, 1/d; 0: 2 pi / V^(1/3)")
      ->capture_default_str();
}

} // namespace

CommandBody add_measure_command(CLI::App& app) {
  auto a = std::make_shared<MeasureArguments>();
  MeasureRunOptions& options = a->options;
  app.add_option("run", options.run, "output folder of a run (finished or running), or a trajectory file")->required();
  app.add_option("--what", a->what,
                 fmt::format("all, or some of {}; separated by commas", fmt::join(measure_names(), ", ")))
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--every", options.every, "every so many frames")->capture_default_str();
  app.add_option("--every-strain", options.every_strain,
                 "instead: a frame whenever the strain has changed by this much");
  app.add_option("--frame", options.only_frame, "one frame alone; negative counts from the end");
  app.add_option("--window", a->window, "strain window of the averages: FIRST LAST")->expected(2);
  app.add_option("--neighbours", a->neighbours, "rule for neighbours of order and motion")
      ->check(CLI::IsMember({"solid-angle", "voronoi"}))
      ->capture_default_str();
  app.add_flag("--relaxed", a->relaxed, "order of a copy of each frame after a short rest in its cell");
  app.add_option("--rest-time", a->rest_time, "time of that rest, tau")
      ->check(CLI::Range(1e-3, 1e6))
      ->capture_default_str();
  app.add_option("--output", options.output, "folder of the tables (default: measures in the run's folder)");
  app.add_option("--threads", options.threads, "threads of a rank; 0 takes all cores")->check(CLI::Range(0, 1024));
  app.add_flag("--stored-stress", options.stored_stress,
               "the stress that the run stored, instead of one from forces evaluated again");
  app.add_flag("--force", options.force, "replace tables that are there");
  add_numbers(app, options.plan);
  app.footer("Tables and columns: docs/formats-measure.md.");
  return [a] { return on_all_ranks([a](const Ranks& ranks) { return measure_stored_frames(*a, ranks); }); };
}

} // namespace boba
