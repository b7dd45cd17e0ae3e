// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace boba::calibration {

/// Runs one of Boba's scripts (in data_folder()) with Debian's python3; false when it fails.
bool run_python(const std::string& script, const std::vector<std::string>& arguments);

} // namespace boba::calibration
