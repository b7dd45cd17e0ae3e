// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/hdf5/hdf5_file.h"
#include "bpm/io/input_error.h"
#include "bpm/io/trajectory.h"
#include "bpm/io/trajectory_packing.h"
#include "tests/support/small_packings.h"
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <limits>

namespace boba {
namespace {

using test::small_snapshot;
using test::small_topology;
using test::TemporaryFolder;

TrajectoryOrigin small_origin() {
  return {"# a scene\nseed = 12 # \u00e9\n", std::numeric_limits<std::uint64_t>::max(), "0.1.0", "0123abc", "unknown"};
}

void write_frames(TrajectoryWriter& writer, std::initializer_list<std::int64_t> steps) {
  for (const std::int64_t step : steps) {
    writer.write(small_snapshot(step));
  }
}

void expect_frames(const std::filesystem::path& path, const std::vector<std::int64_t>& steps) {
  const TrajectoryReader reader(path);
  EXPECT_EQ(reader.steps(), steps);
  for (std::int64_t frame = 0; frame < reader.n_frames(); ++frame) {
    const Snapshot read = reader.snapshot(frame), wanted = small_snapshot(steps[frame]);
    EXPECT_EQ(read.step, wanted.step);
    EXPECT_EQ(read.time, wanted.time);
    EXPECT_EQ(read.strain, wanted.strain);
    EXPECT_EQ(read.streaming_rate, wanted.streaming_rate);
    EXPECT_EQ(read.box.h(), wanted.box.h());
    EXPECT_EQ(read.box.origin(), wanted.box.origin());
    EXPECT_EQ(read.grain_centre, wanted.grain_centre);
    EXPECT_EQ(read.grain_stress, wanted.grain_stress);
    for (std::size_t node = 0; node < wanted.position.size(); ++node) {
      EXPECT_LT((read.position[node] - wanted.position[node]).norm(), 1e-13);
    }
    if (reader.has_velocity()) {
      EXPECT_EQ(read.velocity, wanted.velocity);
    }
  }
}

int run_python(const std::string& arguments) {
  const std::string script = std::string(BOBA_TEST_DATA) + "/../support/read_trajectory.py ";
  return std::system((std::string(BOBA_PYTHON) + " " + script + arguments).c_str());
}

TEST(Trajectory, IsReadByMdanalysis) {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5md";
  TrajectoryWriter writer(path, small_topology(), small_origin(), {true, 0});
  write_frames(writer, {0, 10, 25});
  // The writer still has the file open, as in a run that goes on.
  EXPECT_EQ(run_python(path.string() + " 0 10 25"), 0);
  writer.close();
  EXPECT_EQ(run_python(path.string() + " 0 10 25"), 0);
  EXPECT_NE(run_python(path.string() + " 0 10 24 2>/dev/null"), 0) << "the comparison must be able to fail";
}

TEST(Trajectory, ReadsBackWhatWasWritten) {
  for (const TrajectoryOptions options :
       {TrajectoryOptions{true, 0}, TrajectoryOptions{false, 0}, TrajectoryOptions{true, 4}}) {
    const TemporaryFolder folder;
    const auto path = folder / "run.h5md";
    TrajectoryWriter writer(path, small_topology(), small_origin(), options);
    write_frames(writer, {5, 6, 3000000000});
    EXPECT_EQ(writer.n_frames(), 3);
    expect_frames(path, {5, 6, 3000000000});
    const TrajectoryReader reader(path);
    EXPECT_EQ(reader.has_velocity(), options.velocity);
    EXPECT_EQ(reader.origin().scene, small_origin().scene);
    EXPECT_EQ(reader.origin().seed, small_origin().seed);
    EXPECT_EQ(reader.origin().git_hash, "0123abc");
    const Topology read = reader.topology(), wanted = small_topology();
    EXPECT_EQ(read.first_node, wanted.first_node);
    EXPECT_EQ(read.id, wanted.id);
    EXPECT_EQ(read.molecule, wanted.molecule);
    EXPECT_EQ(read.species, wanted.species);
    EXPECT_EQ(read.alpha, wanted.alpha);
    EXPECT_EQ(read.template_index, wanted.template_index);
    EXPECT_EQ(read.undeformed, wanted.undeformed);
    ASSERT_EQ(read.bonds.size(), wanted.bonds.size());
    for (std::size_t b = 0; b < read.bonds.size(); ++b) {
      EXPECT_EQ(read.bonds[b].i, wanted.bonds[b].i);
      EXPECT_EQ(read.bonds[b].j, wanted.bonds[b].j);
      EXPECT_EQ(read.bonds[b].r0, wanted.bonds[b].r0);
    }
  }
}

TEST(Trajectory, GivesFramesByNumberAndStep) {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5md";
  TrajectoryWriter writer(path, small_topology(), small_origin());
  write_frames(writer, {5, 6, 9});
  const TrajectoryReader reader(path);
  EXPECT_EQ(reader.snapshot(-1).step, 9);
  EXPECT_EQ(reader.snapshot(-3).step, 5);
  EXPECT_EQ(reader.frame_of_step(6), 1);
  EXPECT_NE(test::message_of<InputError>([&] { reader.snapshot(3); }).find("no frame 3"), std::string::npos);
  EXPECT_THROW(reader.snapshot(-4), InputError);
  EXPECT_NE(test::message_of<InputError>([&] { reader.frame_of_step(7); }).find("between steps 5 and 9"),
            std::string::npos);
}

/// Positions that do not follow a shear carry its profile in their velocities. A stage adds the profile of its own.
TEST(Trajectory, APackingStartsWithoutTheStreamingOfItsFrame) {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5md";
  TrajectoryWriter writer(path, small_topology(), small_origin(), {true, 0});
  write_frames(writer, {5, 9});
  const Snapshot frame = small_snapshot(9);
  const Packing packing = read_trajectory_packing(path, -1);
  for (std::size_t node = 0; node < frame.position.size(); ++node) {
    const double streaming = 0.018 * (frame.position[node][1] + 2.0); // rate times height above the cell's origin
    EXPECT_NEAR(packing.velocity[node][0], frame.velocity[node][0] - streaming, 1e-13);
    EXPECT_EQ(packing.velocity[node][1], frame.velocity[node][1]);
    EXPECT_EQ(packing.velocity[node][2], frame.velocity[node][2]);
  }
}

TEST(Trajectory, GoesOnAfterACheckpointWithoutDuplicates) {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5md";
  {
    TrajectoryWriter writer(path, small_topology(), small_origin(), {true, 0});
    write_frames(writer, {0, 10, 20, 30, 40});
  }
  for (const auto& [checkpoint, kept] : {std::pair{25, 3}, {20, 3}, {19, 2}}) {
    TrajectoryWriter writer = TrajectoryWriter::go_on(path, small_topology(), checkpoint);
    EXPECT_EQ(writer.n_frames(), kept);
    write_frames(writer, checkpoint < 20 ? std::initializer_list<std::int64_t>{10, 20, 30}
                                         : std::initializer_list<std::int64_t>{20, 30});
  }
  expect_frames(path, {0, 10, 20, 30});
  EXPECT_EQ(run_python(path.string() + " 0 10 20 30"), 0);
  { TrajectoryWriter writer = TrajectoryWriter::go_on(path, small_topology(), -1); }
  expect_frames(path, {});
}

TEST(Trajectory, GoesOnBeforeItsFirstFrame) {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5md";
  { TrajectoryWriter writer(path, small_topology(), small_origin(), {true, 0}); }
  {
    TrajectoryWriter writer = TrajectoryWriter::go_on(path, small_topology(), 100);
    write_frames(writer, {200});
  }
  expect_frames(path, {200});
}

TEST(Trajectory, WritesManyFrames) {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5md";
  std::vector<std::int64_t> steps;
  {
    TrajectoryWriter writer(path, small_topology(), small_origin());
    for (std::int64_t step = 0; step < 1300; ++step) { // past the split of the index of chunks
      writer.write(small_snapshot(step));
      steps.push_back(step);
    }
  }
  expect_frames(path, steps);
}

TEST(Trajectory, FramesBeyondTheLargestChunkAreCutIntoSlabs) {
  const TemporaryFolder folder;
  const hdf5::File file = hdf5::File::create(folder / "a.h5");
  // HDF5 refuses chunks of 4 GiB: 178956971 nodes. Nothing is written of them.
  file.make_group("/large");
  EXPECT_NO_THROW(file.make_growing<double>("/large/value", {{200'000'000, 3}, 1, 0}, 0.0));
  EXPECT_FALSE(file.has_whole_frames("/large/value"));
  // The same for a small limit, with values.
  file.make_growing<double>("/small", {{7, 3}, 1, 0, 3 * 24}, 0.0);
  file.make_growing<double>("/whole", {{7, 3}, 1, 0}, 0.0);
  EXPECT_FALSE(file.has_whole_frames("/small"));
  EXPECT_TRUE(file.has_whole_frames("/whole"));
  for (const hsize_t frame : {0, 1}) {
    std::vector<double> values(21);
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] = static_cast<double>(100 * frame + k);
    }
    file.write_frame<double>("/small", frame, values);
    EXPECT_EQ(file.read_frame<double>("/small", frame), values);
  }
}

