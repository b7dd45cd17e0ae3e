// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/stop_request.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <fmt/format.h>
#include <utility>

namespace boba {

namespace {

constexpr std::array<std::pair<int, const char*>, 4> stop_signals = {
    {{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}, {SIGUSR1, "SIGUSR1"}}};

volatile std::sig_atomic_t caught_signal = 0;

void remember(int signal) {
  if (caught_signal != 0 && signal == SIGINT) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  caught_signal = signal;
}

/// A signal that was ignored when the program started (by nohup, or by a shell that starts it in the background) stays
/// ignored.
void install(void (*handler)(int)) {
  for (const auto& [signal, name] : stop_signals) {
    struct sigaction action {};
    if (sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) {
      continue;
    }
    action = {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART; // writes under way are not cut short
    sigaction(signal, &action, nullptr);
  }
}

} // namespace

StopRequest::StopRequest(std::optional<double> wall_time, std::chrono::steady_clock::time_point begin)
    : begin_(begin), wall_time_(wall_time) {
  caught_signal = 0;
  install(remember);
}

StopRequest::~StopRequest() {
  install(SIG_DFL);
}

bool StopRequest::pending() const {
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin_;
  return caught_signal != 0 || (wall_time_ && spent.count() >= *wall_time_);
}

std::string StopRequest::reason() const {
  if (caught_signal != 0) {
    return std::find_if(stop_signals.begin(), stop_signals.end() - 1,
                        [](const auto& known) { return known.first == caught_signal; })
        ->second;
  }
  return pending() ? fmt::format("the wall-time limit of {:g} s", *wall_time_) : "";
}

} // namespace boba
