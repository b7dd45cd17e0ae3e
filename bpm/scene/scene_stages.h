// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/scene/scene.h"
#include "bpm/toml/scene_table.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boba {

/// The stages after the start, in order. \throws InputError with the table that is wrong.
std::vector<SceneStage> read_stages(const SceneTables& tables, const Scene& scene);

/// A stage that can run.
struct PreparedStage {
  int index = 0;     ///< as in SceneStage
  std::string label; ///< for the log
  std::unique_ptr<StageDriver> driver;
  bool is_strict = false; ///< as in SceneStage
};

/// What is known of the packing, for StageEntry. \param modulus E / (2 - 2 nu^2), k/d
StageContext stage_context(const Scene& scene, const Packing& packing, std::optional<double> modulus);

/// The drivers of all stages. \throws InputError when one needs E and nu and they are unknown.
std::vector<PreparedStage> prepare_stages(const Scene& scene, const StageContext& context);

} // namespace boba
