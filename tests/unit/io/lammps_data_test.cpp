// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/input_error.h"
#include "bpm/io/lammps_data.h"
#include "bpm/io/lammps_dump.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <zlib.h>

namespace boba {
namespace {

using test::TemporaryFolder;

/// What a person may write: header in no order, comments, blank lines, ids in no order, sections to skip, CR LF.
const std::string by_hand = "two rods  (this line is a title, whatever it says: 99 atoms)\n"
                            "# a comment\n"
                            "\n"
                            "  2   bonds\n"
                            "0.5 -0.25 1.5 xy xz yz   # tilts before limits\n"
                            "-1.0 9.0 zlo zhi\n"
                            "4 atoms # four\n"
                            "2 bond types\n"
                            "1 angles\n"
                            "3 extra bond per atom\n"
                            "0.0 10.0 xlo xhi\n"
                            "+0.0 1.2e1 ylo yhi\n"
                            "2 atom types\n"
                            "\n"
                            "Pair Coeffs # lj/cut\n"
                            "\n"
                            "1 1.0 1.0\n"
                            "2 1.0 1.0\n"
                            "\n"
                            "Velocities\n"
                            "\n"
                            "30 0.1 0.2 0.3\n"
                            "7 1 2 3\n"
                            "12 -1 -2 -3\n"
                            "900 0 0 0.5\n"
                            "\n"
                            "Masses\n"
                            "\n"
                            "2 1.0 # outer\n"
                            "1 2.0\n"
                            "\n"
                            "Atoms # molecular\n"
                            "\n"
                            "12 2 1 1.0 2.0 3.0 0 0 0\n"
                            "900 5 2 4.0 5.0 6.0 1 0 0 # first image\n"
                            "\n"
                            "7 2 1 1.5 2.0 3.0 0 1 -1\n"
                            "30 5 2 4.0 5.5 6.0 1 0 0\n"
                            "\n"
                            "Angles\n"
                            "\n"
                            "1 1 12 7 30\n"
                            "\n"
                            "Bonds\n"
                            "\n"
                            "1 1 12 7\n"
                            "2 2 30 900\n";

void expect_as_by_hand(const LammpsData& data) {
  EXPECT_EQ(data.id, (std::vector<std::int64_t>{12, 900, 7, 30}));
  EXPECT_EQ(data.molecule, (std::vector<std::int64_t>{2, 5, 2, 5}));
  EXPECT_EQ(data.type, (std::vector<int>{1, 2, 1, 2}));
  EXPECT_EQ(data.box.origin(), Vector3(0, 0, -1));
  EXPECT_EQ(data.box.lengths(), Vector3(10, 12, 10));
  EXPECT_EQ(Vector3(data.box.xy(), data.box.xz(), data.box.yz()), Vector3(0.5, -0.25, 1.5));
  EXPECT_TRUE(data.has_images);
  EXPECT_EQ(data.position[1], Vector3(14, 5, 6));
  // One cell up in b = (0.5, 12, 0), one down in c = (-0.25, 1.5, 10).
  EXPECT_EQ(data.position[2], Vector3(1.5 + 0.5 + 0.25, 2 + 12 - 1.5, 3 - 10));
  EXPECT_EQ(data.velocity[0], Vector3(-1, -2, -3));
  EXPECT_EQ(data.velocity[3], Vector3(0.1, 0.2, 0.3));
  EXPECT_EQ(data.mass, (std::vector<double>{2.0, 1.0}));
  ASSERT_EQ(data.bonds.size(), 2u);
  EXPECT_EQ(data.bonds[1].type, 2);
  EXPECT_EQ(data.bond_rows()[0], (std::array<std::int64_t, 2>{0, 2}));
  EXPECT_EQ(data.bond_rows()[1], (std::array<std::int64_t, 2>{3, 1}));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(LammpsData, ReadsAFileWrittenByHand) {
  const TemporaryFolder folder;
  expect_as_by_hand(read_lammps_data(folder.file("a.data", by_hand)));
}

TEST(LammpsData, ReadsCarriageReturnsAndNoFinalLineEnd) {
  const TemporaryFolder folder;
  std::string text;
  for (const char c : by_hand.substr(0, by_hand.size() - 1)) {
    text += c == '\n' ? "\r\n" : std::string(1, c);
  }
  expect_as_by_hand(read_lammps_data(folder.file("a.data", text)));
}

TEST(LammpsData, ReadsGzip) {
  const TemporaryFolder folder;
  const auto path = folder / "a.data.gz";
  gzFile gz = gzopen(path.c_str(), "wb");
  gzwrite(gz, by_hand.data(), static_cast<unsigned>(by_hand.size()));
  gzclose(gz);
  expect_as_by_hand(read_lammps_data(path));
}

TEST(LammpsData, TellsStylesByCommentAndByColumns) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& heading, const std::string& row) {
    return read_lammps_data(folder.file("a.data", "title\n1 atoms\n0 4 xlo xhi\n0 4 ylo yhi\n0 4 zlo zhi\n\n" +
                                                      heading + "\n\n" + row + "\n"));
  };
  for (const auto& [heading, row] :
       std::vector<std::pair<std::string, std::string>>{{"Atoms # full", "3 8 2 -0.5 1 2 3"},
                                                        {"Atoms  # full", "3 8 2 -0.5 1 2 3 0 0 0"},
                                                        {"Atoms", "3 8 2 -0.5 1 2 3"},
                                                        {"Atoms", "3 8 2 -0.5 1 2 3 0 0 0"},
                                                        {"Atoms", "3 8 2 1 2 3"},
                                                        {"Atoms", "3 8 2 1 2 3 0 0 0"},
                                                        {"Atoms # angle", "3 8 2 1 2 3"},
                                                        {"Atoms # bond", "3 8 2 1.0e0 2 3 0 0 0"},
                                                        {"Atoms # bpm/sphere", "3 8 2 1.0 1.9 1 2 3 0 0 0"}}) {
    const LammpsData data = read(heading, row);
    EXPECT_EQ(data.id[0], 3) << row;
    EXPECT_EQ(data.molecule[0], 8) << row;
    EXPECT_EQ(data.type[0], 2) << row;
    EXPECT_EQ(data.position[0], Vector3(1, 2, 3)) << row;
    EXPECT_TRUE(data.bonds.empty());
    EXPECT_TRUE(data.velocity.empty());
  }
  const LammpsData atomic = read("Atoms", "3 2 1.0 2 3 0 0 1");
  EXPECT_EQ(atomic.molecule[0], 0);
  EXPECT_EQ(atomic.position[0], Vector3(1, 2, 7));
}

TEST(LammpsData, RefusesRowsThatMeanSomethingElse) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& heading, const std::string& row) {
    const auto path =
        folder.file("a.data", "title\n1 atoms\n0 4 xlo xhi\n0 4 ylo yhi\n0 4 zlo zhi\n\n" + heading + "\n\n" + row);
    return test::message_of<InputError>([&] { read_lammps_data(path); });
  };
  const auto expect = [&](const std::string& heading, const std::string& row, const std::string& part) {
    EXPECT_NE(said(heading, row).find(part), std::string::npos) << said(heading, row);
  };
  expect("Atoms # bpm/sphere", "1 1 1 2.0 1.909859 1 1 1\n", "diameter is 2; every node's diameter must be 1");
  expect("Atoms # bpm/sphere", "1 1 1 1.0 1.0 1 1 1\n", "node's mass 0.5236; it must be 1");
  expect("Atoms # sphere", "1 1 2.0 1.909859 1 1 1\n", "diameter is 2");
  expect("Atoms # sphere", "1 1 1 1.0 1.0 1 1 1\n", "8 columns; atom style 'sphere' has 7, or 10");
  expect("Atoms # bond", "1 1 1 1 1 1 0\n", "7 columns; atom style 'bond' has 6, or 9");
  expect("Atoms", "1 1 1 2.0 1.0 1 1 1\n", "8 columns can be");
  expect("Atoms # bond", "1 1 1 1 1e300 1\n", "the position is 1 1e+300 1");
}

