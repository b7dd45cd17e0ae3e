// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/caller_observer.h"

#include "bpm/dynamics/simulation.h"
#include "bpm/io/input_error.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <fcntl.h>
#include <fmt/format.h>
#include <span>
#include <stdexcept>
#include <unistd.h>

namespace boba {

namespace {

int caller_descriptor(const std::string& text) {
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 3 || fcntl(value, F_GETFD) < 0) {
    throw InputError(fmt::format("--caller: {}: must be an open file descriptor from 3", text));
  }
  return value;
}

/// False when the caller has gone.
bool write_to_caller(int descriptor, std::span<const char> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor, bytes.data(), bytes.size());
    if (n < 0 && errno != EINTR) {
      return false;
    }
    bytes = bytes.subspan(n > 0 ? static_cast<std::size_t>(n) : 0);
  }
  return true;
}

template <class Vectors> std::vector<double> flat(const Vectors& vectors) {
  std::vector<double> values;
  values.reserve(6 * vectors.size());
  for (const auto& vector : vectors) {
    values.insert(values.end(), vector.begin(), vector.end());
  }
  return values;
}

template <class T> std::vector<double> as_doubles(const std::vector<T>& numbers) {
  return {numbers.begin(), numbers.end()};
}

std::string state_line(const Simulation& simulation, const StageProgress& progress) {
  const Totals& totals = simulation.totals();
  std::string line =
      fmt::format("state {} {:.17g} {:.17g} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}", simulation.step(),
                  simulation.time(), simulation.strain(), progress.stage, progress.done, totals.pressure, totals.mu(),
                  totals.kinetic_energy, totals.elastic_energy, totals.largest_overlap);
  for (const double component : totals.stress) {
    line += fmt::format(" {:.17g}", component);
  }
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      line += fmt::format(" {:.17g}", simulation.box().h()(row, column));
    }
  }
  for (const double component : simulation.box().origin()) {
    line += fmt::format(" {:.17g}", component);
  }
  return line + "\n";
}

} // namespace

std::optional<CallerPipes> caller_of(const std::string& text, const Ranks& ranks) {
  if (text.empty()) {
    return std::nullopt;
  }
  if (ranks.is_distributed()) {
    throw InputError("--caller: a run on several ranks has no caller");
  }
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) {
    throw InputError(fmt::format("--caller {}: must be two file descriptors with a comma between them", text));
  }
  return CallerPipes{caller_descriptor(text.substr(0, comma)), caller_descriptor(text.substr(comma + 1))};
}

CallerObserver::CallerObserver(CallerPipes pipes, Topology topology) : pipes_(pipes), topology_(std::move(topology)) {}

CallerObserver::~CallerObserver() {
  ::close(pipes_.requests);
  ::close(pipes_.answers);
}

bool CallerObserver::wants(const StepForecast& forecast) {
  return !stop_ && (forecast.last_of_stage || (next_ >= 0 && forecast.step >= next_));
}

void CallerObserver::observe(const Simulation& simulation, const StageProgress& progress) {
  if (stop_ || simulation.step() == last_shown_) {
    return; // the end of one stage is the beginning of the next
  }
  last_shown_ = simulation.step();
  answer(state_line(simulation, progress));
  while (!stop_) {
    const std::string request = next_request();
    if (request.starts_with("go ")) {
      next_ = std::stoll(request.substr(3));
      return;
    }
    if (request.starts_with("array ")) {
      answer_array(simulation, request.substr(6));
    } else {
      stop_ = true; // "stop", or nothing that can be understood
    }
  }
}

void CallerObserver::answer(const std::string& text) {
  stop_ = stop_ || !write_to_caller(pipes_.answers, text);
}

void CallerObserver::answer_array(const Simulation& simulation, const std::string& name) {
  try {
    const std::vector<double> values = values_of(simulation, name);
    answer(fmt::format("array {}\n", values.size()));
    stop_ =
        stop_ || !write_to_caller(pipes_.answers, {reinterpret_cast<const char*>(values.data()), 8 * values.size()});
  } catch (const std::logic_error& error) {
    answer(fmt::format("error {}\n", error.what()));
  }
}

std::string CallerObserver::next_request() {
  std::array<char, 256> bytes{};
  while (buffer_.find('\n') == std::string::npos) {
    const ssize_t n = ::read(pipes_.requests, bytes.data(), bytes.size());
    if (n == 0 || (n < 0 && errno != EINTR)) {
      return "stop";
    }
    buffer_.append(bytes.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
  }
  const std::size_t end = buffer_.find('\n');
  std::string line = buffer_.substr(0, end);
  buffer_.erase(0, end + 1);
  return line;
}

std::vector<double> CallerObserver::values_of(const Simulation& simulation, const std::string& name) const {
  if (name == "first_node") {
    return as_doubles(topology_.first_node);
  }
  if (name == "molecule") {
    return as_doubles(topology_.molecule);
  }
  if (name == "species") {
    return as_doubles(topology_.species);
  }
  if (name == "id") {
    return as_doubles(topology_.id);
  }
  const Snapshot snapshot = simulation.snapshot({.velocity = name == "velocity", .force = name == "force"});
  if (name == "position") {
    return flat(snapshot.position);
  }
  if (name == "velocity") {
    return flat(snapshot.velocity);
  }
  if (name == "force") {
    return flat(snapshot.force);
  }
  if (name == "grain_centre") {
    return flat(snapshot.grain_centre);
  }
  if (name == "grain_stress") {
    return flat(snapshot.grain_stress);
  }
  throw std::invalid_argument(name + ": there is no such array");
}

} // namespace boba
