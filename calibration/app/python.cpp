// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/app/python.h"

#include "base/program.h"

#include <cstdio>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::calibration {

bool run_python(const std::string& script, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {(data_folder() / script).string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  try {
    if (run_process(BOBA_PYTHON, words) == 0) {
      return true;
    }
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "boba-calibrate: {}\n", error.what());
  }
  fmt::print(stderr, "boba-calibrate: {} failed; the numbers are written, the picture is not\n", script);
  return false;
}

} // namespace boba::calibration
