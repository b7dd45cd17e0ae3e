// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/archive/archive.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace boba {

namespace {

using Reals = SavedValue::Reals;
using Integers = SavedValue::Integers;
using Shape = std::vector<std::int64_t>;

std::int64_t length(const std::vector<double>& values) {
  return static_cast<std::int64_t>(values.size());
}

} // namespace

void Archive::fail(const std::string& name, const std::string& what) const {
  throw SavedStateError(fmt::format("saved state: {}{} {}", prefix_, name, what));
}

bool Archive::has(const std::string& name) const {
  const std::string full = prefix_ + name;
  const auto at = from_->lower_bound(full);
  if (at != from_->end() && at->first == full) {
    return true;
  }
  const auto below = from_->lower_bound(full + '.');
  return below != from_->end() && below->first.starts_with(full + '.');
}

const SavedValue& Archive::found(const std::string& name) const {
  const auto at = from_->find(prefix_ + name);
  if (at == from_->end()) {
    fail(name, "is missing; it was written by another version of Boba");
  }
  return at->second;
}

/// The values of a field that has the type and the shape of `expected`; a length of -1 there may be any.
template <class Values> const Values& Archive::typed(const std::string& name, const SavedValue& expected) const {
  const SavedValue& value = found(name);
  const bool fits = std::equal(value.shape.begin(), value.shape.end(), expected.shape.begin(), expected.shape.end(),
                               [](std::int64_t is, std::int64_t should) { return should < 0 || is == should; });
  if (!fits || !value.is_whole() || !std::holds_alternative<Values>(value.values)) {
    std::string wanted = description(expected);
    if (const std::size_t any = wanted.find("-1"); any != std::string::npos) {
      wanted.replace(any, 2, "n");
    }
    fail(name, fmt::format("holds {}; expected: {}", description(value), wanted));
  }
  return std::get<Values>(value.values);
}

const std::vector<double>& Archive::real_values(const std::string& name, const Shape& shape) const {
  return typed<Reals>(name, {Reals(), shape});
}

const std::vector<std::int64_t>& Archive::integer_values(const std::string& name, const Shape& shape) const {
  return typed<Integers>(name, {Integers(), shape});
}

void Archive::save(const std::string& name, SavedValue value) {
  if (!to_->emplace(prefix_ + name, std::move(value)).second) {
    throw std::logic_error(fmt::format("saved state: {}{} is saved twice", prefix_, name));
  }
}

std::size_t Archive::checked_count(std::int64_t n) const {
  // Each object has a field at least: a count beyond that is no count.
  if (n < 0 || (is_reading() && n > static_cast<std::int64_t>(from_->size()))) {
    fail("count", fmt::format("= {} cannot be the number of what follows", n));
  }
  return static_cast<std::size_t>(n);
}

void Archive::field(const std::string& name, double& value) {
  if (is_reading()) {
    value = real_values(name, {}).front();
  } else {
    save(name, {Reals{value}, {}});
  }
}

void Archive::field(const std::string& name, std::int64_t& value) {
  if (is_reading()) {
    value = integer_values(name, {}).front();
  } else {
    save(name, {Integers{value}, {}});
  }
}

void Archive::field(const std::string& name, int& value) {
  std::int64_t number = value;
  field(name, number);
  if (number < std::numeric_limits<int>::min() || number > std::numeric_limits<int>::max()) {
    fail(name, fmt::format("= {} does not fit 32 bits", number));
  }
  value = static_cast<int>(number);
}

void Archive::field(const std::string& name, bool& value) {
  std::int64_t number = value ? 1 : 0;
  field(name, number);
  if (number != 0 && number != 1) {
    fail(name, fmt::format("= {}; allowed: 0 or 1", number));
  }
  value = number == 1;
}

void Archive::field(const std::string& name, std::string& value) {
  if (is_reading()) {
    value = typed<std::string>(name, {std::string(), {}});
  } else {
    save(name, {value, {}});
  }
}

void Archive::reals(const std::string& name, double* values, std::size_t n) {
  const Shape shape = {static_cast<std::int64_t>(n)};
  if (is_reading()) {
    std::ranges::copy(real_values(name, shape), values);
  } else {
    save(name, {Reals(values, values + n), shape});
  }
}

void Archive::field(const std::string& name, Eigen::Vector3d& value) {
  reals(name, value.data(), 3);
}

void Archive::field(const std::string& name, Eigen::Matrix3d& value) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  if (is_reading()) {
    value = Eigen::Map<const RowMajor>(real_values(name, {3, 3}).data());
  } else {
    const RowMajor rows = value;
    save(name, {Reals(rows.data(), rows.data() + 9), {3, 3}});
  }
}

void Archive::field(const std::string& name, std::vector<double>& values) {
  if (is_reading()) {
    values = real_values(name, {-1});
  } else {
    save(name, {values, {length(values)}});
  }
}

void Archive::field(const std::string& name, std::vector<std::int64_t>& values) {
  if (is_reading()) {
    values = integer_values(name, {-1});
  } else {
    save(name, {values, {static_cast<std::int64_t>(values.size())}});
  }
}

void Archive::field(const std::string& name, std::vector<std::string>& values) {
  std::string lines;
  for (const std::string& value : values) {
    lines += value + '\n';
  }
  field(name, lines);
  values.clear();
  for (std::size_t begin = 0; begin < lines.size();) {
    const std::size_t end = std::min(lines.find('\n', begin), lines.size());
    values.push_back(lines.substr(begin, end - begin));
    begin = end + 1;
  }
}

void Archive::field(const std::string& name, std::vector<Eigen::Vector3d>& values) {
  if (is_reading()) {
    const std::vector<double>& numbers = real_values(name, {-1, 3});
    values.resize(numbers.size() / 3);
    std::ranges::copy(numbers, values.empty() ? nullptr : values.front().data());
  } else {
    const double* first = values.empty() ? nullptr : values.front().data();
    save(name, {Reals(first, first + 3 * values.size()), {static_cast<std::int64_t>(values.size()), 3}});
  }
}

} // namespace boba
