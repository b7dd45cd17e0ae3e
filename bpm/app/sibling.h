// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace boba {

/// Folder of the running program.
std::filesystem::path program_folder();

/// Replaces this process by another program of the same folder; no shell is involved.
/// \throws std::runtime_error when it is not there or cannot be started.
int start_sibling(const std::string& program, const char* subcommand, const std::vector<std::string>& arguments);

/// Replaces this process by the program with these arguments. \throws std::runtime_error when that fails.
[[noreturn]] void replace_process(const std::filesystem::path& program, const std::vector<std::string>& arguments);

} // namespace boba
