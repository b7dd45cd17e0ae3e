// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace boba {

/// An assignment of the command line, "title=two lines", as one line that means the same: as such it is stored in
/// checkpoints, and in comments of scene.toml. A text that is no TOML is quoted when it holds control characters; in a
/// list or table line breaks become spaces.
/// \throws InputError when that is not possible: in names, and in TOML's strings of several lines.
std::string one_line_override(const std::string& assignment);

} // namespace boba
