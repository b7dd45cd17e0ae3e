// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace boba {

std::string version();      ///< "0.1.0"
std::string git_hash();     ///< of the sources this program was built from, or "unknown"
std::string version_text(); ///< one line with both

} // namespace boba
