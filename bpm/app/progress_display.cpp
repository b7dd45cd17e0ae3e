// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/progress_display.h"

#include "bpm/app/standard_streams.h"
#include "bpm/dynamics/simulation.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <unistd.h>

namespace boba {

namespace {

constexpr double terminal_interval = 0.25; // s between two pictures
constexpr double pipe_interval = 10.0;     // s between two lines
constexpr int bar_width = 24;

double seconds_since(std::chrono::steady_clock::time_point then) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

std::string bar(double done) {
  const int filled = static_cast<int>(std::lround(std::clamp(done, 0.0, 1.0) * bar_width));
  return "[" + std::string(filled, '=') + std::string(bar_width - filled, ' ') + "]";
}

} // namespace

std::string readable_duration(double seconds) {
  if (!(seconds < 1e9)) {
    return "?";
  }
  const auto s = static_cast<std::int64_t>(std::lround(seconds));
  if (s >= 3600) {
    return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
  }
  return s >= 60 ? fmt::format("{} min {:02} s", s / 60, s % 60) : fmt::format("{} s", s);
}

ProgressDisplay::ProgressDisplay(double modulus, std::int64_t n_nodes, bool quiet, const Ranks& ranks)
    : modulus_(modulus), n_nodes_(static_cast<double>(n_nodes)), quiet_(quiet), terminal_(isatty(STDOUT_FILENO) == 1),
      visible_(ranks.is_root()), interval_(terminal_ ? terminal_interval : pipe_interval) {
  ranks.broadcast(interval_);
}

bool ProgressDisplay::wants(const StepForecast& forecast) {
  if (quiet_ || forecast.seconds - last_seconds_ < interval_) {
    return false;
  }
  last_seconds_ = forecast.seconds;
  return true;
}

void ProgressDisplay::begin_stage(std::int64_t step, const StageProgress& progress) {
  finish();
  stage_ = progress.stage;
  first_step_ = step;
  first_done_ = progress.done;
  stage_begin_ = Clock::now();
}

std::string ProgressDisplay::line(const StageProgress& progress, double pressure, std::int64_t step) const {
  const bool normalise = progress.driven == "P" && modulus_ > 0.0;
  const double scale = normalise ? 1.0 / modulus_ : 1.0;
  const double spent = seconds_since(stage_begin_);
  const double steps = static_cast<double>(step - first_step_);
  const double gained = progress.done - first_done_;
  std::string text = fmt::format("{}.{} {} {} {:.4g} of {:.4g}", progress.stage, progress.name, bar(progress.done),
                                 normalise ? "P~" : progress.driven, progress.value * scale, progress.target * scale);
  if (progress.driven != "P") {
    text += modulus_ > 0.0 ? fmt::format("  P~ {:.4g}", pressure / modulus_) : fmt::format("  P {:.4g}", pressure);
  }
  if (!progress.phase.empty()) {
    text += " (" + progress.phase + ")";
  }
  if (steps > 0.0 && spent > 0.0) {
    text += fmt::format("  {:.0f} steps/s, {:.3g} M node-steps/s", steps / spent, steps * n_nodes_ / spent * 1e-6);
  }
  if (gained > 0.01 && progress.done < 1.0) {
    text += ", " + readable_duration(spent * (1.0 - progress.done) / gained) + " left";
  }
  return text;
}

void ProgressDisplay::observe(const Simulation& simulation, const StageProgress& progress) {
  if (quiet_ || !visible_) {
    return;
  }
  if (progress.stage != stage_) {
    begin_stage(simulation.step(), progress);
    if (!terminal_) {
      return; // the first line of a stage comes when there is something to say
    }
  }
  const std::string text = line(progress, simulation.totals().pressure, simulation.step());
  if (terminal_) {
    print_text("\r\x1b[K" + text); // back to the line's beginning, clear it
    drawn_ = true;
  } else {
    print_line(text);
  }
}

void ProgressDisplay::finish() {
  if (drawn_) {
    print_line("");
    drawn_ = false;
  }
}

} // namespace boba
