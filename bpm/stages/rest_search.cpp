// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/rest_search.h"

#include "bpm/dynamics/stepper.h"
#include "bpm/io/input_error.h"

#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

/// Forces of floats are good to so much, k d.
constexpr double least_tolerance_of_mixed = 1e-6;

} // namespace

void RestSearch::begin(const Stepper& stepper, const std::string& stage) {
  if (stepper.options().precision == Precision::mixed && plan_.force_tolerance < least_tolerance_of_mixed) {
    throw InputError(
        fmt::format("{}: force_tolerance = {:g} k d: mixed precision rounds forces to about {:g} k d; allowed "
                    "with it: that and above, or run.precision = \"double\"",
                    stage, plan_.force_tolerance, least_tolerance_of_mixed));
  }
  stage_ = stage;
  start_time_ = stepper.time();
  is_checking_ = false;
}

bool RestSearch::look(Stepper& stepper, bool may_end) {
  MovingPacking& moving = stepper.moving();
  if (stepper.time() - start_time_ > plan_.max_time) {
    throw std::runtime_error(fmt::format("{}: step {}: not at rest after max_time = {:g} tau: the largest net force on "
                                         "a node is {:.3g} k d, allowed are "
                                         "{:g}; a larger max_time or a wider force_tolerance helps",
                                         stage_, stepper.step(), plan_.max_time, largest_force_,
                                         plan_.force_tolerance));
  }
  if (moving.cell.streaming() != Matrix3::Zero() || moving.cell.next_streaming() != Matrix3::Zero()) {
    return false; // velocities still hold the profile of the stage before
  }
  if (is_checking_) {
    largest_force_ = largest_net_force(moving);
    if (may_end && largest_force_ < plan_.force_tolerance) {
      fire_.stop(moving); // what the last step's forces gave them
      return true;
    }
    is_checking_ = false;
  }
  largest_force_ = plan_.method == RestPlan::Method::fire ? fire_.steer(moving) : largest_net_force(moving);
  if (may_end && largest_force_ < plan_.force_tolerance) {
    fire_.stop(moving);
    is_checking_ = true;
  }
  return false;
}

void RestSearch::archive(Archive& archive) {
  archive.field("stage", stage_);
  archive.object("fire", fire_);
  archive.field("is_checking", is_checking_);
  archive.field("start_time", start_time_);
  archive.field("largest_force", largest_force_);
}

std::vector<SceneKey> rest_keys() {
  return {
      above_key("force_tolerance", "k d", 0.0, 1.0, "1e-8",
                "the packing is at rest when no node has a larger net force; from 1e-6 in mixed precision"),
      above_key("max_time", "tau", 0.0, 1e12, "1e5", "the stage fails when the packing is not at rest by then"),
      choice_key("method", {"fire", "damping"}, "\"fire\"",
                 "velocities are turned towards the forces, and stop when the motion goes against them; or the laws' "
                 "damping alone"),
  };
}

RestPlan read_rest_plan(const SceneTable& table) {
  RestPlan plan;
  plan.force_tolerance = table.real("force_tolerance", plan.force_tolerance);
  plan.max_time = table.real("max_time", plan.max_time);
  plan.method = table.text("method", "fire") == "fire" ? RestPlan::Method::fire : RestPlan::Method::damping;
  return plan;
}

} // namespace boba
