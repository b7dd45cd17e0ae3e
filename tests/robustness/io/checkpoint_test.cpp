// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/checkpoint.h"
#include "bpm/io/input_error.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_folder.h"

#include <chrono>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <signal.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace boba {
namespace {

using test::content_of;
using test::message_of;
using test::TemporaryFolder;

using Reals = SavedValue::Reals;
using Integers = SavedValue::Integers;

SavedState sample(std::int64_t step) {
  SavedState data;
  data["scene"] = {std::string("seed = 1\n"), {}};
  data["empty"] = {std::string(), {}};
  data["isa"] = {std::string("avx\0 512", 8), {}};
  data["position"] = {
      Reals{0.1, -0.0, 5e-324, std::numeric_limits<double>::infinity(), 1e300, static_cast<double>(step)}, {2, 3}};
  data["nothing"] = {Reals(), {0}};
  data["step"] = {Integers{step}, {}};
  data["extremes"] = {Integers{INT64_MIN, INT64_MAX, -1}, {3}};
  return data;
}

std::int64_t step_of(const SavedState& data) {
  return std::get<Integers>(data.at("step").values).at(0);
}

bool same_bits(const SavedValue& a, const SavedValue& b) {
  const auto* x = std::get_if<Reals>(&a.values);
  const auto* y = std::get_if<Reals>(&b.values);
  if (x == nullptr || y == nullptr) {
    return a == b;
  }
  return a.shape == b.shape && x->size() == y->size() &&
         (x->empty() || std::memcmp(x->data(), y->data(), x->size() * sizeof(double)) == 0);
}

TEST(Checkpoint, ReadsBackEveryBit) {
  const TemporaryFolder folder;
  SavedState data = sample(3);
  double odd_nan = 0.0;
  const std::uint64_t bits = 0x7ff0dead0000beef;
  std::memcpy(&odd_nan, &bits, sizeof bits);
  data["odd"] = {Reals{odd_nan}, {}};
  const auto path = write_checkpoint(folder / "run", data);
  EXPECT_EQ(path, folder / "run/checkpoint-000001.boba");
  const SavedState read = read_checkpoint(path);
  ASSERT_EQ(read.size(), data.size());
  for (const auto& [name, value] : data) {
    EXPECT_TRUE(same_bits(read.at(name), value)) << name;
  }
}

TEST(Checkpoint, AStrayFileOfAHugeNumberHidesNothing) {
  for (const std::string stray :
       {"18446744073709551615", "18446744073709551614", "1000000000000", "9999999999999999"}) {
    const TemporaryFolder folder;
    write_checkpoint(folder / "", sample(1));
    std::filesystem::copy_file(folder / "checkpoint-000001.boba", folder / ("checkpoint-" + stray + ".boba"));
    EXPECT_EQ(write_checkpoint(folder / "", sample(2)), folder / "checkpoint-000002.boba") << stray;
    EXPECT_EQ(write_checkpoint(folder / "", sample(3)), folder / "checkpoint-000003.boba") << stray;
    EXPECT_EQ(latest_checkpoint(folder / "").data, sample(3)) << stray;
  }
}

TEST(Checkpoint, RefusesAFieldThatDoesNotHoldAsManyValuesAsItSays) {
  const TemporaryFolder folder;
  SavedState data = sample(1);
  data["position"].shape = {2, 4};
  const auto path = write_checkpoint(folder / "", data);
  EXPECT_NE(message_of<InputError>([&] { read_checkpoint(path); }).find("'position' does not hold"), std::string::npos);
}

TEST(Checkpoint, IsTheSameFileWhenWrittenInPieces) {
  const TemporaryFolder folder;
  SavedState data = sample(1);
  Reals velocity;
  Integers place;
  for (int k = 0; k < 15; ++k) { // five nodes
    velocity.push_back(0.1 * k);
    place.push_back(-k);
  }
  data["velocity"] = {velocity, {5, 3}};
  data["place"] = {place, {5, 3}};
  const std::string whole = content_of(write_checkpoint(folder / "whole", data));
  const NodeFields nodes = {{"place", "velocity"}, {{0, 1}, {1, 3}, {4, 1}}, 5};
  EXPECT_TRUE(content_of(write_checkpoint(folder / "pieces", data, Ranks::alone(), nodes)) == whole);
  // Nobody has the last node.
  const NodeFields lacking = {{"place", "velocity"}, {{0, 1}, {1, 3}}, 5};
  EXPECT_NE(message_of<std::runtime_error>([&] {
              write_checkpoint(folder / "pieces", data, Ranks::alone(), lacking);
            }).find("nobody has written"),
            std::string::npos);
}

TEST(Checkpoint, KeepsTheLastTwo) {
  const TemporaryFolder folder;
  for (const int step : {1, 2, 3, 4}) {
    write_checkpoint(folder / "", sample(step));
  }
  // Nothing else is left, neither older ones nor parts.
  const std::filesystem::directory_iterator files(folder / "");
  EXPECT_EQ(std::distance(begin(files), end(files)), 2);
  EXPECT_EQ(step_of(read_checkpoint(folder / "checkpoint-000003.boba")), 3);
  const LatestCheckpoint latest = latest_checkpoint(folder / "");
  EXPECT_EQ(latest.path, folder / "checkpoint-000004.boba");
  EXPECT_EQ(step_of(latest.data), 4);
  EXPECT_TRUE(latest.refused.empty());
}

TEST(Checkpoint, RefusesEveryTruncation) {
  const TemporaryFolder folder;
  const std::string whole = content_of(write_checkpoint(folder / "", sample(1)));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const auto path = folder.file("cut.boba", whole.substr(0, length));
    const std::string message = message_of<InputError>([&] { read_checkpoint(path); });
    ASSERT_NE(message.find("cut.boba: refused"), std::string::npos) << length << " " << message;
  }
  EXPECT_THROW(read_checkpoint(folder.file("long.boba", whole + "x")), InputError);
  EXPECT_THROW(read_checkpoint(folder / "missing.boba"), InputError);
}

