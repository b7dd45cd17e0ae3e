// SPDX-License-Identifier: GPL-3.0-or-later
// A disk that is really full: a small memory disk of this test's own mount namespace (run by `unshare`, see
// CMakeLists.txt). The run stops and names a file; with more room it is gone on with, to the same end bit for bit.
#include "tests/robustness/app/same_run.h"

#include <gtest/gtest.h>
#include <sys/mount.h>

namespace boba::test {
namespace {

/// A memory disk of so many bytes, mounted while it lives.
class SmallDisk {
public:
  SmallDisk(std::filesystem::path place, std::uintmax_t bytes) : place_(std::move(place)) {
    std::filesystem::create_directories(place_);
    mounted_ = mount("tmpfs", place_.c_str(), "tmpfs", 0, size(bytes).c_str()) == 0;
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() {
    if (mounted_) {
      umount(place_.c_str());
    }
  }
  bool mounted() const { return mounted_; }
  bool enlarge(std::uintmax_t bytes) const {
    return mount(nullptr, place_.c_str(), nullptr, MS_REMOUNT, size(bytes).c_str()) == 0;
  }

private:
  static std::string size(std::uintmax_t bytes) { return "size=" + std::to_string(bytes); }
  std::filesystem::path place_;
  bool mounted_ = false;
};

std::vector<std::string> command(const std::string& output) {
  return {"run",
          "scene.toml",
          "--output",
          output,
          "--quiet",
          "--set",
          "stage.2.strain=0.2",
          "--set",
          "output.checkpoint.every_time=30",
          "--set",
          "output.trajectory.every_strain=0.001",
          "--set",
          "measure=[{what = \"stress\", every_strain = 0.01}]"};
}

std::uintmax_t bytes_below(const std::filesystem::path& folder) {
  std::uintmax_t bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    bytes += entry.is_regular_file() ? (entry.file_size() / 4096 + 1) * 4096 : 4096;
  }
  return bytes;
}

TEST(FullDisk, IsToldAndLosesNothing) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  ASSERT_EQ(boba(command("alone"), folder).exit_code, 0);
  const std::uintmax_t needed = bytes_below(folder / "alone");
  ASSERT_GT(needed, 100000U);
  int n_full = 0, n_resumed = 0;
  // Room is reserved 2 MB ahead, so that a full disk is met between two frames.
  const int n_parts = 7;
  for (int part = 1; part <= n_parts; ++part) {
    const std::uintmax_t bytes = needed * part / n_parts + (1 << 20);
    SCOPED_TRACE(std::to_string(bytes) + " of " + std::to_string(needed) + " bytes");
    const SmallDisk disk(folder / "disk", bytes);
    ASSERT_TRUE(disk.mounted());
    const ProgramResult result = boba(command("disk/out"), folder);
    EXPECT_EQ(result.signal, 0) << "crashed";
    if (result.exit_code == 0) {
      EXPECT_GT(part, n_parts / 2);
      continue;
    }
    ++n_full;
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_NE(result.err.find("disk/out"), std::string::npos) << "names no file: " << result.err;
    ASSERT_TRUE(disk.enlarge(64 << 20));
    const ProgramResult resumed = boba({"resume", "disk/out", "--quiet"}, folder);
    if (resumed.exit_code == 0) {
      expect_same_run(folder / "alone", folder / "disk/out");
      ++n_resumed;
    } else { // not even the first checkpoint had room
      EXPECT_EQ(resumed.exit_code, 2) << resumed.err;
      EXPECT_NE(resumed.err.find("checkpoint"), std::string::npos) << resumed.err;
      EXPECT_LT(part, n_parts / 2) << resumed.err;
    }
  }
  EXPECT_GE(n_full, 3);
  EXPECT_GE(n_resumed, 2);
}

} // namespace
} // namespace boba::test
