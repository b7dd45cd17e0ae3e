// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace boba {

/// Why a run should stop now: SIGINT, SIGTERM, SIGHUP (the terminal is gone), SIGUSR1 (which mpirun and Slurm hand on
/// to all ranks), or its wall-time limit. A second SIGINT ends the program at once.
class StopRequest {
public:
  /// Takes over the signals, but for those that are ignored, until it is destroyed. `wall_time`: seconds from `begin`.
  explicit StopRequest(std::optional<double> wall_time,
                       std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now());
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  bool pending() const;
  /// "SIGTERM", "the wall-time limit of 60 s", or "" when nothing is pending.
  std::string reason() const;

private:
  std::chrono::steady_clock::time_point begin_;
  std::optional<double> wall_time_;
};

} // namespace boba
