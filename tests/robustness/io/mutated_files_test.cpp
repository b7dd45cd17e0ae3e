// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/input_error.h"
#include "bpm/io/lammps_packing.h"
#include "tests/support/temporary_folder.h"

#include <array>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

namespace boba {
namespace {

const std::string data_text = "title, timestep = 5\n\n5 atoms\n3 bonds\n2 atom types\n1 bond types\n"
                              "0 10 xlo xhi\n0 10 ylo yhi\n0 10 zlo zhi\n0.5 0 -0.5 xy xz yz\n\n"
                              "Masses\n\n1 1.0\n2 1.0\n\nAtoms # bond\n\n"
                              "1 1 1 1.0 1.0 1.0 0 0 0\n2 1 2 2.0 1.0 1.0 0 0 0\n3 1 1 2.0 2.0 1.0 0 0 0\n"
                              "4 2 1 9.5 5.0 5.0 0 0 0\n5 2 1 0.5 5.0 5.0 1 0 0\n\n"
                              "Velocities\n\n1 0 0 0\n2 0 0 1\n3 0 1 0\n4 1 0 0\n5 1 1 1\n\n"
                              "Bonds\n\n1 1 1 2\n2 1 2 3\n3 1 4 5\n";
const std::string dump_text = "ITEM: TIMESTEP\n10\nITEM: NUMBER OF ATOMS\n5\nITEM: BOX BOUNDS xy xz yz pp pp pp\n"
                              "0 10.5 0.5\n-0.5 10 0\n0 10 -0.5\nITEM: ATOMS id x y z vx vy vz ix iy iz\n"
                              "1 1 1 1 0 0 0 0 0 0\n5 0.5 5 5 0 0 0 1 0 0\n2 2 1 1 0 0 0 0 0 0\n"
                              "4 9.5 5 5 0 0 0 0 0 0\n3 2 2 1 0 0 0 0 0 0\n";

/// Exchanges, drops, doubles or cuts something at a random place.
std::string mutated(std::string text, std::mt19937& random) {
  const std::vector<std::string> odd = {"nan",
                                        "-inf",
                                        "1e999",
                                        "-1",
                                        "0",
                                        "99999999999999999999",
                                        "9223372036854775807",
                                        "1e-400",
                                        "0x10",
                                        "#",
                                        "\n",
                                        "",
                                        "1.5",
                                        "1e308",
                                        "-1e308",
                                        "Bonds",
                                        "\xff",
                                        "+"};
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  const std::size_t at = below(text.size());
  const std::size_t begin = text.find_last_of(" \n", at) + 1,
                    end = std::min(text.find_first_of(" \n", at), text.size());
  switch (below(5)) {
  case 0:
    return text.substr(0, at);
  case 1:
    text[at] = static_cast<char>(below(256));
    return text;
  case 2: { // a line twice, or not at all
    const std::size_t line = text.rfind('\n', at) + 1, next = std::min(text.find('\n', at) + 1, text.size());
    return below(2) == 0 ? text.erase(line, next - line) : text.insert(line, text.substr(line, next - line));
  }
  default:
    return begin <= end ? text.replace(begin, end - begin, odd[below(odd.size())]) : text;
  }
}

TEST(MutatedFiles, AreReadOrRefusedByName) {
  const test::TemporaryFolder folder;
  const auto good_data = folder.file("good.data", data_text), good_dump = folder.file("good.dump", dump_text);
  ASSERT_EQ(read_lammps_packing({good_data, good_dump, {}}).timestep, 10);
  std::mt19937 random(77);
  std::array<int, 2> n_read = {0, 0}, n_refused = {0, 0};
  for (int round = 0; round < 2000; ++round) {
    const int which = round % 2;
    const auto path = which == 0 ? folder.file("bad.data", mutated(data_text, random))
                                 : folder.file("bad.dump", mutated(dump_text, random));
    try {
      const LammpsPacking read =
          which == 0 ? read_lammps_packing({path, {}, {}}) : read_lammps_packing({good_data, path, {}});
      ASSERT_EQ(read.packing.position.size(), read.packing.id.size());
      ASSERT_TRUE(read.packing.box.h().allFinite());
      for (const Vector3& x : read.packing.position) {
        ASSERT_TRUE(x.allFinite()) << test::content_of(path);
      }
      ++n_read[which];
    } catch (const InputError& error) {
      const std::string message = error.what();
      ASSERT_TRUE(message.starts_with(path.string() + ":")) << message;
      ASSERT_EQ(message.find('\n'), std::string::npos) << message;
      ++n_refused[which];
    }
  }
  for (const int which : {0, 1}) { // both outcomes were really met
    EXPECT_GT(n_read[which], 100);
    EXPECT_GT(n_refused[which], 100);
  }
}

} // namespace
} // namespace boba
