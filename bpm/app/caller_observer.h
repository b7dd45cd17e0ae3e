// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/observer.h"
#include "bpm/packing/snapshot.h"
#include "bpm/parallel/ranks.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace boba {

/// Two pipes to the program that started this one: it writes requests, this process writes answers.
struct CallerPipes {
  int requests = -1, answers = -1; ///< file descriptors
};

/// "3,4" as two open file descriptors; nothing for "". \throws InputError, also on several ranks.
std::optional<CallerPipes> caller_of(const std::string& text, const Ranks& ranks);

/// Hands steps to the program that started this one (the Python module), which looks at them and says how to continue.
///
/// At a step that the caller wants, and at the end of every stage, it writes a line
///     state STEP TIME STRAIN STAGE DONE P MU E_KINETIC E_ELASTIC OVERLAP STRESS(6) H(9, by rows) ORIGIN(3)
/// and waits for requests, a line each:
///     go N         continue; N is the next step to stop at, -1 for stage ends alone
///     stop         continue to a checkpoint and stop, as after a signal
///     array NAME   answered by "array COUNT" or "error WHY" and COUNT doubles (names in caller_observer.cpp)
/// A caller that has gone is a wish to stop. The run is the same bit for bit as without a caller.
class CallerObserver : public Observer {
public:
  CallerObserver(CallerPipes pipes, Topology topology);
  ~CallerObserver() override;
  CallerObserver(const CallerObserver&) = delete;
  CallerObserver& operator=(const CallerObserver&) = delete;

  bool wants(const StepForecast& forecast) override;
  void observe(const Simulation& simulation, const StageProgress& progress) override;
  bool wants_to_stop() const { return stop_; }

private:
  void answer(const std::string& text);
  void answer_array(const Simulation& simulation, const std::string& name);
  /// A line without its end; "stop" when the caller has gone.
  std::string next_request();
  std::vector<double> values_of(const Simulation& simulation, const std::string& name) const;

  CallerPipes pipes_;
  Topology topology_;
  std::string buffer_;
  std::int64_t next_ = 0, last_shown_ = -1;
  bool stop_ = false;
};

} // namespace boba