TEST(LammpsData, ReadsTypeLabels) {
  const TemporaryFolder folder;
  const LammpsData data = read_lammps_data(folder.file(
      "a.data", "title\n2 atoms\n2 atom types\n1 bond types\n1 bonds\n0 4 xlo xhi\n0 4 ylo yhi\n0 4 zlo zhi\n\n"
                "Atom Type Labels\n\n1 core\n2 skin\n\nBond Type Labels\n\n1 spring\n\n"
                "Atoms # bond\n\n1 1 skin 1 1 1\n2 1 core 2 1 1\n\nBonds\n\n1 spring 1 2\n"));
  EXPECT_EQ(data.type, (std::vector<int>{2, 1}));
  EXPECT_EQ(data.bonds[0].type, 1);
}

TEST(LammpsData, ReadsTheStepThatLammpsWrites) {
  const TemporaryFolder folder;
  const std::string text = replaced(
      by_hand, "two rods", "LAMMPS data file via write_data, version 29 Aug 2024, timestep = 3970, units = lj");
  EXPECT_EQ(read_lammps_data(folder.file("a.data", text)).timestep, 3970);
}

TEST(LammpsData, ReadsTheFixtures) {
  const LammpsData data = read_lammps_data(std::string(BOBA_TEST_DATA) + "/forces/tri.ref.data.gz");
  EXPECT_EQ(data.n_nodes(), 606);
  EXPECT_EQ(data.bonds.size(), 3302u);
  EXPECT_EQ(data.box.h().col(1), Vector3(5.2, 13, 0));
  EXPECT_EQ(data.box.h().col(2), Vector3(-3.1, 4.4, 12.5));
  EXPECT_EQ(data.box.origin(), Vector3(0.5, -2, 1));
  for (const auto& [i, j] : data.bond_rows()) {
    ASSERT_LT((data.position[i] - data.position[j]).norm(), 1.5);
  }
}

