// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/app/python.h"

#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace boba::calibration {

namespace {

namespace fs = std::filesystem;

/// The script in the installation the program belongs to, else in the source tree it was built from.
fs::path find_script(const std::string& script) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share" / "boba" / script;
  return !error && fs::exists(installed) ? installed : fs::path(BOBA_SCRIPT_FOLDER) / script;
}

} // namespace

bool run_python(const std::string& script, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {BOBA_PYTHON, find_script(script).string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) {
    argv.push_back(word.data());
  }
  argv.push_back(nullptr);
  pid_t child = 0;
  int status = 0;
  if (posix_spawn(&child, argv[0], nullptr, nullptr, argv.data(), environ) != 0 ||
      waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    fmt::print(stderr, "boba-calibrate: {} failed; the numbers are written, the picture is not\n", script);
    return false;
  }
  return true;
}

} // namespace boba::calibration
