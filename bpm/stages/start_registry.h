// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/stages/start.h"

#include <concepts>
#include <functional>
#include <memory>
#include <vector>

namespace boba {

/// A kind of start that scenes may name, and how it is read from its table.
struct StartKind {
  SceneSection section;
  std::function<std::shared_ptr<const StartEntry>(const SceneTable&, const StartFiles&)> read;

  /// Is it a part of [start], chosen by its first key? Otherwise it is a first [[stage]], chosen by its type.
  bool is_from_files() const { return section.path == "start"; }
  const std::string& file_key() const { return section.keys.front().name; }
};

/// A class that register_start takes: a StartEntry with its keys and a constructor that reads them.
template <class Entry>
concept ReadableStart = std::derived_from<Entry, StartEntry> &&
    std::constructible_from<Entry, const SceneTable&, const StartFiles&> && requires {
  { Entry::section() } -> std::same_as<SceneSection>;
};

template <ReadableStart Entry> StartKind start_kind() {
  return {Entry::section(),
          [](const SceneTable& table, const StartFiles& files) { return std::make_shared<const Entry>(table, files); }};
}

/// Adds a kind of start, before the first scene is read; a program of your own does it in main().
/// \throws std::logic_error when there is one of that name already.
void register_start(StartKind kind);
template <ReadableStart Entry> void register_start() {
  register_start(start_kind<Entry>());
}

/// All kinds of starts, in the order in which the documentation lists them.
const std::vector<StartKind>& start_kinds();
/// The start that is a first [[stage]] of that type; null when there is none.
const StartKind* find_placing_start(const std::string& type);

/// The [start] table: the keys of all starts from files, and those that they share.
SceneSection start_section();
/// The start that a [start] table chooses. \throws InputError when it names no file, several, or keys of another start.
const StartKind& chosen_file_start(const SceneTable& table);

} // namespace boba
