// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/parallel/usable_cores.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sched.h>
#include <string>
#include <thread>
#include <vector>

namespace boba {

namespace {

namespace fs = std::filesystem;

/// Quota divided by period, both in microseconds, of one control group; 0 without a limit.
double quota_of(const fs::path& group) {
  double quota = 0.0, period = 0.0;
  if (std::ifstream in(group / "cpu.max"); in >> quota >> period) { // "max 100000" without a limit: no number
    return quota > 0.0 && period > 0.0 ? quota / period : 0.0;
  }
  std::ifstream v1_quota(group / "cpu.cfs_quota_us"), v1_period(group / "cpu.cfs_period_us");
  if (v1_quota >> quota && v1_period >> period) { // -1 without a limit
    return quota > 0.0 && period > 0.0 ? quota / period : 0.0;
  }
  return 0.0;
}

/// Folder of the process's group below `root`, and where that hierarchy begins; from a line "ID:CONTROLLERS:PATH".
struct GroupFolder {
  fs::path top, path;
};

std::vector<GroupFolder> group_folders(const fs::path& groups, const fs::path& root) {
  std::vector<GroupFolder> folders;
  std::ifstream in(groups);
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) {
      continue;
    }
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const fs::path below = fs::path(line.substr(second + 1)).relative_path();
    const std::string listed = "," + controllers + ",";
    if (controllers.empty()) {
      folders.push_back({root, root / below});
    } else if (listed.find(",cpu,") != std::string::npos) {
      folders.push_back({root / "cpu", root / "cpu" / below});
    }
  }
  return folders;
}

} // namespace

int cores_of_mask() {
  constexpr int most = 1 << 16;
  for (int n = 1024; n <= most; n *= 4) { // the kernel wants room for all cores that it could have
    cpu_set_t* set = CPU_ALLOC(n);
    if (set == nullptr) {
      break;
    }
    const std::size_t size = CPU_ALLOC_SIZE(n);
    const bool is_known = sched_getaffinity(0, size, set) == 0;
    const int count = is_known ? CPU_COUNT_S(size, set) : 0;
    CPU_FREE(set);
    if (count > 0) {
      return count;
    }
  }
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

int cores_of_quota(const fs::path& groups, const fs::path& root) {
  double smallest = 0.0;
  for (const GroupFolder& folder : group_folders(groups, root)) {
    fs::path at = folder.path.lexically_normal();
    const fs::path top = folder.top.lexically_normal();
    while (true) {
      const double quota = quota_of(at);
      smallest = quota > 0.0 && (smallest == 0.0 || quota < smallest) ? quota : smallest;
      if (at == top || !at.has_relative_path() || at == at.parent_path()) {
        break;
      }
      at = at.parent_path();
    }
  }
  return static_cast<int>(std::ceil(std::min(smallest, 1e6)));
}

int usable_cores() {
  const int quota = cores_of_quota();
  const int mask = cores_of_mask();
  return quota > 0 ? std::min(mask, quota) : mask;
}

} // namespace boba
