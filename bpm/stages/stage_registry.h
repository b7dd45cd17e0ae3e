// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/stages/stage.h"

#include <concepts>
#include <functional>
#include <memory>
#include <vector>

namespace boba {

/// A kind of stage that scenes may name: its table and how an entry is read from it.
struct StageKind {
  SceneSection section; ///< [[stage]] with `type = section.kind`
  std::function<std::shared_ptr<const StageEntry>(const SceneTable&)> read;
};

/// A class that register_stage takes: a StageEntry with its keys and a constructor that reads them.
template <class Entry>
concept ReadableStage =
    std::derived_from<Entry, StageEntry> && std::constructible_from<Entry, const SceneTable&> && requires {
  { Entry::section() } -> std::same_as<SceneSection>;
};

/// Adds a kind of stage, before the first scene is read; a program of your own does it in main().
/// \throws std::logic_error when there is one of that name already.
void register_stage(StageKind kind);
template <ReadableStage Entry> void register_stage() {
  register_stage({Entry::section(), [](const SceneTable& table) { return std::make_shared<const Entry>(table); }});
}

/// All kinds of stages, in the order in which the documentation lists them.
const std::vector<StageKind>& stage_kinds();
/// Null when no stage has that name.
const StageKind* find_stage_kind(const std::string& name);

} // namespace boba
