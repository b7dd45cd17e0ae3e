// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/input_error.h"
#include "bpm/io/lammps_dump.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

namespace boba {
namespace {

using test::TemporaryFolder;

const std::string first_frame = "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\n"
                                "ITEM: BOX BOUNDS pp ff pp\n0 10\n-5 5\n0 20\n"
                                "ITEM: ATOMS type x id iz y iy c_extra ix z vx vy vz\n"
                                "1 1.0 8 1 2.0 0 99 0 3.0 0.1 0.2 0.3\n"
                                "2 4.0 3 0 5.0 0 nan -1 6.0 0.4 0.5 0.6\n";
const std::string second_frame = "ITEM: UNITS\nlj\nITEM: TIME\n25.5\nITEM: TIMESTEP\n200\nITEM: NUMBER OF ATOMS\n2\n"
                                 "ITEM: BOX BOUNDS xy xz yz pp pp pp\n-3 17 4\n-2 15.5 -3\n1 11 2.5\n"
                                 "ITEM: ATOMS id mol xs ys zs fx fy fz\n"
                                 "3 7 0.5 0.5 0.5 1 2 3\n8 7 0 0 0 4 5 6\n";

TEST(LammpsDump, ReadsColumnsInAnyOrder) {
  const TemporaryFolder folder;
  const LammpsFrame frame = read_lammps_dump(folder.file("a.dump", first_frame));
  EXPECT_EQ(frame.timestep, 100);
  EXPECT_EQ(frame.id, (std::vector<std::int64_t>{8, 3}));
  EXPECT_EQ(frame.type, (std::vector<int>{1, 2}));
  EXPECT_TRUE(frame.molecule.empty());
  EXPECT_TRUE(frame.force.empty());
  EXPECT_TRUE(frame.is_unwrapped);
  EXPECT_EQ(frame.position[0], Vector3(1, 2, 23));
  EXPECT_EQ(frame.position[1], Vector3(-6, 5, 6));
  EXPECT_EQ(frame.velocity[1], Vector3(0.4, 0.5, 0.6));
  EXPECT_EQ(frame.box.periodic(), (std::array<bool, 3>{true, false, true}));
}

TEST(LammpsDump, TakesTheLastFrameOrTheOneAskedFor) {
  const TemporaryFolder folder;
  const auto path = folder.file("a.dump", first_frame + second_frame);
  const LammpsFrame last = read_lammps_dump(path);
  EXPECT_EQ(last.timestep, 200);
  EXPECT_EQ(last.time, 25.5);
  EXPECT_FALSE(last.is_unwrapped);
  // The cell inside the bounding limits: a = (13, 0, 0), b = (4, 15, 0), c = (-3, 2.5, 10) at (0, -2, 1).
  EXPECT_EQ(last.box.origin(), Vector3(0, -2, 1));
  EXPECT_EQ(last.box.h().col(0), Vector3(13, 0, 0));
  EXPECT_EQ(last.box.h().col(1), Vector3(4, 15, 0));
  EXPECT_EQ(last.box.h().col(2), Vector3(-3, 2.5, 10));
  EXPECT_EQ(last.position[0], Vector3(0 + 7, -2 + 8.75, 1 + 5));
  EXPECT_EQ(last.force[1], Vector3(4, 5, 6));
  EXPECT_EQ(read_lammps_dump(path, 100).timestep, 100);
  EXPECT_EQ(lammps_dump_timesteps(path), (std::vector<std::int64_t>{100, 200}));
  const std::string message = test::message_of<InputError>([&] { read_lammps_dump(path, 150); });
  EXPECT_NE(message.find("no frame of step 150"), std::string::npos) << message;
}

TEST(LammpsDump, TakesAFrameByItsPlaceInTheFile) {
  const TemporaryFolder folder;
  // LAMMPS's reset_timestep: the third frame is of step 100 once more.
  std::string third = first_frame;
  third.replace(third.find("1 1.0 8"), 7, "1 7.0 8");
  const auto path = folder.file("a.dump", first_frame + second_frame + third);
  EXPECT_EQ(read_lammps_dump_frame(path, 0).position[0], Vector3(1, 2, 23));
  EXPECT_EQ(read_lammps_dump_frame(path, 1).timestep, 200);
  EXPECT_EQ(read_lammps_dump_frame(path, 2).position[0], Vector3(7, 2, 23));
  EXPECT_EQ(read_lammps_dump_frame(path, -1).position[0], Vector3(7, 2, 23));
  EXPECT_EQ(read_lammps_dump_frame(path, -3).position[0], Vector3(1, 2, 23));
  const auto said = [&](std::int64_t frame) {
    return test::message_of<InputError>([&] { read_lammps_dump_frame(path, frame); });
  };
  EXPECT_NE(said(3).find("has 3 frames; allowed: -3 to 2"), std::string::npos) << said(3);
  EXPECT_NE(said(-4).find("allowed: -3 to 2"), std::string::npos) << said(-4);
  const std::string twice = test::message_of<InputError>([&] { read_lammps_dump(path, 100); });
  EXPECT_NE(twice.find("frames 0 and 2 are both of step 100"), std::string::npos) << twice;
}

TEST(LammpsDump, ACutOffFileGivesItsWholeFrames) {
  const TemporaryFolder folder;
  const std::string whole = first_frame + second_frame;
  // Wherever the second frame is cut, inside its last number too.
  for (std::size_t length = first_frame.size() + 1; length < whole.size(); ++length) {
    const auto path = folder.file("cut.dump", whole.substr(0, length));
    const LammpsFrame frame = read_lammps_dump(path);
    EXPECT_EQ(frame.timestep, 100) << length;
    EXPECT_FALSE(frame.cut_off.empty()) << length;
    EXPECT_EQ(read_lammps_dump_frame(path, 0).timestep, 100) << length;
    EXPECT_THROW(read_lammps_dump_frame(path, 1), InputError) << length;
  }
  EXPECT_TRUE(read_lammps_dump(folder.file("whole.dump", whole)).cut_off.empty());
  for (std::size_t length = 0; length < first_frame.size(); ++length) {
    EXPECT_THROW(read_lammps_dump(folder.file("none.dump", whole.substr(0, length))), InputError) << length;
  }
}

TEST(LammpsDump, PrefersUnwrappedColumns) {
  const TemporaryFolder folder;
  const LammpsFrame frame = read_lammps_dump(
      folder.file("a.dump", "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n"
                            "ITEM: ATOMS id x y z xu yu zu ix iy iz\n1 0.5 0.5 0.5 2.5 0.5 -0.5 2 0 -1\n"));
  EXPECT_EQ(frame.position[0], Vector3(2.5, 0.5, -0.5));
}

TEST(LammpsDump, ReadsTheFixtureCell) {
  const LammpsFrame frame = read_lammps_dump(std::string(BOBA_TEST_DATA) + "/forces/tri.a2.step0.dump.gz");
  EXPECT_EQ(frame.n_nodes(), 606);
  EXPECT_TRUE(frame.box.origin().isApprox(Vector3(0.5, -2, 1), 1e-15));
  EXPECT_TRUE(frame.box.h().col(1).isApprox(Vector3(5.2, 13, 0), 1e-15));
  EXPECT_EQ(frame.force[0], Vector3(0.14389567391651137, -1.0086281037420299, -0.48333743772642651));
}

TEST(LammpsDump, MatchesIds) {
  const TemporaryFolder folder;
  const auto path = folder.file("a.dump", first_frame);
  const LammpsFrame frame = read_lammps_dump(path);
  const std::vector<std::int64_t> wanted = {3, 8}, other = {3, 9}, more = {3, 8, 9};
  EXPECT_EQ(rows_of_ids(frame, wanted, path), (std::vector<std::int64_t>{1, 0}));
  EXPECT_NE(test::message_of<InputError>([&] { rows_of_ids(frame, other, path); }).find("no atom 9"),
            std::string::npos);
  EXPECT_NE(test::message_of<InputError>([&] { rows_of_ids(frame, more, path); }).find("2 atoms; 3"),
            std::string::npos);
}

/// A file with one fault, and what the message must say.
struct Refusal {
  const char* name;
  std::string from, to, says;
};

void PrintTo(const Refusal& refusal, std::ostream* out) {
  *out << refusal.name;
}

class LammpsDumpRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(LammpsDumpRefusal, NamesFileAndFault) {
  const TemporaryFolder folder;
  std::string text = first_frame;
  const std::size_t at = text.find(GetParam().from);
  ASSERT_NE(at, std::string::npos);
  const auto path = folder.file("bad.dump", text.replace(at, GetParam().from.size(), GetParam().to));
  const std::string message = test::message_of<InputError>([&] { read_lammps_dump(path); });
  EXPECT_NE(message.find(path.string() + ":"), std::string::npos) << message;
  EXPECT_NE(message.find(GetParam().says), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    , LammpsDumpRefusal,
    testing::Values(
        Refusal{"NoId", " id ", " ID ", "no column 'id'"}, Refusal{"NoX", " x ", " q ", "no columns 'x y z'"},
        Refusal{"Nan", "1 1.0 8", "1 NaN 8", ":10: position is 'NaN'"},
        Refusal{"TornRow", " 6.0 0.4 0.5 0.6\n", " 6.0", "ends after 1 of 2 rows"},
        Refusal{"TornFrame", "2 4.0 3 0 5.0 0 nan -1 6.0 0.4 0.5 0.6\n", "", "ends after 1 of 2 rows"},
        Refusal{"Huge", "ATOMS\n2\n", "ATOMS\n90000000000000\n", "GB"},
        Refusal{"NotADump", "ITEM: TIMESTEP", "TIMESTEP", "'ITEM:'"},
        Refusal{"SameIdTwice", "1 1.0 8", "1 1.0 3", "atom id 3 stands twice"},
        Refusal{"InvertedBox", "0 10\n", "10 0\n", "must be positive"},
        Refusal{"TiltUnderAnUprightHeader", "0 10\n", "0 10 0.5\n", "3 numbers; a limit of an upright cell"},
        Refusal{"UprightUnderATiltedHeader", "BOUNDS pp", "BOUNDS xy xz yz pp", "2 numbers; a limit of a tilted"},
        Refusal{"UnknownBoundary", "BOUNDS pp ff pp", "BOUNDS pp ff pq", "three boundaries"},
        Refusal{"ExtraColumn", "0.1 0.2 0.3\n", "0.1 0.2 0.3 9\n", "13 columns"},
        Refusal{"FarAway", "1 1.0 8", "1 1e300 8", "position is 1e+300"},
        Refusal{"Fast", "0.1 0.2 0.3\n", "0.1 0.2 1e300\n", "velocity is 0.1 0.2 1e+300"},
        Refusal{"OtherMass", "c_extra", "mass", "mass is 99"},
        Refusal{"OtherDiameter", "c_extra", "diameter", "diameter is 99"},
        Refusal{"ShortLimits", "0 10\n", "10\n", "1 numbers"},
        Refusal{"NoBox", "ITEM: BOX BOUNDS pp ff pp\n0 10\n-5 5\n0 20\n", "", "before 'ITEM: BOX BOUNDS'"}),
    [](const auto& the_case) { return std::string(the_case.param.name); });

Topology two_grains() {
  Topology topology;
  topology.first_node = {0, 1, 3};
  topology.id = {5, 9, 2};
  topology.molecule = {4, 6};
  topology.species = {0, 1};
  topology.alpha = {0, 0};
  topology.template_index = {0, 1};
  return topology;
}

Snapshot tilted_state(std::int64_t step) {
  Snapshot snapshot;
  snapshot.step = step;
  snapshot.box = Box(Vector3(0.5, -2, 1), Vector3(14, 13, 12.5), Vector3(5.2, -3.1, 4.4));
  snapshot.position = {Vector3(1.0 / 3.0, 0.1, 2), Vector3(40, -50, 60), Vector3(0.7, -0.9, 1.1)};
  snapshot.velocity = {Vector3(0.1, 0.2, 0.3), Vector3(1, 2, 3), Vector3(4, 5, 6)};
  snapshot.force = {Vector3(-0.1, 0.2, 0.3), Vector3(1e-17, 2, 3), Vector3(4, 5, 6)};
  return snapshot;
}

TEST(LammpsDumpWriter, WritesBoundingLimitsAndGrains) {
  const TemporaryFolder folder;
  LammpsDumpWriter writer(folder / "a.dump", DumpLayout::viewer);
  writer.write(two_grains(), tilted_state(3));
  writer.write(two_grains(), tilted_state(7));
  const std::string text = test::content_of(folder / "a.dump"); // before the writer is closed: frames are on disk
  // Limits of the upright box around the cell, by hand: x from 0.5 - 3.1, to 14.5 + 5.2; y to 11 + 4.4.
  EXPECT_NE(text.find("ITEM: BOX BOUNDS xy xz yz pp pp pp\n-2.6"), std::string::npos) << text.substr(0, 200);
  const LammpsFrame frame = read_lammps_dump(folder / "a.dump");
  EXPECT_EQ(frame.timestep, 7);
  EXPECT_EQ(frame.id, (std::vector<std::int64_t>{2, 5, 9}));
  EXPECT_EQ(frame.molecule, (std::vector<std::int64_t>{6, 4, 6}));
  EXPECT_EQ(frame.type, (std::vector<int>{2, 1, 2}));
  EXPECT_TRUE(frame.is_unwrapped);
  EXPECT_LT((frame.position[2] - Vector3(40, -50, 60)).norm(), 1e-8);
  EXPECT_TRUE(frame.box.h().isApprox(tilted_state(7).box.h(), 1e-15));
}

TEST(LammpsDumpWriter, HasOneFormOfHeaderForAPeriodicCell) {
  const TemporaryFolder folder;
  LammpsDumpWriter writer(folder / "a.dump", DumpLayout::viewer);
  for (const double xy : {0.0, 0.3, 0.0}) {
    Snapshot snapshot = tilted_state(static_cast<std::int64_t>(10.0 * xy));
    snapshot.box = Box(Vector3::Zero(), Vector3(14, 13, 12), Vector3(xy, 0.0, 0.0));
    writer.write(two_grains(), snapshot);
  }
  writer.close();
  const std::string text = test::content_of(folder / "a.dump");
  std::size_t n = 0;
  for (std::size_t at = text.find("BOX BOUNDS"); at != std::string::npos; at = text.find("BOX BOUNDS", at + 1), ++n) {
    EXPECT_EQ(text.substr(at, 28), "BOX BOUNDS xy xz yz pp pp pp");
  }
  EXPECT_EQ(n, 3u);
}

TEST(LammpsDumpWriter, BoundsTiltsOfEverySign) {
  // By the eight corners of the cell, without the format's formula.
  for (const Vector3& tilts : {Vector3(-2, -3, -1), Vector3(2, 3, 1), Vector3(-2, 3, -1), Vector3(2, -3, 1)}) {
    const TemporaryFolder folder;
    Snapshot snapshot = tilted_state(0);
    snapshot.box = Box(Vector3(0.5, -2, 1), Vector3(14, 13, 12), tilts);
    LammpsDumpWriter(folder / "a.dump", DumpLayout::viewer).write(two_grains(), snapshot);
    Vector3 low = snapshot.box.origin(), high = low;
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3 x = snapshot.box.to_position(Vector3(corner & 1, corner >> 1 & 1, corner >> 2));
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    const std::string wanted = fmt::format("{:g} {:g} {:g}\n{:g} {:g} {:g}\n{:g} {:g} {:g}\n", low[0], high[0],
                                           tilts[0], low[1], high[1], tilts[1], low[2], high[2], tilts[2]);
    EXPECT_NE(test::content_of(folder / "a.dump").find(wanted), std::string::npos) << wanted;
    const Box read = read_lammps_dump(folder / "a.dump").box;
    EXPECT_EQ(read.h(), snapshot.box.h());
    EXPECT_EQ(read.origin(), snapshot.box.origin());
  }
}

TEST(LammpsDumpWriter, WritesForcesWithAllDigits) {
  const TemporaryFolder folder;
  LammpsDumpWriter writer(folder / "f.dump", DumpLayout::forces);
  writer.write(two_grains(), tilted_state(3));
  writer.close();
  EXPECT_NE(test::content_of(folder / "f.dump").find("ITEM: ATOMS id x y z vx vy vz fx fy fz\n2 "), std::string::npos);
  const LammpsFrame frame = read_lammps_dump(folder / "f.dump");
  const Snapshot state = tilted_state(3);
  const std::vector<int> node_of_row = {2, 0, 1};
  for (int row = 0; row < 3; ++row) {
    EXPECT_EQ(frame.force[row], state.force[node_of_row[row]]);
    EXPECT_EQ(frame.velocity[row], state.velocity[node_of_row[row]]);
    EXPECT_LT((frame.position[row] - state.box.wrapped(state.position[node_of_row[row]])).norm(), 1e-13);
  }
}

TEST(LammpsDumpWriter, GoesOnAfterACheckpoint) {
  const TemporaryFolder folder;
  const auto path = folder / "a.dump";
  LammpsDumpWriter writer(path, DumpLayout::viewer);
  for (const int step : {0, 10, 20, 30}) {
    writer.write(two_grains(), tilted_state(step));
  }
  writer.close();
  const std::string whole = test::content_of(path);
  EXPECT_EQ(truncate_lammps_dump(path, 20), 3);
  LammpsDumpWriter again(path, DumpLayout::viewer, FileMode::append);
  again.write(two_grains(), tilted_state(30));
  again.close();
  EXPECT_EQ(test::content_of(path), whole);
  EXPECT_THROW(LammpsDumpWriter(path, DumpLayout::viewer), std::runtime_error);
}

TEST(LammpsDumpWriter, DropsATornFrame) {
  const TemporaryFolder folder;
  const auto path = folder / "a.dump";
  LammpsDumpWriter writer(path, DumpLayout::viewer);
  writer.write(two_grains(), tilted_state(0));
  const std::string one = test::content_of(path);
  writer.write(two_grains(), tilted_state(10));
  writer.close();
  const std::string two = test::content_of(path);
  for (std::size_t length = one.size(); length < two.size(); ++length) {
    folder.file("a.dump", two.substr(0, length));
    EXPECT_EQ(truncate_lammps_dump(path, 10), 1) << length;
    EXPECT_EQ(test::content_of(path), one);
  }
  EXPECT_EQ(truncate_lammps_dump(folder / "missing.dump", 10), 0);
  EXPECT_THROW(truncate_lammps_dump(folder.file("letter.txt", "Dear reader,\n"), 10), InputError);
  EXPECT_EQ(test::content_of(folder / "letter.txt"), "Dear reader,\n");
}

} // namespace
} // namespace boba
