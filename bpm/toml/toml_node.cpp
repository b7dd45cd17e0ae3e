// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/toml/toml_node.h"

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

// What a scene may hold. A parser may go down one call for every level, so depth is looked at before it begins.
constexpr int deepest_nesting = 32, longest_dotted_key = 32;

/// The value as text, no further than a message shows it: an array is looked at only as far as that.
void append(std::string& text, const toml::node& node) {
  const auto append_all = [&](const auto& container, char open, char close, auto append_one) {
    text += open;
    const char* before = " ";
    for (auto&& entry : container) {
      if (text.size() > longest_shown) {
        return;
      }
      text += before;
      append_one(entry);
      before = ", ";
    }
    text += container.empty() ? "" : " ";
    text += close;
  };
  if (const auto* words = node.as_string()) {
    text += '"' + words->get() + '"';
  } else if (const auto* real = node.as_floating_point()) {
    const std::string number = fmt::format("{}", real->get());
    text += number;
    text += number.find_first_not_of("-0123456789") == std::string::npos ? ".0" : ""; // 7.0 is no whole number
  } else if (const auto* array = node.as_array()) {
    append_all(*array, '[', ']', [&](const toml::node& item) { append(text, item); });
  } else if (const auto* table = node.as_table()) {
    append_all(*table, '{', '}', [&](const auto& member) {
      text += std::string(member.first.str()) + " = ";
      append(text, member.second);
    });
  } else {
    std::ostringstream out;
    node.visit([&out](const auto& value) { out << value; });
    text += out.str();
  }
}

/// For a message: one line, shortened.
std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return text.size() > longest_shown ? text.substr(0, longest_shown) + "..." : text;
}

std::string shown(const toml::node& node) {
  std::string text;
  append(text, node);
  return on_one_line(std::move(text));
}

/// Behind the string that begins at `at`, with one or three of its quotes; the end of the text when it has no end.
std::size_t behind_string(const std::string& text, std::size_t at) {
  const char quote = text[at];
  const bool is_long = text.compare(at, 3, std::string(3, quote)) == 0;
  const std::string end = std::string(is_long ? 3 : 1, quote);
  for (at += end.size(); at < text.size(); ++at) {
    if (text[at] == '\\' && quote == '"') {
      ++at;
    } else if (text.compare(at, end.size(), end) == 0) {
      return at + end.size();
    } else if (text[at] == '\n' && !is_long) {
      return at;
    }
  }
  return text.size();
}

/// \throws InputError when brackets or dotted keys go deeper than any scene needs.
void check_depth(const std::string& text, const std::string& file) {
  int depth = 0, dots = 0, line = 1;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      const std::size_t end = behind_string(text, at);
      line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                                          text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
      at = end;
      continue;
    }
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    depth += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
    dots = c == '.' ? dots + 1 : c == '=' || c == ',' || c == '\n' || c == '[' || c == '{' ? 0 : dots;
    line += c == '\n' ? 1 : 0;
    if (depth > deepest_nesting || dots > longest_dotted_key) {
      throw InputError(fmt::format("{}:{}: {} deeper than {} levels; this is no scene", file, line,
                                   depth > deepest_nesting ? "brackets nested" : "a dotted key", deepest_nesting));
    }
    ++at;
  }
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
TomlNode override_value(const std::string& text, const std::string& place) {
  if (text.starts_with('[') || text.starts_with('{')) {
    check_depth(text, place);
  }
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
  check_depth(text, file);
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
  const std::string place = "--set " + on_one_line(assignment);
  const std::size_t equals = assignment.find('=');
  std::vector<std::string> path = split_path(assignment.substr(0, std::min(equals, assignment.size())));
  const bool empty_part = std::find(path.begin(), path.end(), std::string()) != path.end();
  if (equals == std::string::npos || equals + 1 == assignment.size() || path.empty() || empty_part) {
    throw InputError(place + ": must look like section.key=value or stage.0.key=value");
  }
  if (path.size() > longest_dotted_key) {
    throw InputError(fmt::format("{}: the key has {} parts; {} at most", place, path.size(), longest_dotted_key));
  }
  TomlNode value = override_value(assignment.substr(equals + 1), place);
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
