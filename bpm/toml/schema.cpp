// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/toml/schema.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <numeric>

namespace boba {

namespace {

std::string range_text(const SceneKey& key) {
  const auto shown = [&key](double bound) {
    return key.type == SceneKey::Type::integer ? fmt::format("{:.0f}", bound) : fmt::format("{:g}", bound);
  };
  std::string text;
  if (std::isfinite(key.lowest)) {
    text = fmt::format(" {} {}", key.above_lowest ? "above" : "from", shown(key.lowest));
  }
  if (std::isfinite(key.highest)) {
    text += fmt::format(" {} {}", key.above_lowest ? "and at most" : "to", shown(key.highest));
  }
  return text + (key.unit.empty() ? "" : " (" + key.unit + ")");
}

SceneKey make_key(SceneKey::Type type, std::string name, std::string fallback, std::string doc) {
  SceneKey key;
  key.type = type;
  key.name = std::move(name);
  key.fallback = std::move(fallback);
  key.doc = std::move(doc);
  return key;
}

} // namespace

std::string SceneKey::allowed() const {
  switch (type) {
  case Type::boolean:
    return "true or false";
  case Type::integer:
    return "a whole number" + range_text(*this);
  case Type::real:
    return "a number" + range_text(*this) +
           (choices.empty() ? "" : fmt::format(", or \"{}\"", fmt::join(choices, "\", \"")));
  case Type::text:
    return "a text in quotes";
  case Type::choice:
    return fmt::format("one of \"{}\"", fmt::join(choices, "\", \""));
  case Type::vector3:
    return "three numbers in brackets, each" + range_text(*this);
  case Type::vectors:
    return fmt::format("a list of {} to {} points [x, y, z], each number", fewest, most) + range_text(*this);
  case Type::numbers:
    return fmt::format("a list of {} to {} numbers, each", fewest, most) + range_text(*this);
  }
  return "";
}

SceneKey boolean_key(std::string name, std::string fallback, std::string doc) {
  return make_key(SceneKey::Type::boolean, std::move(name), std::move(fallback), std::move(doc));
}

SceneKey integer_key(std::string name, double lowest, double highest, std::string fallback, std::string doc) {
  SceneKey key = make_key(SceneKey::Type::integer, std::move(name), std::move(fallback), std::move(doc));
  key.lowest = lowest;
  key.highest = highest;
  return key;
}

SceneKey real_key(std::string name, std::string unit, double lowest, double highest, std::string fallback,
                  std::string doc) {
  SceneKey key = make_key(SceneKey::Type::real, std::move(name), std::move(fallback), std::move(doc));
  key.unit = std::move(unit);
  key.lowest = lowest;
  key.highest = highest;
  return key;
}

SceneKey above_key(std::string name, std::string unit, double lowest, double highest, std::string fallback,
                   std::string doc) {
  SceneKey key = real_key(std::move(name), std::move(unit), lowest, highest, std::move(fallback), std::move(doc));
  key.above_lowest = true;
  return key;
}

SceneKey text_key(std::string name, std::string fallback, std::string doc) {
  return make_key(SceneKey::Type::text, std::move(name), std::move(fallback), std::move(doc));
}

SceneKey choice_key(std::string name, std::vector<std::string> choices, std::string fallback, std::string doc) {
  SceneKey key = make_key(SceneKey::Type::choice, std::move(name), std::move(fallback), std::move(doc));
  key.choices = std::move(choices);
  return key;
}

SceneKey vector_key(std::string name, std::string unit, double lowest, double highest, std::string fallback,
                    std::string doc) {
  SceneKey key = above_key(std::move(name), std::move(unit), lowest, highest, std::move(fallback), std::move(doc));
  key.type = SceneKey::Type::vector3;
  return key;
}

SceneKey vectors_key(std::string name, std::string unit, double lowest, double highest, std::size_t fewest,
                     std::size_t most, std::string doc) {
  SceneKey key = real_key(std::move(name), std::move(unit), lowest, highest, "", std::move(doc));
  key.type = SceneKey::Type::vectors;
  key.fewest = fewest;
  key.most = most;
  return key;
}

SceneKey numbers_key(std::string name, std::string unit, double lowest, double highest, std::size_t fewest,
                     std::size_t most, std::string doc) {
  SceneKey key = vectors_key(std::move(name), std::move(unit), lowest, highest, fewest, most, std::move(doc));
  key.type = SceneKey::Type::numbers;
  return key;
}

std::vector<SceneKey> joined(std::vector<SceneKey> first, const std::vector<SceneKey>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

SceneKey required(SceneKey key) {
  key.required = true;
  return key;
}

SceneKey or_text(SceneKey key, std::vector<std::string> texts) {
  key.choices = std::move(texts);
  return key;
}

const SceneKey* SceneSection::find(const std::string& name) const {
  const auto at = std::find_if(keys.begin(), keys.end(), [&](const SceneKey& key) { return key.name == name; });
  return at == keys.end() ? nullptr : &*at;
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& known) {
  // Levenshtein's distance, one row at a time.
  const auto distance = [&word](const std::string& other) {
    std::vector<std::size_t> row(other.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < word.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i + 1;
      for (std::size_t j = 0; j < other.size(); ++j) {
        const std::size_t substituted = diagonal + (word[i] == other[j] ? 0 : 1);
        diagonal = row[j + 1];
        row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
      }
    }
    return row.back();
  };
  constexpr std::size_t longest_word = 64; // an absurdly long key is near to nothing
  std::string nearest;
  std::size_t best = word.size() > longest_word ? 0 : std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& other : known) {
    const bool beginning = word.size() >= 3 && word.size() <= longest_word && other.starts_with(word);
    const std::size_t d = best == 0 ? 0 : (beginning ? 1 : distance(other));
    if (best > 0 && d < best) {
      best = d;
      nearest = other;
    }
  }
  return nearest;
}

} // namespace boba
