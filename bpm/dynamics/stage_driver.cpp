// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/stage_driver.h"

#include "bpm/dynamics/compress_driver.h"
#include "bpm/dynamics/press_driver.h"
#include "bpm/dynamics/timed_driver.h"

namespace boba {

namespace {

template <class... Cases> struct Overloaded : Cases... { using Cases::operator()...; };
template <class... Cases> Overloaded(Cases...) -> Overloaded<Cases...>;

} // namespace

std::unique_ptr<StageDriver> make_stage_driver(const Stage& stage) {
  using Made = std::unique_ptr<StageDriver>;
  return std::visit(Overloaded{[](const CompressStage& s) -> Made { return std::make_unique<CompressDriver>(s); },
                               [](const HoldStage& s) -> Made { return std::make_unique<TimedDriver>(s); },
                               [](const ShearStage& s) -> Made { return std::make_unique<TimedDriver>(s); },
                               [](const PressStage& s) -> Made { return std::make_unique<PressDriver>(s); }},
                    stage);
}

std::string stage_name(const Stage& stage) {
  return std::visit(Overloaded{[](const CompressStage&) { return "compress"; }, [](const HoldStage&) { return "hold"; },
                               [](const ShearStage&) { return "shear"; }, [](const PressStage&) { return "press"; }},
                    stage);
}

} // namespace boba
