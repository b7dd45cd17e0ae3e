// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace boba {

/// Cores that this process may run on: its affinity mask (taskset, Slurm, mpirun --bind-to), at least 1.
int cores_of_mask();

/// Cores' worth of time that the process's control group may use, rounded up: cpu.max of cgroup v2 or cpu.cfs_quota_us
/// of v1, the smallest on the way up. 0 without a limit.
/// \param groups as /proc/self/cgroup; `root` as /sys/fs/cgroup
int cores_of_quota(const std::filesystem::path& groups = "/proc/self/cgroup",
                   const std::filesystem::path& root = "/sys/fs/cgroup");

/// Threads that make sense here: the smaller of both, at least 1.
int usable_cores();

} // namespace boba
