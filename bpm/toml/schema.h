// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace boba {

/// A checked value of a scene.
using SceneValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;

/// What a key of a scene may hold.
struct SceneKey {
  enum class Type { boolean, integer, real, text, choice, vector3, vectors, numbers };

  std::string name;
  Type type = Type::real;
  std::string unit; ///< "" for a pure number
  std::string doc;
  bool required = false;
  std::string fallback; ///< how the default reads in the documentation; "" when the key may be absent
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool above_lowest = false;        ///< the lowest value itself is not allowed
  std::size_t fewest = 0, most = 0; ///< of the entries of a list
  std::vector<std::string> choices; ///< of a choice; of a number: texts that may stand in its place

  /// "a number above 0 and at most 1 (tau)": the end of every message about this key.
  std::string allowed() const;
};

/// Builders, so that a table of keys reads like a table.
SceneKey boolean_key(std::string name, std::string fallback, std::string doc);
SceneKey integer_key(std::string name, double lowest, double highest, std::string fallback, std::string doc);
SceneKey real_key(std::string name, std::string unit, double lowest, double highest, std::string fallback,
                  std::string doc);
/// As real_key, but greater than `lowest`.
SceneKey above_key(std::string name, std::string unit, double lowest, double highest, std::string fallback,
                   std::string doc);
SceneKey text_key(std::string name, std::string fallback, std::string doc);
SceneKey choice_key(std::string name, std::vector<std::string> choices, std::string fallback, std::string doc);
SceneKey vector_key(std::string name, std::string unit, double lowest, double highest, std::string fallback,
                    std::string doc);
/// A list of as many vectors of three numbers as `fewest` to `most`; read as one vector with all numbers in a row.
SceneKey vectors_key(std::string name, std::string unit, double lowest, double highest, std::size_t fewest,
                     std::size_t most, std::string doc);
/// A list of as many numbers as `fewest` to `most`.
SceneKey numbers_key(std::string name, std::string unit, double lowest, double highest, std::size_t fewest,
                     std::size_t most, std::string doc);
SceneKey required(SceneKey key);
/// The keys of both, in order.
std::vector<SceneKey> joined(std::vector<SceneKey> first, const std::vector<SceneKey>& second);
/// The same, and one of these texts is allowed in place of a number.
SceneKey or_text(SceneKey key, std::vector<std::string> texts);

/// The keys of one table of a scene.
struct SceneSection {
  std::string path;      ///< "run", "output.table", "stage", "species.size" (in each entry); "" for the top of the file
  std::string kind;      ///< value of `type` that selects this one among the tables of the same path, or ""
  bool repeated = false; ///< an array of tables: [[stage]]
  std::string doc;
  std::vector<SceneKey> keys;

  const SceneKey* find(const std::string& name) const;
};

/// All tables of a format.
using SceneSchema = std::vector<SceneSection>;

/// The word of `known` that is nearest to `word` by edit distance, or "" when none is near.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

} // namespace boba
