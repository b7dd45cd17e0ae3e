// SPDX-License-Identifier: GPL-3.0-or-later
// What is saved comes back to the last bit; what is missing or of another type or shape is refused by its name.
#include "bpm/archive/archive.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <gtest/gtest.h>
#include <limits>

namespace boba {
namespace {

struct Part {
  std::int64_t count = 0;
  double gain = 0.0;
  void archive(Archive& archive) {
    archive.field("count", count);
    archive.field("gain", gain);
  }
};

enum class Phase { ramp, settle, settled };

struct Whole {
  std::int64_t large = 0;
  int number = 0;
  bool flag = false;
  std::string text;
  double real = 0.0;
  Phase phase = Phase::ramp;
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  std::array<double, 6> stress{};
  std::vector<std::int64_t> integers;
  std::vector<std::string> texts;
  std::vector<Eigen::Vector3d> vectors;
  std::optional<double> present, absent;
  Part part;
  std::vector<Part> parts;

  void archive(Archive& archive) {
    archive.field("large", large);
    archive.field("number", number);
    archive.field("flag", flag);
    archive.field("text", text);
    archive.field("real", real);
    archive.field("phase", phase, Phase::settled);
    archive.field("vector", vector);
    archive.field("matrix", matrix);
    archive.field("stress", stress);
    archive.field("integers", integers);
    archive.field("texts", texts);
    archive.field("vectors", vectors);
    archive.field("present", present);
    archive.field("absent", absent);
    archive.object("part", part);
    archive.objects("parts", parts, [](Archive& a, Part& one) { one.archive(a); });
  }
};

Whole sample() {
  Whole whole;
  whole.large = std::numeric_limits<std::int64_t>::max() - 1; // no double holds it
  whole.number = -7;
  whole.flag = true;
  whole.text = "two\nlines";
  whole.real = std::bit_cast<double>(std::uint64_t{0x7ff0dead0000beef});
  whole.phase = Phase::settle;
  whole.vector = {1.0, -0.0, 5e-324};
  whole.matrix << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  whole.stress = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  whole.integers = {std::numeric_limits<std::int64_t>::min(), 0};
  whole.texts = {"a", "", "c"};
  whole.vectors = {{1, 2, 3}, {4, 5, 6}};
  whole.present = 0.25;
  whole.part = {3, 0.5};
  whole.parts = {{1, 1.5}, {2, 2.5}};
  return whole;
}

SavedState saved(Whole whole) {
  SavedState state;
  Archive archive = Archive::saving_to(state);
  archive.object("it", whole);
  return state;
}

std::string refusal(const SavedState& state) {
  try {
    Whole whole;
    Archive archive = Archive::reading_from(state);
    archive.object("it", whole);
  } catch (const SavedStateError& error) {
    return error.what();
  }
  return "";
}

TEST(Archive, EveryBitComesBack) {
  const Whole whole = sample();
  const SavedState state = saved(whole);
  Whole read;
  read.absent = 3.0; // the state has none
  Archive archive = Archive::reading_from(state);
  archive.object("it", read);
  EXPECT_EQ(read.large, whole.large);
  EXPECT_EQ(read.number, -7);
  EXPECT_TRUE(read.flag);
  EXPECT_EQ(read.text, whole.text);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(read.real), std::bit_cast<std::uint64_t>(whole.real));
  EXPECT_EQ(read.phase, Phase::settle);
  EXPECT_EQ(read.vector, whole.vector);
  EXPECT_TRUE(std::signbit(read.vector[1]));
  EXPECT_EQ(read.matrix, whole.matrix);
  EXPECT_EQ(read.stress, whole.stress);
  EXPECT_EQ(read.integers, whole.integers);
  EXPECT_EQ(read.texts, whole.texts);
  EXPECT_EQ(read.vectors, whole.vectors);
  EXPECT_EQ(read.present, 0.25);
  EXPECT_FALSE(read.absent);
  EXPECT_EQ(read.part.count, 3);
  ASSERT_EQ(read.parts.size(), 2U);
  EXPECT_EQ(read.parts[1].gain, 2.5);
}

TEST(Archive, FieldsAreNestedAndTyped) {
  const SavedState state = saved(sample());
  EXPECT_EQ(description(state.at("it.large")), "an integer");
  EXPECT_EQ(description(state.at("it.text")), "a text");
  EXPECT_EQ(description(state.at("it.matrix")), "3 x 3 real numbers");
  EXPECT_EQ(description(state.at("it.vectors")), "2 x 3 real numbers");
  EXPECT_EQ(std::get<SavedValue::Reals>(state.at("it.matrix").values).at(1), 2.0); // row by row
  EXPECT_EQ(description(state.at("it.parts.1.gain")), "a real number");
  EXPECT_FALSE(state.contains("it.absent"));
}

TEST(Archive, EveryMissingFieldIsNamed) {
  const SavedState whole = saved(sample());
  for (const auto& [name, value] : whole) {
    SavedState state = whole;
    state.erase(name);
    const std::string expected = name == "it.present" ? "" : "saved state: " + name + " is missing";
    EXPECT_EQ(refusal(state).substr(0, expected.size()), expected);
    EXPECT_EQ(refusal(state).empty(), expected.empty()) << name;
  }
}

TEST(Archive, AnotherTypeOrShapeIsNamed) {
  const SavedState whole = saved(sample());
  const std::vector<SavedValue> others = {
      {std::string("x"), {}},      {SavedValue::Reals{1.0}, {}},      {SavedValue::Integers{1}, {}},
      {SavedValue::Reals(2), {2}}, {SavedValue::Integers(3), {1, 3}}, {SavedValue::Reals(4), {2, 2}}};
  for (const auto& [name, value] : whole) {
    for (const SavedValue& other : others) {
      const bool fits = other.values.index() == value.values.index() && other.shape.size() == value.shape.size() &&
                        (value.shape.size() != 1 || value.shape == other.shape || name == "it.integers");
      if (!fits) {
        SavedState state = whole;
        state[name] = other;
        EXPECT_EQ(refusal(state).find("saved state: " + name + " holds " + description(other) + "; expected: "), 0U)
            << refusal(state);
      }
    }
  }
  EXPECT_EQ(refusal([&] {
              SavedState state = whole;
              state["it.vectors"] = {SavedValue::Reals(4), {2, 2}};
              return state;
            }()),
            "saved state: it.vectors holds 2 x 2 real numbers; expected: n x 3 real numbers");
}

TEST(Archive, NumbersThatMeanNothingAreRefused) {
  const std::vector<std::pair<std::string, std::int64_t>> wrong = {
      {"it.phase", 3},        {"it.phase", -1},
      {"it.flag", 2},         {"it.number", std::int64_t{1} << 31},
      {"it.parts.count", -1}, {"it.parts.count", std::numeric_limits<std::int64_t>::max()},
      {"it.parts.count", 3}};
  for (const auto& [name, number] : wrong) {
    SavedState state = saved(sample());
    state.at(name).values = SavedValue::Integers{number};
    EXPECT_EQ(refusal(state).find("saved state: it."), 0U) << name << " = " << number << ": " << refusal(state);
  }
  SavedState hollow = saved(sample());
  hollow.at("it.vectors").shape = {1000, 3}; // it holds two
  EXPECT_NE(refusal(hollow), "");
}

TEST(Archive, AFieldIsSavedOnce) {
  SavedState state;
  Archive archive = Archive::saving_to(state);
  double value = 1.0;
  archive.field("gain", value);
  EXPECT_THROW(archive.field("gain", value), std::logic_error);
}

} // namespace
} // namespace boba
