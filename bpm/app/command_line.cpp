// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/command_line.h"

#include "bpm/app/command.h"
#include "bpm/app/on_ranks.h"
#include "bpm/app/sibling.h"
#include "bpm/app/thread_waiting.h"
#include "bpm/app/version.h"

#include <array>
#include <cstdio>
#include <fmt/format.h>
#include <hdf5.h>
#include <new>
#include <stdexcept>

namespace boba {

namespace {

const std::array commands = {
    Command{"run", "run a scene", add_run_command},
    Command{"resume", "go on with a run that was stopped or killed", add_resume_command},
    Command{"check", "say what a scene would run, without running it", add_check_command},
    Command{"forces", "forces and pressure tensor of a LAMMPS data file of bonded grains", add_forces_command},
    Command{"measure", "measure the stored frames of a run", add_measure_command},
    Command{"plot", "panels and pictures of runs", add_plot_command},
    Command{"info", "version, instruction set, scene reference", add_info_command},
};

/// Programs of their own, started with the arguments that follow.
struct Sibling {
  const char* name;
  const char* summary;
  const char* program;
  const char* subcommand; ///< put in front of the arguments, or nullptr
};

constexpr std::array siblings = {
    Sibling{"continuum", "start boba-continuum: cylinder and sphere by finite elements", "boba-continuum", nullptr},
    Sibling{"calibrate", "start boba-calibrate: (k, alpha) to (E, nu) and back", "boba-calibrate", nullptr},
    Sibling{"compare", "start boba-calibrate compare: particles against the continuum", "boba-calibrate", "compare"},
};

int report(const std::string& message, ExitCode code) {
  fmt::print(stderr, "boba: {}\n", message);
  return static_cast<int>(code);
}

int run_command(int argc, char** argv) {
  CLI::App app("Packings of deformable grains, from a scene file.");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text());
  app.footer("Exit codes: 0 done, 1 failed, 2 wrong input, 3 a check failed, 75 stopped with a checkpoint.");
  std::vector<std::pair<CLI::App*, CommandBody>> bodies;
  for (const Command& command : commands) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    bodies.emplace_back(sub, command.add(*sub));
  }
  for (const Sibling& sibling : siblings) {
    app.add_subcommand(sibling.name, sibling.summary)->prefix_command();
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) { // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    if (is_other_rank()) {
      // Rank 0 tells, and fails for all: a launcher that sees another rank fail first ends rank 0 before it has spoken.
      return static_cast<int>(ExitCode::done);
    }
    app.exit(error);
    return static_cast<int>(ExitCode::wrong_input);
  }
  for (const auto& [sub, body] : bodies) {
    if (sub->parsed()) {
      return static_cast<int>(body());
    }
  }
  return static_cast<int>(ExitCode::wrong_input);
}

} // namespace

int run_command_line(int argc, char** argv) {
  // A file that could not be written cannot be closed either: HDF5's own clean-up at the end would crash on it. Every
  // file is closed by its owner.
  H5dont_atexit();
  shorten_thread_waiting(argv);
  try {
    for (const Sibling& sibling : siblings) {
      // Handed over whole, before anything here could take an argument (--help, -o) for its own.
      if (argc > 1 && std::string_view(argv[1]) == sibling.name) {
        return start_sibling(sibling.program, sibling.subcommand, {argv + 2, argv + argc});
      }
    }
    return run_command(argc, argv);
  } catch (const std::invalid_argument& error) {
    return report(error.what(), ExitCode::wrong_input);
  } catch (const std::bad_alloc&) {
    return report("out of memory", ExitCode::failed);
  } catch (const std::exception& error) {
    return report(error.what(), ExitCode::failed);
  }
}

} // namespace boba
