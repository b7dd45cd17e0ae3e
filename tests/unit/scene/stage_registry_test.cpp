// SPDX-License-Identifier: GPL-3.0-or-later
// A stage that the tree does not know: registered here, read from a scene's text, checked, estimated, run, stopped and
// continued.
#include "bpm/archive/archive.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/dynamics/stepper.h"
#include "bpm/io/input_error.h"
#include "bpm/scene/poisson_table.h"
#include "bpm/scene/scene.h"
#include "bpm/scene/scene_packing.h"
#include "bpm/scene/scene_schema.h"
#include "bpm/scene/scene_stages.h"
#include "bpm/stages/stage_registry.h"
#include "bpm/stages/timed_steps.h"

#include <cmath>
#include <gtest/gtest.h>

namespace boba {
namespace {

/// Lets the cell grow along all axes, at one rate.
class ExpandDriver : public StageDriver {
public:
  ExpandDriver(double rate, double time) : rate_(rate), time_(time) {}
  std::string name() const override { return "expand"; }
  void begin(Stepper& stepper) override { steps_.begin(time_, stepper.options().dt); }
  bool needs_pressure() const override { return false; }
  CellRates update(Stepper&) override {
    steps_.count();
    return {.dilation = rate_};
  }
  bool finished() const override { return steps_.finished(); }
  std::int64_t steps_left(const Stepper&) const override { return steps_.left(); }
  bool may_end(const Stepper&) const override { return steps_.left() == 1; }
  double shear_rate() const override { return 0.0; }
  void end(Stepper&) override {}
  StageProgress progress(const Stepper&) const override { return {.done = steps_.share_done()}; }
  void archive(Archive& archive) override { archive.object("steps", steps_); }

private:
  double rate_, time_;
  TimedSteps steps_;
};

class ExpandEntry : public StageEntry {
public:
  static SceneSection section() {
    return {"stage",
            "expand",
            true,
            "The cell grows.",
            {required(above_key("rate", "1/tau", 0.0, 0.1, "", "d ln L / dt")),
             above_key("time", "tau", 0.0, 1e6, "2", "how long")}};
  }
  explicit ExpandEntry(const SceneTable& table) : rate_(table.real("rate", 0.0)), time_(table.real("time", 2.0)) {}