TEST(Trajectory, KeepsWallsOpen) {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5md";
  TrajectoryWriter writer(path, small_topology(), small_origin());
  Snapshot snapshot = small_snapshot(0);
  snapshot.box = Box(Vector3(0, 0, 0), Vector3(5, 5, 5), Vector3::Zero(), {true, false, false});
  writer.write(snapshot);
  const Snapshot read = TrajectoryReader(path).snapshot(0);
  EXPECT_EQ(read.box.periodic(), snapshot.box.periodic());
  EXPECT_EQ(read.position[4][1], snapshot.position[4][1]);
}

TEST(Trajectory, RefusesWrongUse) {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5md";
  TrajectoryWriter writer(path, small_topology(), small_origin(), {true, 0});
  writer.write(small_snapshot(10));
  writer.write(small_snapshot(10));
  EXPECT_EQ(writer.n_frames(), 1);
  EXPECT_THROW(writer.write(small_snapshot(9)), std::invalid_argument);
  Snapshot without = small_snapshot(11);
  without.velocity.clear();
  EXPECT_NE(test::message_of<std::invalid_argument>([&] { writer.write(without); }).find("0 velocities; 5"),
            std::string::npos);
  EXPECT_NE(test::message_of<std::runtime_error>([&] { TrajectoryWriter(path, small_topology(), {}); }).find("exists"),
            std::string::npos);
  EXPECT_THROW(TrajectoryWriter(folder / "no/such/folder.h5md", small_topology(), {}), std::runtime_error);
  Topology other = small_topology();
  other.id[0] = 99;
  EXPECT_NE(
      test::message_of<std::runtime_error>([&] { TrajectoryWriter::go_on(path, other, 10); }).find("another packing"),
      std::string::npos);
  const auto message = [](const std::filesystem::path& bad) {
    return test::message_of<InputError>([&] { TrajectoryReader reader(bad); });
  };
  EXPECT_NE(message(folder / "missing.h5md").find("missing.h5md"), std::string::npos);
  EXPECT_NE(message(folder.file("text.h5md", "no HDF5")).find("text.h5md"), std::string::npos);
  const std::string bytes = test::content_of(path);
  EXPECT_NE(message(folder.file("cut.h5md", bytes.substr(0, bytes.size() / 2))).find("cut.h5md"), std::string::npos);
}

} // namespace
} // namespace boba