TEST(LammpsData, BondsAcrossFacesAreAsManyAsThePeerCounts) {
  // Counted in the perturbed states by the program that computed the fixtures' forces.
  for (const auto& [name, peer] : {std::pair{"ortho", 476}, {"tri", 661}}) {
    const std::string base = std::string(BOBA_TEST_DATA) + "/forces/" + name;
    const LammpsData data = read_lammps_data(base + ".ref.data.gz");
    const auto path = base + ".pert.dump.gz";
    const LammpsFrame state = read_lammps_dump(path);
    const std::vector<std::int64_t> rows = rows_of_ids(state, data.id, path);
    int across = 0;
    for (const auto& [i, j] : data.bond_rows()) {
      across += state.box.image_of(state.position[rows[i]]) != state.box.image_of(state.position[rows[j]]) ? 1 : 0;
    }
    EXPECT_EQ(across, peer) << name;
  }
}

/// A file with one fault, and what the message must say.
struct Refusal {
  const char* name;
  std::string from, to;
  std::vector<std::string> says;
};

void PrintTo(const Refusal& refusal, std::ostream* out) {
  *out << refusal.name;
}

class LammpsDataRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(LammpsDataRefusal, NamesFileLineAndValue) {
  const TemporaryFolder folder;
  const auto path = folder.file("bad.data", replaced(by_hand, GetParam().from, GetParam().to));
  const std::string message = test::message_of<InputError>([&] { read_lammps_data(path); });
  EXPECT_NE(message.find(path.string()), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const std::string& part : GetParam().says) {
    EXPECT_NE(message.find(part), std::string::npos) << message << " should say " << part;
  }
}

INSTANTIATE_TEST_SUITE_P(
    , LammpsDataRefusal,
    testing::Values(Refusal{"NotANumber", "1.0 2.0 3.0 0 0 0", "nan 2.0 3.0 0 0 0", {":34:", "x is 'nan'", "finite"}},
                    Refusal{"Infinite", "1.0 2.0 3.0 0 0 0", "1.0 1e999 3.0 0 0 0", {":34:", "y is '1e999'", "finite"}},
                    Refusal{"Text", "1.0 2.0 3.0 0 0 0", "1.0 2.0 3,0 0 0 0", {":34:", "z is '3,0'", "a number"}},
                    Refusal{"FractionalId", "7 2 1 1.5", "7.5 2 1 1.5", {":37:", "atom id is '7.5'", "whole number"}},
                    Refusal{"NegativeId", "7 2 1 1.5", "-7 2 1 1.5", {":37:", "atom id is -7", "1 or more"}},
                    Refusal{"Columns", "4.0 5.5 6.0 1 0 0", "4.0 5.5 6.0", {":38:", "6 columns", "9"}},
                    Refusal{"TooFewRows", "4 atoms", "5 atoms", {"Velocities", "4 of the 5 rows"}},
                    Refusal{"TooManyRows", "4 atoms", "3 atoms", {"Velocities", "a row more"}},
                    Refusal{"HugeCount", "4 atoms", "400000000000 atoms", {":7:", "400000000000", "GB"}},
                    Refusal{
                        "OverflowingCount", "4 atoms", "99999999999999999999 atoms", {":7:", "99999999999999999999"}},
                    Refusal{"NegativeCount", "  2   bonds", "-2 bonds", {":4:", "-2", "0 or more"}},
                    Refusal{"NoAtomsLine", "4 atoms", "4 atom", {"'N atoms'"}},
                    Refusal{"NoLimits", "0.0 10.0 xlo xhi", "", {"xlo xhi"}},
                    Refusal{"InvertedLimits", "0.0 10.0 xlo", "10.0 10.0 xlo", {":11:", "10 and 10", "below"}},
                    Refusal{"NanLimits", "0.0 10.0 xlo", "0.0 NaN xlo", {":11:", "NaN", "finite"}},
                    Refusal{"OverflowingLimits", "0.0 10.0 xlo", "-1e308 1e308 xlo", {"cannot be computed with"}},
                    Refusal{"OverflowingTilt", "0.5 -0.25 1.5 xy", "1e308 -0.25 1.5 xy", {"cannot be computed with"}},
                    Refusal{"GeneralTriclinic", "0.0 10.0 xlo xhi", "1 0 0 avec", {":11:", "avec"}},
                    Refusal{"TypeTooLarge", "7 2 1 1.5", "7 2 3 1.5", {":37:", "atom type is 3", "2 types"}},
                    Refusal{"BondTypeZero", "1 1 12 7\n2", "1 0 12 7\n2", {"bond type is 0", "1 or more"}},
                    Refusal{"BondToNowhere", "2 2 30 900", "2 2 30 901", {"30 - 901", "no atom 901"}},
                    Refusal{"BondToItself", "2 2 30 900", "2 2 30 30", {"atom 30 to itself"}},
                    Refusal{"CutOff", "1 1 12 7\n2 2 30 900\n", "1 1 12 7\n", {"ends in section 'Bonds'", "1 of 2"}},
                    Refusal{"NoBondsSection", "Bonds\n\n1 1 12 7\n2 2 30 900\n", "", {"2 bonds", "no section 'Bonds'"}},
                    Refusal{"SameIdTwice", "12 2 1 1.0", "7 2 1 1.0", {"atom id 7", "twice"}},
                    Refusal{"VelocityOfNobody", "900 0 0 0.5", "901 0 0 0.5", {"Velocities", "901"}},
                    Refusal{"UnknownStyle", "Atoms # molecular", "Atoms # dipole", {"dipole", "bond"}},
                    Refusal{"NegativeMass", "2 1.0 #", "2 -1.0 #", {"mass is -1", "positive"}}),
    [](const auto& the_case) { return std::string(the_case.param.name); });