  void check(const SceneTable& table, const StageSurroundings& surroundings) const override {
    require_periodic_cell(table, surroundings);
    require_countable_steps(table, "time", time_, surroundings.dt);
  }
  bool moves_cell() const override { return true; }
  bool holds_pressure() const override { return false; }
  bool has_ends() const override { return false; }
  StageLength estimate(const StageContext&) const override { return {.time = time_}; }
  std::unique_ptr<StageDriver> make_driver(const StageContext&) const override {
    return std::make_unique<ExpandDriver>(rate_, time_);
  }

private:
  double rate_, time_;
};

const std::string scene_text = R"([run]
dt = 0.1
threads = 1
[[template]]
name = "point"
nodes = 1
[[species]]
count = 8
alpha = 0.0
[[stage]]
type = "insert"
packing_fraction = 0.1
[[stage]]
type = "expand"
name = "slowly"
rate = 1e-3
time = 5.0
)";

Scene read(const std::vector<std::string>& overrides = {}, const std::string& text = scene_text) {
  return read_stored_scene(text, "scene.toml", overrides);
}

std::string message_of(const std::vector<std::string>& overrides, const std::string& text = scene_text) {
  try {
    read(overrides, text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

class StageRegistry : public testing::Test {
protected:
  static void SetUpTestSuite() {
    scene_schema(); // a stage may be registered although the schema was used before
    register_stage<ExpandEntry>();
  }
};

struct SceneRun {
  explicit SceneRun(const Scene& scene)
      : packing(make_start(scene, PoissonTable::installed(), [](const std::string&) {})),
        stages(prepare_stages(scene, stage_context(scene, packing, {}))),
        simulation(packing, scene.material, scene.options) {}
  RunOutcome go(const Simulation::StopRequest& stop = {}) {
    return simulation.run(stages.front().index, *stages.front().driver, {}, stop);
  }
  Packing packing;
  std::vector<PreparedStage> stages;
  Simulation simulation;
};

TEST_F(StageRegistry, RunsAStageFromASceneTheTreeDoesNotKnow) {
  SceneRun run(read());
  EXPECT_EQ(run.stages.front().label, "stage.1 expand \"slowly\"");
  const double length = run.packing.box.lengths()[0];
  EXPECT_EQ(run.go(), RunOutcome::finished);
  EXPECT_EQ(run.simulation.step(), 50);
  EXPECT_NEAR(run.simulation.box().lengths()[0], length * std::pow(1.0 + 1e-4, 50), 1e-12 * length);
}

TEST_F(StageRegistry, ContinuesAStoppedStageBitForBit) {
  const Scene scene = read();
  SceneRun whole(scene), first(scene), second(scene);
  whole.go();
  ASSERT_EQ(first.go([&] { return first.simulation.step() == 17; }), RunOutcome::stopped);
  second.simulation.restore(first.simulation.save());
  EXPECT_EQ(second.go(), RunOutcome::finished);
  EXPECT_EQ(second.simulation.step(), 50);
  EXPECT_EQ(second.simulation.box().lengths(), whole.simulation.box().lengths());
  // The same without a saved state, and with another driver of the same stage; first it must end.
  SceneRun again(scene);
  EXPECT_THROW(first.simulation.run(2, *again.stages.front().driver, {}), std::invalid_argument);
  EXPECT_EQ(first.simulation.run(1, *again.stages.front().driver, {}), RunOutcome::finished);
  EXPECT_EQ(first.simulation.box().lengths(), whole.simulation.box().lengths());
}

TEST_F(StageRegistry, RefusesToContinueAnotherStage) {
  const Scene scene = read();
  SceneRun first(scene), second(read({}, [] {
    std::string text = scene_text;
    text.replace(text.find("type = \"expand\""), 15, "type = \"hold\"");
    text.erase(text.find("rate = 1e-3\n"), 12);
    return text;
  }()));
  ASSERT_EQ(first.go([&] { return first.simulation.step() == 17; }), RunOutcome::stopped);
  second.simulation.restore(first.simulation.save());
  try {
    second.go();
    FAIL() << "a hold continues an expansion";
  } catch (const SavedStateError& error) {
    EXPECT_EQ(std::string(error.what()),
              "saved state: simulation.stage.name is \"expand\"; the run continues with a stage \"hold\"");
  }
}

TEST_F(StageRegistry, IsReadCheckedAndDocumentedLikeAnyStage) {
  EXPECT_NE(message_of({"stage.expand.rate=1"}).find("stage.1.rate = 1: must be a number above 0 and at most 0.1"),
            std::string::npos);
  EXPECT_NE(message_of({"stage.expand.rat=1"}).find("Did you mean \"rate\"?"), std::string::npos);
  EXPECT_NE(scene_reference().find("## `[[stage]]` `type = \"expand\"`"), std::string::npos);
  const Scene scene = read({"stage.slowly.time=30"});
  const Packing packing;
  EXPECT_EQ(scene.stages.front().entry->estimate(stage_context(scene, packing, {})).time, 30.0);
  std::string specimen = scene_text;
  specimen.replace(specimen.find("\"insert\"\npacking_fraction = 0.1"), 31, "\"specimen\"");
  EXPECT_NE(message_of({"species.0.count=1"}, specimen).find("needs a periodic cell"), std::string::npos);
}

TEST_F(StageRegistry, RefusesNamesThatCannotBeToldApart) {
  for (const char* name : {"shear", "insert", "expand", "7", "a.b", "\"\"", "a b"}) {
    EXPECT_NE(message_of({std::string("stage.1.name=") + name}).find("stage.1.name"), std::string::npos) << name;
  }
  const std::string two = scene_text + "[[stage]]\ntype = \"hold\"\nname = \"slowly\"\ntime = 1.0\n";
  EXPECT_NE(message_of({}, two).find("stage.2.name"), std::string::npos);
  EXPECT_NE(message_of({"stage.slowly.time=2"}, two).find("more than one"), std::string::npos);
}

TEST_F(StageRegistry, RefusesASecondStageOfTheSameName) {
  EXPECT_THROW(register_stage<ExpandEntry>(), std::logic_error);
}

} // namespace
} // namespace boba
