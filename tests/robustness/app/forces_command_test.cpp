// SPDX-License-Identifier: GPL-3.0-or-later
// `boba forces` against what LAMMPS computed for the same states (tests/data/forces).
#include "bpm/io/lammps_dump.h"
#include "tests/robustness/app/small_scene.h"

#include <cmath>
#include <gtest/gtest.h>

namespace boba::test {
namespace {

const std::filesystem::path data = std::filesystem::path(BOBA_TEST_DATA) / "forces";

/// The six numbers behind "step0 pxx pyy pzz pxy pxz pyz =".
std::vector<double> published_pressure(const std::filesystem::path& file) {
  const std::string text = content_of(file);
  std::istringstream in(text.substr(text.find('=') + 1));
  std::vector<double> p(6);
  for (double& value : p) {
    in >> value;
  }
  return p;
}

TEST(ForcesCommand, AgreesWithLammps) {
  const TemporaryFolder folder;
  for (const std::string name : {"ortho", "tri"}) {
    for (const std::string alpha : {"-0.8", "0", "2", "12"}) {
      const std::string out = (folder / "f.dump").string();
      const ProgramResult result =
          boba({"forces", data / (name + ".ref.data.gz"), "--state", data / (name + ".pert.dump.gz"),
                "--alpha=" + alpha, "--output", out, "--force"},
               folder);
      ASSERT_EQ(result.exit_code, 0) << result.err;

      const LammpsFrame expected = read_lammps_dump(data / (name + ".a" + alpha + ".step0.dump.gz"));
      const LammpsFrame found = read_lammps_dump(out);
      const std::vector<std::int64_t> rows = rows_of_ids(found, expected.id, out);
      double largest = 0.0, difference = 0.0;
      for (std::size_t i = 0; i < expected.id.size(); ++i) {
        largest = std::max(largest, expected.force[i].norm());
        difference = std::max(difference, (found.force[rows[i]] - expected.force[i]).norm());
      }
      EXPECT_LT(difference, 1e-11 * largest) << name << " " << alpha;

      std::istringstream printed(result.out);
      double scale = 0.0;
      const std::vector<double> p = published_pressure(data / (name + ".a" + alpha + ".press.txt"));
      for (const double value : p) {
        scale = std::max(scale, std::abs(value));
      }
      for (const double value : p) {
        double mine = std::nan("");
        printed >> mine;
        EXPECT_NEAR(mine, value, 1e-11 * scale) << name << " " << alpha;
      }
    }
  }
}

TEST(ForcesCommand, KeepsAnExistingFile) {
  const TemporaryFolder folder;
  folder.file("f.dump", "mine");
  const std::string reference = data / "ortho.ref.data.gz";
  EXPECT_EQ(boba({"forces", reference, "--alpha", "0", "--output", "f.dump"}, folder).exit_code, 2);
  EXPECT_EQ(content_of(folder / "f.dump"), "mine");
}

TEST(ForcesCommand, PrintsThePressureAlone) {
  const TemporaryFolder folder;
  const std::string reference = std::filesystem::path(BOBA_TEST_DATA) / "../../examples/from_lammps/undeformed.data.gz";
  const ProgramResult result = boba({"forces", reference, "--alpha", "0", "--pressure"}, folder);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::istringstream in(result.out);
  int n = 0;
  for (double value; in >> value;) {
    EXPECT_LT(std::abs(value), 1e-12) << "undeformed grains that do not touch carry no stress";
    ++n;
  }
  EXPECT_EQ(n, 6);
}

} // namespace
} // namespace boba::test
