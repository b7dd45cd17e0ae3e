// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/stop_request.h"

#include <csignal>
#include <fmt/format.h>

namespace boba {

namespace {

volatile std::sig_atomic_t caught_signal = 0;

void remember(int signal) {
  if (caught_signal != 0 && signal == SIGINT) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  caught_signal = signal;
}

void install(void (*handler)(int)) {
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART; // writes under way are not cut short
    sigaction(signal, &action, nullptr);
  }
}

} // namespace

StopRequest::StopRequest(std::optional<double> wall_time) : wall_time_(wall_time) {
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
    return caught_signal == SIGINT ? "SIGINT" : caught_signal == SIGTERM ? "SIGTERM" : "SIGUSR1";
  }
  return pending() ? fmt::format("the wall-time limit of {:g} s", *wall_time_) : "";
}

} // namespace boba
