// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/toml/scene_table.h"

#include "bpm/io/input_error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <set>

namespace boba {

namespace {

using Kind = TomlNode::Kind;

std::string dotted(const std::string& table, const std::string& key) {
  return table.empty() ? key : table + "." + key;
}

bool is_number(const TomlNode& node) {
  return node.kind == Kind::integer || node.kind == Kind::real;
}

double number(const TomlNode& node) {
  return node.kind == Kind::integer ? static_cast<double>(node.integer) : node.real;
}

bool in_range(const SceneKey& key, double value) {
  return std::isfinite(value) && value <= key.highest && (key.above_lowest ? value > key.lowest : value >= key.lowest);
}

std::optional<SceneValue> checked_choice(const SceneKey& key, const TomlNode& node) {
  const bool known =
      node.kind == Kind::text && std::find(key.choices.begin(), key.choices.end(), node.text) != key.choices.end();
  return known ? std::optional<SceneValue>(node.text) : std::nullopt;
}

/// The numbers of a list of `fewest` to `most`.
std::optional<std::vector<double>> numbers(const SceneKey& key, const TomlNode& node, std::size_t fewest,
                                           std::size_t most) {
  const auto good = [&key](const TomlNode& item) { return is_number(item) && in_range(key, number(item)); };
  if (node.kind != Kind::array || node.items.size() < fewest || node.items.size() > most ||
      !std::all_of(node.items.begin(), node.items.end(), good)) {
    return std::nullopt;
  }
  std::vector<double> all;
  std::transform(node.items.begin(), node.items.end(), std::back_inserter(all), number);
  return all;
}

/// The value if the key allows it.
std::optional<SceneValue> checked(const SceneKey& key, const TomlNode& node) {
  using Type = SceneKey::Type;
  switch (key.type) {
  case Type::boolean:
    return node.kind == Kind::boolean ? std::optional<SceneValue>(node.boolean) : std::nullopt;
  case Type::integer:
    return node.kind == Kind::integer && in_range(key, number(node)) ? std::optional<SceneValue>(node.integer)
                                                                     : std::nullopt;
  case Type::real:
    return is_number(node) && in_range(key, number(node)) ? std::optional<SceneValue>(number(node))
                                                          : checked_choice(key, node);
  case Type::text:
    return node.kind == Kind::text ? std::optional<SceneValue>(node.text) : std::nullopt;
  case Type::choice:
    return checked_choice(key, node);
  case Type::vector3:
    return numbers(key, node, 3, 3);
  case Type::vectors: {
    if (node.kind != Kind::array || node.items.size() < key.fewest || node.items.size() > key.most) {
      return std::nullopt;
    }
    std::vector<double> all;
    for (const TomlNode& item : node.items) {
      const std::optional<std::vector<double>> row = numbers(key, item, 3, 3);
      if (!row) {
        return std::nullopt;
      }
      all.insert(all.end(), row->begin(), row->end());
    }
    return all;
  }
  case Type::numbers:
    return numbers(key, node, key.fewest, key.most);
  }
  return std::nullopt;
}

[[noreturn]] void fail_unknown(const TomlNode& node, const std::string& name, const std::string& key,
                               const std::vector<std::string>& known) {
  const std::string near = nearest_word(key, known);
  const std::string advice = near.empty() ? "" : fmt::format(" Did you mean \"{}\"?", near);
  const std::string list = known.empty() ? "no keys" : fmt::format("{}", fmt::join(known, ", "));
  throw InputError(fmt::format("{}: {} = {}: there is no such key.{} Allowed here: {}", node.place, dotted(name, key),
                               node.shown, advice, list));
}

/// Names of the tables directly inside the table `path` ("output" -> "table", ...).
std::vector<std::string> inner_tables(const SceneSchema& schema, const std::string& path) {
  std::set<std::string> names;
  const std::string prefix = path.empty() ? "" : path + ".";
  for (const SceneSection& section : schema) {
    if (section.path.size() > prefix.size() && section.path.starts_with(prefix)) {
      names.insert(section.path.substr(prefix.size(), section.path.find('.', prefix.size()) - prefix.size()));
    }
  }
  return {names.begin(), names.end()};
}

/// A table in each entry of a repeated one, like [species.size].
bool is_inside_entries(const SceneSchema& schema, const SceneSection& section) {
  return std::any_of(schema.begin(), schema.end(), [&](const SceneSection& outer) {
    return outer.repeated && section.path.starts_with(outer.path + ".");
  });
}

const TomlNode* node_at(const TomlNode& root, const std::string& path) {
  const TomlNode* node = &root;
  for (std::size_t begin = 0; node != nullptr && begin < path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    node = node->find(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return node;
}

/// The section of a repeated table that its `type` selects.
const SceneSection& section_of_entry(const SceneSchema& schema, const std::string& path, const std::string& name,
                                     const TomlNode& entry) {
  std::vector<std::string> kinds;
  const TomlNode* type = entry.find("type");
  for (const SceneSection& section : schema) {
    if (section.path == path) {
      if (section.kind.empty() || (type != nullptr && type->kind == Kind::text && type->text == section.kind)) {
        return section;
      }
      kinds.push_back(section.kind);
    }
  }
  if (type == nullptr) {
    throw InputError(
        fmt::format("{}: {}.type is missing; it must be one of \"{}\"", entry.place, name, fmt::join(kinds, "\", \"")));
  }
  const std::string near = nearest_word(type->text, kinds);
  throw InputError(fmt::format("{}: {}.type = {}: must be one of \"{}\".{}", type->place, name, type->shown,
                               fmt::join(kinds, "\", \""), near.empty() ? "" : " Did you mean \"" + near + "\"?"));
}

} // namespace

SceneTable::SceneTable(const SceneSchema& schema, const SceneSection& section, std::string name, const TomlNode* node,
                       const std::string& file)
    : section_(&section), name_(std::move(name)), node_(node), file_(file) {
  if (node == nullptr) {
    return;
  }
  if (node->kind != Kind::table) {
    throw InputError(fmt::format("{}: {} = {}: must be a table, [{}]", node->place, name_, node->shown, section.path));
  }
  std::vector<std::string> inner = inner_tables(schema, section.path);
  for (const auto& [key_name, value] : node->members) {
    const SceneKey* key = section.find(key_name);
    const bool is_type = !section.kind.empty() && key_name == "type";
    if (is_type || std::find(inner.begin(), inner.end(), key_name) != inner.end()) {
      continue;
    }
    if (key == nullptr) {
      std::vector<std::string> known = inner;
      for (const SceneKey& other : section.keys) {
        known.push_back(other.name);
      }
      fail_unknown(value, name_, key_name, known);
    }
    const std::optional<SceneValue> good = checked(*key, value);
    if (!good) {
      throw InputError(
          fmt::format("{}: {} = {}: must be {}", value.place, dotted(name_, key_name), value.shown, key->allowed()));
    }
    values_.emplace(key_name, *good);
  }
  for (const SceneKey& key : section.keys) {
    if (key.required && !has(key.name)) {
      fail(key.name, "is missing; it must be " + key.allowed());
    }
  }
  if (section.repeated) {
    read_inner(schema, file);
  }
}

void SceneTable::read_inner(const SceneSchema& schema, const std::string& file) {
  for (const SceneSection& section : schema) {
    if (!is_inside_entries(schema, section) || !section.path.starts_with(section_->path + ".")) {
      continue;
    }
    const std::string own = section.path.substr(section_->path.size() + 1);
    if (const TomlNode* node = node_->find(own)) {
      inner_.emplace_back(schema, section, dotted(name_, own), node, file);
    }
  }
}

const SceneTable* SceneTable::inner(const std::string& name) const {
  const std::string wanted = dotted(name_, name);
  const auto at =
      std::find_if(inner_.begin(), inner_.end(), [&](const SceneTable& table) { return table.name() == wanted; });
  return at == inner_.end() ? nullptr : &*at;
}

void SceneTable::fail(const std::string& key, const std::string& message) const {
  const TomlNode* value = node_ == nullptr ? nullptr : node_->find(key);
  if (value != nullptr) {
    throw InputError(fmt::format("{}: {} = {}: {}", value->place, dotted(name_, key), value->shown, message));
  }
  throw InputError(fmt::format("{}: {} {}", node_ == nullptr ? file_ : node_->place, dotted(name_, key), message));
}

SceneTables::SceneTables(const SceneSchema& schema, TomlNode tree, const std::string& file) : root(std::move(tree)) {
  for (const SceneSection& section : schema) {
    if (tables.contains(section.path) || is_inside_entries(schema, section)) {
      continue; // another `type` of a repeated table, handled with the first; or read by the entry that holds it
    }
    std::vector<SceneTable>& made = tables[section.path];
    const TomlNode* node = section.path.empty() ? &root : node_at(root, section.path);
    present[section.path] = node != nullptr;
    if (!section.repeated) {
      made.emplace_back(schema, section, section.path, node, file);
      continue;
    }
    if (node != nullptr && node->kind != Kind::array) {
      throw InputError(fmt::format("{}: {} = {}: must be a list of tables, [[{}]]", node->place, section.path,
                                   node->shown, section.path));
    }
    for (std::size_t i = 0; node != nullptr && i < node->items.size(); ++i) {
      const std::string name = fmt::format("{}.{}", section.path, i);
      if (node->items[i].kind != Kind::table) {
        throw InputError(fmt::format("{}: {} = {}: must be a table, [[{}]]", node->items[i].place, name,
                                     node->items[i].shown, section.path));
      }
      made.emplace_back(schema, section_of_entry(schema, section.path, name, node->items[i]), name, &node->items[i],
                        file);
    }
  }
}

} // namespace boba
