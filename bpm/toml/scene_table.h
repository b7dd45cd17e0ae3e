// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/toml/schema.h"
#include "bpm/toml/toml_node.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace boba {

/// One table of a scene whose keys, types and ranges have been checked against the schema, which must outlive it.
class SceneTable {
public:
  /// `name` is how messages call the table: "run", "stage.1". An absent table (node == nullptr) has only defaults.
  /// \throws InputError at the first key that is unknown, of a wrong type, out of range or missing.
  SceneTable(const SceneSchema& schema, const SceneSection& section, std::string name, const TomlNode* node,
             const std::string& file);

  bool has(const std::string& key) const { return values_.contains(key); }
  /// Does a text stand where a number may? See or_text.
  bool is_text(const std::string& key) const {
    const auto at = values_.find(key);
    return at != values_.end() && std::holds_alternative<std::string>(at->second);
  }
  bool boolean(const std::string& key, bool fallback) const { return value_or<bool>(key, fallback); }
  std::int64_t integer(const std::string& key, std::int64_t fallback) const { return value_or(key, fallback); }
  double real(const std::string& key, double fallback) const { return value_or(key, fallback); }
  std::string text(const std::string& key, const std::string& fallback) const { return value_or(key, fallback); }
  std::vector<double> vector(const std::string& key, const std::vector<double>& fallback) const {
    return value_or(key, fallback);
  }
  std::optional<double> maybe_real(const std::string& key) const { return maybe<double>(key); }
  std::optional<std::int64_t> maybe_integer(const std::string& key) const { return maybe<std::int64_t>(key); }
  std::optional<std::string> maybe_text(const std::string& key) const { return maybe<std::string>(key); }

  /// A table inside an entry of a repeated one ("size" of a species); nullptr where the file has none.
  const SceneTable* inner(const std::string& name) const;

  const std::string& name() const { return name_; }
  const std::string& kind() const { return section_->kind; }
  /// Stops with "place: table.key = value: message". Without the key in the file: the table's place.
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;

private:
  template <typename T> std::optional<T> maybe(const std::string& key) const {
    const auto at = values_.find(key);
    return at == values_.end() ? std::nullopt : std::optional<T>(std::get<T>(at->second));
  }
  template <typename T> T value_or(const std::string& key, const T& fallback) const {
    return maybe<T>(key).value_or(fallback);
  }

  void read_inner(const SceneSchema& schema, const std::string& file);

  const SceneSection* section_;
  std::string name_;
  const TomlNode* node_;
  std::string file_;
  std::map<std::string, SceneValue> values_;
  std::vector<SceneTable> inner_;
};

/// All tables of a scene, checked.
struct SceneTables {
  TomlNode root;                                         ///< what the tables point into: this struct is not copied
  std::map<std::string, std::vector<SceneTable>> tables; ///< by path; one entry for a table that is not repeated
  std::map<std::string, bool> present;

  SceneTables(const SceneSchema& schema, TomlNode tree, const std::string& file);
  SceneTables(const SceneTables&) = delete;
  SceneTables& operator=(const SceneTables&) = delete;
  const SceneTable& table(const std::string& path) const { return tables.at(path).front(); }
  const std::vector<SceneTable>& list(const std::string& path) const { return tables.at(path); }
};

} // namespace boba
