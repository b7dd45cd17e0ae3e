// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/input_error.h"
#include "bpm/io/vtk.h"
#include "tests/support/small_packings.h"
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <gtest/gtest.h>

namespace boba {
namespace {

using test::small_snapshot;
using test::small_topology;
using test::TemporaryFolder;

TEST(Vtk, IsReadByVtk) {
  const TemporaryFolder folder;
  VtkSeries series(folder / "run.pvd");
  for (const int step : {0, 10, 25}) {
    series.write(small_topology(), small_snapshot(step));
  }
  const std::string command = std::string(BOBA_PYTHON) + " " + BOBA_TEST_DATA + "/../support/read_vtk.py " +
                              (folder / "run.pvd").string() + " ";
  EXPECT_EQ(std::system((command + "0 10 25").c_str()), 0);
  EXPECT_NE(std::system((command + "0 10 24 2>/dev/null").c_str()), 0) << "the comparison must be able to fail";
}

TEST(Vtk, LeavesOutWhatTheSnapshotLacks) {
  const TemporaryFolder folder;
  Snapshot snapshot = small_snapshot(0);
  snapshot.velocity.clear();
  snapshot.force.clear();
  write_vtp(folder / "a.vtp", small_topology(), snapshot);
  const std::string text = test::content_of(folder / "a.vtp");
  EXPECT_EQ(text.find("velocity"), std::string::npos);
  EXPECT_EQ(text.find("\"force\""), std::string::npos);
  EXPECT_NE(text.find("\"grain\""), std::string::npos);
  EXPECT_THROW(write_vtp(folder / "a.vtp", small_topology(), snapshot), std::runtime_error);
}

TEST(Vtk, SeriesGoesOnAfterACheckpoint) {
  const TemporaryFolder folder;
  const auto pvd = folder / "run.pvd";
  VtkSeries series(pvd);
  for (const int step : {0, 10, 20}) {
    series.write(small_topology(), small_snapshot(step));
  }
  const std::string whole = test::content_of(pvd);
  VtkSeries again = VtkSeries::go_on(pvd, 10);
  EXPECT_FALSE(std::filesystem::exists(folder / "run_20.vtp"));
  EXPECT_TRUE(std::filesystem::exists(folder / "run_10.vtp"));
  EXPECT_NE(test::content_of(pvd), whole);
  again.write(small_topology(), small_snapshot(10));
  again.write(small_topology(), small_snapshot(20));
  EXPECT_EQ(test::content_of(pvd), whole);
  EXPECT_THROW(VtkSeries{pvd}, std::runtime_error);
  const auto other = folder.file("other.pvd", "<DataSet timestep=\"0\" name=\"99\" file=\"/etc/passwd\"/>\n");
  EXPECT_THROW(VtkSeries::go_on(other, 10), InputError);
}

} // namespace
} // namespace boba
