// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/app/box_options.h"
#include "calibration/app/commands.h"
#include "calibration/app/report.h"

#include <fmt/format.h>
#include <memory>

namespace boba::calibration {

namespace {

/// Alphas of the installed table: dense where nu bends most.
const std::vector<double> table_alphas = {-0.95, -0.9, -0.8, -0.6, -0.3, 0.0,  0.5,  1.0,
                                          2.0,   3.5,  5.0,  8.0,  12.0, 18.0, 26.0, 40.0};

struct TableOptions {
  BoxOptions box;
  std::vector<double> alphas;
  std::string output;
  bool force = false;
};

void print_times(const Sweep& sweep, int n_seeds) {
  fmt::print("{} boxes of {} nodes: networks {:.1f} s, solves {:.1f} s\n", n_seeds, sweep.n_nodes,
             sweep.template_seconds, sweep.solve_seconds);
}

} // namespace

Command add_table(CLI::App& app) {
  auto options = std::make_shared<TableOptions>();
  CLI::App* command = app.add_subcommand("table", "E and nu at given alphas, beside the published values");
  command->add_option("--alpha", options->alphas, "Many-body coefficients, k d, separated by commas")
      ->delimiter(',')
      ->required();
  command->add_option("--output", options->output, "Directory for table.csv, table.json and table.png");
  command->add_flag("--force", options->force, "Write into a directory that holds files");
  options->box.add_to(*command);
  return {command, [options] {
            const SweepSettings settings = options->box.settings(options->alphas);
            if (!options->output.empty()) {
              prepare_output(options->output, options->force);
            }
            const Sweep sweep = run_sweep(settings);
            fmt::print("{}", table_text(sweep));
            print_times(sweep, settings.n_seeds);
            if (!options->output.empty()) {
              const std::filesystem::path directory = options->output;
              write_text(directory / "table.csv", table_csv(sweep));
              write_text(directory / "table.json", table_json(sweep, settings));
              plot_table(directory);
            }
            return 0;
          }};
}

Command add_make_table(CLI::App& app) {
  auto options = std::make_shared<TableOptions>();
  options->alphas = table_alphas;
  CLI::App* command = app.add_subcommand("make-table", "Generate the table that `poisson = ...` in a scene reads");
  command->add_option("--output", options->output, "File to write (table.toml)")->required();
  command->add_option("--alpha", options->alphas, "Many-body coefficients, k d, separated by commas")->delimiter(',');
  command->add_flag("--force", options->force, "Replace an existing file");
  options->box.add_to(*command);
  return {command, [options] {
            if (std::filesystem::exists(options->output) && !options->force) {
              throw std::invalid_argument(fmt::format("output = {} exists; --force replaces it", options->output));
            }
            const SweepSettings settings = options->box.settings(options->alphas);
            const Sweep sweep = run_sweep(settings);
            fmt::print("{}", table_text(sweep));
            print_times(sweep, settings.n_seeds);
            write_text(options->output, table_toml(sweep, settings));
            return 0;
          }};
}

} // namespace boba::calibration
