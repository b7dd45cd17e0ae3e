// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/input_error.h"
#include "bpm/io/lammps_data.h"
#include "bpm/io/lammps_dump.h"
#include "bpm/io/lammps_packing.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <map>

namespace boba {
namespace {

const std::string data_folder = std::string(BOBA_TEST_DATA) + "/forces/";

TEST(LammpsPacking, JoinsReferenceAndDump) {
  const LammpsPacking read =
      read_lammps_packing({data_folder + "tri.ref.data.gz", data_folder + "tri.a2.step100.dump.gz", {}});
  EXPECT_EQ(read.timestep, 100);
  const LammpsFrame frame = read_lammps_dump(data_folder + "tri.a2.step100.dump.gz");
  std::map<std::int64_t, std::size_t> row_of_id;
  for (std::size_t row = 0; row < frame.id.size(); ++row) {
    row_of_id[frame.id[row]] = row;
  }
  const Packing& packing = read.packing;
  ASSERT_EQ(packing.position.size(), 606u);
  for (std::size_t node = 0; node < packing.position.size(); ++node) {
    const std::size_t row = row_of_id.at(packing.id[node]);
    // The peer's image flags are consistent, so both agree up to one lattice vector for each grain.
    EXPECT_EQ(packing.velocity[node], frame.velocity[row]);
    EXPECT_LT((packing.box.wrapped(packing.position[node]) - packing.box.wrapped(frame.position[row])).norm(), 1e-12);
  }
  for (const Topology::Pair& bond : packing.topology(true).bonds) {
    EXPECT_LT((packing.position[bond.i] - packing.position[bond.j]).norm(), 2.5);
  }
}

TEST(LammpsPacking, TakesADataFileAsState) {
  const test::TemporaryFolder folder;
  const LammpsPacking from_dump =
      read_lammps_packing({data_folder + "tri.ref.data.gz", data_folder + "tri.pert.dump.gz", {}});
  Snapshot snapshot;
  snapshot.box = from_dump.packing.box;
  snapshot.position = from_dump.packing.position;
  snapshot.velocity = from_dump.packing.velocity;
  write_lammps_data(folder / "state.data", from_dump.packing.topology(true), snapshot);
  const LammpsPacking from_data = read_lammps_packing({data_folder + "tri.ref.data.gz", folder / "state.data", {}});
  EXPECT_EQ(from_data.packing.id, from_dump.packing.id);
  EXPECT_EQ(from_data.packing.velocity, from_dump.packing.velocity);
  for (std::size_t node = 0; node < snapshot.position.size(); ++node) {
    EXPECT_LT((from_data.packing.position[node] - snapshot.position[node]).norm(), 1e-12);
  }
}

TEST(LammpsPacking, StartsFromTheReferenceAlone) {
  const LammpsPacking read = read_lammps_packing({data_folder + "ortho.ref.data.gz", {}, {}});
  EXPECT_EQ(read.packing.n_grains(), 2);
  EXPECT_EQ(read.packing.velocity[17], Vector3(0, 0, 0));
}

TEST(LammpsPacking, NamesTheFileAtFault) {
  const test::TemporaryFolder folder;
  const std::string head = "t\n2 atoms\n1 bonds\n1 atom types\n1 bond types\n0 9 xlo xhi\n0 9 ylo yhi\n0 9 zlo zhi\n\n";
  const std::string body = "Atoms\n\n1 1 1 1 1 1\n2 1 1 2 1 1\n\nBonds\n\n1 1 1 2\n";
  const auto good = folder.file("good.data", head + body);
  const auto heavy = folder.file("heavy.data", head + "Masses\n\n1 2.5\n\n" + body);
  const auto state =
      folder.file("state.dump", "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n"
                                "0 9\n0 9\n0 9\nITEM: ATOMS id x y z\n1 1 1 1\n3 2 1 1\n");
  const auto torn = folder.file("torn.dump", "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n"
                                             "0 9\n0 9\n0 9\nITEM: ATOMS id x y z\n1 1 1 1\n2 5.5 1 1\n");
  const auto message = [](const LammpsSource& source) {
    return test::message_of<InputError>([&] { read_lammps_packing(source); });
  };
  EXPECT_EQ(message({good, {}, {}}), "");
  EXPECT_NE(message({heavy, {}, {}}).find("heavy.data: section 'Masses' gives 2.5"), std::string::npos);
  EXPECT_NE(message({good, state, {}}).find("state.dump: there is no atom 2"), std::string::npos);
  EXPECT_NE(message({good, torn, {}}).find("torn.dump: bond between nodes"), std::string::npos);
}

} // namespace
} // namespace boba