TEST(LammpsData, RefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  const auto message = [](const std::filesystem::path& path) {
    return test::message_of<InputError>([&] { read_lammps_data(path); });
  };
  EXPECT_NE(message(folder / "missing.data").find("No such file"), std::string::npos);
  EXPECT_NE(message(folder / "").find("folder"), std::string::npos);
  EXPECT_NE(message(folder.file("empty.data", "")).find("empty"), std::string::npos);
  EXPECT_NE(message(folder.file("zeros.data", std::string(3 << 20, '\0'))).find("not a text file"), std::string::npos);
}

TEST(LammpsData, RefusesDamagedGzip) {
  const TemporaryFolder folder;
  std::string bytes = test::content_of(std::string(BOBA_TEST_DATA) + "/forces/ortho.ref.data.gz");
  for (const std::size_t length : {std::size_t{20}, bytes.size() / 2, bytes.size() - 4}) {
    const auto path = folder.file("cut.data.gz", bytes.substr(0, length));
    const std::string message = test::message_of<InputError>([&] { read_lammps_data(path); });
    EXPECT_NE(message.find("compressed data"), std::string::npos) << length << ": " << message;
  }
  bytes[bytes.size() / 2] ^= 0x10;
  EXPECT_THROW(read_lammps_data(folder.file("flipped.data.gz", bytes)), InputError);
}

TEST(LammpsData, WritesWhatItReads) {
  const TemporaryFolder folder;
  Topology topology;
  topology.first_node = {0, 2, 3};
  topology.id = {4, 2, 9};
  topology.molecule = {11, 3};
  topology.species = {0, 1};
  topology.alpha = {0, 0};
  topology.template_index = {0, 1};
  topology.bonds = {{0, 1, 1.0}};
  Snapshot snapshot;
  snapshot.step = 17;
  snapshot.box = Box(Vector3(1, 2, 3), Vector3(5, 6, 7), Vector3(0.5, 0.25, -1));
  snapshot.position = {Vector3(0.1, 2.5, 4), Vector3(1.1, 2.5, 4), Vector3(20, -30, 40)};
  snapshot.velocity = {Vector3(1e-300, 2, 3), Vector3(0.1, 0.2, 0.3), Vector3(-1, 0, 1)};
  for (const std::string name : {"out.data", "out.data.gz"}) {
    write_lammps_data(folder / name, topology, snapshot);
    const LammpsData data = read_lammps_data(folder / name);
    EXPECT_EQ(data.timestep, 17);
    EXPECT_EQ(data.id, topology.id);
    EXPECT_EQ(data.molecule, (std::vector<std::int64_t>{11, 11, 3}));
    EXPECT_EQ(data.type, (std::vector<int>{1, 1, 2}));
    EXPECT_TRUE(data.box.h().isApprox(snapshot.box.h(), 1e-15));
    for (int node = 0; node < 3; ++node) {
      EXPECT_LT((data.position[node] - snapshot.position[node]).norm(), 1e-13);
      EXPECT_EQ(data.velocity[node], snapshot.velocity[node]);
    }
    EXPECT_EQ(data.bond_rows()[0], (std::array<std::int64_t, 2>{0, 1}));
    EXPECT_THROW(write_lammps_data(folder / name, topology, snapshot), std::runtime_error);
    write_lammps_data(folder / name, topology, snapshot, FileMode::overwrite);
  }
}

} // namespace
} // namespace boba
