// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <iosfwd>
#include <memory>

namespace CLI {
class App;
}

namespace boba::continuum {

/// The commands of boba-continuum with the options that the command line filled in.
class Commands {
public:
  virtual ~Commands() = default;
  /// Runs the chosen command and returns the exit code. Warnings go to `warnings`.
  /// Throws std::invalid_argument for wrong input, std::runtime_error when a solution fails.
  virtual int run(std::ostream& warnings) = 0;
};

/// Adds the commands and their options.
std::unique_ptr<Commands> add_commands(CLI::App& app);

} // namespace boba::continuum
