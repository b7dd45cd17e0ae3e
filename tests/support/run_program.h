// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace boba::test {

/// What became of a program that was run.
struct ProgramResult {
  int exit_code = -1; ///< -1 when a signal ended it
  int signal = 0;
  std::string out, err;
};

/// How to disturb a program while it runs.
struct Disturbance {
  double after_seconds = 0.0;
  int signal = 0;
  std::string once_exists; ///< the time counts from when this file is there (within a minute); "" for the start
};

/// Runs a program without a shell, in `folder`, and waits for its end. BOBA_CACHE_DIR is set to a folder of the tests.
ProgramResult run_program(const std::vector<std::string>& command, const std::string& folder,
                          std::optional<Disturbance> disturbance = std::nullopt);

} // namespace boba::test
