// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace boba {

/// The program's manual page, troff with the man macros, made from the description that its --help prints.
std::string manual_page(const CLI::App& program, const std::string& version);

/// Completion of commands, options and their values for a shell: "bash", "zsh" or "fish".
/// \throws std::invalid_argument for another shell.
std::string shell_completion(const CLI::App& program, const std::string& shell);

} // namespace boba
