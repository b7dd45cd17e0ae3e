// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/fire.h"
#include "bpm/toml/scene_table.h"

#include <string>
#include <vector>

namespace boba {

class Stepper;

/// How a packing is brought to rest: the largest net force on any node is to be below a tolerance.
struct RestPlan {
  enum class Method {
    fire,    ///< see Fire
    damping, ///< the laws' own damping alone
  };
  Method method = Method::fire;
  double force_tolerance = 1e-8; ///< k d
  double max_time = 1e5;         ///< tau
};

/// The search for a packing's rest, step by step. Before it ends, all nodes stop and the forces of the nodes at rest
/// are looked at: those that a motion could have balanced do not count.
class RestSearch {
public:
  explicit RestSearch(const RestPlan& plan) : plan_(plan) {}

  /// Nodes keep their velocities. \throws InputError for a tolerance that mixed precision cannot tell from rounding.
  void begin(const Stepper& stepper, const std::string& stage);
  /// After the forces of a step, which were kept: true when the packing is at rest. \param may_end false while
  /// something else has not settled. \throws std::runtime_error after max_time.
  bool look(Stepper& stepper, bool may_end);
  /// Is the next step the one that may find it at rest?
  bool is_checking() const { return is_checking_; }
  double largest_force() const { return largest_force_; }
  const RestPlan& plan() const { return plan_; }

  void archive(Archive& archive);

private:
  RestPlan plan_;
  std::string stage_; ///< for messages
  Fire fire_;
  bool is_checking_ = false;
  double start_time_ = 0.0;    ///< tau
  double largest_force_ = 0.0; ///< k d
};

std::vector<SceneKey> rest_keys();
RestPlan read_rest_plan(const SceneTable& table);

} // namespace boba
