// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace boba {

/// A value of a TOML file with the place it came from. The parser's own types stay in one source file.
struct TomlNode {
  enum class Kind { boolean, integer, real, text, array, table, other };

  TomlNode(); // not inline: the members' type needs the complete class

  Kind kind = Kind::table;
  bool boolean = false;
  std::int64_t integer = 0;
  double real = 0.0;
  std::string text;
  std::vector<TomlNode> items;                           ///< of an array
  std::vector<std::pair<std::string, TomlNode>> members; ///< of a table
  std::string place;                                     ///< "scene.toml:12" or "--set stage.1.rate=fast"
  std::string shown;                                     ///< the value as text, shortened for messages

  const TomlNode* find(const std::string& name) const;
  TomlNode* find(const std::string& name);
};

/// Parses TOML text; `file` names it in messages.
/// \throws InputError with file and line when the text is no TOML.
TomlNode parse_toml(const std::string& text, const std::string& file);

/// Reads a whole text file. \throws InputError when it is missing, no regular file or larger than `largest` bytes.
std::string read_text_file(const std::filesystem::path& path, std::uintmax_t largest = 1 << 20);

/// Puts a value of the command line, "stage.1.rate=1e-4", into the tree: later text wins over the file.
///
/// Tables on the way are made when they are missing. Entries of an array are counted from 0; an entry may
/// also be named by its `name` or its `type` when only one has it ("stage.shear.rate"). A value that is no TOML is
/// taken as text. \throws InputError when the text has no "=" or the place does not exist; the message names the
/// override.
void apply_override(TomlNode& root, const std::string& assignment);

} // namespace boba
