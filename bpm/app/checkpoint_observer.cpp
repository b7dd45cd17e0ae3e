// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/checkpoint_observer.h"

#include "bpm/app/version.h"
#include "bpm/dynamics/share_state.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/io/input_error.h"
#include "bpm/io/packing_archive.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

// Fields of this file, below these names; the simulation has its own.
const std::string run_name = "run", packing_name = "packing", output_name = "output";

bool changes(const std::string& field) {
  return field.starts_with("simulation.") || field.starts_with(output_name + ".");
}

} // namespace

void RunRecord::archive(Archive& archive) {
  archive.field("scene", scene);
  archive.field("scene_path", scene_path);
  archive.field("overrides", overrides);
  archive.field("version", version);
  archive.field("instruction_set", instruction_set);
  archive.field("modulus", modulus);
}

SavedState constant_part(const RunSetup& setup, const Simulation& simulation) {
  SavedState data;
  if (!simulation.ranks().is_root()) {
    return data;
  }
  const Scene& scene = setup.scene;
  RunRecord record = {scene.text,     scene.path.string(),          scene.overrides,
                      version_text(), simulation.instruction_set(), setup.modulus};
  Packing packing = simulation.packing();
  Archive archive = Archive::saving_to(data);
  archive.object(run_name, record);
  archive.inside(packing_name, [&] { archive_packing(archive, packing); });
  return data;
}

void share_checkpoint(LatestCheckpoint& checkpoint, const Ranks& ranks) {
  if (ranks.is_distributed()) {
    share_but_nodes(checkpoint.data, ranks);
    std::string path = checkpoint.path.string();
    ranks.broadcast(path);
    checkpoint.path = path;
  }
}

RunRecord run_record(const LatestCheckpoint& checkpoint) {
  RunRecord record;
  try {
    Archive archive = Archive::reading_from(checkpoint.data);
    archive.object(run_name, record);
  } catch (const SavedStateError& error) {
    throw InputError(fmt::format("{}: the run cannot continue: {}", checkpoint.path.string(), error.what()));
  }
  return record;
}

RunSetup setup_from(const LatestCheckpoint& checkpoint, const OutputFolder& folder) {
  try {
    const RunRecord record = run_record(checkpoint);
    Archive archive = Archive::reading_from(checkpoint.data);
    Packing packing;
    archive.inside(packing_name, [&] { archive_packing(archive, packing); });
    RunSetup::Restart restart = {checkpoint.data, 0, checkpoint.path.string()};
    archive.inside("simulation", [&] { archive.field("step", restart.step); });
    Scene scene = read_stored_scene(record.scene, record.scene_path, record.overrides);
    return {std::move(scene), folder, std::move(packing), {}, record.modulus, false, std::move(restart)};
  } catch (const InputError&) {
    throw;
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: the run cannot continue: {}", checkpoint.path.string(), error.what()));
  } catch (const SavedStateError& error) {
    throw InputError(fmt::format("{}: the run cannot continue: {}", checkpoint.path.string(), error.what()));
  }
}

void store_writers(SavedState& data, RunWriters& writers) {
  Archive archive = Archive::saving_to(data);
  archive.object(output_name, writers);
}

bool CheckpointObserver::wants(const StepForecast& forecast) {
  now_ = forecast.seconds;
  due_ = schedule_.due(forecast) || now_ - last_ >= every_seconds_;
  return due_;
}

void CheckpointObserver::observe(const Simulation& simulation, const StageProgress&) {
  if (due_) { // the run writes those between stages itself
    write(simulation);
    due_ = false;
  }
}

std::filesystem::path CheckpointObserver::write(const Simulation& simulation) {
  std::erase_if(data_, [](const auto& entry) { return changes(entry.first); });
  last_ = now_;
  data_.merge(simulation.save());
  store_writers_(data_);
  const std::vector<std::int64_t> first_node = simulation.packing().first_nodes();
  return write_checkpoint(
      folder_, data_, simulation.ranks(),
      {{node_fields.begin(), node_fields.end()}, node_runs(simulation.own_grains(), first_node), first_node.back()});
}

} // namespace boba
