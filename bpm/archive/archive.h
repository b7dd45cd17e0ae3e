// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/archive/saved_state.h"

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace boba {

/// Saves the fields of an object under their names, or reads them back. One function of the object does both:
///
///     void TimedSteps::archive(Archive& archive) {
///       archive.field("n_steps", n_steps_);
///       archive.field("steps_done", steps_done_);
///     }
///
/// Types, shapes and names are checked when a state is read. 64-bit integers stay integers, reals keep all their bits.
/// \throws SavedStateError, naming the field, when it is missing or is not what is expected.
class Archive {
public:
  /// Saves into `state`, which must outlive this.
  static Archive saving_to(SavedState& state) { return Archive(&state, nullptr); }
  /// Reads from `state`, which must outlive this.
  static Archive reading_from(const SavedState& state) { return Archive(nullptr, &state); }
  bool is_reading() const { return from_ != nullptr; }

  void field(const std::string& name, double& value);
  void field(const std::string& name, std::int64_t& value);
  void field(const std::string& name, int& value);
  void field(const std::string& name, bool& value);
  void field(const std::string& name, std::string& value);
  void field(const std::string& name, Eigen::Vector3d& value);
  void field(const std::string& name, Eigen::Matrix3d& value); ///< row by row
  void field(const std::string& name, std::vector<double>& values);
  void field(const std::string& name, std::vector<std::int64_t>& values);
  void field(const std::string& name, std::vector<std::string>& values); ///< none of them may hold a line feed
  void field(const std::string& name, std::vector<Eigen::Vector3d>& values);
  template <std::size_t n> void field(const std::string& name, std::array<double, n>& values) {
    reals(name, values.data(), n);
  }
  /// An enumerator by its number; reading refuses numbers beyond `last`.
  template <class Enum>
  requires std::is_enum_v<Enum>
  void field(const std::string& name, Enum& value, Enum last) {
    auto number = static_cast<std::int64_t>(value);
    field(name, number);
    if (number < 0 || number > static_cast<std::int64_t>(last)) {
      fail(name, "holds a number that means nothing");
    }
    value = static_cast<Enum>(number);
  }
  /// A value that may be absent: so is its field.
  template <class Value> void field(const std::string& name, std::optional<Value>& value) {
    if (is_reading() ? !has(name) : !value) {
      value.reset();
      return;
    }
    if (!value) {
      value.emplace();
    }
    field(name, *value);
  }

  /// An object with a function `archive(Archive&)`: its fields stand below `name`.
  template <class Object> void object(const std::string& name, Object& object) {
    inside(name, [&] { object.archive(*this); });
  }
  /// As many objects as there are, below `name.0`, `name.1`, ...; new ones are made when a state is read. \param each
  /// archives one: `each(archive, object)`
  template <class Object, class Each>
  void objects(const std::string& name, std::vector<Object>& list, const Each& each) {
    inside(name, [&] {
      auto n = static_cast<std::int64_t>(list.size());
      field("count", n);
      list.resize(checked_count(n));
      for (std::int64_t k = 0; k < n; ++k) {
        inside(std::to_string(k), [&] { each(*this, list[static_cast<std::size_t>(k)]); });
      }
    });
  }
  /// Calls `body` with `name.` in front of the names of its fields.
  template <class Body> void inside(const std::string& name, const Body& body) {
    const std::string outer = prefix_;
    prefix_ += name + '.';
    body();
    prefix_ = outer;
  }

  /// Hands over large values without a copy. \param shape as in SavedValue
  void save(const std::string& name, SavedValue value);
  /// The values of a field that is read. \param shape what it must be
  const std::vector<double>& real_values(const std::string& name, const std::vector<std::int64_t>& shape) const;
  const std::vector<std::int64_t>& integer_values(const std::string& name,
                                                  const std::vector<std::int64_t>& shape) const;
  /// Is there such a field, or are there fields below it?
  bool has(const std::string& name) const;
  /// \throws SavedStateError "saved state: NAME WHAT".
  [[noreturn]] void fail(const std::string& name, const std::string& what) const;

private:
  Archive(SavedState* to, const SavedState* from) : to_(to), from_(from) {}
  const SavedValue& found(const std::string& name) const;
  template <class Values> const Values& typed(const std::string& name, const SavedValue& expected) const;
  void reals(const std::string& name, double* values, std::size_t n);
  std::size_t checked_count(std::int64_t n) const;

  SavedState* to_;
  const SavedState* from_;
  std::string prefix_;
};

} // namespace boba
