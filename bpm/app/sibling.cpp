// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/sibling.h"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <stdexcept>
#include <unistd.h>

namespace boba {

std::filesystem::path program_folder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

void replace_process(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) {
    argv.push_back(word.data());
  }
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  throw std::runtime_error(fmt::format("{}: cannot be started: {}", program.string(), std::strerror(errno)));
}

int start_sibling(const std::string& program, const char* subcommand, const std::vector<std::string>& arguments) {
  const std::filesystem::path path = program_folder() / program;
  if (!std::filesystem::exists(path)) {
    throw std::runtime_error(fmt::format(
        "{}: there is no such program; it was not built (see CMakeLists.txt, BOBA_BUILD_...)", path.string()));
  }
  std::vector<std::string> all;
  if (subcommand != nullptr) {
    all.emplace_back(subcommand);
  }
  all.insert(all.end(), arguments.begin(), arguments.end());
  replace_process(path, all);
}

} // namespace boba
