// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/scene/toml_node.h"

#include "bpm/io/input_error.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <toml++/toml.h>

namespace boba {

namespace {

constexpr std::size_t longest_shown = 60;

std::string shown(const toml::node& node) {
  std::string text;
  if (const auto* words = node.as_string()) {
    text = '"' + words->get() + '"';
  } else if (const auto* real = node.as_floating_point()) {
    text = fmt::format("{}", real->get());
    text += text.find_first_not_of("-0123456789") == std::string::npos ? ".0" : ""; // 7.0 is no whole number
  } else {
    std::ostringstream out;
    node.visit([&out](const auto& value) { out << value; });
    text = out.str();
  }
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return text.size() > longest_shown ? text.substr(0, longest_shown) + "..." : text;
}

TomlNode converted(const toml::node& node, const std::string& file) {
  using Kind = TomlNode::Kind;
  TomlNode result;
  result.place = fmt::format("{}:{}", file, node.source().begin.line);
  result.shown = shown(node);
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table) {
      result.members.emplace_back(std::string(key.str()), converted(value, file));
    }
  } else if (const auto* array = node.as_array()) {
    result.kind = Kind::array;
    for (const toml::node& value : *array) {
      result.items.push_back(converted(value, file));
    }
  } else if (const auto* boolean = node.as_boolean()) {
    result.kind = Kind::boolean;
    result.boolean = boolean->get();
  } else if (const auto* integer = node.as_integer()) {
    result.kind = Kind::integer;
    result.integer = integer->get();
  } else if (const auto* real = node.as_floating_point()) {
    result.kind = Kind::real;
    result.real = real->get();
  } else if (const auto* text = node.as_string()) {
    result.kind = Kind::text;
    result.text = text->get();
  } else {
    result.kind = Kind::other;
  }
  return result;
}

/// The value of an override: TOML if it is TOML, else text.
TomlNode override_value(const std::string& text) {
  try {
    return parse_toml("value = " + text + "\n", "").members.front().second;
  } catch (const InputError&) {
    TomlNode node;
    node.kind = TomlNode::Kind::text;
    node.text = text;
    node.shown = '"' + text + '"';
    return node;
  }
}

void set_place(TomlNode& node, const std::string& place) {
  node.place = place;
  for (TomlNode& item : node.items) {
    set_place(item, place);
  }
  for (auto& [name, member] : node.members) {
    set_place(member, place);
  }
}

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts;
  std::istringstream in(path);
  for (std::string part; std::getline(in, part, '.');) {
    parts.push_back(part);
  }
  return parts;
}

/// The entry of an array that a part of an override's path names: its number from 0, its `name` or its `type`.
TomlNode& array_entry(TomlNode& array, const std::string& name, const std::string& part, const std::string& place) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error == std::errc() && end == part.data() + part.size() && index < array.items.size()) {
    return array.items[index];
  }
  TomlNode* found = nullptr;
  for (TomlNode& item : array.items) {
    const TomlNode* type = item.find("type");
    const TomlNode* own_name = item.find("name");
    if ((type != nullptr && type->text == part) || (own_name != nullptr && own_name->text == part)) {
      if (found != nullptr) {
        throw InputError(fmt::format("{}: more than one {} has the type or the name {}; use its number, counted from 0",
                                     place, name, part));
      }
      found = &item;
    }
  }
  if (found == nullptr) {
    throw InputError(fmt::format("{}: there is no {}.{}; the scene has {}.0 to {}.{} (counted from 0)", place, name,
                                 part, name, name, array.items.size() - 1));
  }
  return *found;
}

} // namespace

TomlNode::TomlNode() = default;

const TomlNode* TomlNode::find(const std::string& name) const {
  return const_cast<TomlNode*>(this)->find(name);
}

TomlNode* TomlNode::find(const std::string& name) {
  const auto at =
      std::find_if(members.begin(), members.end(), [&](const auto& member) { return member.first == name; });
  return at == members.end() ? nullptr : &at->second;
}

TomlNode parse_toml(const std::string& text, const std::string& file) {
  try {
    const toml::table table = toml::parse(text, file);
    return converted(table, file);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}: {}", file, error.source().begin.line, error.description()));
  }
}

std::string read_text_file(const std::filesystem::path& path, std::uintmax_t largest) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw InputError(fmt::format("{}: there is no such file", path.string()));
  }
  if (!std::filesystem::is_regular_file(path, error)) {
    throw InputError(fmt::format("{}: not a regular file", path.string()));
  }
  if (std::filesystem::file_size(path, error) > largest) {
    throw InputError(fmt::format("{}: larger than {} bytes; this is no scene", path.string(), largest));
  }
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) {
    throw InputError(fmt::format("{}: cannot be read", path.string()));
  }
  return text.str();
}

void apply_override(TomlNode& root, const std::string& assignment) {
  const std::string place = "--set " + assignment;
  const std::size_t equals = assignment.find('=');
  std::vector<std::string> path = split_path(assignment.substr(0, std::min(equals, assignment.size())));
  const bool empty_part = std::find(path.begin(), path.end(), std::string()) != path.end();
  if (equals == std::string::npos || equals + 1 == assignment.size() || path.empty() || empty_part) {
    throw InputError(place + ": must look like section.key=value or stage.0.key=value");
  }
  TomlNode value = override_value(assignment.substr(equals + 1));
  set_place(value, place);

  TomlNode* node = &root;
  std::string name;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (node->kind == TomlNode::Kind::array && !node->items.empty()) {
      node = &array_entry(*node, name, path[i], place);
    } else if (node->kind == TomlNode::Kind::table) {
      TomlNode* next = node->find(path[i]);
      if (next == nullptr) {
        TomlNode made;
        made.place = place;
        node->members.emplace_back(path[i], made);
        next = &node->members.back().second;
      }
      node = next;
    } else {
      throw InputError(fmt::format("{}: {} is {}, it has no {}", place, name, node->shown, path[i]));
    }
    name += (name.empty() ? "" : ".") + path[i];
  }
  *node = value;
}

} // namespace boba
