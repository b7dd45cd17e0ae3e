// SPDX-License-Identifier: GPL-3.0-or-later
// The wrapper against HDF5's own tools: h5dump and h5py read what it writes (trajectory_test.cpp, python tests); here
// its own promises.
#include "base/hdf5/hdf5_file.h"
#include "tests/support/temporary_folder.h"

#include <fcntl.h>
#include <fstream>
#include <gtest/gtest.h>
#include <stdexcept>
#include <unistd.h>

namespace boba::test {
namespace {

using hdf5::File;

TEST(Hdf5File, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "file.h5";
  const std::vector<double> reals = {1.5, -2.25, 1e300};
  const std::vector<std::int32_t> ends = {0, 1, 1, 2};
  {
    File file = File::create(path);
    file.make_group("/a/b");
    file.write("/a/b/reals", std::span<const double>(reals));
    file.write("/a/ends", std::span<const std::int32_t>(ends), 2);
    file.write_text("/text", "two\nlines");
    file.set_attribute("/a/b/reals", "unit", std::string("d"));
    file.close();
  }
  const File file = File::open(path, false);
  EXPECT_EQ(file.read<double>("/a/b/reals"), reals);
  EXPECT_EQ(file.read<std::int32_t>("/a/ends"), ends);
  EXPECT_EQ(file.shape("/a/ends"), (std::vector<hsize_t>{2, 2}));
  EXPECT_EQ(file.read_text("/text"), "two\nlines");
  EXPECT_EQ(file.text_attribute("/a/b/reals", "unit"), "d");
  EXPECT_TRUE(file.has("/a/b"));
  EXPECT_FALSE(file.has("/a/c"));
}

TEST(Hdf5File, GrowsFrameByFrame) {
  const TemporaryFolder folder;
  File file = File::create(folder / "file.h5");
  file.make_growing("/x", {.frame_shape = {2, 3}}, -1.0);
  const std::vector<double> first = {1, 2, 3, 4, 5, 6}, third = {7, 8, 9, 10, 11, 12};
  file.write_frame("/x", 0, std::span<const double>(first));
  file.write_frame("/x", 2, std::span<const double>(third)); // the frame between is the fill value
  EXPECT_EQ(file.shape("/x"), (std::vector<hsize_t>{3, 2, 3}));
  EXPECT_EQ(file.read_frame<double>("/x", 1), std::vector<double>(6, -1.0));
  EXPECT_EQ(file.read_frame<double>("/x", 2), third);
  file.set_frames("/x", 1);
  EXPECT_EQ(file.shape("/x"), (std::vector<hsize_t>{1, 2, 3}));
  const std::vector<double> short_frame = {1, 2};
  EXPECT_NE(message_of<std::runtime_error>([&] {
              file.write_frame("/x", 0, std::span<const double>(short_frame));
            }).find("has 6 values"),
            std::string::npos);
  file.close();
}

TEST(Hdf5File, AllocatedFramesAreFilledByOthers) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "file.h5";
  const std::vector<double> values = {3.0, 1.0, 4.0};
  {
    File file = File::create(path, true);
    file.make_growing("/x", {.frame_shape = {3}}, 0.0);
    const std::uint64_t at = file.allocate_frame<double>("/x", 0);
    const int other = ::open(path.c_str(), O_WRONLY);
    ASSERT_EQ(pwrite(other, values.data(), sizeof(double) * values.size(), static_cast<off_t>(at)), 24);
    ::close(other);
    file.close();
  }
  EXPECT_EQ(File::open(path, false).read_frame<double>("/x", 0), values);
}

TEST(Hdf5File, DetachedKeepsWhatWasFlushed) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "file.h5";
  const std::vector<double> kept = {1.0}, lost = {2.0};
  {
    File file = File::create(path);
    file.write("/kept", std::span<const double>(kept));
    file.flush();
    file.detach();
    file.write("/lost", std::span<const double>(lost));
  }
  const File file = File::open(path, false);
  EXPECT_EQ(file.read<double>("/kept"), kept);
  EXPECT_FALSE(file.has("/lost"));
}

TEST(Hdf5File, NamesFileAndDatasetInErrors) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "file.h5";
  File file = File::create(path);
  const std::vector<double> reals = {1.0};
  file.write("/reals", std::span<const double>(reals));
  for (const std::string& message : {message_of<std::runtime_error>([&] { file.read<double>("/absent"); }),
                                     message_of<std::runtime_error>([&] { file.read<std::int64_t>("/reals"); })}) {
    EXPECT_NE(message.find("file.h5"), std::string::npos) << message;
  }
  EXPECT_NE(
      message_of<std::runtime_error>([&] { file.read<std::int64_t>("/reals"); }).find("does not hold whole numbers"),
      std::string::npos);
  file.close();
  std::ofstream(path) << "no HDF5 file";
  EXPECT_NE(message_of<std::runtime_error>([&] { File::open(path, false); }).find("file.h5"), std::string::npos);
}

} // namespace
} // namespace boba::test