TEST(Checkpoint, RefusesAFlippedBitInAnyByte) {
  const TemporaryFolder folder;
  const std::string whole = content_of(write_checkpoint(folder / "", sample(1)));
  for (std::size_t byte = 0; byte < whole.size(); ++byte) {
    const int bit = static_cast<int>(3 * byte % 8); // one in each byte, every one in turn
    std::string bytes = whole;
    bytes[byte] = static_cast<char>(bytes[byte] ^ (1 << bit));
    const auto path = folder.file("flipped.boba", bytes);
    ASSERT_THROW(read_checkpoint(path), InputError) << "byte " << byte << " bit " << bit;
  }
  EXPECT_NO_THROW(read_checkpoint(folder.file("same.boba", whole)));
}

TEST(Checkpoint, RefusesThatOfAnOlderVersion) {
  const TemporaryFolder folder;
  std::string bytes = content_of(write_checkpoint(folder / "", sample(1)));
  for (const char* mark : {"BOBACKP1", "BOBACKP2"}) {
    bytes.replace(0, 8, mark);
    const auto path = folder.file("old.boba", bytes);
    const std::string message = message_of<InputError>([&] { read_checkpoint(path); });
    EXPECT_NE(message.find("older"), std::string::npos) << message;
    EXPECT_NE(message.find(mark), std::string::npos) << message;
  }
}

TEST(Checkpoint, OffersTheOlderOneAndKeepsIt) {
  const TemporaryFolder folder;
  write_checkpoint(folder / "", sample(1));
  const auto newest = write_checkpoint(folder / "", sample(2));
  std::filesystem::resize_file(newest, 100);
  const LatestCheckpoint latest = latest_checkpoint(folder / "");
  EXPECT_EQ(step_of(latest.data), 1);
  ASSERT_EQ(latest.refused.size(), 1u);
  EXPECT_NE(latest.refused[0].find("checkpoint-000002.boba: refused as a checkpoint: truncated"), std::string::npos)
      << latest.refused[0];
  // A damaged one does not count as one of the two that are kept.
  write_checkpoint(folder / "", sample(3));
  EXPECT_TRUE(std::filesystem::exists(folder / "checkpoint-000001.boba"));
  EXPECT_EQ(step_of(latest_checkpoint(folder / "").data), 3);
}

TEST(Checkpoint, NamesEveryRefusedOneWhenNoneIsLeft) {
  const TemporaryFolder folder;
  EXPECT_NE(message_of<InputError>([&] { latest_checkpoint(folder / "empty"); }).find("no checkpoint"),
            std::string::npos);
  folder.file("checkpoint-000001.boba", "x");
  folder.file("checkpoint-000002.boba", "");
  folder.file("checkpoint-old.boba", "a name of another kind");
  const std::string message = message_of<InputError>([&] { latest_checkpoint(folder / ""); });
  EXPECT_NE(message.find("checkpoint-000001.boba"), std::string::npos) << message;
  EXPECT_NE(message.find("checkpoint-000002.boba"), std::string::npos) << message;
}

TEST(Checkpoint, AFullDiskLeavesTheOlderOne) {
  const TemporaryFolder folder;
  const auto older = write_checkpoint(folder / "", sample(1));
  const std::string before = content_of(older);
  SavedState big = sample(2);
  big["position"] = {Reals(100000, 1.0), {100000}};
  for (const rlim_t limit : {rlim_t{0}, rlim_t{100}, rlim_t{500000}}) {
    const test::FileSizeLimit full(limit);
    const std::string message = message_of<std::runtime_error>([&] { write_checkpoint(folder / "", big); });
    EXPECT_NE(message.find("not written"), std::string::npos) << message;
    EXPECT_NE(message.find("checkpoint-000001.boba"), std::string::npos) << message;
  }
  EXPECT_EQ(content_of(older), before);
  EXPECT_FALSE(std::filesystem::exists(folder / "checkpoint-000002.boba"));
  EXPECT_FALSE(std::filesystem::exists(folder / "checkpoint-000002.boba.part"));
  EXPECT_EQ(read_checkpoint(write_checkpoint(folder / "", big)).at("position") == big.at("position"), true);
}

TEST(Checkpoint, AFolderThatCannotBeMadeIsAMessage) {
  EXPECT_NE(message_of<std::runtime_error>([] { write_checkpoint("/dev/null/run", sample(1)); }).find("not written"),
            std::string::npos);
}

TEST(Checkpoint, AKillAtAnyMomentLeavesAWholeOne) {
  for (int round = 0; round < 20; ++round) {
    const TemporaryFolder folder;
    write_checkpoint(folder / "", sample(0));
    const pid_t child = fork();
    if (child == 0) {
      for (std::int64_t step = 1;; ++step) {
        SavedState data = sample(step);
        data["position"] = {Reals(200000, static_cast<double>(step)), {200000}};
        write_checkpoint(folder / "", data);
      }
    }
    std::this_thread::sleep_for(std::chrono::microseconds(1500 * round));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const LatestCheckpoint latest = latest_checkpoint(folder / "");
    EXPECT_TRUE(latest.refused.empty()); // renamed only when whole
    const std::int64_t step = step_of(latest.data);
    EXPECT_EQ(std::get<Reals>(latest.data.at("position").values).back(), static_cast<double>(step));
  }
}

} // namespace
} // namespace boba
