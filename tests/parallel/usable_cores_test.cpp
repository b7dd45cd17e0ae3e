// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/parallel/usable_cores.h"
#include "tests/support/temporary_folder.h"

#include <sched.h>

namespace boba::test {
namespace {

/// Writes a file and the folders on the way.
void put(const std::filesystem::path& path, const std::string& content) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << content;
}

TEST(UsableCores, FollowTheAffinityMask) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  EXPECT_EQ(cores_of_mask(), CPU_COUNT(&before));
  cpu_set_t one;
  CPU_ZERO(&one);
  for (int core = 0; core < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++core) {
    if (CPU_ISSET(core, &before)) {
      CPU_SET(core, &one);
    }
  }
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  EXPECT_EQ(cores_of_mask(), 1);
  EXPECT_EQ(usable_cores(), 1);
  sched_setaffinity(0, sizeof before, &before);
}

TEST(UsableCores, FollowTheSmallestQuotaOnTheWayUp) {
  const TemporaryFolder folder;
  const auto groups = folder.file("cgroup", "0::/slice/job\n");
  const auto root = folder / "fs";
  put(root / "slice/job/cpu.max", "max 100000\n");
  EXPECT_EQ(cores_of_quota(groups, root), 0);
  put(root / "slice/cpu.max", "250000 100000\n");
  EXPECT_EQ(cores_of_quota(groups, root), 3); // two and a half cores' worth
  put(root / "slice/job/cpu.max", "50000 100000\n");
  EXPECT_EQ(cores_of_quota(groups, root), 1);
}

TEST(UsableCores, ReadTheFirstVersionToo) {
  const TemporaryFolder folder;
  // In a container the group's path is the host's: only the top is there.
  const auto groups = folder.file("cgroup", "5:memory:/docker/1\n3:cpu,cpuacct:/docker/1\n");
  put(folder / "fs/cpu/cpu.cfs_quota_us", "400000\n");
  put(folder / "fs/cpu/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(cores_of_quota(groups, folder / "fs"), 4);
  put(folder / "fs/cpu/cpu.cfs_quota_us", "-1\n");
  EXPECT_EQ(cores_of_quota(groups, folder / "fs"), 0);
  EXPECT_EQ(cores_of_quota(folder / "nowhere", folder / "fs"), 0);
}

} // namespace
} // namespace boba::test
