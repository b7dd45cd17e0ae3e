// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/command_line.h"

#include "base/program.h"
#include "bpm/app/command.h"
#include "bpm/app/on_ranks.h"
#include "bpm/app/standard_streams.h"
#include "bpm/app/thread_waiting.h"
#include "bpm/app/uncaught_errors.h"
#include "bpm/app/version.h"
#include "bpm/io/printable.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <hdf5.h>
#include <new>
#include <stdexcept>

namespace boba {

namespace {

const std::array commands = {
    Command{"run", "run a scene", add_run_command},
    Command{"resume", "continue a run that was stopped or killed", add_resume_command},
    Command{"check", "say what a scene would run, without running it", add_check_command},
    Command{"forces", "forces and pressure tensor of a LAMMPS data file of bonded grains", add_forces_command},
    Command{"measure", "measure the stored frames of a run", add_measure_command},
    Command{"plot", "curves of one or several runs, as PNG, PDF or SVG", add_plot_command},
    Command{"picture", "the grains of a frame, coloured by what was measured", add_picture_command},
    Command{"report", "one HTML file that shows runs", add_report_command},
    Command{"watch", "a run in a browser while it goes on", add_watch_command},
    Command{"units", "from E, nu, size and density in SI units to the units of a scene, and back", add_units_command},
    Command{"info", "version, instruction set, scene reference", add_info_command},
};

/// Programs of their own, started with the arguments that follow.
struct OtherProgram {
  const char* name;
  const char* summary;
  const char* program;
  const char* subcommand; ///< put in front of the arguments, or nullptr
};

constexpr std::array other_programs = {
    OtherProgram{"continuum", "start boba-continuum: cylinder and sphere by finite elements", "boba-continuum",
                 nullptr},
    OtherProgram{"calibrate", "start boba-calibrate: (k, alpha) to (E, nu) and back", "boba-calibrate", nullptr},
    OtherProgram{"compare", "start boba-calibrate compare: particles against the continuum", "boba-calibrate",
                 "compare"},
};

[[noreturn]] void start(const OtherProgram& other, const std::vector<std::string>& arguments) {
  std::vector<std::string> all = arguments;
  if (other.subcommand != nullptr) {
    all.insert(all.begin(), other.subcommand);
  }
  replace_process(program_beside(other.program), all);
}

int report(const std::string& message, ExitCode code) {
  print_error("boba: " + printable(message));
  return static_cast<int>(code);
}

/// The first word must be a command; the parser itself would only say that one is missing.
std::string unknown_command(int argc, char** argv) {
  const std::string word = argc > 1 ? argv[1] : "";
  const auto is_word = [&word](const auto& known) { return word == known.name; };
  if (word.empty() || word.front() == '-' || std::any_of(commands.begin(), commands.end(), is_word) ||
      std::any_of(other_programs.begin(), other_programs.end(), is_word)) {
    return "";
  }
  std::string names;
  for (const auto& command : commands) {
    names += std::string(command.name) + ", ";
  }
  for (const auto& other : other_programs) {
    names += std::string(other.name) + (&other == &other_programs.back() ? "" : ", ");
  }
  const std::string advice = word.ends_with(".toml") ? fmt::format("; a scene is run by: boba run {}", word) : "";
  return fmt::format("{}: there is no such command{}; there are {}", word, advice, names);
}

/// Standard output is a command's result, unless the command writes files.
ExitCode with_output_written(const CLI::App& sub, ExitCode code) {
  const std::string failure = standard_output_failure();
  const bool writes_files = sub.get_name() == "run" || sub.get_name() == "resume";
  if (!failure.empty() && code == ExitCode::done && !writes_files) {
    throw std::runtime_error("standard output cannot be written: " + failure);
  }
  return code;
}

int run_command(int argc, char** argv) {
  CLI::App app("Packings of deformable grains, from a scene file.");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text());
  app.footer("Exit codes: 0 done, 1 failed, 2 wrong input, 3 a check failed, 75 stopped with a checkpoint.");
  if (const std::string unknown = unknown_command(argc, argv); !unknown.empty()) {
    if (is_other_rank()) {
      wait_for_first_rank(5000);
    }
    return report(unknown, ExitCode::wrong_input);
  }
  std::vector<std::pair<CLI::App*, CommandBody>> bodies;
  for (const Command& command : commands) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    bodies.emplace_back(sub, command.add(*sub));
  }
  for (const OtherProgram& other : other_programs) {
    app.add_subcommand(other.name, other.summary)->prefix_command();
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) { // --help, --version
    const int code = app.exit(success);
    with_output_written(app, ExitCode::done);
    return code;
  } catch (const CLI::ParseError& error) {
    if (is_other_rank()) {
      // A launcher that sees another rank fail first ends rank 0 before it has spoken.
      wait_for_first_rank(5000);
    }
    app.exit(error);
    return static_cast<int>(ExitCode::wrong_input);
  }
  for (const auto& [sub, body] : bodies) {
    if (sub->parsed()) {
      return static_cast<int>(with_output_written(*sub, body()));
    }
  }
  return static_cast<int>(ExitCode::wrong_input);
}

} // namespace

int run_command_line(int argc, char** argv) {
  // A file that could not be written cannot be closed either: HDF5's own clean-up at the end would crash on it. Every
  // file is closed by its owner.
  H5dont_atexit();
  secure_standard_streams();
  tell_uncaught_errors();
  shorten_thread_waiting(argv);
  try {
    for (const OtherProgram& other : other_programs) {
      // Handed over whole, before anything here could take an argument (--help, -o) for its own.
      if (argc > 1 && std::string_view(argv[1]) == other.name) {
        start(other, {argv + 2, argv + argc});
      }
    }
    return run_command(argc, argv);
  } catch (const std::invalid_argument& error) {
    return report(error.what(), ExitCode::wrong_input);
  } catch (const std::bad_alloc&) {
    return report(out_of_memory, ExitCode::failed);
  } catch (const std::exception& error) {
    return report(error.what(), ExitCode::failed);
  }
}

} // namespace boba
