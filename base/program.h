// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace boba {

/// Folder of the running program. \throws std::filesystem::filesystem_error when the system does not tell it.
std::filesystem::path program_folder();

/// Folder of tables and scripts: ../share/boba beside the running program's folder; for a program outside the tree, the
/// share/boba of the installation that it was linked with (find_package(boba)).
std::filesystem::path data_folder();

/// The program `name` in the folder of the running one. \throws std::runtime_error when it is not there.
std::filesystem::path program_beside(const std::string& name);

/// Replaces this process by the program with these arguments; no shell is involved.
/// \throws std::runtime_error when that fails.
[[noreturn]] void replace_process(const std::filesystem::path& program, const std::vector<std::string>& arguments);

/// Replaces this process by the running program, with these arguments and the environment as it is now. Returns only
/// when that fails.
void restart_process(char** argv);

/// Runs the program to its end and returns its exit code, -1 when a signal ended it; no shell is involved.
/// \param log file that takes both output streams; empty: they go where this program's go
/// \throws std::runtime_error when the program cannot be started.
int run_process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                const std::filesystem::path& log = {});

} // namespace boba
